// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoser `tube_membership` on representations of every kind, and what it refuses.
#include <doctest/doctest.h>

#include "diagnosis/four_models.hpp"
#include "diagnosis/tube_membership.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using namespace diagnosis_test;

namespace {

std::vector<Diagnostic> check(const ModeBank& bank, const std::string& backend,
                              const Params& params) {
  return plugins().registry.check<DiagnoserEntry>("tube_membership",
                                                  {bank, plugins().backend(backend)}, params);
}

/// Zonotopes whose exchange form is said to be larger than the set.
class Loose final : public SetBackend {
 public:
  Loose() : SetBackend({"loose", true, true, false, Rounding::nominal, "for a test", ""}) {}

 private:
  class Held final : public Set {
   public:
    Held(const SetBackend& backend, LineForm form)
        : Set(backend, form.dim()), form_(std::move(form)) {}

   private:
    Complexity do_complexity() const override { return {}; }
    LineForm do_line_form() const override { return form_; }
    LineForm form_;
  };

  Made do_import(const LineForm& X) const override {
    return {std::make_unique<Held>(*this, X), Tightness::exact};
  }
};

}  // namespace

TEST_CASE("systems without E need neither lines nor intersections") {
  ModeBank bank = examples::three_scalar_models();
  for (Mode& mode : bank.modes) mode.model.X0 = make_box(cube(1, 5));
  for (const std::string backend :
       {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(backend);
    const auto diagnoser = make(bank, backend, horizon(3));
    for (Index truth = 0; truth < 3; ++truth) {
      const auto samples = scalar_samples(bank[truth].model, 2, {0, .99, 0, 0}, 5, false);
      const Run found = run(*diagnoser, samples);
      CHECK(found.steps.back().mode == truth);
      CHECK(found.steps[0].modes[0].consistent == Answer::yes);
    }
  }
}

TEST_CASE("a set that the backend can only enclose is taken as the mode has it") {
  ModeBank bank = examples::three_scalar_models();
  for (Mode& mode : bank.modes) {
    mode.model.linear.Bw = Matrix{{1, -1}};
    mode.model.W = make_zonotope(Vector::Zero(2), Matrix{{1}, {1}});  // both are equal: they cancel
    mode.model.X0 = make_point(Vector{{0}});
  }
  const std::vector<Sample> samples{{0, Vector{{0}}, Vector{{0}}}, {1, Vector{{0}}, Vector{{1.5}}}};
  const Run exact = run(*make(bank, "zonotope", horizon(3)), samples);
  CHECK(exact.steps[0].modes[0].consistent == Answer::yes);
  CHECK(exact.steps[1].decision == Decision::unknown_fault);
  const Run boxes = run(*make(bank, "interval", horizon(3)), samples);
  CHECK(boxes.steps[0].modes[0].consistent == Answer::yes);
  CHECK(boxes.steps[1].decision == Decision::unknown_fault);
}

TEST_CASE("an exchange form that encloses is not used") {
  const ModeBank bank = examples::three_scalar_models();
  const auto diagnoser = plugins().registry.make<DiagnoserEntry>(
      "tube_membership", {bank, std::make_shared<Loose>()}, horizon(1));
  const Run found = run(*diagnoser, {{0, Vector{{2}}, Vector{{0}}}, {1, Vector{{0}}, Vector{{2}}}});
  CHECK(found.steps[0].modes[0].candidate);
  CHECK(found.steps[0].modes[0].consistent == Answer::yes);
}

TEST_CASE("what cannot work is refused") {
  const ModeBank bank = four_models();
  CHECK(check(bank, "line_zonotope", horizon(3)).empty());

  auto problems = check(bank, "zonotope", horizon(3));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("static rows") != std::string::npos);

  problems = check(bank, "constrained_zonotope", horizon(3));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/admissible_set");

  Params admissible = horizon(3);
  admissible.set("admissible_set", make_space(3));
  problems = check(bank, "constrained_zonotope", admissible);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/admissible_set");
  CHECK(problems[0].message.find("unbounded") != std::string::npos);
  CHECK(check(bank, "line_zonotope", admissible).empty());

  admissible.set("admissible_set", make_box(cube(2, 1)));
  problems = check(bank, "line_zonotope", admissible);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("dimension 2") != std::string::npos);

  admissible.set("admissible_set", make_empty(3));
  CHECK(check(bank, "line_zonotope", admissible).size() == 1);

  ModeBank unbounded = examples::three_scalar_models();
  CHECK(check(unbounded, "line_zonotope", horizon(3)).empty());
  problems = check(unbounded, "zonotope", horizon(3));
  REQUIRE(problems.size() == 3);
  CHECK(problems[0].message.find("X0 of mode") != std::string::npos);

  unbounded.modes[1].model.linear.actuator = {Vector{{.2}}, Vector{{.7}}};
  problems = check(unbounded, "line_zonotope", horizon(3));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("ranges") != std::string::npos);
  CHECK(problems[0].message.find("fast") != std::string::npos);
}

TEST_CASE("a horizon that the memory could not hold is refused") {
  Model model;
  const Index n = 60;
  model.linear = {{},
                  Matrix::Identity(n, n),
                  Matrix::Ones(n, 1),
                  Matrix::Identity(n, n),
                  Matrix::Identity(n, n),
                  Matrix::Zero(n, 1),
                  Matrix::Identity(n, n)};
  model.X0 = model.W = model.V = make_box(cube(n, 1));
  ModeBank bank;
  bank.modes = {{"one", model}, {"two", model}};
  CHECK(check(bank, "line_zonotope", horizon(2)).empty());
  const auto problems = check(bank, "line_zonotope", horizon(100));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/horizon");
}
