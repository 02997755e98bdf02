// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed about designed inputs, and which exit code it makes.
#include "design_report.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/components.hpp"
#include "run_failures.hpp"
#include "run_report.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

Study study() {
  Study s = fakes::study({});
  s.modes = {{"leak", s.model}};
  return s;
}

/// An optimal design of two modes.
PipelineDesign design() {
  PipelineDesign d;
  d.name = "AFD";
  d.backend = "line_zonotope";
  d.designer = "facets";
  d.design_s = .25;
  DesignOutcome& outcome = d.outcome.emplace();
  outcome.status = DesignStatus::optimal;
  outcome.horizon = 1;
  outcome.tried = {{0, DesignStatus::infeasible, "no output depends on u_0"}};
  outcome.nodes = 12;
  outcome.programs = 138;
  outcome.facets = 100;
  outcome.lower_bound = 9.25;
  InputDesign& best = outcome.best.emplace();
  best.u = Matrix{{.5}, {-7.0632}};
  best.cost = 9.25;
  best.pairs = {{0, 1, .1875, .125, Answer::yes, {}}};
  best.empty = {Answer::no, Answer::no};
  best.outputs = {Box::empty(2), Box::empty(2)};
  return d;
}

ExactSeparation exact(Answer disjoint, Answer empty = Answer::no) {
  return {{{0, 1, disjoint, .0625, disjoint == Answer::unknown ? "too large" : ""}},
          {empty, Answer::no},
          .5};
}

PipelineDesign without(DesignStatus status) {
  PipelineDesign d = design();
  d.outcome->status = status;
  d.outcome->best.reset();
  d.outcome->reason = "a reason";
  d.outcome->suggestion = "a longer horizon";
  return d;
}

std::string text(const PipelineDesign& d) {
  return apps::designs_text(study(), {d}, apps::Paint(stdout));
}
bool has(const std::string& where, const std::string& what) {
  return where.find(what) != std::string::npos;
}

}  // namespace

TEST_CASE("a design on paper") {
  PipelineDesign d = design();
  std::string shown = text(d);
  CHECK(has(shown, "AFD  line_zonotope, facets\n"));
  CHECK(has(shown, "Optimal (claimed by facets): cost 9.25, claimed lower bound 9.25\n"));
  CHECK(has(shown, "Horizon N = 1: inputs and outputs of k = 0 … 1\n"));
  CHECK(has(shown, "tried before: N = 0, infeasible: no output depends on u_0\n"));
  CHECK(has(shown, "k  u_1\n0  0.5\n1  -7.0632\n"));
  CHECK(has(shown, "healthy, leak  0.1875  -         disjoint (claimed)\n"));
  CHECK(has(shown, "Search: 12 nodes, 138 linear programs, 100 facets, 0.25 s\n"));
  CHECK_FALSE(has(shown, "exact"));
  CHECK_FALSE(has(shown, "roven"));
  CHECK_FALSE(has(shown, "Modelling error"));

  d.outcome->status = DesignStatus::feasible;
  d.outcome->best->cost = 18.5;
  d.outcome->lower_bound = -std::numeric_limits<double>::infinity();
  d.outcome->restriction = RestrictedProblem{"the reduced problem", 18.25};
  d.outcome->stopped = true;
  d.outcome->last_output_only = true;
  d.outcome->best->pairs[0].disjoint = Answer::unknown;
  shown = text(d);
  CHECK(has(shown, "Feasible: cost 18.5, no lower bound is known\n"));
  CHECK(has(shown,
            "Searched in place of the problem: the reduced problem; that one costs at least 18.25, "
            "the problem itself may"));
  CHECK_FALSE(has(shown, "gap"));
  CHECK(has(shown, "the last output"));
  CHECK(has(shown, "ended by the limit"));
  CHECK(has(shown, "0.1875  -         not decided"));

  d.outcome->status = DesignStatus::given;
  CHECK(has(text(d), "Given: cost 18.5, the modes are not proven to be separated\n"));
  d.outcome->best->pairs[0].disjoint = Answer::no;
  CHECK(has(text(d), "the modes are not separated (claimed)\n"));
  CHECK(has(text(d), "meet (claimed)"));
  d.outcome->best->pairs[0].disjoint = Answer::yes;
  CHECK(has(text(d), "the modes are separated (claimed)\n"));
  d.exact = exact(Answer::yes);
  CHECK(has(text(d), "the modes are separated (proven)\n"));
  d.exact = exact(Answer::no);
  CHECK(has(text(d), "the modes are not separated (proven)\n"));
  // What the designer leaves open and exact arithmetic decides is open no more.
  d.outcome->reason = "whether they can be the same is not decided";
  CHECK(has(text(d), "not decided"));
  d.outcome->best->pairs[0].disjoint = Answer::unknown;
  d.outcome->best->pairs[0].kappa = not_available;
  CHECK_FALSE(has(text(d), "not decided"));
  d.exact = exact(Answer::yes);
  CHECK_FALSE(has(text(d), "not decided"));
  // That they touch stays a reason why they do not separate.
  d.exact = exact(Answer::no);
  d.outcome->best->pairs[0].kappa = -1e-10;
  d.outcome->reason = "they touch";
  CHECK(has(text(d), "they touch"));
  d.outcome->reason = "whether they can be the same is not decided";
  d.exact.reset();
  CHECK(has(text(d), "whether they can be the same is not decided"));
  d.outcome->best->empty[1] = Answer::yes;
  CHECK(has(text(d), "Modelling error: no output of leak fits this input"));
}

TEST_CASE("designs without an input") {
  CHECK(has(text(without(DesignStatus::infeasible)),
            "Infeasible (claimed by facets): no input of the input set separates the modes\n"));
  PipelineDesign open = without(DesignStatus::unknown);
  const std::string unknown = text(open);
  CHECK(has(unknown, "No answer: claimed lower bound 9.25\n"));
  CHECK_FALSE(has(unknown, "limit"));
  open.outcome->stopped = true;
  CHECK(has(text(open), "No answer within the limit: claimed lower bound 9.25\n"));
  CHECK(has(unknown, "a reason\nTo try: a longer horizon\n"));
  PipelineDesign broken = design();
  broken.outcome.reset();
  broken.error = "out of ideas";
  CHECK(has(text(broken), "Stopped: out of ideas\n"));
}

TEST_CASE("the exact proof beside the design") {
  PipelineDesign d = design();
  d.exact = exact(Answer::yes);
  std::string shown = text(d);
  CHECK(has(shown, "0.1875  0.0625    disjoint (proven)\n"));
  CHECK(has(shown, "In exact arithmetic: the modes are separated (0.5 s)\n"));
  d.exact = exact(Answer::unknown);
  CHECK(has(text(d), "Not decided exactly: healthy, leak: too large\n"));
  CHECK(has(text(d), "In exact arithmetic: separation is not proven"));
  d.exact = exact(Answer::yes, Answer::yes);
  CHECK(has(text(d), "Modelling error: no output of healthy fits"));
  d.exact = exact(Answer::no);
  CHECK(has(text(d), "In exact arithmetic: the modes are not separated"));
}

TEST_CASE("exit codes, and a sentence for each that is not 0") {
  const auto expect = [&](const std::vector<PipelineDesign>& designs, apps::Exit exit,
                          const std::string& sentence, bool all_proven = false) {
    CHECK(apps::exit_of(designs, all_proven) == exit);
    const std::vector<std::string> said = apps::complaints(study(), designs, all_proven);
    CHECK(said.empty() == sentence.empty());
    if (!said.empty()) CHECK_MESSAGE(has(said.back(), sentence), said.back());
  };
  PipelineDesign proven = design(), open = design(), wrong = design(), empty = design(),
                 exactly_empty = design(), broken = design(), crooked = design();
  proven.exact = exact(Answer::yes);
  open.exact = exact(Answer::unknown);
  wrong.exact = exact(Answer::no);
  wrong.refuted = {"the output tubes of a and b are called disjoint, and meet"};
  empty.outcome->best->empty[0] = Answer::yes;
  exactly_empty.exact = exact(Answer::yes, Answer::yes);
  broken.outcome.reset();
  broken.error = "out of ideas";
  broken.error_code = Errc::plugin;
  crooked.outcome.reset();
  crooked.error = "its input is too short";
  crooked.error_code = Errc::violated;
  const PipelineDesign infeasible = without(DesignStatus::infeasible),
                       unknown = without(DesignStatus::unknown);
  expect({design(), infeasible, proven}, apps::Exit::done, "");
  expect({unknown}, apps::Exit::unanswered, "no input was found");
  expect({open}, apps::Exit::done, "");
  expect({open}, apps::Exit::unanswered, "leaves a question open", true);
  expect({empty}, apps::Exit::invalid, "contradicts itself");
  expect({exactly_empty}, apps::Exit::invalid, "no output of healthy fits");
  expect({unknown, broken}, apps::Exit::plugin, "out of ideas");
  expect({broken, empty}, apps::Exit::plugin, "contradicts itself");
  expect({empty, broken, wrong}, apps::Exit::violated,
         "violates its guarantee: the output tubes of a and b are called disjoint");
  expect({empty, crooked}, apps::Exit::violated, "its input is too short");
  CHECK(has(text(wrong),
            "Proven false: the output tubes of a and b are called disjoint, and meet\n"));
}

TEST_CASE("designs for programs") {
  PipelineDesign d = design();
  d.exact = exact(Answer::yes);
  const json report = json::parse(apps::designs_json(study(), {d, without(DesignStatus::unknown)}));
  CHECK(report["modes"] == json({"healthy", "leak"}));
  CHECK(report["pipelines"][0]["designer"] == "facets");
  CHECK(report["pipelines"][0]["design"]["status"] == "optimal");
  CHECK(report["pipelines"][0]["exact"]["separates"] == "yes");
  CHECK(report["pipelines"][0]["exact"]["pairs"][0]["kappa_lower"] == .0625);
  CHECK(report["pipelines"][0]["exact"]["pairs"][0]["reason"].is_null());
  CHECK(report["pipelines"][0]["exact"]["tubes"][1]["mode"] == "leak");
  CHECK(report["pipelines"][0]["exact"]["wall_s"] == .5);
  CHECK(report["pipelines"][0]["design_s"] == .25);
  CHECK(report["pipelines"][0]["error"].is_null());
  CHECK(report["pipelines"][1]["exact"].is_null());
  CHECK(report["pipelines"][1]["design"]["u"].is_null());
  CHECK(json::parse(apps::designs_json(study(), {d}))["pipelines"].size() == 1);
  d.exact = exact(Answer::unknown);
  const json open = json::parse(apps::designs_json(study(), {d}));
  CHECK(open["pipelines"][0]["exact"]["pairs"][0]["kappa_lower"].is_null());
  CHECK(open["pipelines"][0]["exact"]["pairs"][0]["reason"] == "too large");
}

namespace {

/// A run with a design, with experiments or without.
RunOutcome designed_run(bool experiments) {
  PipelineOutcome p;
  p.name = "AFD";
  p.backend = "line_zonotope";
  DesignedOutcome& found = p.task.emplace<DesignedOutcome>();
  found.designer = "facets";
  found.design = design().outcome;
  if (experiments) {
    found.diagnoser = "tube_membership";
    found.experiments = {{0, 500, {500, 12}, 488, 0, 0, 12, {488, 1, 2, 1.5}},
                         {1, 500, {0, 500}, 499, 1, 0, 0, {}}};
  }
  RunOutcome outcome;
  outcome.pipelines = {std::move(p)};
  return outcome;
}

}  // namespace

TEST_CASE("a design in a run, with its experiments") {
  CHECK(has(apps::report_text(study(), designed_run(false), "out"),
            "No experiments: name a \"diagnoser\""));
  const RunOutcome outcome = designed_run(true);
  const std::string shown = apps::report_text(study(), outcome, "out");
  CHECK(has(shown, "AFD  line_zonotope, facets, tube_membership\n"));
  CHECK(has(shown, "Optimal (claimed by facets): cost 9.25"));
  CHECK(has(shown, "healthy    500   500      12    488       0      0     12         1.5\n"));
  CHECK(has(shown, "leak       500   0        500   499       1      0     0          -\n"));
  CHECK_FALSE(has(shown, "PIPELINE"));
  CHECK(apps::exit_of(outcome) == apps::Exit::done);
  CHECK(apps::complaints(study(), outcome).empty());
  const json report = json::parse(apps::report_json(study(), outcome))["pipelines"][0];
  CHECK(report["design"]["cost"] == 9.25);
  CHECK(report["experiments"][0]["possible"] == json({500, 12}));
  CHECK(report["experiments"][0]["isolation"]["median"] == 1.5);
  CHECK(report["experiments"][1]["isolation"].is_null());
  CHECK(report["modes"].size() == 2);

  CHECK(report["assumptions_until"].is_null());
  CHECK_FALSE(has(shown, "Assumption"));
}

TEST_CASE("a design in a run: failed assumptions, refuted claims, no input") {
  RunOutcome outcome = designed_run(true);
  const PipelineOutcome p = outcome.pipelines[0];
  using What = FailedAssumption::What;
  outcome.pipelines[0].assumptions_until = 2;
  outcome.pipelines[0].failed_assumption = FailedAssumption{What::admissible_set, 2, -1, 0};
  CHECK(apps::exit_of(outcome) == apps::Exit::done);
  CHECK(has(apps::report_text(study(), outcome, "out"),
            "Assumption failed: x_2 lies outside an admissible set"));
  const json told = json::parse(apps::report_json(study(), outcome))["pipelines"][0];
  CHECK(told["assumptions_until"] == 2);
  CHECK(told["failed_assumption"]["what"] == "admissible_set");
  outcome.pipelines[0].failed_assumption = FailedAssumption{What::initial_set, 0, 1, 0};
  CHECK(has(apps::report_text(study(), outcome, "out"),
            "Assumption failed: x_0 lies outside X0 of mode \"leak\""));
  outcome.pipelines[0] = p;
  outcome.pipelines[0].design()->refuted = {"u_k is outside"};
  CHECK(apps::exit_of(outcome) == apps::Exit::violated);
  CHECK(has(apps::complaints(study(), outcome).at(0), "violates its guarantee: u_k is outside"));
  outcome.pipelines[0] = p;
  outcome.pipelines[0].violated_at = 2;
  CHECK(apps::exit_of(outcome) == apps::Exit::violated);
  CHECK(has(apps::complaints(study(), outcome).at(0), "at k = 2 of an experiment"));
  outcome.pipelines[0] = p;
  outcome.pipelines[0].design()->design->best->empty[1] = Answer::yes;
  CHECK(apps::exit_of(outcome) == apps::Exit::invalid);
  CHECK(has(apps::complaints(study(), outcome).at(0), "no output of mode \"leak\""));
  outcome.pipelines[0].design()->design = without(DesignStatus::unknown).outcome;
  CHECK(apps::exit_of(outcome) == apps::Exit::unanswered);
  CHECK(has(apps::complaints(study(), outcome).at(0), "no input was found"));
  CHECK_FALSE(has(apps::complaints(study(), outcome).at(0), "limit"));
  outcome.pipelines[0].design()->design->stopped = true;
  CHECK(has(apps::complaints(study(), outcome).at(0), "no input was found within the limit"));
  CHECK(has(apps::report_text(study(), outcome, "out"),
            "No experiments: there is no input to try\n"));
}

TEST_CASE("experiments that stay open because the diagnoser stops before the input does") {
  RunOutcome outcome;
  outcome.pipelines.resize(1);
  PipelineOutcome& p = outcome.pipelines[0];
  p.name = "AFD";
  DesignedOutcome& found = p.task.emplace<DesignedOutcome>();
  found.designer = "facets";
  found.diagnoser = "tube_membership";
  found.design = design().outcome;  // N = 1
  found.experiments = {{0, 5, {5, 0}, 5, 0, 0, 0, {}}, {1, 5, {0, 5}, 4, 0, 0, 1, {}}};
  const auto hint = [&](std::optional<Index> last) {
    found.last_used_sample = last;
    const std::string shown = apps::report_text(study(), outcome, "out");
    CHECK(has(shown, "To try: a \"horizon\" of 1\n") == has(shown, "takes no sample after k = 0"));
    return has(shown, "takes no sample after k");
  };
  CHECK(hint(0));
  CHECK_FALSE(hint(1));
  CHECK_FALSE(hint(std::nullopt));
  found.experiments[1].undecided = 0;
  CHECK_FALSE(hint(0));
}

TEST_CASE("how far a search is") {
  CHECK(apps::design_progress("AFD", 3, infinity, -infinity) == "AFD  N = 3");
  CHECK(apps::design_progress("AFD", 3, infinity, 2) == "AFD  N = 3  at least 2");
  CHECK(apps::design_progress("AFD", 3, 4, 3) == "AFD  N = 3  best 4  at least 3  (25 %)");
  CHECK(apps::design_progress("AFD", 3, 0, 0) == "AFD  N = 3  best 0  at least 0");
}
