// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/forbidden_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "designers/facets/growing_hull.hpp"

namespace cordon::designers {

using linalg::product;
using linalg::transposed_product;

namespace {

constexpr double rank_tolerance =
    tube_row_noise;  ///< of the terms: what inputs move less cannot be told from rounding
constexpr double flat_tolerance = 1e-9;       ///< of the terms
constexpr double flat_distance = 1e-6;        ///< of the terms, see forbidden_set
constexpr double point_accuracy = 1e-13;      ///< of the terms
constexpr double residual_tolerance = 1e-11;  ///< of the terms
/// Of the terms: by how much rows are moved to see whether Q has a point all the same.
constexpr double most_room = 0.5, least_room = 1e-13;

/// What is small beside its terms is computed with more digits.
using Long = long double;
using LongMatrix = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;

/// The support function of Q by certified linear programs.
class Support {
 public:
  struct Answer {
    Vector y;                 ///< on the scaled rows
    double level = 0;         ///< h_Q(d) ≤ level
    std::optional<Vector> x;  ///< a point near Q that attains it: see `loss_along`
  };

  Support(const ScaledPair& pair, Matrix R, Matrix L, Vector centre)
      : pair_(pair),
        R_(std::move(R)),
        L_(std::move(L)),
        c_(std::move(centre)),
        seen_(transposed_product(R_, pair_.G)),
        rows_(transposed_product(L_, pair_.G)),
        right_(-transposed_product(L_, c_) / pair_.factor),
        program_(rows_, right_, {product(L_.cwiseAbs().transpose(), pair_.terms), {}}) {}

  /// Is Q empty?
  cordon::Answer empty() {
    ++programs;
    return program_.is_empty();
  }
  /// Proven: has Q a point however the rows' right-hand sides are moved by up to `effect`, and by
  /// rounding?
  bool is_met_within(const Vector& effect) {
    ++programs;
    const Matrix shares = L_.cwiseAbs().transpose();
    const Vector error = effect + tube_row_noise * pair_.terms;
    return BoxedProgram(rows_, right_, {product(shares, pair_.terms), product(shares, error)})
               .is_empty() == cordon::Answer::no;
  }
  /// Finds how far the rows' right-hand sides may be moved, by their terms, before Q is empty.
  /// False: not even by up to `effect`, and by rounding. `inputs` (N Z) tell what they do there;
  /// the numbers of the rows have been rounded before.
  bool find_room(const Vector& effect, const Matrix& inputs) {
    const Matrix shares = L_.cwiseAbs().transpose();
    const Index operations = 2 * (pair_.G.rows() + pair_.G.cols() + inputs.cols()) + 8;
    const double rounding =
        static_cast<double>(operations) * static_cast<double>(std::numeric_limits<Long>::epsilon());
    const LongMatrix by_inputs = L_.cast<Long>().transpose() * inputs.cast<Long>();
    moved_ = (1 + tube_row_noise) * by_inputs.cwiseAbs().rowwise().sum().cast<double>() +
             (tolerances::product_noise + rounding) * product(shares, pair_.terms);
    room_ = Vector::Zero(moved_.size());
    for (double share = most_room; share > least_room; share /= 2) {
      const Vector room = share * pair_.terms;
      if (!is_met_within(effect + room)) continue;
      room_ = product(shares, room);
      return true;
    }
    return is_met_within(effect);
  }
  /// How far the support of Q along d may lie below that of the points so far. Each satisfies rows
  /// that are moved by r, its residual and what is unknown of the rows; Q has a point z where they
  /// are moved by -r (1 - λ) / λ, as far as there is room; so that (1 - λ) x + λ z lies in Q.
  double loss_along(const Vector& d, double level) const {
    const Vector h = product(R_, d);
    const double least =  // of hᵀz
        h.dot(c_) - pair_.factor * transposed_product(pair_.G, h).cwiseAbs().sum();
    return lambda_ * (std::max(0.0, level - least) + tube_row_noise * terms_along(d));
  }
  double terms_along(const Vector& d) const {
    return pair_.terms.dot(Vector(product(R_, d)).cwiseAbs());
  }

  Answer along(const Vector& d) {
    ++programs;
    const BoxedProgram::Bound bound = program_.maximum(transposed_product(seen_, d));
    Answer answer;
    answer.y = product(R_, d) - product(L_, bound.y);
    answer.level =
        pair_.factor * transposed_product(pair_.G, answer.y).cwiseAbs().sum() + answer.y.dot(c_);
    if (bound.solved && bound.xi) answer.x = point(*bound.xi);
    return answer;
  }

  std::int64_t programs = 0;

 private:
  /// RᵀGξ + Rᵀc for a basic solution that satisfies the rows.
  std::optional<Vector> point(Vector xi) {
    const Vector inside = xi.cwiseMax(-1.0).cwiseMin(1.0);
    if (!inside.allFinite()) return std::nullopt;
    const Vector residual = (product(rows_, inside) - right_).cwiseAbs();
    const Vector allowed = residual_tolerance * product(L_.cwiseAbs().transpose(), pair_.terms);
    if (residual.size() && (residual - allowed).maxCoeff() > 0) return std::nullopt;
    const LongMatrix reached = pair_.G.cast<Long>() * inside.cast<Long>() +
                               c_.cast<Long>() / static_cast<Long>(pair_.factor);
    const LongMatrix exactly = L_.cast<Long>().transpose() * reached;
    for (Index i = 0; i < residual.size(); ++i) {
      const double moved =
          (1 + tube_row_noise) * std::abs(static_cast<double>(exactly(i, 0))) + moved_[i];
      if (moved > 0) lambda_ = std::max(lambda_, room_[i] > 0 ? moved / (moved + room_[i]) : 1.0);
    }
    return Vector(pair_.factor * product(seen_, inside) + transposed_product(R_, c_));
  }

  const ScaledPair& pair_;
  Matrix R_, L_;
  Vector c_;
  Matrix seen_, rows_;
  Vector right_;
  BoxedProgram program_;
  Vector room_, moved_;  ///< per row
  double lambda_ = 0;    ///< the largest of all points
};

/// Points of Q in general position, and the directions in which it has no width.
struct Span {
  Matrix points;  ///< r×(q+1)
  Matrix flat;    ///< r×(r-q), orthonormal
};

class Builder {
 public:
  Builder(const ScaledPair& pair, Support& support, Index r, Index max_facets, const Watch& watch)
      : pair_(pair), support_(support), r_(r), max_facets_(max_facets), watch_(watch) {}

  ForbiddenSet build() {
    const std::optional<Span> span = this->span();
    if (!span) return failed();
    set_.flat = span->flat.cols() > 0;
    if (const Index q = r_ - span->flat.cols(); q > 0 && !grow(*span)) return failed();
    set_.kind = ForbiddenSet::Kind::facets;
    return std::move(set_);
  }

 private:
  ForbiddenSet failed() {
    if (reason_.empty()) reason_ = "a linear program could not be solved";
    ForbiddenSet set;
    set.reason = reason_;
    return set;
  }

  bool stopped() {
    reason_ = "the search was stopped";
    return false;
  }

  std::optional<Span> span() {
    Span span{Matrix(r_, 0), Matrix(r_, 0)};
    const auto append = [](Matrix& columns, const Vector& column) {
      columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
      columns.col(columns.cols() - 1) = column;
    };
    while (std::max<Index>(0, span.points.cols() - 1) + span.flat.cols() < r_) {
      if (watch_.over()) {
        stopped();
        return std::nullopt;
      }
      Matrix known = span.flat;
      for (Index p = 1; p < span.points.cols(); ++p)
        append(known, span.points.col(p) - span.points.col(0));
      const Matrix rest =
          known.cols() ? linalg::null_space(known.transpose()) : Matrix::Identity(r_, r_);
      if (rest.cols() == 0) return std::nullopt;
      const Vector d = rest.col(0);
      const Support::Answer above = support_.along(d), below = support_.along(-d);
      if (!above.x || !below.x) return std::nullopt;
      if (above.level + below.level <= flat_tolerance * support_.terms_along(d)) {
        if (span.points.cols() == 0) append(span.points, *above.x);
        const double width = std::max(0.0, above.level + below.level);
        set_.facets.push_back(facet_of(pair_, above.y, flat_distance, width));
        set_.facets.push_back(facet_of(pair_, below.y, flat_distance, width));
        append(span.flat, d);
        continue;
      }
      if (span.points.cols() == 0) {
        append(span.points, *above.x);
        append(span.points, *below.x);
        continue;
      }
      const double middle = d.dot(span.points.col(0));
      append(span.points,
             d.dot(*above.x) - middle > middle - d.dot(*below.x) ? *above.x : *below.x);
    }
    return span;
  }

  /// Facets of the hull in the directions that are not flat.
  bool grow(const Span& span) {
    const Matrix basis =
        span.flat.cols() ? linalg::null_space(span.flat.transpose()) : Matrix::Identity(r_, r_);
    const Matrix down = basis.transpose();
    double terms = 0;
    for (Index i = 0; i < r_; ++i)
      terms = std::max(terms, support_.terms_along(Vector::Unit(r_, i)));
    GrowingHull hull(product(down, span.points), point_accuracy * terms);
    if (hull.facets().empty()) return false;
    for (;;) {
      auto& facets = hull.facets();
      if (static_cast<Index>(facets.size()) > max_facets_) {
        reason_ = "the set of inputs that do not separate them has more than " +
                  std::to_string(max_facets_) + " facets";
        return false;
      }
      const auto open = std::find_if(facets.begin(), facets.end(),
                                     [](const GrowingHull::Facet& f) { return !f.settled; });
      if (open == facets.end()) break;
      if (watch_.over()) return stopped();
      const Support::Answer found = support_.along(product(basis, open->h.normalized()));
      if (!found.x || found.level < hull.level(*open) - residual_tolerance * terms)
        return false;  // a point outside Q
      const Vector x = product(down, *found.x);
      if (hull.beyond(*open, x) > hull.tolerance(*open)) {
        if (!hull.add(x, [this] { return watch_.over(); })) return stopped();
      } else {
        open->settled = true;
        open->proof = found.y;
        open->proven = found.level;
      }
    }
    if (!hull.is_closed()) {
      reason_ = "the set of inputs that do not separate them is so thin that facets may be missing";
      return false;
    }
    for (const GrowingHull::Facet& facet : hull.facets()) {
      const double loss = support_.loss_along(product(basis, facet.h.normalized()), facet.proven);
      set_.facets.push_back(
          facet_of(pair_, facet.proof, 0, std::max(0.0, facet.proven - hull.level(facet)) + loss));
    }
    return true;
  }

  const ScaledPair& pair_;
  Support& support_;
  Index r_, max_facets_;
  const Watch& watch_;
  ForbiddenSet set_;
  std::string reason_;
};

ForbiddenSet of_kind(ForbiddenSet::Kind kind, std::string reason = {}) {
  ForbiddenSet set;
  set.kind = kind;
  set.reason = std::move(reason);
  return set;
}

}  // namespace

ForbiddenSet forbidden_set(const PairProgram& pair, const InputSequences& U, double epsilon,
                           Index max_facets, const Watch& watch) {
  if (pair.rows() == 0) {
    return pair.vanished == 0
               ? of_kind(ForbiddenSet::Kind::never,
                         "no output tells one from the other, whatever the inputs are")
               : of_kind(ForbiddenSet::Kind::unknown,
                         "they differ by less than rounding allows to tell");
  }
  const ScaledPair scaled(pair, U, epsilon);
  // ζ = p + Zη: η is free but for the box.
  const bool equations = U.b.size() > 0;
  const Matrix Z = equations ? linalg::null_space(U.A) : Matrix::Identity(U.G.cols(), U.G.cols());
  const Vector p = equations ? product(linalg::pseudo_inverse(U.A), U.b) : Vector::Zero(U.G.cols());
  const linalg::Svd parts = linalg::svd(product(scaled.N, Z));
  const Index r = (parts.sigma.array() > rank_tolerance).count(), m = pair.rows();
  Support support(scaled, parts.U.leftCols(r), parts.U.rightCols(m - r),
                  scaled.c - product(scaled.N, p));

  const Answer empty = support.empty();
  ForbiddenSet set;
  if (empty == Answer::yes) {
    set = of_kind(ForbiddenSet::Kind::separated);
  } else if (r > 0) {
    const Matrix seen = parts.U.leftCols(r) * parts.sigma.head(r).asDiagonal();
    const Matrix unseen = product(scaled.N, Z) - product(seen, parts.V.leftCols(r).transpose());
    set = pair.vanished == 0 &&
                  support.find_room(unseen.cwiseAbs().rowwise().sum(), product(scaled.N, Z))
              ? Builder(scaled, support, r, max_facets, watch).build()
              : of_kind(ForbiddenSet::Kind::unknown,
                        "whether outputs on which the inputs have no effect tell them apart is a "
                        "matter of rounding");
  } else if (pair.vanished == 0 &&
             support.is_met_within(product(scaled.N, Z).cwiseAbs().rowwise().sum())) {
    set = of_kind(ForbiddenSet::Kind::never,
                  "the inputs that may be chosen have no effect on what tells one from the other");
  } else if (empty == Answer::no) {
    set = of_kind(ForbiddenSet::Kind::unknown,
                  "what the inputs that may be chosen change is not told from rounding");
  } else {
    set = of_kind(ForbiddenSet::Kind::unknown,
                  "whether they are told apart without inputs is a matter of rounding");
  }
  set.programs = support.programs;
  return set;
}

}  // namespace cordon::designers
