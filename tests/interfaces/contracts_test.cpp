// SPDX-License-Identifier: GPL-3.0-or-later
// Public functions of gain designers and plants check what they are given, and what they get.
#include <limits>
#include <optional>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/interfaces/gain_designer.hpp"
#include "cordon/interfaces/plant_formulas.hpp"

using namespace cordon;

namespace {

/// Of two states and one output.
Model model() {
  Model made;
  made.linear.A = Matrix::Identity(2, 2);
  made.linear.C = Matrix::Ones(1, 2);
  return made;
}

class FollowingGain final : public GainDesigner {
 public:
  explicit FollowingGain(Matrix L) : L_(std::move(L)) {}

 private:
  GainDesign do_design(const Model&) const override { return {}; }
  bool do_is_time_varying() const override { return true; }
  Matrix do_update(const Model&, MatrixIn) const override { return L_; }

  Matrix L_;
};

class SteadyGain final : public GainDesigner {
  GainDesign do_design(const Model&) const override { return {}; }
};

/// Two states, one input, one output; answers as it was told.
class ToldPlant final : public Plant {
 public:
  ToldPlant(Index next, Index output) : next_(next), output_(output) {}

 private:
  Index do_states() const override { return 2; }
  Index do_inputs() const override { return 1; }
  Index do_outputs() const override { return 1; }
  Vector do_next(Index, VectorIn, VectorIn) const override { return Vector::Zero(next_); }
  Vector do_output(Index, VectorIn, VectorIn) const override { return Vector::Zero(output_); }

  Index next_, output_;
};

/// x⁺ = x / 2 and y = x1, as many formulas as it was told; or y in a graph of its own.
class FormulaPlant final : public Plant {
 public:
  FormulaPlant(std::size_t next, std::size_t output, bool own_graph = false)
      : next_(next), output_(output), own_graph_(own_graph) {}

 private:
  Index do_states() const override { return 2; }
  Index do_inputs() const override { return 1; }
  Index do_outputs() const override { return 1; }
  Vector do_next(Index, VectorIn x, VectorIn) const override { return x / 2; }
  Vector do_output(Index, VectorIn x, VectorIn) const override { return x.head(1); }
  std::optional<PlantFormulas> do_formulas(const PlantVariables& of) const override {
    PlantFormulas made{{next_, of.x[0] / 2}, {output_, of.x[0]}};
    if (own_graph_) made.output.assign(output_, other_.variable(0));
    return made;
  }

  std::size_t next_, output_;
  bool own_graph_;
  mutable formulas::Graph other_{{"x1"}};
};

template <class Call>
Errc code_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.code();
  }
  return Errc::internal;  // of nothing that is tried here
}

}  // namespace

TEST_CASE("a gain that follows the set has the model's size, and is finite") {
  const Matrix P = Matrix::Identity(2, 2);
  CHECK(FollowingGain(Matrix{{1}, {2}}).update(model(), P) == Matrix{{1}, {2}});
  for (const Matrix& L : {Matrix(Matrix{{1, 2}}), Matrix(0, 0), Matrix(2, 2),
                          Matrix(Matrix{{1}, {std::numeric_limits<double>::quiet_NaN()}}),
                          Matrix(Matrix{{infinity}, {0}})}) {
    CHECK(code_of([&] { FollowingGain(L).update(model(), P); }) == Errc::violated);
  }
  for (const Matrix& wrong : {Matrix(1, 1), Matrix(2, 3), Matrix(0, 0)}) {
    CHECK(code_of([&] {
            FollowingGain(Matrix{{1}, {2}}).update(model(), wrong);
          }) == Errc::dimension);
  }
  CHECK_FALSE(SteadyGain().is_time_varying());
  CHECK_THROWS_AS(SteadyGain().update(model(), P), Error);
}

TEST_CASE("a plant is given vectors of its sizes, and answers with them") {
  const Vector x = Vector::Zero(2), u = Vector::Zero(1);
  CHECK(ToldPlant(2, 1).next(0, x, u).size() == 2);
  CHECK(ToldPlant(2, 1).output(0, x, u).size() == 1);
  CHECK(code_of([&] { ToldPlant(3, 1).next(0, x, u); }) == Errc::violated);
  CHECK(code_of([&] { ToldPlant(2, 0).output(0, x, u); }) == Errc::violated);
  CHECK(code_of([&] { ToldPlant(2, 1).next(0, u, u); }) == Errc::dimension);
  CHECK(code_of([&] { ToldPlant(2, 1).output(0, x, x); }) == Errc::dimension);
}

TEST_CASE("a plant is given variables of its sizes, and answers with formulas of their graph") {
  formulas::Graph graph({"x1", "x2", "u1", "k"});
  const PlantVariables of{
      {graph.variable(0), graph.variable(1)}, {graph.variable(2)}, graph.variable(3)};
  CHECK_FALSE(ToldPlant(2, 1).as_formulas(of));
  const auto made = FormulaPlant(2, 1).as_formulas(of);
  REQUIRE(made);
  CHECK(graph.to_string(made->next[0].node()) == "x1*0.5");
  CHECK(made->output[0].node() == of.x[0].node());
  CHECK(code_of([&] { FormulaPlant(1, 1).as_formulas(of); }) == Errc::violated);
  CHECK(code_of([&] { FormulaPlant(2, 2).as_formulas(of); }) == Errc::violated);
  CHECK(code_of([&] { FormulaPlant(2, 1, true).as_formulas(of); }) == Errc::violated);
  CHECK(code_of([&] { FormulaPlant(2, 1).as_formulas({of.u, of.u, of.k}); }) == Errc::dimension);
}
