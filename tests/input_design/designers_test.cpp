// SPDX-License-Identifier: GPL-3.0-or-later
// What all designers check and report, tried with the one that is given its input.
#include <algorithm>

#include <doctest/doctest.h>

#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using examples::backend;
using examples::numbers;
using examples::registry;

namespace {

Matrix by_time(const Vector& u, Index inputs) {
  return Eigen::Map<const Matrix>(u.data(), inputs, u.size() / inputs).transpose();
}

DesignOutcome judged(const ModeBank& bank, const char* backend_name, const Params& params) {
  REQUIRE(registry().check<DesignerEntry>("given", {bank, backend(backend_name)}, params).empty());
  DesignControl control;
  return registry()
      .make<DesignerEntry>("given", {bank, backend(backend_name)}, params)
      ->design(control);
}

std::vector<Diagnostic> problems(const char* designer, const ModeBank& bank,
                                 const char* backend_name, const Params& params) {
  return registry().check<DesignerEntry>(designer, {bank, backend(backend_name)}, params);
}

bool mentions(const std::vector<Diagnostic>& problems, const std::string& pointer,
              const std::string& text) {
  return std::any_of(problems.begin(), problems.end(), [&](const Diagnostic& problem) {
    return problem.pointer == pointer && problem.message.find(text) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("A given input is judged: cost, pairs, tubes") {
  const ModeBank bank = examples::four_descriptor_models();
  Params params = Params()
                      .set("input", by_time(examples::published_line_input(), 2))
                      .set("reference", Matrix((Matrix(1, 2) << .5, -1).finished()));
  DesignOutcome outcome = judged(bank, "line_zonotope", params);
  CHECK(outcome.status == DesignStatus::given);
  CHECK(outcome.horizon == 3);
  REQUIRE(outcome.best);
  CHECK(outcome.best->cost == doctest::Approx(3.9399 + .5854 + 6.0632).epsilon(1e-12));
  CHECK(outcome.best->separates() == Answer::yes);
  CHECK(outcome.reason.empty());
  CHECK(outcome.best->pairs.size() == 6);
  CHECK(outcome.best->outputs[0].upper[3] == doctest::Approx(11.46462));
  CHECK(outcome.best->u(2, 1) == -7.0632);

  params.set("cost", std::string("norm_inf"));
  CHECK(judged(bank, "line_zonotope", params).best->cost == doctest::Approx(6.0632).epsilon(1e-12));
  params.set("cost", std::string("quadratic"))
      .set("weights", Matrix((Matrix(3, 2) << 1, 1, 2, 1, 1, 3).finished()));
  CHECK(judged(bank, "line_zonotope", params).best->cost ==
        doctest::Approx(2 * 3.9399 * 3.9399 + .5854 * .5854 + 3 * 6.0632 * 6.0632).epsilon(1e-12));

  params.set("input", by_time(examples::published_constrained_input(), 2));
  outcome = judged(bank, "line_zonotope", params);
  CHECK(outcome.best->separates() == Answer::no);
  CHECK(outcome.reason == "the outputs of \"model_1\" and \"model_3\" can be the same");
}

TEST_CASE("An empty tube is a modelling error, and no separation") {
  const ModeBank bank = examples::four_descriptor_models();
  for (const Vector& u :
       {examples::published_line_input(), examples::published_constrained_input()}) {
    const Params params =
        Params().set("input", by_time(u, 2)).set("admissible_set", examples::cube(3, 1));
    const DesignOutcome outcome = judged(bank, "constrained_zonotope", params);
    for (const PairSeparation& pair : outcome.best->pairs)
      CHECK(pair.disjoint == Answer::yes);  // of nothing
    CHECK(std::count(outcome.best->empty.begin(), outcome.best->empty.end(), Answer::yes) == 4);
    CHECK(outcome.best->separates() == Answer::unknown);
    CHECK(outcome.reason.find(
              "output tubes of \"model_1\", \"model_2\", \"model_3\", \"model_4\" are empty") !=
          std::string::npos);
    CHECK(outcome.admissible_set.has_value());
  }
}

TEST_CASE("The judgement of a given input can be stopped between tubes, pairs and hulls") {
  class Counted final : public DesignControl {
   public:
    explicit Counted(int most) : most_(most) {}
    bool stop() const noexcept override { return ++asked > most_; }
    mutable int asked = 0;

   private:
    int most_;
  };
  const ModeBank bank = examples::four_descriptor_models();
  const Params params = Params().set("input", by_time(examples::published_line_input(), 2));
  const auto designer =
      registry().make<DesignerEntry>("given", {bank, backend("line_zonotope")}, params);
  const int all = 4 + 6 + 6 + 4;
  for (int most = 0; most < all; ++most) {
    Counted control(most);
    const DesignOutcome outcome = designer->design(control);
    CHECK(outcome.status == DesignStatus::unknown);
    CHECK(outcome.stopped);
    CHECK_FALSE(outcome.best);
    CHECK_FALSE(outcome.reason.empty());
    CHECK(control.asked == most + 1);
  }
  Counted enough(all);
  CHECK(designer->design(enough).status == DesignStatus::given);
  CHECK(enough.asked == all);
}

TEST_CASE("A single empty tube is named") {
  ModeBank bank = examples::three_scalar_models();
  LinearModel& m =
      bank.modes[1].model.linear;  // 0 = x - 100 w besides x⁺ = …: no state of X0 and W meets it
  m.E = Matrix::Zero(1, 1);
  m.A = Matrix::Zero(1, 1);
  const Params params = Params().set("input", by_time(numbers({1, 1, 1}), 1));
  const DesignOutcome outcome = judged(bank, "line_zonotope", params);
  CHECK(outcome.best->empty == std::vector{Answer::no, Answer::yes, Answer::no});
  CHECK(outcome.reason.find("output tube of \"fast\" is empty") != std::string::npos);
}

TEST_CASE("A given input outside /system/U is judged, and told") {
  ModeBank bank = examples::three_scalar_models();
  for (Mode& mode : bank.modes) mode.model.U = examples::cube(1, 2);
  const auto reason = [&](std::initializer_list<double> u) {
    const DesignOutcome outcome =
        judged(bank, "line_zonotope", Params().set("input", by_time(numbers(u), 1)));
    CHECK(outcome.suggestion.empty() == (outcome.reason.find("/system/U") == std::string::npos));
    return outcome.reason;
  };
  CHECK(reason({0, 2, 0, -2}).empty());
  CHECK(reason({3, 2, 0, -2.5}) ==
        "u_k lies outside /system/U, the set of all inputs, at k = 0, 3");
  CHECK(reason({0, 0, 2.5}).find("at k = 2; the outputs of \"slow\"") !=
        std::string::npos);  // u_2 has no effect on y_2
  for (Mode& mode : bank.modes) mode.model.U = make_space(1);
  CHECK(reason({3, 2, 0, -2.5}).empty());
}

TEST_CASE("Costs that are too large to be compared are refused") {
  ModeBank bank = examples::three_scalar_models();
  for (Mode& mode : bank.modes) mode.model.U = make_box({numbers({-2}), numbers({3})});
  const auto found = [&](const char* designer, double reference, double weight, const char* cost) {
    Params params = Params()
                        .set("reference", Matrix(Matrix::Constant(1, 1, reference)))
                        .set("weights", Matrix(Matrix::Constant(1, 1, weight)))
                        .set("cost", std::string(cost));
    designer == std::string("given") ? params.set("input", by_time(numbers({0, 1}), 1))
                                     : params.set("horizon", std::int64_t{1});
    return problems(designer, bank, "line_zonotope", params);
  };
  for (const char* designer : {"given", "facets", "milp"}) {
    CHECK(found(designer, 1e49, 1, "quadratic").empty());
    CHECK(mentions(found(designer, 1e51, 1, "quadratic"), "/reference", "costs of up to 2e+102"));
    CHECK(mentions(found(designer, -1e51, 1, "quadratic"), "/reference", "costs of up to 2e+102"));
    CHECK(mentions(found(designer, 1e160, 1, "quadratic"), "/reference", "inf"));
    CHECK(mentions(found(designer, 1e160, 0, "quadratic"), "/reference", ""));  // 0·∞
    CHECK(found(designer, 1e51, 1, "norm_1").empty());
    CHECK(mentions(found(designer, 1e110, 1, "norm_inf"), "/reference", ""));
    CHECK(mentions(found(designer, 0, 1e120, "norm_1"), "/weights", ""));
  }
  // the farthest input of [-2, 3] from 1 is -2: (1e99 + 1e99)·3
  CHECK(found("facets", 1, 1e99, "norm_1").empty());
  CHECK(mentions(found("facets", 1, 2e99, "quadratic"), "/weights", "costs of up to 3.6e+100"));
  CHECK(mentions(found("facets", 0, 1e99, "quadratic"), "/weights", "costs of up to 1.8e+100"));
  for (Mode& mode : bank.modes) mode.model.U = examples::cube(1, 1e60);
  CHECK(mentions(found("facets", 0, 1, "quadratic"), "/cost", "costs of up to 2e+120"));
}

TEST_CASE("Tubes that touch are not separated") {
  const ModeBank bank = examples::three_scalar_models();
  const Params params = Params().set("input", by_time(numbers({0, .9, 0, 0}), 1));
  const DesignOutcome outcome = judged(bank, "line_zonotope", params);
  CHECK(outcome.best->separates() != Answer::yes);
  CHECK(outcome.reason.find("touch") != std::string::npos);
}

TEST_CASE("What makes no sense is refused, all of it at once") {
  const ModeBank bank = examples::four_descriptor_models();
  const Matrix input = by_time(examples::reference_input(), 2);
  SUBCASE("shapes") {
    const auto found = problems("given", bank, "line_zonotope",
                                Params()
                                    .set("input", input)
                                    .set("weights", Matrix(Matrix::Ones(1, 3)))
                                    .set("reference", Matrix(Matrix::Ones(2, 1)))
                                    .set("admissible_set", examples::cube(2, 1)));
    CHECK(mentions(found, "/weights", "1 × 3"));
    CHECK(mentions(found, "/reference", "2 × 1"));
    CHECK(mentions(found, "/admissible_set", "dimension 2"));
  }
  SUBCASE("input") {
    CHECK(mentions(
        problems("given", bank, "line_zonotope", Params().set("input", Matrix(Matrix::Ones(4, 3)))),
        "/input", "4 × 3"));
    CHECK(mentions(
        problems("given", bank, "line_zonotope", Params().set("input", Matrix(Matrix::Ones(1, 2)))),
        "/input", "1 × 2"));
    CHECK(mentions(problems("given", examples::three_scalar_models(), "line_zonotope",
                            Params().set("input", Matrix(Matrix::Ones(1, 1)))),
                   "/input", "must have 1 column,"));
  }
  SUBCASE("values") {
    Params params = Params().set("input", input).set("weights", Matrix(-Matrix::Ones(1, 2)));
    CHECK(mentions(problems("given", bank, "line_zonotope", params), "/weights", "negative"));
    params = Params().set("input", input).set("admissible_set", make_empty(3));
    CHECK(mentions(problems("given", bank, "line_zonotope", params), "/admissible_set", "empty"));
    CHECK(mentions(
        problems("given", bank, "line_zonotope", Params().set("input", input).set("epsilon", -.1)),
        "/epsilon", ""));
  }
}

TEST_CASE("What designers cannot work with is refused: sizes, backends, modes") {
  const ModeBank bank = examples::four_descriptor_models();
  const Matrix input = by_time(examples::reference_input(), 2);
  SUBCASE("sizes") {
    // 4 equations and outputs and 8 columns or fewer per time and mode: the columns are the more,
    // then the rows.
    const ModeBank small = examples::three_scalar_models();
    const auto judged_at = [&](const ModeBank& of, Index rows) {
      return problems("given", of, "line_zonotope",
                      Params().set("input", Matrix(Matrix::Ones(rows, 1))));
    };
    CHECK(judged_at(small, 100).empty());
    CHECK(mentions(judged_at(small, 5000), "/input", "rows and"));
    ModeBank tall = small;
    for (Mode& mode : tall.modes) {
      const LinearModel& m = mode.model.linear;
      mode.model.linear.C = m.C.replicate(300, 1).eval();
      mode.model.linear.D = m.D.replicate(300, 1).eval();
      mode.model.linear.Dv = m.Dv.replicate(300, 1).eval();
    }
    CHECK(judged_at(tall, 3).empty());
    CHECK(mentions(judged_at(tall, 12), "/input",
                   "rows and"));  // few columns, but the square of the rows
  }
  SUBCASE("backends") {
    const Params params = Params().set("input", input);
    CHECK(mentions(problems("given", bank, "constrained_zonotope", params), "/admissible_set",
                   "is missing"));
    CHECK(mentions(problems("given", bank, "zonotope", params), "", "static rows"));
    const Params scalar = Params().set("input", Matrix(Matrix::Ones(3, 1)));
    CHECK(mentions(problems("given", examples::three_scalar_models(), "zonotope", scalar), "",
                   "X0 of mode \"slow\""));
  }
  SUBCASE("modes") {
    ModeBank other = bank;
    other.modes[2].model.linear.C = Matrix::Ones(2, 3);
    other.modes[2].model.linear.D = Matrix::Zero(2, 2);
    other.modes[2].model.linear.Dv = Matrix::Ones(2, 1);
    CHECK(mentions(problems("given", other, "line_zonotope", Params().set("input", input)), "",
                   "mode \"model_3\" has 2 outputs, \"model_1\" has 1"));
    other = bank;
    other.modes.resize(1);
    CHECK(mentions(problems("given", other, "line_zonotope", Params().set("input", input)), "",
                   "no modes to tell apart"));
    other = bank;
    other.modes[1].model.linear.A_radius = Matrix::Constant(3, 3, .1);
    CHECK(mentions(problems("given", other, "line_zonotope", Params().set("input", input)), "",
                   "interval matrices"));
    other = bank;
    other.modes[1].model.linear.actuator = {Vector::Constant(2, .5), Vector::Ones(2)};
    CHECK(mentions(problems("given", other, "line_zonotope", Params().set("input", input)), "",
                   "range"));
  }
}
