// SPDX-License-Identifier: GPL-3.0-or-later
// Values: copies, temporaries, threads, and programs that have names of their own.
#include <thread>
#include <type_traits>

#include <doctest/doctest.h>

#include "values/known_sets.hpp"

// with `using namespace cordon` in force nothing of these is ambiguous
using namespace values_test;

namespace {

/// A class of somebody else with members of the names that sets and the framework have.
class Tank {
 public:
  explicit Tank(ConvexSet level) : level_(std::move(level)) {}

  double support(const Vector& d) const { return level_.support(d); }
  Box hull() const { return level_.hull(); }
  bool contains(const Vector& x) const { return level_.contains(x) == Answer::yes; }
  bool is_empty() const { return level_.is_empty() == Answer::yes; }
  std::string representation() const { return cordon::representation("interval")->info().name; }
  std::string to_string() const { return cordon::to_string(level_); }
  ConvexSet operator*(double hours) const { return hours * level_; }
  ConvexSet operator+(const Tank& other) const { return level_ + other.level_; }
  ConvexSet operator&(const Tank& other) const { return level_ & other.level_; }
  Tank after(const Matrix& A, const ConvexSet& W) const { return Tank(A * level_ + W); }

 private:
  ConvexSet level_;
};

Vector three() { return Vector{{3, 3}}; }
Matrix twice() { return 2 * Matrix::Identity(2, 2); }

}  // namespace

static_assert(std::is_copy_constructible_v<ConvexSet> && std::is_copy_assignable_v<ConvexSet>);
static_assert(!std::is_default_constructible_v<ConvexSet>);
static_assert(sizeof(ConvexSet) == sizeof(Enclosure));

TEST_CASE("a class with members of the same names calls them all") {
  const Tank tank(unit_box(2));
  CHECK(is_above(tank.support(Vector{{1, 1}}), 2));
  CHECK(is_above(tank.hull().upper[0], 1));
  CHECK(tank.contains(Vector{{1, 1}}));
  CHECK_FALSE(tank.is_empty());
  CHECK(tank.representation() == "interval");
  CHECK(tank.to_string() == "interval in R^2: 2 generators (exact)");
  CHECK(is_above((tank * 3).hull().upper[1], 3));
  CHECK(is_above((tank + tank).hull().upper[1], 2));
  CHECK(is_above((tank & tank).hull().upper[1], 1));
  CHECK(is_above(tank.after(Matrix::Identity(2, 2), unit_box(2)).hull().upper[0], 2));
}

TEST_CASE("arguments may be temporaries and expressions") {
  const ConvexSet X = ConvexSet::zonotope(Vector::Zero(2), Matrix::Identity(2, 2) * 0.5);
  const Vector w = three();
  CHECK(is(ConvexSet::box(-w, w).hull(), Vector{{-3, -3}}, Vector{{3, 3}}));
  CHECK(is((twice() * X).hull(), Vector{{-1, -1}}, Vector{{1, 1}}));
  CHECK(is((twice() * twice() * X).hull(), Vector{{-2, -2}}, Vector{{2, 2}}));
  CHECK(is((twice().transpose() * X + three()).hull(), Vector{{2, 2}}, Vector{{4, 4}}));
  CHECK(is((Matrix::Identity(2, 2) * X - three() * 2).hull(), Vector{{-6.5, -6.5}},
           Vector{{-5.5, -5.5}}));
  CHECK(is_above(X.support(twice().col(0)), 1));
  CHECK(X.contains(w / 10) == Answer::yes);
  CHECK(is((twice().topRows(1) * X).hull(), Vector{{-1}}, Vector{{1}}));
}

TEST_CASE("results outlive their operands, and operands do not change") {
  std::optional<ConvexSet> kept;
  {
    Matrix A = twice();
    Vector t = three();
    auto X = std::make_unique<ConvexSet>(hexagon());
    const ConvexSet before = *X;
    kept = (A * *X + t).reduce(2);
    CHECK(X->hull().upper == before.hull().upper);
    CHECK(before.enclosure().set == X->enclosure().set);
    *X = unit_box(2);
    CHECK(before.representation() == "zonotope");
    A.setConstant(100);
    t.setConstant(100);
  }
  CHECK(is(kept->hull(), Vector{{1, 3}}, Vector{{9, 11}}));
  kept = *kept;  // NOLINT
  CHECK(is_above(kept->hull().upper[0], 9));
  const View view = (hexagon() + unit_box(2)).view();
  CHECK(view.form.generators() >= 5);
}

TEST_CASE("several threads use one object, and ask for representations") {
  const ConvexSet X = triangle(), Y = hexagon();
  std::vector<std::thread> threads;
  std::vector<double> sums(4, 0);
  for (std::size_t t = 0; t < sums.size(); ++t) {
    threads.emplace_back([&X, &Y, &sum = sums[t]] {
      for (int i = 0; i < 25; ++i) {
        const ConvexSet Z = (X + Y).as("line_zonotope") & ConvexSet::space(2);
        sum += Z.hull().upper.sum() + X.support(Vector{{1, 1}});
        sum += X.contains(Vector{{-0.5, 0.25}}) == Answer::yes ? 1 : 0;
        sum += cordon::representation("interval")->box({Vector{{0}}, Vector{{1}}})->dim();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) {
    CHECK(sum == doctest::Approx(25 * (4 + 5 + 0 + 1 + 1)).epsilon(1e-9));
    CHECK(sum == sums[0]);
  }
}

TEST_CASE("representations without parameters are one object") {
  CHECK(cordon::representation("zonotope") == cordon::representation("zonotope"));
  const Params outward = Params().set("rounding", std::string("outward"));
  CHECK(cordon::representation("zonotope", outward) != cordon::representation("zonotope"));
  CHECK(&installed_components() == &installed_components());
  CHECK(&hexagon().backend() == cordon::representation("zonotope").get());
}
