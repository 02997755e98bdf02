// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed of statements that diagnosers make in advance.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/study/outcome.hpp"
#include "diagnosis_report.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

Box interval(double lower, double upper) { return {Vector{{lower}}, Vector{{upper}}}; }

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("statements in advance: the table, the error set, the answer") {
  Guarantees g{"outer iteration, 30 steps",
               {{0, 0, interval(-.3, .3), Answer::yes},
                {1, 0, interval(-.83254, -.29374), Answer::yes},
                {0, 1, interval(-.01, .8), Answer::unknown},
                {1, 1, interval(1, 2), Answer::no}},
               Answer::no,
               {}};
  const std::vector<std::string> modes{"healthy", "fault 1"};
  const apps::Paint paint(stdout);
  CHECK(apps::guarantees_text(g, {}, modes, paint) ==
        "Method: outer iteration, 30 steps\n"
        "OBSERVER  TRUE MODE  RESIDUALS                 CONDITION  HOLDS\n"
        "healthy   healthy    R̊00 = [-0.3000, 0.3000]   0 inside   yes\n"
        "healthy   fault 1    R̊10 = [-0.8325, -0.2937]  0 outside  yes\n"
        "fault 1   healthy    R̊01 = [-0.0100, 0.8000]   0 outside  not guaranteed\n"
        "fault 1   fault 1    R̊11 = [1.0000, 2.0000]    0 inside   no\n"
        "R̊ij encloses all residuals of observer j once mode i has been true for long. 0 inside: "
        "the observer of the true mode\n"
        "agrees with the data; 0 outside: the data contradict that of another mode. yes and no "
        "are proven.\n"
        "The condition fails for some modes, whatever the accuracy: 0 lies in the limit of "
        "these sets, which may be larger than those of the residuals\n");
  g.all = Answer::yes;
  g.error_set = ErrorSetCheck{make_box(interval(-1, 1)), false, .86, .5, 1, 0};
  std::string text = apps::guarantees_text(g, {}, modes, paint);
  CHECK(has(text,
            "all errors lie in 0.86 times the set; in steady state 0.5, attained in mode \"fault "
            "1\" by the observer of "
            "\"healthy\": large enough\n"));
  CHECK(has(text, "Guaranteed in steady state: "));
  g.all = Answer::unknown;
  g.error_set->factor = 1.163;
  text = apps::guarantees_text(g, {}, modes, paint);
  for (const char* part : {"too small", "Not guaranteed: "}) CHECK(has(text, part));
  g.error_set->computed = true;
  CHECK(has(apps::guarantees_text(g, {}, modes, paint), "by construction"));
  CHECK(apps::box_text({Vector{{-1., 0.}}, Vector{{1., 2.5}}}) == "[-1, 1] × [0, 2.5]");
  CHECK(apps::box_text(Box::empty(2)) == "∅");
  CHECK(apps::box_text(interval(-2e-5, 1e-5), apps::Digits::decimals) == "[-2e-05, 1e-05]");
  const json data = json::parse(json_of(g, modes));
  CHECK(data["pairs"].size() == 4);
  CHECK(data["pairs"][2]["observer"] == "fault 1");
  CHECK(data["pairs"][2]["holds"] == "unknown");
  CHECK(data["error_set"]["computed"] == true);
  CHECK(data["error_set"]["set"]["generators"] == 1);
}

TEST_CASE("statements in advance about additive faults") {
  Guarantees g;
  g.method = "recursion of the error sets";
  g.faults = {{0, 1, .1234567}, {1, 4, std::numeric_limits<double>::infinity()}};
  const apps::Paint paint(stdout);
  const std::string table =
      "Method: recursion of the error sets\n"
      "ADDITIVE FAULT  DELAY  HALF WIDTH IN STEADY STATE, BUT FOR ROUNDING\n"
      "1               1      0.123457\n"
      "2               4      no bound is proven\n";
  CHECK(apps::guarantees_text(g, {}, {"healthy"}, paint) == table);
  g.pairs = {{0, 0, interval(-1, 1), Answer::yes}};
  CHECK(has(apps::guarantees_text(g, {}, {"healthy"}, paint), table + "OBSERVER"));
  const json second = json::parse(json_of(g, {"healthy"}))["faults"][1];
  CHECK(second == json{{"fault", 2}, {"delay", 4}, {"half_width", "inf"}});
}
