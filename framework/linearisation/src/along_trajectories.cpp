// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/linearisation/along_trajectories.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carried_zonotope.hpp"
#include "cordon/core/error.hpp"
#include "cordon/formulas/box_enclosure.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "linear_rows.hpp"

namespace cordon {

namespace {

/// Errors of one time are bounded less closely than those of a region, which stand for all times.
constexpr LinearisationEffort quick{
    12, 4, 100'000, 64, formulas::AffineForm::first_order, "where the states may be"};

Box meet(const Box& X, const Box& Y) {
  return {X.lower.cwiseMax(Y.lower), X.upper.cwiseMin(Y.upper)};
}

}  // namespace

TimedModel::TimedModel(std::vector<Model> models) : models_(std::move(models)) {
  if (models_.empty()) throw Error(Errc::invalid, "a model needs one time at least");
}

const Model& TimedModel::operator[](Index k) const {
  return models_[static_cast<std::size_t>(std::min(k, count() - 1))];
}

struct AlongTrajectories::State {
  State(const Model& of, Index first)
      : model(of),
        formulas(*of.nonlinear),
        f(by_inputs(*formulas.f, formulas.states(), formulas.inputs)),
        g(by_inputs(*formulas.g, formulas.outputs(), formulas.inputs)),
        range(f, formulas.states(), formulas::AffineForm::mean_value, Rounding::outward),
        W(bounded_hull(of.W, "W")),
        V(bounded_hull(of.V, "V")),
        k(first),
        x(of.X0, "X0"),
        X(bounded_hull(of.X0, "X0")) {
    if (formulas.admissible) admissible = interval_hull(*formulas.admissible);
    admit();
  }

  void admit() {
    if (!admissible) return;
    const Box inside = meet(X, *admissible);
    if (!inside.is_empty()) X = inside;
  }

  Variables variables(const Box& drawn, VectorIn u) const {
    Variables all;
    add_bounds(all, X);
    add_bounds(all, drawn);
    for (const double value : u) all.push_back({value, value});
    const auto time = static_cast<double>(k);
    all.push_back({time, time});
    return all;
  }

  void append(VectorIn u) {
    const Index n = formulas.states(), m = formulas.inputs;
    const Variables of_f = variables(W, u);
    const LinearRows next = linear_rows(f, n, of_f, "f", {}, quick),
                     shown = linear_rows(g, n, variables(V, u), "g", {}, quick);
    Model made;
    LinearModel& linear = made.linear;
    linear.A = next.slopes.leftCols(n);
    linear.B = next.slopes.rightCols(m);
    linear.Bw = beside(next.slopes.middleCols(n, W.dim()), next.columns);
    linear.C = shown.slopes.leftCols(n);
    linear.D = shown.slopes.rightCols(m);
    linear.Dv = beside(shown.slopes.middleCols(n, V.dim()), shown.columns);
    made.X0 = model.X0;
    made.U = model.U;
    made.W = with_errors(model.W, next);
    made.V = with_errors(model.V, shown);
    range.set_box(of_f);
    x.advance(linear, u, CarriedZonotope(made.W, "W"));
    Box reached = x.hull();
    for (Index i = 0; i < n; ++i) {
      const Interval values = range.range(i);
      reached.lower[i] = std::max(reached.lower[i], values.lower);
      reached.upper[i] = std::min(reached.upper[i], values.upper);
    }
    if (!reached.is_bounded())
      throw Error(Errc::not_enclosed, "the states have no bounds any more");
    X = std::move(reached);
    admit();
    ++k;
    models.push_back(std::move(made));
  }

  const Model model;
  const NonlinearModel& formulas;
  std::shared_ptr<const formulas::Function> f, g;
  formulas::BoxEnclosure range;
  Box W, V;
  Index k;
  CarriedZonotope x;
  Box X;  ///< holds x_k
  std::optional<Box> admissible;
  std::vector<Model> models;
};

AlongTrajectories::AlongTrajectories(const Model& model, Index first) {
  if (!model.nonlinear) throw Error(Errc::unsupported, "the system is linear already");
  state_ = std::make_unique<State>(model, first);
}
AlongTrajectories::~AlongTrajectories() = default;
AlongTrajectories::AlongTrajectories(AlongTrajectories&&) noexcept = default;
AlongTrajectories& AlongTrajectories::operator=(AlongTrajectories&&) noexcept = default;

void AlongTrajectories::append(VectorIn u) {
  if (u.size() != state_->formulas.inputs || !u.allFinite())
    throw Error(Errc::dimension, "the input has another size than the formulas, or is no number");
  try {
    state_->append(u);
  } catch (const Error& error) {
    if (error.code() != Errc::not_enclosed) throw;
    throw Error(Errc::not_enclosed,
                "at k = " + std::to_string(state_->k) + ": " + std::string(error.what()));
  }
}

const Box& AlongTrajectories::states() const { return state_->X; }
const std::vector<Model>& AlongTrajectories::models() const { return state_->models; }

namespace {

/// Throws unless all x_k, k < N, and with outputs that are not linear x_N, lie in the region.
void expect_region(const Model& model, const Matrix& u) {
  const ValidRegion& region = *model.region;
  const Index last = u.rows() - 1;
  const CarriedZonotope W(model.W, "W");
  CarriedZonotope x(model.X0, "X0");
  const auto leaves = [](const Box& X, const Box& of) {
    return !((X.lower.array() >= of.lower.array()).all() &&
             (X.upper.array() <= of.upper.array()).all());
  };
  for (Index k = 0; k <= last; ++k) {
    const bool counts = k < last || region.nonlinear_outputs;
    const Vector now = u.row(k);
    const char* what = leaves({now, now}, region.inputs) && counts ? "input"
                       : counts && leaves(x.hull(), region.states) ? "state"
                                                                   : nullptr;
    if (what)
      throw Error(Errc::not_enclosed,
                  "at k = " + std::to_string(k) + " the " + what +
                      " is not shown to lie in the region that the model is proven in");
    if (k < last) x.advance(model.linear, now, W);
  }
}

}  // namespace

TimedModel model_under(const Model& model, const Matrix& u) {
  if (model.region) expect_region(model, u);
  if (!model.nonlinear) return TimedModel(model);
  AlongTrajectories along(model);
  for (Index k = 0; k < u.rows(); ++k) along.append(u.row(k).transpose());
  return TimedModel(along.models());
}

}  // namespace cordon
