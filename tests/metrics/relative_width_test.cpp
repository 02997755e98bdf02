// SPDX-License-Identifier: GPL-3.0-or-later
// Widths of the hull as multiples of given ones.
#include <cmath>
#include <filesystem>

#include <doctest/doctest.h>

#include "cordon/core/line_form.hpp"
#include "cordon/registry/registry.hpp"

using namespace cordon;

namespace {

struct Measuring {
  Measuring() {
    registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  }

  /// The value of a step with this hull.
  double at(Metric& metric, Index k, const Box& hull, Answer consistent = Answer::yes) {
    Estimate estimate;
    estimate.k = k;
    estimate.consistent = consistent;
    estimate.set = registry.make<BackendEntry>("interval", {})
                       ->import(make_box({Vector{{0, 0}}, Vector{{1, 1}}}));
    const PhaseTimes times;
    return std::get<double>(metric.step({estimate, hull, nullptr, true, times})[0].value);
  }

  std::vector<Diagnostic> problems(const Params& params) {
    Model model;
    model.linear.A = Matrix::Identity(2, 2);
    return registry.check<MetricEntry>("relative_width", {model}, params);
  }

  Registry registry;
};

Params given_widths() {
  return Params().set("steps", Vector{{1, 4}}).set("widths", Matrix{{2, 4}, {1, .5}});
}

}  // namespace

TEST_CASE("the mean over all states and the times that are given") {
  Measuring m;
  const auto metric = m.registry.make<MetricEntry>("relative_width", given_widths());
  const Box hull{Vector{{-1, 3}}, Vector{{3, 5}}};  // widths 4 and 2
  CHECK(std::isnan(m.at(*metric, 0, hull)));
  CHECK(m.at(*metric, 1, hull) == 1.25);
  CHECK(std::isnan(m.at(*metric, 2, hull)));
  CHECK(m.at(*metric, 4, hull) == 4);
  const auto summary = metric->summary();
  CHECK(std::get<double>(summary[0].value) == 2.625);
  CHECK(std::get<double>(summary[1].value) == 4);
  CHECK(std::get<Index>(summary[2].value) == 0);
}

TEST_CASE("estimates without a size") {
  Measuring m;
  const auto metric = m.registry.make<MetricEntry>("relative_width", given_widths());
  CHECK(std::isnan(m.at(*metric, 1, {Vector{{0, 0}}, Vector{{1, 1}}}, Answer::no)));
  CHECK(std::isinf(m.at(*metric, 4, {Vector{{0, -infinity}}, Vector{{1, infinity}}})));
  CHECK(std::get<Index>(metric->summary()[2].value) == 1);
  CHECK(std::isnan(std::get<double>(metric->summary()[0].value)));
}

TEST_CASE("widths that do not fit are told") {
  Measuring m;
  CHECK(m.problems(given_widths()).empty());
  const auto pointer = [&](const Vector& steps, const Matrix& widths) {
    const auto found = m.problems(Params().set("steps", steps).set("widths", widths));
    REQUIRE(found.size() == 1);
    return found[0].pointer;
  };
  CHECK(pointer(Vector{{1, 1}}, Matrix{{1, 1}, {1, 1}}) == "/steps");
  CHECK(pointer(Vector{{1, 2.5}}, Matrix{{1, 1}, {1, 1}}) == "/steps");
  CHECK(pointer(Vector{{-1, 2}}, Matrix{{1, 1}, {1, 1}}) == "/steps");
  CHECK(pointer(Vector{{1, 2}}, Matrix{{1, 1}}) == "/widths");
  CHECK(pointer(Vector{{1}}, Matrix{{1}}) == "/widths");
  CHECK(pointer(Vector{{1}}, Matrix{{1, 0}}) == "/widths");
}
