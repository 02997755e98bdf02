// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/semi_explicit_observer.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <boost/container/small_vector.hpp>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/interfaces/archive.hpp"
#include "observer_parameters.hpp"
#include "observers/effectiveness.hpp"
#include "observers/interval_spread.hpp"
#include "observers/rounding_room.hpp"
#include "observers/static_rows.hpp"

namespace cordon::estimators {

namespace {

/// Operations that round outward are taken at their word, and need numbers that were not rounded
/// before them. Where those of z = T⁻¹ x were and ž has no bound that an error could be a share of,
/// the states keep their coordinates.
StaticRows rows_for(const LinearModel& model, const SetBackend& backend, const Params& params) {
  StaticRows rows(model);
  const bool outward = backend.info().rounding == Rounding::outward;
  const bool keep_states = outward && !(rows.is_exact && rows.outputs_exact) &&
                           backend.info().unbounded && !params.has("admissible_set");
  return keep_states ? StaticRows(model, true) : rows;
}

class SemiExplicitObserver final : public Observer {
 public:
  SemiExplicitObserver(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        transformed_(rows_for(model().linear, backend(), params)),
        same_coordinates_(transformed_.T.isIdentity(0)),
        budget_(budget_from(params)),
        static_at_start_(params.flag("static_at_start")),
        X0_(initial_set_from(model(), params)),
        W_(backend().import(model().W)),
        effectiveness_(model(), backend()),
        static_W_(effectiveness_.has_input_ranges()
                      ? backend().product(W_, effectiveness_.input_factors())
                      : W_),
        inputs_enter_as_sets_(effectiveness_.inputs_enter_as_sets() &&
                              model().linear.inputs() > 0) {
    const Index n = model().linear.states(), free = transformed_.static_rows();
    keeps_states_ = transformed_.E.rows() > 0;
    rows_come_last_ = keeps_states_ && !transformed_.static_exact;
    const bool outward = backend().info().rounding == Rounding::outward;
    is_rounded_ = outward && !transformed_.is_exact;
    measures_states_ = has_spread(model().linear.C_radius) || is_rounded_ ||
                       (outward && !transformed_.outputs_exact);
    // Without the static rows of k = 0 every estimate is that of a larger initial set.
    const bool whole = transformed_.static_rows() == 0 || static_at_start_;
    recursion_ =
        whole && !transformed_.share_disturbances(model().W) ? Tightness::exact : Tightness::outer;
    recursion_ = meet(recursion_, effectiveness_.recursion({&transformed_.B, &transformed_.static_B,
                                                            &model().linear.D}));
    stacked_A_ = stacked(transformed_.A);
    stacked_B_ = stacked(transformed_.B);
    stacked_Bw_ = stacked(transformed_.Bw);
    stacked_rows_ = stacked(transformed_.rows);
    disturbance_ = linalg::product(stacked_Bw_, model().W.c);
    thickness_ = Thickness(model().W, stacked_Bw_);
    static_disturbance_ = linalg::product(transformed_.static_Bw, model().W.c);
    static_thickness_ = Thickness(model().W, transformed_.static_Bw);
    if (model().linear.is_uncertain() || is_rounded_) recursion_ = Tightness::outer;
    if (params.has("admissible_set")) {
      recursion_ = Tightness::outer;  // of the set only the part that E does not determine is used
      admissible_form_ = params.set_form("admissible_set");
      admissible_ = backend().import(*admissible_form_);
      const Matrix lower = transformed_.T_inverse.bottomRows(free);
      free_ = backend().affine_map(admissible_, lower, Vector::Zero(free));
    } else {
      free_ = backend().space(keeps_states_ ? n : free);
    }
    if (is_rounded_) largest_w_ = magnitudes(W_);
    if (is_rounded_ && !keeps_states_) {
      const Matrix lower = transformed_.T_inverse.bottomRows(free);
      const Matrix phi =
          linalg::product(transformed_.T_inverse.topRows(transformed_.rank()), lower.transpose());
      dynamic_rows_ = stacked(Matrix::Identity(transformed_.rank(), transformed_.rank()));
      free_rounding_ = interval_spread(rounding_radius(phi), magnitudes(free_), phi.rows());
    }
  }

  LineForm initial_set() const override { return X0_; }
  std::optional<LineForm> admissible_set() const override { return admissible_form_; }
  Tightness claim() const override { return recursion_; }
  bool follows_its_sets() const override { return true; }
  bool takes_missing_outputs() const override { return true; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    const Enclosure start = X0 ? *X0 : backend().import(X0_);
    Z_ = to_z(start);
    if (static_at_start_ && !rows_come_last_) Z_ = with_static_rows(Z_, first.u);
    return finish(Z_, first, static_at_start_);
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    const Enclosure predicted = timed(Phase::predict, [&] {
      const Matrix spread = effectiveness_.input_spread(stacked_B_, before.u);
      boost::container::small_vector<Term, 4> terms;  // without memory of its own
      terms.push_back({stacked_Bw_, W_});
      if (transformed_.static_rows() > 0 && !keeps_states_)
        terms.push_back({transformed_.free_part, free_});
      if (effectiveness_.has_input_ranges())
        terms.push_back({spread, effectiveness_.input_factors()});
      const Enclosure open = effectiveness_.has_open_states()
                                 ? effectiveness_.open_states(to_x(Z_), before.u)
                                 : Enclosure{};
      if (effectiveness_.has_open_states()) terms.push_back({stacked_rows_, open});
      const Enclosure input = inputs_enter_as_sets_ ? backend().point(before.u) : Enclosure{};
      if (inputs_enter_as_sets_) terms.push_back({stacked_B_, input});
      const Vector shift = inputs_enter_as_sets_ ? Vector(Vector::Zero(stacked_B_.rows()))
                                                 : effectiveness_.input(stacked_B_, before.u);
      const Vector sizes =
          effectiveness_.input_terms(stacked_B_, before.u) + disturbance_.cwiseAbs();
      const RoundingRoom room(backend(), shift + disturbance_, sizes, thickness_);
      if (room.is_needed()) terms.push_back(room.term());
      const Enclosure rounding =
          is_rounded_ && !keeps_states_ ? dynamic_rounding(before.u, open) : Enclosure{};
      if (rounding.set) terms.push_back({dynamic_rows_, rounding});
      const Enclosure next =
          solved(backend().predict(Z_, {stacked_A_, shift, {terms.data(), terms.size()}}));
      return rows_come_last_ ? next : with_static_rows(next, now.u);
    });
    return finish(predicted, now, true);
  }

  void do_replace(const Enclosure& X) override { Z_ = to_z(X); }
  void do_serialize(Archive& archive) override { archive.set(Z_, model().states()); }

  /// M in the dynamic rows, above zeros for ž.
  Matrix stacked(const Matrix& M) const {
    if (keeps_states_) return M;
    Matrix rows = Matrix::Zero(model().linear.states(), M.cols());
    rows.topRows(M.rows()) = M;
    return rows;
  }

  /// {x : Ẽ x ∈ F}, where states keep their coordinates.
  Enclosure solved(const Enclosure& F) const {
    if (!keeps_states_) return F;
    const Index rows = transformed_.rank();
    return backend().correct(
        free_, {transformed_.E, Vector::Zero(rows), {-Matrix::Identity(rows, rows), F}});
  }

  /// What the rounding of matrices can add to M_A z + M_B u + M_w w + M_o o.
  Vector rounding_of(const Matrix& M_A, const Vector& z, const Matrix& M_B, VectorIn u,
                     const Matrix& M_w, const Matrix& M_o, const Enclosure& o) const {
    const Index rows = M_A.rows();
    Vector sum = interval_spread(rounding_radius(M_A), z, rows) +
                 interval_spread(rounding_radius(M_B), effectiveness_.largest_input(u), rows) +
                 interval_spread(rounding_radius(M_w), largest_w_, rows);
    if (o.set) sum += interval_spread(rounding_radius(M_o), magnitudes(o), rows);
    return sum * (1 + 8 * rounding::unit);
  }

  /// Of z̃, which holds ž times the error of T⁻¹ besides.
  Enclosure dynamic_rounding(VectorIn u, const Enclosure& open) const {
    const StaticRows& form = transformed_;
    const Vector rows = rounding_of(form.A, magnitudes(Z_), form.B, u, form.Bw, form.rows, open);
    const Vector widths = (rows + free_rounding_) * (1 + 2 * rounding::unit);
    return backend().box({-widths, widths});
  }

  Enclosure to_z(const Enclosure& X) const {
    return same_coordinates_
               ? X
               : backend().affine_map(X, transformed_.T_inverse, Vector::Zero(X->dim()));
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
    entries << form.static_Bw,
        inputs_enter_as_sets_ ? form.static_B : effectiveness_.input_spread(form.static_B, u);
    Enclosure open;
    if (effectiveness_.has_open_states()) {
      open = effectiveness_.open_states(to_x(Z), u);
      noise = backend().product(noise, open);
      entries.conservativeResize(Eigen::NoChange, noise->dim());
      entries.rightCols(form.static_rows_map.cols()) = form.static_rows_map;
    }
    const Vector f = inputs_enter_as_sets_ ? Vector(Vector::Zero(rows))
                                           : Vector(-effectiveness_.input(form.static_B, u));
    if (is_rounded_ && !form.static_exact) return with_rounded_rows(Z, f, entries, noise, u, open);
    const Vector sizes =
        effectiveness_.input_terms(form.static_B, u) + static_disturbance_.cwiseAbs();
    const RoundingRoom room(backend(), f - static_disturbance_, sizes, static_thickness_);
    return room.correct(Z, {form.static_A, f, {entries, noise}});
  }

  /// The same where the rows were rounded: each gets room for that. One that holds a state without
  /// a bound says nothing.
  Enclosure with_rounded_rows(const Enclosure& Z, const Vector& f, const Matrix& entries,
                              const Enclosure& noise, VectorIn u, const Enclosure& open) const {
    const StaticRows& form = transformed_;
    const Vector widths = rounding_of(form.static_A, magnitudes(Z), form.static_B, u,
                                      form.static_Bw, form.static_rows_map, open);
    std::vector<Index> used;
    for (Index i = 0; i < widths.size(); ++i) {
      if (std::isfinite(widths[i])) used.push_back(i);
    }
    if (used.empty()) return Z;
    const Vector room = widths(used);
    Matrix columns(room.size(), entries.cols() + room.size());
    columns << entries(used, Eigen::all), Matrix::Identity(room.size(), room.size());
    const Enclosure all = backend().product(noise, backend().box({-room, room}));
    return backend().correct(Z, {form.static_A(used, Eigen::all), f(used), {columns, all}});
  }

  Enclosure finish(const Enclosure& predicted, const Sample& now, bool has_static_rows) {
    const Enclosure corrected = timed(Phase::correct, [&] {
      if (!measures_states_) return effectiveness_.correct(predicted, transformed_.C, now);
      const Enclosure measured =
          to_z(effectiveness_.correct(to_x(predicted), model().linear.C, now));
      return has_static_rows && rows_come_last_ ? with_static_rows(measured, now.u) : measured;
    });
    Z_ = timed(Phase::reduce, [&] { return backend().reduce(corrected, budget_); });
    return to_x(Z_);
  }

  StaticRows transformed_;
  bool same_coordinates_;         ///< z = x
  bool keeps_states_ = false;     ///< and dynamic rows stand as Ẽ x
  bool is_rounded_ = false;       ///< numbers were rounded, and operations round outward
  bool measures_states_ = false;  ///< C as it stands, since C T is rounded or an interval
  bool rows_come_last_ =
      false;  ///< static rows that were rounded need states that the outputs have bounded
  Budget budget_;
  bool static_at_start_;
  LineForm X0_;
  Enclosure W_;
  Effectiveness effectiveness_;
  Enclosure static_W_;                       ///< W × factors of inputs
  Vector disturbance_, static_disturbance_;  ///< center of Bw W, dynamic and static rows
  Thickness thickness_, static_thickness_;   ///< of the same
  Vector largest_w_, free_rounding_;  ///< magnitudes of W; what the rounding of T⁻¹ adds to z̃
  bool inputs_enter_as_sets_;         ///< B u and B̌ u are left to the backend
  Matrix stacked_A_, stacked_B_, stacked_Bw_, stacked_rows_, dynamic_rows_;
  Tightness recursion_ = Tightness::exact;
  std::optional<LineForm> admissible_form_;
  Enclosure admissible_, free_, Z_;
};

}  // namespace

std::unique_ptr<Observer> semi_explicit_observer(const ObserverContext& context,
                                                 const Params& params) {
  return std::make_unique<SemiExplicitObserver>(context, params);
}

}  // namespace cordon::estimators
