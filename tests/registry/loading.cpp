// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>

#include <doctest/doctest.h>

#include "cordon/registry/registry.hpp"
#include "registry/temporary.hpp"

using namespace cordon;
using namespace test;

namespace {

Model scalar_model() {
  Model model;
  const Matrix one = Matrix::Ones(1, 1);
  model.linear = {{}, one * 0.5, one, one, one, Matrix::Zero(1, 1), one};
  model.X0 = make_box({Vector::Constant(1, -1), Vector::Constant(1, 1)});
  model.W = model.V = make_box({Vector::Constant(1, -0.1), Vector::Constant(1, 0.1)});
  return model;
}

template <class Call>
std::string message_of(Errc code, Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    CHECK(error.code() == code);
    return error.what();
  }
  FAIL("nothing was thrown");
  return "";
}

void register_host_metric(Registrar& registrar) {
  registrar.add(MetricEntry{{"host_metric", "of the host", "", {}},
                            [](const Params&) -> std::unique_ptr<Metric> { return nullptr; }});
}
void register_then_throw(Registrar& registrar) {
  registrar.add(MetricEntry{{"never_seen", "of the host", "", {}},
                            [](const Params&) -> std::unique_ptr<Metric> { return nullptr; }});
  throw std::runtime_error("stop");
}

}  // namespace

TEST_CASE("a word is no spelling of another that shares no letter with it") {
  CHECK(suggest("tset_box", {"test_box", "u"}) == "did you mean \"test_box\"?");
  CHECK(suggest("e", {"A", "E"}) == "did you mean \"E\"?");
  CHECK(suggest("Z", {"A", "E"}) == "there are \"A\", \"E\"");
  CHECK(suggest("", {"W"}) == "there is only \"W\"");
}

TEST_CASE("a good plugin tells what it is, and its components are known") {
  Registry registry;
  const PluginReport& report = registry.load_file(good("test_box"));
  CHECK_MESSAGE(report.state == PluginReport::State::loaded, report.reason);
  CHECK(report.file == good("test_box"));
  CHECK(report.name == "test_box");
  CHECK(report.version == "1.2.3");
  CHECK(report.license == "GPL-3.0-or-later");
  CHECK(report.author == "The Cordon authors");
  CHECK(report.summary == "boxes for tests");
  CHECK(report.abi_tag == CORDON_ABI_TAG);
  CHECK(report.components ==
        std::vector<std::string>{"backend test_box", "observer open_loop", "metric step_count"});
  CHECK(registry.names("backend") == std::vector<std::string>{"test_box"});
  CHECK(registry.names("observer") == std::vector<std::string>{"open_loop"});
  CHECK(registry.names("metric") == std::vector<std::string>{"step_count"});
  CHECK(registry.plugin_of("backend", "test_box") == "test_box");
  REQUIRE(registry.info("backend", "test_box"));
  CHECK(registry.info("backend", "test_box")->schema.names() == std::vector<std::string>{"growth"});
  CHECK(registry.info("backend", "test_bo") == nullptr);
  CHECK(registry.info("observer", "test_box") == nullptr);
  CHECK(registry.info("metric", "step_count")->summary == "number of steps");
}

TEST_CASE("what is made works: an observer over a backend of a plugin") {
  Registry registry;
  registry.load_file(good("test_box"));
  const Model model = scalar_model();
  const ObserverContext context{model, registry.make<BackendEntry>("test_box", {})};
  CHECK(registry.check<ObserverEntry>("open_loop", context, {}).empty());
  const auto observer = registry.make<ObserverEntry>("open_loop", context, {});
  observer->start();
  // start and X⁺ = 0.5 [-1,1] + 2 + [-0.1,0.1] through the private functions, without a question to
  // a solver
  const Enclosure X = context.backend->import(model.X0);
  const Term noise{model.linear.Bw, X};
  const Enclosure next =
      context.backend->predict(X, {model.linear.A, Vector::Constant(1, 2), {&noise, 1}});
  const LineForm form = next->line_form();
  CHECK(form.c[0] == doctest::Approx(2));
  CHECK(form.G.cwiseAbs().sum() == doctest::Approx(1.5));
  CHECK(next.tightness == Tightness::exact);
}

TEST_CASE("parameters are checked again when something is made") {
  Registry registry;
  registry.load_file(good("test_box"));
  const auto backend =
      registry.make<BackendEntry>("test_box", Params().set("growth", 1));  // promoted
  const Enclosure X = backend->import(make_box({Vector::Constant(1, -1), Vector::Constant(1, 1)}));
  CHECK(X->line_form().G.cwiseAbs().sum() == doctest::Approx(2));
  CHECK(X.tightness == Tightness::outer);
  const std::string message = message_of(Errc::invalid, [&] {
    registry.make<BackendEntry>("test_box", Params().set("growth", 2.0).set("grwth", 1.0));
  });
  CHECK(message.find("backend \"test_box\": 2 errors") != std::string::npos);
  CHECK(message.find("/growth: is 2, must lie in [0, 1]") != std::string::npos);
  CHECK(message.find("did you mean \"growth\"?") != std::string::npos);
}

TEST_CASE("check_observer reports parameters and combinations") {
  Registry registry;
  registry.load_file(good("test_box"));
  Model model = scalar_model();
  const ObserverContext context{model, registry.make<BackendEntry>("test_box", {})};
  CHECK(registry.check<ObserverEntry>("open_loop", context, Params().set("x", 1)).at(0).pointer ==
        "/x");
  model.linear.E = Matrix::Zero(1, 1);
  CHECK(registry.check<ObserverEntry>("open_loop", context, {}).at(0).message ==
        "needs a standard model");
}

TEST_CASE("unknown components are invalid input with a suggestion") {
  Registry registry;
  CHECK(message_of(Errc::invalid, [&] { registry.make<BackendEntry>("test_box", {}); }) ==
        "no backend \"test_box\"; no plugin provides one");
  registry.load_file(good("test_box"));
  CHECK(message_of(Errc::invalid, [&] { registry.make<BackendEntry>("tset_box", {}); }) ==
        "no backend \"tset_box\"; did you mean \"test_box\"?");
  CHECK(message_of(Errc::invalid, [&] {
          registry.plugin_of("backends", "test_box");
        }).find("did you mean \"backend\"?") != std::string::npos);
}

TEST_CASE("loading a file twice changes nothing, not even through a link") {
  const TemporaryDirectory directory;
  Registry registry;
  registry.load_file(good("test_box"));
  registry.load_file(good("test_box"));
  fs::create_symlink(good("test_box"), directory / "again.so");
  CHECK(registry.load_file(directory / "again.so").state == PluginReport::State::loaded);
  CHECK(registry.reports().size() == 1);
}

TEST_CASE("a refused file is tried again when it is loaded again") {
  const TemporaryDirectory directory;
  Registry registry;
  const fs::path file = directory.write("test_box.so", "not yet");
  CHECK(registry.load_file(file).state == PluginReport::State::refused);
  fs::remove(file);
  directory.add(good("test_box"));
  const PluginReport& report = registry.load_file(file);
  CHECK(report.state == PluginReport::State::loaded);
  CHECK(report.reason.empty());
  CHECK(registry.reports().size() == 1);
}

TEST_CASE("the host registers components of its own: all or none") {
  Registry registry;
  registry.add(register_host_metric);
  CHECK(registry.names("metric") == std::vector<std::string>{"host_metric"});
  CHECK(registry.plugin_of("metric", "host_metric").empty());
  CHECK_THROWS_WITH_AS(registry.add(register_then_throw), "stop", std::runtime_error);
  CHECK_FALSE(has(registry.names("metric"), "never_seen"));
  CHECK(message_of(Errc::invalid, [&] { registry.add(register_host_metric); }) ==
        "metric \"host_metric\" is there already, from this program itself");
  CHECK(message_of(Errc::plugin, [&] {
          registry.make<MetricEntry>("host_metric", {});
        }).find("returned nothing") != std::string::npos);
}

TEST_CASE("exceptions of a plugin arrive as errors that name it, and outlive it") {
  const auto made = [](const char* metric) {
    Registry registry;
    registry.load_file(good("test_faults"));
    registry.make<MetricEntry>(metric, {});
  };  // the registry, and with it the library, is gone before the message is read
  CHECK(message_of(Errc::plugin, [&] { made("throws_own"); }) ==
        "metric \"throws_own\" of plugin \"test_faults\" threw an exception of the plugin's own");
  CHECK(
      message_of(Errc::plugin, [&] { made("throws_int"); }) ==
      "metric \"throws_int\" of plugin \"test_faults\" threw something that is no std::exception");
  CHECK(message_of(Errc::unsupported, [&] { made("throws_error"); }) == "cannot enclose");
  CHECK(message_of(Errc::invalid, [&] { made("throws_input_error"); }) ==
        "study.json: 1 error\n  /a: is wrong; repair it");
  CHECK(message_of(Errc::plugin, [&] { made("returns_nothing"); }) ==
        "metric \"returns_nothing\" of plugin \"test_faults\" was not made: its function returned "
        "nothing");
  CHECK_FALSE(is_mapped(good("test_faults")));
}

TEST_CASE("the kinds of components, and kinds that there are not") {
  const std::vector<std::string>& kinds = Registry::kinds();
  CHECK(std::set<std::string>(kinds.begin(), kinds.end()).size() == kinds.size());
  CHECK(std::find(kinds.begin(), kinds.end(), "backend") != kinds.end());
  Registry registry;
  registry.load_file(good("test_box"));
  CHECK(registry.entry<BackendEntry>("test_box") != nullptr);
  CHECK(registry.entry<ObserverEntry>("test_box") == nullptr);
  CHECK(registry.names("backends").empty());
  CHECK(registry.info("backends", "test_box") == nullptr);
}
