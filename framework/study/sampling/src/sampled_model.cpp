// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/sampling/sampled_model.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/rounding.hpp"
#include "study/sampling/matrix_exponential.hpp"

namespace cordon::sampling {

namespace {

constexpr std::size_t powers = 13;  // e^{A h 2⁻ʲ}, as far as pieces are divided
constexpr std::size_t max_pieces = 64;
constexpr double small_share = 0.02;  // of the whole, for what is not reached
constexpr double nothing = 1e-280;    // what decays to less is 0
constexpr double longest = 1e12;      // ‖A‖ h

LongMatrix to_long(const Matrix& A) { return A.cast<Long>(); }

/// The smallest double that is found at or above.
double above(const Long& x) {
  const double near = x.convert_to<double>();
  return Long(near) >= x ? near : rounding::up(near);
}

Matrix above(const LongMatrix& X) {
  Matrix result(X.rows(), X.cols());
  for (Index i = 0; i < X.size(); ++i) result.data()[i] = above(X.data()[i]);
  return result;
}

/// Doubles, with what lies between them and the exact matrix; `more`: an uncertainty beside.
IntervalMatrix rounded(const Enclosed& X, const LongMatrix& more = {}) {
  Matrix center(X.value.rows(), X.value.cols()), radius = center;
  for (Index i = 0; i < center.size(); ++i) {
    center.data()[i] = X.value.data()[i].convert_to<double>();
    if (!(std::abs(center.data()[i]) < infinity))
      throw Error(Errc::invalid, "e^(A h), or its integral, is too large for a double");
    Long off = abs(X.value.data()[i] - center.data()[i]) + X.error.data()[i];
    if (more.size() > 0) off += more.data()[i];
    radius.data()[i] = rounding::up(above(off));
    if (!(radius.data()[i] < infinity))
      throw Error(Errc::invalid, "radii of e^(A h), or its integral, are too large for a double");
  }
  return {center, radius};
}

/// The centre, which has to be a double next to the exact matrix.
Matrix nearest(const IntervalMatrix& X) {
  const double size = X.center.size() == 0 ? 0 : X.center.cwiseAbs().maxCoeff();
  for (Index i = 0; i < X.center.size(); ++i) {
    const double x = std::abs(X.center.data()[i]);
    if (X.radius.data()[i] > std::max({2 * (rounding::up(x) - x), 1e-30 * size, nothing}))
      throw Error(Errc::invalid, "numbers of e^(A h) differ too much in size to be known");
  }
  return X.center;
}

Enclosed product(const Enclosed& X, const Matrix& B) {
  return sampling::product(X, exactly(to_long(B)));
}

LongMatrix row_sums(const LongMatrix& X) { return X.cwiseAbs().rowwise().sum(); }

/// |X| from above, with rows added up.
LongMatrix row_sums(const Enclosed& X) { return row_sums(magnitude(X)); }

/// |w| for w ∈ W, from above: constraints are not looked at.
LongMatrix largest_values(const LineForm& W) {
  return to_long(W.c).cwiseAbs() + row_sums(to_long(W.G));
}

/// X, and `more` on either side of every coordinate.
LineForm with_box(LineForm X, const Vector& more) {
  const Index n = X.dim(), before = X.generators();
  Index added = 0;
  X.G.conservativeResize(n, before + n);
  for (Index i = 0; i < n; ++i) {
    if (more[i] == 0) continue;
    X.G.col(before + added).setZero();
    X.G(i, before + added++) = more[i];
  }
  X.G.conservativeResize(n, before + added);
  const Index rows = X.A.rows(), columns = X.A.cols();
  X.A.conservativeResize(rows, columns + added);
  X.A.rightCols(added).setZero();
  return X;
}

/// A part of [0, h]: h 2^-level long, with e^{A t} B G at its beginning and its end.
struct Piece {
  std::size_t level = 0;
  Enclosed begin, end;
  LongMatrix extent;     ///< a column: half the width of its part of the set
  LongMatrix curvature;  ///< a column: the box of what is not linear
  LongMatrix bend;       ///< a column: how far its part may be above that of what is linear
};

/// The largest x_i / whole_i.
double largest_share(const LongMatrix& x, const LongMatrix& whole) {
  double largest = 0;
  for (Index i = 0; i < x.rows(); ++i) {
    if (x(i, 0) == 0) continue;
    const double share =
        whole(i, 0) == 0 ? infinity : Long(x(i, 0) / whole(i, 0)).convert_to<double>();
    if (!(share <= largest)) largest = std::isnan(share) ? infinity : share;
  }
  return largest;
}

}  // namespace

struct Sampling::Enclosures {
  Long h;
  Enclosed A;
  Exponential center;  ///< of the matrices' centres
  /// Of interval models, from above: ∫ e^{(Â+R) s} ds, e^{(Â+R) h} - e^{Â h}, and the same of their
  /// integrals.
  LongMatrix integral_of_majorant, spread, spread_of_integral;
  /// Of any signal, from above: |e^{A s}| for 0 ≤ s ≤ h 2⁻ʲ.
  std::vector<LongMatrix> growth;

  Long length(std::size_t level) const { return ldexp(h, -static_cast<int>(level)); }
  Piece piece(std::size_t level, Enclosed begin, Enclosed end) const;
  /// Of [0, h], so fine that neither curvatures matter nor, where |e^{A s} B w| changes its sign
  /// within a piece in some direction, what a trapezoid is above its integral. `fine`: it was
  /// possible.
  std::vector<Piece> pieces(const Matrix& B, const Matrix& G, bool& fine) const;
  // What a box has to add is added to the column `more`.
  LineForm held_disturbances(const Matrix& B, const LineForm& W, LongMatrix& more) const;
  LineForm any_disturbances(const Matrix& B, const LineForm& W, LongMatrix& more) const;
};

/// On a piece of length τ, e^{A s} V differs from what is linear between its ends by s (τ - s)/2
/// times its second derivative A² e^{A s} V, and ∫ s (τ - s)/2 ds = τ³/12.
Piece Sampling::Enclosures::piece(std::size_t level, Enclosed begin, Enclosed end) const {
  const Long t = length(level);
  const Enclosed second = product(A, product(A, begin));
  LongMatrix curvature = growth[level] * row_sums(second) * (t * t * t / 12);
  curvature *= Long(1) + 1e-30;
  LongMatrix extent = (row_sums(begin.value) + row_sums(end.value)) * (t / 2),
             bend = row_sums(LongMatrix(end.value - begin.value)) * (t / 8);
  return {level,          std::move(begin), std::move(end), std::move(extent), std::move(curvature),
          std::move(bend)};
}

std::vector<Piece> Sampling::Enclosures::pieces(const Matrix& B, const Matrix& G,
                                                bool& fine) const {
  const Enclosed first = product(exactly(to_long(B)), G);
  std::vector<Piece> all{piece(0, first, product(center.power[0], first))};
  fine = false;
  for (;;) {
    LongMatrix extent = LongMatrix::Zero(B.rows(), 1), curvature = extent;
    for (const Piece& one : all) extent += one.extent, curvature += one.curvature;
    const auto more = [&](const Piece& x, const Piece& y) {
      return largest_share(x.curvature + x.bend, extent) <
             largest_share(y.curvature + y.bend, extent);
    };
    const auto worst = std::max_element(all.begin(), all.end(), more);
    const std::size_t level = worst->level + 1;
    fine = largest_share(curvature, extent) <= small_share &&
           largest_share(worst->bend, extent) <= small_share;
    if (fine || level == powers || all.size() == max_pieces) break;
    Enclosed middle = product(center.power[level], worst->begin);
    Piece left = piece(level, worst->begin, middle),
          right = piece(level, std::move(middle), worst->end);
    *worst = std::move(left);
    all.insert(worst + 1, std::move(right));
  }
  return all;
}

Sampling::Sampling(const LinearModel& continuous, double h, DisturbanceSignal disturbance,
                   Matrices matrices)
    : disturbance_(disturbance),
      uncertain_(continuous.is_uncertain() || matrices == Matrices::enclosed) {
  const Matrix& A = continuous.A;
  const Matrix R =
      continuous.A_radius.size() ? continuous.A_radius : Matrix(Matrix::Zero(A.rows(), A.cols()));
  if (!((A.cwiseAbs() + R).rowwise().sum().maxCoeff() * h <= longest))
    throw Error(Errc::invalid, "A h is too large");
  auto all = std::make_unique<Enclosures>();
  all->h = h;
  all->A = exactly(to_long(A));
  all->center = exponential(all->A.value, h, powers);
  if (uncertain_) {
    const Exponential inner = exponential(metzler_majorant(A, {}), h, 1),
                      outer = exponential(metzler_majorant(A, R), h, 1);
    const auto spread = [](const Enclosed& X, const Enclosed& Y) {
      return LongMatrix((X.value - Y.value).cwiseAbs() +
                        Matrix(2 * (X.error + Y.error)).cast<Long>());
    };
    all->spread = spread(outer.power[0], inner.power[0]);
    all->spread_of_integral = spread(outer.integral, inner.integral);
    all->integral_of_majorant = magnitude(outer.integral);
  }
  if (disturbance == DisturbanceSignal::any) {
    const LongMatrix growing = metzler_majorant(A, {}).cwiseMax(Long(0));
    for (const Enclosed& power : exponential(growing, h, powers).power)
      all->growth.push_back(magnitude(power));
  }
  enclosures_ = std::move(all);
  transition();
}

Sampling::~Sampling() = default;

IntervalMatrix Sampling::transition() const {
  return rounded(enclosures_->center.power[0], enclosures_->spread);
}

/// |∫ e^{(A+Δ) s} ds (B+δ) - ∫ e^{A s} ds B| is at most the spread of the integral times |B|, and
/// the integral of the majorant times the radius of B.
IntervalMatrix Sampling::integral(const Matrix& B, const Matrix& radius) const {
  const Enclosed exact = product(enclosures_->center.integral, B);
  if (!uncertain_) return rounded(exact);
  LongMatrix more = enclosures_->spread_of_integral * to_long(B).cwiseAbs();
  if (radius.size() > 0) more += enclosures_->integral_of_majorant * to_long(radius);
  return rounded(exact, more * (Long(1) + 1e-30));
}

Matrix Sampling::nearest_integral(const Matrix& B) const { return nearest(integral(B)); }

LineForm Sampling::disturbances(const Matrix& B, const LineForm& W) const {
  if (W.lines() > 0) throw Error(Errc::invalid, "W must be bounded");
  const Enclosures& all = *enclosures_;
  LongMatrix more = LongMatrix::Zero(B.rows(), 1);
  if (uncertain_)
    more = all.spread_of_integral * (to_long(B).cwiseAbs() * largest_values(W)) * (Long(1) + 1e-30);
  LineForm X = disturbance_ == DisturbanceSignal::held ? all.held_disturbances(B, W, more)
                                                       : all.any_disturbances(B, W, more);
  const Vector box = above(more * (Long(1) + 1e-30)).col(0);
  if (!box.allFinite())
    throw Error(Errc::invalid, "what w does to the state is not bounded by a double");
  return with_box(std::move(X), box);
}

bool Sampling::is_fine(const Matrix& B, const LineForm& W) const {
  bool fine = true;
  if (disturbance_ == DisturbanceSignal::any) enclosures_->pieces(B, W.G, fine);
  return fine;
}

LineForm Sampling::Enclosures::held_disturbances(const Matrix& B, const LineForm& W,
                                                 LongMatrix& more) const {
  const Enclosed map = product(center.integral, B);
  const IntervalMatrix middle = rounded(product(map, W.c)), generators = rounded(product(map, W.G));
  more += row_sums(to_long(middle.radius)) + row_sums(to_long(generators.radius));
  LineForm X = W;
  X.c = middle.center.col(0);
  X.G = generators.center;
  X.M = Matrix(B.rows(), 0);
  return X;
}

LineForm Sampling::Enclosures::any_disturbances(const Matrix& B, const LineForm& W,
                                                LongMatrix& more) const {
  const IntervalMatrix middle = rounded(product(product(center.integral, B), W.c));
  more += row_sums(to_long(middle.radius));
  const Index n = B.rows(), g = W.generators(), m = W.constraints();
  bool fine = false;
  const std::vector<Piece> all = pieces(B, W.G, fine);
  const auto ends = static_cast<Index>(all.size()) + 1;
  LineForm X{Matrix(n, 0),
             Matrix(n, ends * g),
             middle.center.col(0),
             Matrix(ends * m, 0),
             Matrix::Zero(ends * m, ends * g),
             Vector(ends * m)};
  for (Index i = 0; i < ends; ++i) {
    const Piece* const before = i > 0 ? &all[as_size(i - 1)] : nullptr;
    const Piece* const after = i + 1 < ends ? &all[as_size(i)] : nullptr;
    const Long weight =
        ((before ? length(before->level) : Long(0)) + (after ? length(after->level) : Long(0))) / 2;
    const Enclosed& at = after ? after->begin : before->end;
    const IntervalMatrix part = rounded(scaled(at, weight));
    more += row_sums(to_long(part.radius));
    X.G.middleCols(i * g, g) = part.center;
    X.A.block(i * m, i * g, m, g) = W.A;
    X.b.segment(i * m, m) = W.b;
  }
  for (const Piece& one : all) more += one.curvature;
  return X;
}

Model sampled(const Model& continuous, const Sampling& sampling) {
  Model model = continuous;
  const LinearModel& from = continuous.linear;
  LinearModel& to = model.linear;
  const IntervalMatrix A = sampling.transition(), B = sampling.integral(from.B, from.B_radius);
  if (sampling.encloses_matrices()) {
    to.A = A.center, to.A_radius = A.radius;
    to.B = B.center, to.B_radius = B.radius;
  } else {
    to.A = nearest(A), to.B = nearest(B);
  }
  if (from.faults() > 0) to.F = sampling.nearest_integral(from.F);
  if (from.disturbances() == 0) return model;
  if (sampling.keeps_matrices()) {
    to.Bw = sampling.nearest_integral(from.Bw);
  } else {
    model.W = sampling.disturbances(from.Bw, continuous.W);
    to.Bw = Matrix::Identity(from.states(), from.states());
  }
  return model;
}

}  // namespace cordon::sampling
