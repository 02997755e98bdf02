// SPDX-License-Identifier: GPL-3.0-or-later
// Public functions of gain designers and plants check what they are given, and what they get.
#include <limits>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/interfaces/gain_designer.hpp"
#include "cordon/interfaces/plant.hpp"

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
