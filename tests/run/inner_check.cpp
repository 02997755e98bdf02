// SPDX-License-Identifier: GPL-3.0-or-later
// Gains, last hulls and inner estimates of observers, in outcomes and files.
#include "study/checks/inner_check.hpp"

#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/components.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using detail::InnerCheck;
using nlohmann::json;

namespace {

Box box(std::initializer_list<double> lower, std::initializer_list<double> upper) {
  Box made{Vector(static_cast<Index>(lower.size())), Vector(static_cast<Index>(upper.size()))};
  std::copy(lower.begin(), lower.end(), made.lower.begin());
  std::copy(upper.begin(), upper.end(), made.upper.begin());
  return made;
}

RunOutcome run(const Study& study, const std::filesystem::path& out = {}) {
  Registry registry;
  registry.add(fakes::register_all);
  RunOptions options;
  options.out = out;
  return run_study(study, registry, options);
}

Params scaled(double scale, double later, bool cut = false) {
  Params params;
  return params.set("scale", scale).set("later", later).set("cut", cut);
}

std::vector<std::string> fields(const std::string& text, std::size_t row) {
  std::istringstream stream(text);
  std::string line;
  for (std::size_t i = 0; i <= row; ++i) std::getline(stream, line);
  std::vector<std::string> found(1);
  for (const char c : line) c == ',' ? found.emplace_back() : found.back() += c;
  return found;
}

}  // namespace

TEST_CASE("inside, touching, and beyond a bound by more or less than rounding") {
  const Box hull = box({-1, 2}, {1, 2000});
  CHECK_FALSE(detail::leaves(hull, hull));
  CHECK_FALSE(detail::leaves(box({-1 - 1e-10, 2}, {1 + 1e-10, 2000 + 1e-6}), hull));
  CHECK(detail::leaves(box({-1 - 1e-8, 2}, {1, 2000}), hull));
  CHECK(detail::leaves(box({-1, 2}, {1 + 1e-8, 2000}), hull));
  CHECK(detail::leaves(box({-1, 2}, {1, 2000 + 1e-5}), hull));
  CHECK(detail::leaves(box({-1, 1}, {1, 2000}), hull));
  CHECK(detail::leaves(box({-1, -infinity}, {1, 3}), hull));
  CHECK_FALSE(detail::leaves(box({-infinity, 0}, {5, 1e9}), Box::space(2)));
  CHECK(detail::leaves(box({0, 0}, {0, 0}), Box::empty(2)));
}

TEST_CASE("the share of the width is a mean over steps and states") {
  InnerCheck check;
  CHECK(check.steps() == 0);
  CHECK(std::isnan(check.share()));
  check.step(4, box({0, 0}, {1, 1}), box({0, 0}, {2, 4}));
  CHECK(check.share() == doctest::Approx(.375));
  check.step(5, box({0, 3}, {1, 3}),
             box({-infinity, 3}, {infinity, 3}));  // a width of infinity, and none at all
  CHECK(check.share() == doctest::Approx(.25));
  CHECK(check.steps() == 2);
  CHECK(check.outside() == -1);
  check.step(6, box({0, 0}, {1, 3}), box({0, 0}, {1, 1}));
  check.step(7, box({0, 0}, {1, 3}), box({0, 0}, {1, 1}));
  CHECK(check.outside() == 6);
}

TEST_CASE("what is no box of the states is refused") {
  InnerCheck check;
  const Box hull = box({0, 0}, {1, 1});
  CHECK_THROWS_WITH_AS(check.step(3, box({0}, {1}), hull), doctest::Contains("k = 3"), Error);
  CHECK_THROWS_AS(check.step(3, box({0, 0}, {1}), hull), Error);
  CHECK_THROWS_AS(check.step(3, box({1, 0}, {0, 1}), hull), Error);
  CHECK_THROWS_AS(check.step(3, box({0, 0}, {std::nan(""), 1}), hull), Error);
  CHECK(check.steps() == 0);
  CHECK_NOTHROW(check.step(3, box({0, 0}, {0, 0}), hull));  // a point
}

TEST_CASE("gains, the last hull and inner estimates of a run") {
  const Scratch scratch;
  const RunOutcome outcome =
      run(fakes::study({fakes::pipeline("plain"), fakes::pipeline("offers", "offering")}),
          scratch / "one");
  const EstimationOutcome &plain = *outcome.pipelines[0].estimation(),
                          &offers = *outcome.pipelines[1].estimation();
  CHECK(plain.gains.empty());
  CHECK(plain.inner_steps == 0);
  CHECK(plain.inner_outside == -1);
  REQUIRE(offers.gains.size() == 2);
  CHECK(offers.gains[0].name == "upper_gain");
  CHECK(offers.inner_steps == 19);  // k = 2 … 20
  CHECK(offers.inner_outside == -1);
  CHECK(offers.inner_share == doctest::Approx(.5));
  CHECK(outcome.pipelines[1].violated_at == -1);

  const json results = json::parse(bytes_of(scratch / "one/results.json"));
  const json &first = results["pipelines"][0], &second = results["pipelines"][1];
  CHECK(first["gains"] == json::array());
  CHECK(first["summary"]["inner_steps"] == 0);
  CHECK(first["summary"]["inner_share"].is_null());
  CHECK_FALSE(first["steps"][5].contains("inner"));
  const json& gains = second["gains"];
  REQUIRE(gains.size() == 2);
  CHECK(gains[0] == json{{"name", "upper_gain"},
                         {"type", "designed"},
                         {"matrix", {json::array({.5}), json::array({-.25})}},
                         {"spectral_radius", .75},
                         {"monotone", true},
                         {"norm", {{"lower", 2.5}, {"upper", 2.5}}},
                         {"objective", "γ"},
                         {"optimum", 2.5},
                         {"optimum_bound", 2.4375},
                         {"margin", .001}});
  CHECK(gains[1]["monotone"] == false);
  CHECK(gains[1]["norm"]["upper"] == "inf");
  CHECK_FALSE(gains[1].contains("objective"));
  CHECK_FALSE(second["steps"][1].contains("inner"));
  for (std::size_t k = 2; k <= 20; ++k) {
    const json& step = second["steps"][k];
    const double lower = step["hull"]["lower"][1], upper = step["hull"]["upper"][1];
    CHECK(step["inner"]["lower"][1].get<double>() == doctest::Approx(.75 * lower + .25 * upper));
    CHECK(step["inner"]["upper"][1].get<double>() == doctest::Approx(.25 * lower + .75 * upper));
  }
  CHECK(second["summary"]["inner_steps"] == 19);
  CHECK(second["summary"]["inner_share"].get<double>() == doctest::Approx(.5));
  CHECK(second["summary"]["inner_outside"].is_null());
  const json& last = second["last"];
  CHECK(last["k"] == 20);
  CHECK(last["hull"] == second["steps"][20]["hull"]);
  for (std::size_t i = 0; i < 2; ++i) {
    const double width = last["width"][i];
    CHECK(width > 0);
    CHECK(width == last["hull"]["upper"][i].get<double>() - last["hull"]["lower"][i].get<double>());
    CHECK(offers.last_hull.upper[static_cast<Index>(i)] == last["hull"]["upper"][i].get<double>());
  }
}

TEST_CASE("steps.csv has the inner estimate behind the metrics, empty where there is none") {
  const Scratch scratch;
  run(fakes::study({fakes::pipeline("plain"), fakes::pipeline("offers", "offering")}),
      scratch.path());
  const std::string text = bytes_of(scratch / "steps.csv");
  const json results = json::parse(bytes_of(scratch / "results.json"));
  const std::vector<std::string> names = fields(text, 0);
  REQUIRE(names.size() == 16);
  CHECK(names[12] == "inner_lower_1");
  CHECK(names[13] == "inner_lower_2");
  CHECK(names[15] == "inner_upper_2");
  CHECK(fields(text, 6).size() == 16);
  CHECK(fields(text, 6)[13].empty());
  const std::vector<std::string> row = fields(text, 1 + 21 + 5);
  REQUIRE(row.size() == 16);
  const json& inner = results["pipelines"][1]["steps"][5]["inner"];
  CHECK(std::stod(row[12]) == inner["lower"][0].get<double>());
  CHECK(std::stod(row[13]) == inner["lower"][1].get<double>());
  CHECK(std::stod(row[14]) == inner["upper"][0].get<double>());
  CHECK(std::stod(row[15]) == inner["upper"][1].get<double>());
}

TEST_CASE("an inner estimate that leaves the hull is told with its time") {
  const Scratch scratch;
  const RunOutcome outcome = run(
      fakes::study({fakes::pipeline("crooked", "offering", scaled(.5, 1.001))}), scratch.path());
  CHECK(outcome.pipelines[0].estimation()->inner_outside == 7);
  CHECK(outcome.pipelines[0].violated_at == -1);
  CHECK(outcome.pipelines[0].error.empty());
  CHECK(outcome.pipelines[0].steps == 21);
  const json summary = json::parse(bytes_of(scratch / "results.json"))["pipelines"][0]["summary"];
  CHECK(summary["inner_outside"] == 7);
  CHECK(run(fakes::study({fakes::pipeline("touching", "offering", scaled(1, 1))}))
            .pipelines[0]
            .estimation()
            ->inner_outside == -1);
}

TEST_CASE("an inner estimate of another size stops its pipeline") {
  const PipelineOutcome outcome =
      run(fakes::study({fakes::pipeline("cut", "offering", scaled(.5, .5, true))})).pipelines[0];
  CHECK(outcome.error_code == Errc::plugin);
  CHECK(outcome.steps == 2);
  CHECK(outcome.estimation()->inner_steps == 0);
  CHECK(outcome.estimation()->last_hull.dim() == 2);  // of k = 1
}

TEST_CASE("the last hull where there is none, is empty or unbounded") {
  const Scratch scratch;
  Params empty, broken;
  empty.set("radius", -1.);
  broken.set("how", std::string("error"));
  const RunOutcome outcome = run(fakes::study({fakes::pipeline("unheard", "unheard_of"),
                                               fakes::pipeline("e", "claiming", empty),
                                               fakes::pipeline("b", "breaking", broken)}),
                                 scratch.path());
  CHECK(outcome.pipelines[0].estimation()->last_hull.dim() == 0);
  CHECK(outcome.pipelines[1].estimation()->last_hull.is_empty());
  CHECK_FALSE(outcome.pipelines[2].estimation()->last_hull.is_bounded());
  const json results = json::parse(bytes_of(scratch / "results.json"));
  CHECK(results["pipelines"][0]["last"].is_null());
  CHECK(results["pipelines"][1]["last"]["k"] == 20);
  CHECK(results["pipelines"][1]["last"]["width"].is_null());
  CHECK(results["pipelines"][2]["last"]["k"] == 4);
  CHECK(results["pipelines"][2]["last"]["width"] == json::array({"inf", "inf"}));
}

TEST_CASE("a repeated run with gains and inner estimates gives the same bytes") {
  const Scratch one, two;
  const Study study = fakes::study({fakes::pipeline("offers", "offering"),
                                    fakes::pipeline("crooked", "offering", scaled(1, 2))});
  run(study, one.path());
  run(study, two.path());
  const auto first = tree_without_times(one.path()), second = tree_without_times(two.path());
  CHECK((first == second));
}
