// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/semi_explicit_observer.hpp"

#include <optional>

#include <boost/container/small_vector.hpp>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "observer_parameters.hpp"
#include "observers/effectiveness.hpp"
#include "observers/interval_spread.hpp"
#include "observers/rounding_room.hpp"
#include "observers/static_rows.hpp"

namespace cordon::estimators {

namespace {

class SemiExplicitObserver final : public Observer {
 public:
  SemiExplicitObserver(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        transformed_(model().linear),
        same_coordinates_(transformed_.T.isIdentity(0)),
        budget_(budget_from(params)),
        static_at_start_(params.flag("static_at_start")),
        X0_(initial_set_from(model(), params)),
        W_(backend().import(model().W)),
        effectiveness_(model(), backend()),
        static_W_(effectiveness_.has_input_ranges() ? backend().product(W_, effectiveness_.input_factors()) : W_),
        measured_(linalg::product(model().linear.C, transformed_.T)),
        inputs_enter_as_sets_(effectiveness_.inputs_enter_as_sets() && model().linear.inputs() > 0) {
    const Index n = model().linear.states(), free = transformed_.static_rows();
    // Without the static rows of k = 0 every estimate is that of a larger initial set.
    const bool whole = transformed_.static_rows() == 0 || static_at_start_;
    recursion_ = whole && !transformed_.share_disturbances(model().W) ? Tightness::exact : Tightness::outer;
    recursion_ = meet(recursion_, effectiveness_.recursion({&transformed_.B, &transformed_.static_B, &model().linear.D}));
    stacked_B_ = Matrix::Zero(n, transformed_.B.cols());
    stacked_B_.topRows(transformed_.rank()) = transformed_.B;
    stacked_A_ = Matrix::Zero(n, n);
    stacked_A_.topRows(transformed_.rank()) = transformed_.A;
    stacked_Bw_ = Matrix::Zero(n, transformed_.Bw.cols());
    stacked_Bw_.topRows(transformed_.rank()) = transformed_.Bw;
    disturbance_ = linalg::product(stacked_Bw_, model().W.c);
    disturbance_widths_ = half_widths(model().W, stacked_Bw_);
    static_disturbance_ = linalg::product(transformed_.static_Bw, model().W.c);
    static_widths_ = half_widths(model().W, transformed_.static_Bw);
    stacked_rows_ = Matrix::Zero(n, n);
    stacked_rows_.topRows(transformed_.rank()) = transformed_.rows;
    // operations that round outward are taken at their word, and these coordinates are rounded before them
    const bool is_rounded = backend().info().rounding == Rounding::outward && !transformed_.is_exact;
    if (model().linear.is_uncertain() || is_rounded) recursion_ = Tightness::outer;
    if (params.has("admissible_set")) {
      recursion_ = Tightness::outer;  // of the set only the part that E does not determine is used
      admissible_ = backend().import(params.set_form("admissible_set"));
      const Matrix lower = transformed_.T_inverse.bottomRows(free);
      free_ = backend().affine_map(admissible_, lower, Vector::Zero(free));
    } else {
      free_ = backend().space(free);
    }
  }

  LineForm initial_set() const override { return X0_; }
  const Set* admissible_set() const override { return admissible_.set.get(); }
  Tightness claim() const override { return recursion_; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    const Enclosure start = X0 ? *X0 : backend().import(X0_);
    Z_ = to_z(start);
    if (static_at_start_) Z_ = with_static_rows(Z_, first.u);
    return finish(Z_, first);
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    const Enclosure predicted = timed(Phase::predict, [&] {
      const Matrix spread = effectiveness_.input_spread(stacked_B_, before.u);
      boost::container::small_vector<Term, 4> terms;  // without memory of its own
      terms.push_back({stacked_Bw_, W_});
      if (transformed_.static_rows() > 0) terms.push_back({transformed_.free_part, free_});
      if (effectiveness_.has_input_ranges()) terms.push_back({spread, effectiveness_.input_factors()});
      const Enclosure open = effectiveness_.has_open_states() ? effectiveness_.open_states(to_x(Z_), before.u) : Enclosure{};
      if (effectiveness_.has_open_states()) terms.push_back({stacked_rows_, open});
      const Enclosure input = inputs_enter_as_sets_ ? backend().point(before.u) : Enclosure{};
      if (inputs_enter_as_sets_) terms.push_back({stacked_B_, input});
      const Vector shift =
          inputs_enter_as_sets_ ? Vector(Vector::Zero(stacked_B_.rows())) : effectiveness_.input(stacked_B_, before.u);
      const Vector sizes = effectiveness_.input_terms(stacked_B_, before.u) + disturbance_.cwiseAbs();
      const RoundingRoom room(backend(), shift + disturbance_, sizes, disturbance_widths_);
      if (room.is_needed()) terms.push_back(room.term());
      return with_static_rows(backend().predict(Z_, {stacked_A_, shift, {terms.data(), terms.size()}}), now.u);
    });
    return finish(predicted, now);
  }

  void do_replace(const Enclosure& X) override { Z_ = to_z(X); }

  Enclosure to_z(const Enclosure& X) const {
    return same_coordinates_ ? X : backend().affine_map(X, transformed_.T_inverse, Vector::Zero(X->dim()));
  }
  Enclosure to_x(const Enclosure& Z) const {
    return same_coordinates_ ? Z : backend().affine_map(Z, transformed_.T, Vector::Zero(Z->dim()));
  }

  /// 0 = Ǎ z + B̌ diag(f) u + B̌w w with a fresh w ∈ W.
  Enclosure with_static_rows(const Enclosure& Z, VectorIn u) const {
    const StaticRows& form = transformed_;
    const Index rows = form.static_rows();
    if (rows == 0) return Z;
    Enclosure noise = inputs_enter_as_sets_ ? backend().product(W_, backend().point(u)) : static_W_;
    Matrix entries(rows, noise->dim());
    entries << form.static_Bw, inputs_enter_as_sets_ ? form.static_B : effectiveness_.input_spread(form.static_B, u);
    if (effectiveness_.has_open_states()) {
      noise = backend().product(noise, effectiveness_.open_states(to_x(Z), u));
      entries.conservativeResize(Eigen::NoChange, noise->dim());
      entries.rightCols(form.static_rows_map.cols()) = form.static_rows_map;
    }
    const Vector f = inputs_enter_as_sets_ ? Vector(Vector::Zero(rows)) : Vector(-effectiveness_.input(form.static_B, u));
    const Vector sizes = effectiveness_.input_terms(form.static_B, u) + static_disturbance_.cwiseAbs();
    const RoundingRoom room(backend(), f - static_disturbance_, sizes, static_widths_);
    return room.correct(Z, {form.static_A, f, {entries, noise}});
  }

  Enclosure finish(const Enclosure& predicted, const Sample& now) {
    const Enclosure corrected = timed(Phase::correct, [&] {
      if (!has_spread(model().linear.C_radius)) return effectiveness_.correct(predicted, measured_, now);
      return to_z(effectiveness_.correct(to_x(predicted), model().linear.C, now));
    });
    Z_ = timed(Phase::reduce, [&] { return backend().reduce(corrected, budget_); });
    return to_x(Z_);
  }

  StaticRows transformed_;
  bool same_coordinates_;  ///< z = x
  Budget budget_;
  bool static_at_start_;
  LineForm X0_;
  Enclosure W_;
  Effectiveness effectiveness_;
  Enclosure static_W_;                         ///< W × factors of inputs
  Vector disturbance_, disturbance_widths_;    ///< center and half widths of Bw W, dynamic rows
  Vector static_disturbance_, static_widths_;  ///< the same, static rows
  Matrix measured_;                            ///< C T
  bool inputs_enter_as_sets_;                  ///< B u and B̌ u are left to the backend
  Matrix stacked_A_, stacked_B_, stacked_Bw_, stacked_rows_;
  Tightness recursion_ = Tightness::exact;
  Enclosure admissible_, free_, Z_;
};

}  // namespace

std::unique_ptr<Observer> semi_explicit_observer(const ObserverContext& context, const Params& params) {
  return std::make_unique<SemiExplicitObserver>(context, params);
}

}  // namespace cordon::estimators
