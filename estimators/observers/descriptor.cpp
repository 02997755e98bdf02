// SPDX-License-Identifier: GPL-3.0-or-later
// Observer for descriptor systems E x⁺ = A x + B u + Bw w, y = C x + D u + Dv v with singular E. The recursion follows from what
// the backend can do.
//
// Backends with exact intersections [Rego2025, sec. 4], with E = U Σ Vᵀ, z = Vᵀ x = (z̃, ž), n_z = rank E:
//   z̃_k = Ã z_{k-1} + B̃ u_{k-1} + B̃w w_{k-1},   0 = Ǎ z_k + B̌ u_k + B̌w w_k  (static rows)
//   Z̄_k = {([Ã z + B̃ u + B̃w w]; ž) : z ∈ Ẑ_{k-1}, w ∈ W, ž ∈ R^{n-n_z}} cut by the static rows with a second copy of W, then by
//   the measurement.
// ž is free with lines; without, it is taken from an admissible set X_A that holds x_k for all k. Exact if no generator of W
// enters both B̃w and B̌w; and the static rows of k = 0 are
// included; else the two copies of W, or the larger start, make the recursion an outer one, and the estimate says so.
//
// Other backends [Wang2018a]: with [T N] = [E; C]⁺ it holds T E + N C = I, so
//   x_k = (T A - L C) x_{k-1} + T B u_{k-1} + T Bw w_{k-1} + L (y_{k-1} - D u_{k-1} - Dv v_{k-1}) + N (y_k - D u_k - Dv v_k)
// for every gain L; L_k = T A P Cᵀ (C P Cᵀ + Q)⁻¹ with P = G Gᵀ of the estimate and Q = Dv Gv Gvᵀ Dvᵀ minimises the F-radius.
// Outputs whose sensors can fail altogether are left out there: y_k enters before anything is known of x_k.
//
// Ranges of effectiveness: effectiveness.hpp. An input with a range that enters dynamic rows, static rows or outputs alike has
// its factor taken once for each, which makes the recursion an outer one.
//
// Interval matrices A and B add a box to every equation, of the size that effectiveness.hpp tells for the states before: to the
// dynamic rows that of the last estimate, to the static rows that of the predicted set. A static row that holds a state without a
// bound says nothing then. C may be an interval matrix where intersections are exact; else y_k enters before x_k is bounded.
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <boost/container/small_vector.hpp>

#include "components.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"
#include "observer_parameters.hpp"
#include "observers/effectiveness.hpp"
#include "observers/interval_spread.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

namespace {

constexpr double rank_tolerance = 1e-10;
constexpr double steady = 1e-12;  ///< changes of entries of P, relative to their states' sizes, that leave the gain as it is

/// An orthogonal factor without entries that are zero up to the rounding of the decomposition.
Matrix denoised(const Matrix& Q) { return (Q.array().abs() <= 1e-15).select(0.0, Q); }

/// Row scales of E x⁺ = …: each row by its entries in E, static rows by those of A. The equation stays the same, and the rank of
/// E does not depend on units.
Vector equation_scales(const LinearModel& m) {
  Vector scale = linalg::row_scales(m.E);
  const Vector of_A = linalg::row_scales(m.A);
  for (Index i = 0; i < scale.size(); ++i) {
    if (m.E.row(i).isZero(0)) scale[i] = of_A[i];
  }
  return scale;
}

/// The system in the coordinates z = Vᵀ x: dynamic rows above, static rows below.
struct Transformed {
  Matrix T;                              ///< x = T z
  Matrix A, B, Bw;                       ///< dynamic rows, n_z of them, divided by the singular values
  Matrix static_A, static_B, static_Bw;  ///< static rows
  Matrix rows, static_rows_map;          ///< what makes the dynamic and the static rows of those of the model
  Matrix free_part;                      ///< [0; I]: where ž enters
  Vector sigma;                          ///< singular values of the scaled E

  explicit Transformed(const LinearModel& m) {
    const Index n = m.states();
    const Vector units = m.is_descriptor() ? equation_scales(m) : Vector(Vector::Ones(n));
    const linalg::Svd d = linalg::svd(m.is_descriptor() ? Matrix(units.asDiagonal() * m.E) : Matrix(Matrix::Identity(n, n)));
    sigma = d.sigma;
    const Index rank = m.is_descriptor() ? descriptor_rank(m.E) : n;
    Vector scale = Vector::Ones(n);
    for (Index i = 0; i < rank; ++i) scale[i] = 1 / d.sigma[i];
    const Matrix left = scale.asDiagonal() * denoised(d.U).transpose() * units.asDiagonal();
    T = denoised(d.V);
    const Matrix all_A = linalg::denoised_product(left, linalg::denoised_product(m.A, T));
    const Matrix all_B = linalg::denoised_product(left, m.B), all_Bw = linalg::denoised_product(left, m.Bw);
    A = all_A.topRows(rank);
    B = all_B.topRows(rank);
    Bw = all_Bw.topRows(rank);
    static_A = all_A.bottomRows(n - rank);
    static_B = all_B.bottomRows(n - rank);
    static_Bw = all_Bw.bottomRows(n - rank);
    rows = left.topRows(rank);
    static_rows_map = left.bottomRows(n - rank);
    free_part = Matrix::Zero(n, n - rank);
    free_part.bottomRows(n - rank).setIdentity();
  }

  Index rank() const { return A.rows(); }
  Index static_rows() const { return static_A.rows(); }
};

/// Does a factor of W enter dynamic and static rows alike? Constraints couple all factors.
bool shares_disturbances(const Transformed& t, const LineForm& W) {
  const auto enters = [](const Matrix& rows, const Matrix& columns, Index j) {
    return !linalg::product(rows, columns.col(j)).isZero(0);
  };
  bool any_dynamic = false, any_static = false, both = false;
  for (const Matrix* columns : {&W.G, &W.M}) {
    for (Index j = 0; j < columns->cols(); ++j) {
      const bool dynamic = enters(t.Bw, *columns, j), fixed = enters(t.static_Bw, *columns, j);
      any_dynamic = any_dynamic || dynamic;
      any_static = any_static || fixed;
      both = both || (dynamic && fixed);
    }
  }
  return both || (W.constraints() > 0 && any_dynamic && any_static);
}

class SingularValueObserver final : public Observer {
 public:
  SingularValueObserver(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        transformed_(model().linear),
        same_coordinates_(transformed_.T.isIdentity(0)),
        budget_(budget_from(params)),
        static_at_start_(params.flag("static_at_start")),
        X0_(initial_set_from(model(), params)),
        W_(backend().import(model().W)),
        effectiveness_(model(), backend()),
        static_W_(effectiveness_.has_input_ranges() ? backend().product(W_, effectiveness_.input_factors()) : W_),
        measured_(linalg::product(model().linear.C, transformed_.T)) {
    const Index n = model().linear.states(), free = transformed_.static_rows();
    // Without the static rows of k = 0 every estimate is that of a larger initial set.
    const bool whole = transformed_.static_rows() == 0 || static_at_start_;
    recursion_ = whole && !shares_disturbances(transformed_, model().W) ? Tightness::exact : Tightness::outer;
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
    if (model().linear.is_uncertain()) recursion_ = Tightness::outer;
    if (params.has("admissible_set")) {
      recursion_ = Tightness::outer;  // of the set only the part that E does not determine is used
      admissible_ = backend().import(params.set_form("admissible_set"));
      const Matrix lower = transformed_.T.transpose().bottomRows(free);
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
      const Vector shift = effectiveness_.input(stacked_B_, before.u);
      const Vector sizes = effectiveness_.input_terms(stacked_B_, before.u) + disturbance_.cwiseAbs();
      const RoundingRoom room(backend(), shift + disturbance_, sizes, disturbance_widths_);
      if (room.is_needed()) terms.push_back(room.term());
      const Enclosure Z = backend().predict(Z_, {stacked_A_, shift, {terms.data(), terms.size()}});
      return with_static_rows(Z, now.u);
    });
    return finish(predicted, now);
  }

  void do_replace(const Enclosure& X) override { Z_ = to_z(X); }

  Enclosure to_z(const Enclosure& X) const {
    return same_coordinates_ ? X : backend().affine_map(X, transformed_.T.transpose(), Vector::Zero(X->dim()));
  }
  Enclosure to_x(const Enclosure& Z) const {
    return same_coordinates_ ? Z : backend().affine_map(Z, transformed_.T, Vector::Zero(Z->dim()));
  }

  /// 0 = Ǎ z + B̌ diag(f) u + B̌w w with a fresh w ∈ W.
  Enclosure with_static_rows(const Enclosure& Z, VectorIn u) const {
    if (transformed_.static_rows() == 0) return Z;
    const Vector f = -effectiveness_.input(transformed_.static_B, u);
    Matrix entries(transformed_.static_rows(), static_W_->dim());
    entries << transformed_.static_Bw, effectiveness_.input_spread(transformed_.static_B, u);
    const Vector sizes = effectiveness_.input_terms(transformed_.static_B, u) + static_disturbance_.cwiseAbs();
    const RoundingRoom room(backend(), f - static_disturbance_, sizes, static_widths_);
    if (!effectiveness_.has_open_states()) return room.correct(Z, {transformed_.static_A, f, {entries, static_W_}});
    const Enclosure noise = backend().product(static_W_, effectiveness_.open_states(to_x(Z), u));
    Matrix open_entries(entries.rows(), noise->dim());
    open_entries << entries, transformed_.static_rows_map;
    return room.correct(Z, {transformed_.static_A, f, {open_entries, noise}});
  }

  Enclosure finish(const Enclosure& predicted, const Sample& now) {
    const Enclosure corrected = timed(Phase::correct, [&] {
      if (!has_spread(model().linear.C_radius)) return effectiveness_.correct(predicted, measured_, now);
      return to_z(effectiveness_.correct(to_x(predicted), model().linear.C, now));
    });
    Z_ = timed(Phase::reduce, [&] { return backend().reduce(corrected, budget_); });
    return to_x(Z_);
  }

  Transformed transformed_;
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
  Matrix stacked_A_, stacked_B_, stacked_Bw_, stacked_rows_;
  Tightness recursion_ = Tightness::exact;
  Enclosure admissible_, free_, Z_;
};

/// Outputs that the measurement itself bounds, weighted by the middle of their effectiveness; the others have rows of zeros.
LinearModel with_bounded_outputs(LinearModel m) {
  const Vector g = m.sensor_center();
  for (Index i = 0; i < m.outputs(); ++i) {
    if (Effectiveness::is_bounded_by_measurement(m, i)) {
      m.C.row(i) *= g[i];
      m.D.row(i) *= g[i];
    } else {
      m.C.row(i).setZero();
      m.D.row(i).setZero();
      m.Dv.row(i).setZero();
    }
  }
  return m;
}

/// The largest sum of magnitudes of a row.
double row_norm(const Matrix& A) { return A.size() ? A.cwiseAbs().rowwise().sum().maxCoeff() : 0.0; }

double largest(VectorIn x) { return x.size() ? x.lpNorm<Eigen::Infinity>() : 0.0; }

/// [E; C].
Matrix stacked_E_C(const LinearModel& m) {
  Matrix stacked(m.states() + m.outputs(), m.states());
  stacked << (m.is_descriptor() ? m.E : Matrix(Matrix::Identity(m.states(), m.states()))), m.C;
  return stacked;
}

/// Claims no exact estimate: the first measurement enters with the second, by a gain, and v_{k-1} twice.
class PseudoInverseObserver final : public Observer {
 public:
  PseudoInverseObserver(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        budget_(budget_from(params)),
        X0_(initial_set_from(model(), params)),
        W_(backend().import(model().W)),
        V_(backend().import(model().V)),
        effectiveness_(model(), backend()),
        used_(with_bounded_outputs(model().linear)),
        is_used_(used_.outputs()) {
    const Index n = used_.states();
    for (Index i = 0; i < is_used_.size(); ++i) is_used_[i] = Effectiveness::is_bounded_by_measurement(model().linear, i);
    const Matrix inverse = linalg::pseudo_inverse(stacked_E_C(used_));
    T_ = inverse.leftCols(n);
    N_ = inverse.rightCols(used_.outputs());
    TA_ = linalg::product(T_, used_.A);
    TB_ = linalg::product(T_, used_.B);
    TBw_ = linalg::product(T_, used_.Bw);
    minus_ND_ = -linalg::product(N_, used_.D);
    minus_NDv_ = -linalg::product(N_, used_.Dv);
    disturbance_ = linalg::product(TBw_, model().W.c) + linalg::product(minus_NDv_, model().V.c);
    disturbance_widths_ = half_widths(model().W, TBw_) + half_widths(model().V, minus_NDv_);
    least_width_ = disturbance_widths_.size() ? disturbance_widths_.minCoeff() : 0;
    const Vector f = model().linear.actuator_center();
    input_norms_ = {row_norm(TB_ * f.asDiagonal()), row_norm(used_.D * f.asDiagonal())};
    noise_generators_ = linalg::product(used_.Dv, model().V.G);
    C_transposed_ = used_.C.transpose();
    TA_transposed_ = TA_.transpose();
    const Index p = used_.outputs();
    minus_LDv_.resize(n, used_.Dv.cols());
    map_.resize(n, n);
    CP_.resize(p, n);
    S_.resize(p, p);
    cross_.resize(p, n);
    shift_.resize(n);
    output_.resize(p);
    part_.resize(n);
  }

  LineForm initial_set() const override { return X0_; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample&) override {
    unit_ = 0;  // no gain of an earlier run is kept
    return X_ = X0 ? *X0 : backend().import(X0_);
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    const Enclosure predicted = timed(Phase::predict, [&] {
      const Matrix spread_before = output_spread(before, true);
      find_gain(spread_before);
      boost::container::small_vector<Term, 8> terms;  // without memory of its own
      terms.push_back({TBw_, W_});
      terms.push_back({minus_LDv_, V_});
      terms.push_back({minus_NDv_, V_});
      Matrix inputs_before, inputs_now, outputs_before, outputs_now;
      if (effectiveness_.has_input_ranges()) {
        inputs_before = effectiveness_.input_spread(TB_ - linalg::product(L_, used_.D), before.u);
        inputs_now = effectiveness_.input_spread(minus_ND_, now.u);
        terms.push_back({inputs_before, effectiveness_.input_factors()});
        terms.push_back({inputs_now, effectiveness_.input_factors()});
      }
      if (effectiveness_.has_output_ranges()) {
        outputs_before = linalg::product(L_, spread_before);
        outputs_now = linalg::product(N_, output_spread(now, false));
        terms.push_back({outputs_before, effectiveness_.output_factors()});
        terms.push_back({outputs_now, effectiveness_.output_factors()});
      }
      const Enclosure open = effectiveness_.has_open_states() ? effectiveness_.open_states(X_, before.u) : Enclosure{};
      if (effectiveness_.has_open_states()) terms.push_back({T_, open});
      effectiveness_.input(TB_, before.u, shift_);
      add_output(L_, before);
      add_output(N_, now);
      const std::optional<RoundingRoom> room = room_of(before, now);
      if (room && room->is_needed()) terms.push_back(room->term());
      return backend().predict(X_, {map_, shift_, {terms.data(), terms.size()}});
    });
    return X_ = timed(Phase::reduce, [&] { return backend().reduce(predicted, budget_); });
  }

  void do_replace(const Enclosure& X) override { X_ = X; }

  /// What ranges of sensors add to y; X_ holds the state of that sample, or not.
  Matrix output_spread(const Sample& sample, bool state_is_known) const {
    if (!effectiveness_.has_output_ranges()) return Matrix::Zero(used_.outputs(), 0);
    std::optional<Box> reach;
    if (state_is_known) {
      reach = backend().affine_map(X_, model().linear.C, Vector::Zero(used_.outputs()))->interval_hull();
    }
    return is_used_.asDiagonal() * effectiveness_.output_spread(effectiveness_.output_bound(sample, reach ? &*reach : nullptr));
  }

  /// shift += M (y - D u), of the outputs that are used.
  void add_output(const Matrix& M, const Sample& sample) {
    effectiveness_.input(used_.D, sample.u, output_);
    output_ = is_used_.cwiseProduct(sample.y) - output_;
    linalg::product(M, output_, part_);
    shift_ += part_;
  }

  /// For what has been added up in shift_.
  std::optional<RoundingRoom> room_of(const Sample& before, const Sample& now) const {
    const double u = std::max(largest(before.u), largest(now.u));
    const double y = std::max(largest(before.y), largest(now.y)) + input_norms_[1] * u;
    const double centers = largest(disturbance_) + row_norm(minus_LDv_) * largest(model().V.c);
    const double most = input_norms_[0] * u + (row_norm(L_) + row_norm(N_)) * y + centers;
    if (!RoundingRoom::may_be_needed(most, least_width_)) return std::nullopt;
    const auto seen = [&](const Sample& sample) {
      return Vector(sample.y.cwiseAbs() + effectiveness_.input_terms(used_.D, sample.u));
    };
    const Vector center = disturbance_ + linalg::product(minus_LDv_, model().V.c);
    const Vector terms = effectiveness_.input_terms(TB_, before.u) + linalg::product(L_.cwiseAbs(), seen(before)) +
                         linalg::product(N_.cwiseAbs(), seen(now)) + center.cwiseAbs();
    const Vector widths = disturbance_widths_ + half_widths(model().V, minus_LDv_);
    return std::optional<RoundingRoom>(std::in_place, backend(), shift_ + center, terms, widths);
  }

  /// L minimises the F-radius of the next estimate, as far as the last measurement decides it.
  void find_gain(const Matrix& spread) {
    const LineForm X = X_->line_form();
    // squares of sets that shrink to a point underflow: L does not depend on the unit
    const double largest = std::max({largest_entry(noise_generators_), largest_entry(X.G), largest_entry(spread)});
    const double unit = largest < std::numeric_limits<double>::min() ? 0.0 : std::ldexp(1.0, -std::ilogb(largest));
    scaled_ = X.G * unit;
    linalg::gram(scaled_, P_);
    if (unit > 0 && unit == unit_ && spread.size() == 0 && is_steady()) return;
    unit_ = 0;  // until all that follows from P is there
    solved_P_ = P_;
    L_.setZero(TA_.rows(), used_.outputs());
    if (unit > 0) solve_for_gain(spread, unit);
    linalg::product(L_, used_.Dv, minus_LDv_);
    minus_LDv_ = -minus_LDv_;
    linalg::product(L_, used_.C, map_);
    map_ = TA_ - map_;
    unit_ = unit;
  }

  /// Any gain makes an enclosure: the last one is kept where P is the same to nearly all digits.
  bool is_steady() const {
    for (Index j = 0; j < P_.cols(); ++j) {
      for (Index i = 0; i <= j; ++i) {
        const double size = std::sqrt(solved_P_(i, i) * solved_P_(j, j));  // the units of states do not matter
        if (!(std::abs(P_(i, j) - solved_P_(i, j)) <= steady * size)) return false;
      }
    }
    return true;
  }

  void solve_for_gain(const Matrix& spread, double unit) {
    linalg::product(used_.C, P_, CP_);
    linalg::product(CP_, C_transposed_, S_);
    scaled_ = noise_generators_ * unit;
    linalg::gram(scaled_, noise_gram_);
    S_ += noise_gram_;
    if (spread.size() > 0) S_ += linalg::gram(spread * unit);
    linalg::product(CP_, TA_transposed_, cross_);  // C P (T A)ᵀ
    if (const auto solved = linalg::solve_spd(S_, cross_)) {
      L_ = solved->transpose();
    } else {
      L_ = linalg::transposed_product(cross_, linalg::pseudo_inverse(S_));
    }
  }

  static double largest_entry(const Matrix& M) { return M.size() == 0 ? 0.0 : M.cwiseAbs().maxCoeff(); }

  Budget budget_;
  LineForm X0_;
  Enclosure W_, V_, X_;
  Effectiveness effectiveness_;
  LinearModel used_;  ///< weighted by the sensors' effectiveness
  Vector is_used_;    ///< per output: 1 or 0
  Matrix T_, N_, TA_, TB_, TBw_, minus_ND_, minus_NDv_;
  Matrix noise_generators_;  ///< Dv Gv
  Matrix C_transposed_, TA_transposed_;
  Matrix L_, minus_LDv_, map_;  ///< the last gain, -L Dv, T A - L C
  Matrix solved_P_;             ///< that L_ was computed from
  double unit_ = 0;             ///< of solved_P_; 0: none
  // Kept from step to step, so that no step takes memory for them.
  Matrix scaled_, P_, CP_, S_, cross_, noise_gram_;
  Vector disturbance_, disturbance_widths_;  ///< center and half widths of T Bw W ⊕ (-N Dv V)
  double least_width_ = 0;
  std::array<double, 2> input_norms_{};  ///< of T B and D
  Vector shift_, output_, part_;
};

bool by_singular_values(const SetBackend& backend) { return backend.info().intersections; }

std::vector<Diagnostic> check(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems = check_common(context, params);
  const LinearModel& m = context.model.linear;
  const BackendInfo& info = context.backend->info();
  const Transformed t(m);
  for (Index i = 0; i < t.sigma.size(); ++i) {
    const double share = t.sigma[0] > 0 ? t.sigma[i] / t.sigma[0] : 0;
    if (share > 1e-13 && share < 1e-7) {
      problems.push_back({"",
                          "E is nearly singular (its singular values differ by a factor of " + std::to_string(1 / share) +
                              "), so that it is not clear which of its rows are static",
                          "set entries of E that stand for zero to zero, or choose other units of the states"});
      break;
    }
  }
  if (by_singular_values(*context.backend)) {
    if (params.has("admissible_set")) {
      check_set(context, params.set_form("admissible_set"), "/admissible_set", problems);
    } else if (!info.unbounded && t.static_rows() > 0) {
      problems.push_back({"/admissible_set",
                          "is missing: the backend \"" + info.name +
                              "\" holds bounded sets only, so the part of the state that E does not determine needs a bound",
                          "give a set that contains the state at all times, or use \"line_zonotope\""});
    }
    return problems;
  }
  for (const char* name : {"admissible_set"}) {
    if (params.has(name))
      problems.push_back({std::string("/") + name, "has no use with the backend \"" + info.name + "\"", "leave it out"});
  }
  if (params.flag("static_at_start")) {
    problems.push_back(
        {"/static_at_start", "needs exact intersections, which the backend \"" + info.name + "\" does not have", "leave it out"});
  }
  if (has_spread(m.C_radius)) {
    problems.push_back(
        {"/type",
         "takes an interval matrix C with exact intersections only, which the backend \"" + info.name + "\" does not have",
         "use \"constrained_zonotope\" or \"line_zonotope\", or give an exact C"});
  }
  if (linalg::rank(stacked_E_C(with_bounded_outputs(m)), rank_tolerance) < m.states()) {
    problems.push_back({"",
                        std::string("[E; C] does not have full column rank") +
                            (m.sensor.dim() ? " without the outputs whose sensors can fail altogether" : "") +
                            ", so that no T, N with T E + N C = I exist",
                        "measure more, or use \"line_zonotope\""});
  }
  return problems;
}

}  // namespace

void register_descriptor(Registrar& registrar) {
  ParamSchema schema = common_parameters();
  schema.set("admissible_set",
             "set that holds the state at all times; needed by bounded representations with exact intersections");
  schema.flag("static_at_start", "let the static rows of k = 0 cut the initial set", false);
  registrar.observer({{"descriptor", "descriptor systems with singular E, any backend", "Rego2025; Rego2020b; Wang2018a", schema},
                      check,
                      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
                        if (by_singular_values(*context.backend)) return std::make_unique<SingularValueObserver>(context, params);
                        return std::make_unique<PseudoInverseObserver>(context, params);
                      },
                      true,
                      true});
}

}  // namespace cordon::estimators
