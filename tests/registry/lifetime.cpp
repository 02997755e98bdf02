// SPDX-License-Identifier: GPL-3.0-or-later
// Who keeps a plugin's library mapped, and who lets go of it.
#include <optional>
#include <thread>

#include <doctest/doctest.h>

#include "cordon/registry/registry.hpp"
#include "registry/temporary.hpp"

using namespace cordon;
using namespace test;

namespace {

/// A library of its own for each case, so that no other case can keep it mapped.
struct Loaded {
  TemporaryDirectory directory;
  fs::path file = directory.add(good("test_box"));
  std::unique_ptr<Registry> registry = std::make_unique<Registry>();
  Loaded() { REQUIRE(registry->load_file(file).state == PluginReport::State::loaded); }
};

const Vector one = Vector::Ones(1);

}  // namespace

TEST_CASE("the library goes with the registry when nothing was made") {
  Loaded loaded;
  CHECK(is_mapped(loaded.file));
  loaded.registry.reset();
  CHECK_FALSE(is_mapped(loaded.file));
}

TEST_CASE("a set outlives the pointer to its backend, and even the registry") {
  Loaded loaded;
  std::optional<Enclosure> X =
      loaded.registry->make<BackendEntry>("test_box", {})->import(make_box({-one, one}));
  loaded.registry.reset();
  REQUIRE(is_mapped(loaded.file));
  CHECK((*X)->line_form().G.cwiseAbs().sum() == doctest::Approx(1));
  CHECK((*X)->complexity().generators == 1);
  Enclosure next = (*X)->backend().affine_map(*X, 2 * Matrix::Ones(1, 1), one);  // and makes others
  X.reset();
  CHECK(next->line_form().c[0] == 1);
  CHECK(next->backend().info().name == "test_box");
  next.set.reset();
  CHECK_FALSE(is_mapped(loaded.file));
}

TEST_CASE("a weak pointer keeps nothing alive and harms nothing") {
  Loaded loaded;
  std::weak_ptr<const Set> weak;
  {
    const Enclosure X =
        loaded.registry->make<BackendEntry>("test_box", {})->import(make_point(one));
    weak = X.set;
    loaded.registry.reset();
    CHECK(weak.lock());
  }
  CHECK_FALSE(weak.lock());
  weak.reset();
  CHECK_FALSE(is_mapped(loaded.file));
}

TEST_CASE("unload refuses while something lives, naming the number, and really unmaps afterwards") {
  Loaded loaded;
  Registry& registry = *loaded.registry;
  std::optional<Enclosure> X = registry.make<BackendEntry>("test_box", {})->import(make_point(one));
  auto metric = registry.make<MetricEntry>("step_count", {});
  CHECK_THROWS_WITH_AS(registry.unload("test_box"),
                       "plugin \"test_box\" cannot be unloaded while 2 of its components live; let "
                       "go of them and of their sets first",
                       Error);
  metric.reset();
  CHECK_THROWS_AS(registry.unload("test_box"), Error);
  CHECK(registry.info("backend", "test_box"));
  CHECK(is_mapped(loaded.file));
  X.reset();
  registry.unload("test_box");
  CHECK_FALSE(is_mapped(loaded.file));
  CHECK(registry.names("backend").empty());
  CHECK(registry.names("observer").empty());
  CHECK(registry.names("metric").empty());
  CHECK(registry.reports().empty());
  CHECK_THROWS_AS(registry.unload("test_box"), Error);
  CHECK(registry.load_file(loaded.file).state == PluginReport::State::loaded);
  CHECK(registry.make<BackendEntry>("test_box", {})->info().name == "test_box");
}

TEST_CASE("an observer keeps its backend, both keep the library") {
  Loaded loaded;
  const Matrix I = Matrix::Ones(1, 1);
  Model model;
  model.linear = {{}, I, I, I, I, I, I};
  model.X0 = model.W = model.V = make_point(one);
  auto observer = loaded.registry->make<ObserverEntry>(
      "open_loop", {model, loaded.registry->make<BackendEntry>("test_box", {})}, {});
  CHECK_THROWS_AS(loaded.registry->unload("test_box"), Error);
  loaded.registry.reset();
  observer->start();
  CHECK(is_mapped(loaded.file));
  observer.reset();
  CHECK_FALSE(is_mapped(loaded.file));
}

TEST_CASE("rolling back leaves no component and no mapping") {
  const TemporaryDirectory directory;
  const fs::path file = directory.add(bad("throws_late"));
  Registry registry;
  const PluginReport report = registry.load_file(file);
  CHECK(report.components == std::vector<std::string>{"metric before_the_throw"});
  CHECK(registry.names("metric").empty());
  CHECK_FALSE(is_mapped(file));
  CHECK(report.reason ==
        "it threw while registering: no licence server");  // a text of ours, not of the library's
}

TEST_CASE("sets are used and let go of in another thread") {
  Loaded loaded;
  Enclosure X = loaded.registry->make<BackendEntry>("test_box", {})->import(make_box({-one, one}));
  double sum = 0;
  std::thread other([&sum, X = std::move(X)]() mutable {
    for (int i = 0; i < 100; ++i) X = X->backend().sum(X, X->backend().point(Vector::Ones(1)));
    sum = X->line_form().c[0];
    X.set.reset();
  });
  loaded.registry.reset();
  other.join();
  CHECK(sum == 100);
  CHECK_FALSE(is_mapped(loaded.file));
}

TEST_CASE("components are made from several threads at once") {
  Loaded loaded;
  std::vector<std::thread> threads;
  std::vector<Enclosure> sets(4);
  for (Enclosure& set : sets) {
    threads.emplace_back([&registry = *loaded.registry, &set] {
      for (int i = 0; i < 50; ++i)
        set = registry.make<BackendEntry>("test_box", {})->import(make_point(Vector::Ones(2)));
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK_THROWS_AS(loaded.registry->unload("test_box"), Error);
  sets.clear();
  loaded.registry->unload("test_box");
  CHECK_FALSE(is_mapped(loaded.file));
}
