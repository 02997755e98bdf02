// SPDX-License-Identifier: GPL-3.0-or-later
// From rationals back to doubles: rounded lists, and the enclosure in exchange form.
#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "solvers/polytope_representation.hpp"

namespace cordon {

namespace {

using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;

[[noreturn]] void refuse_overflow() {
  throw Error(Errc::not_finite, "polytope: a number exceeds the range of doubles");
}

double rounded(const Rational& q) {
  const double x = rational::nearest(q);
  if (!std::isfinite(x)) refuse_overflow();
  return x;
}

double rounded_up(const Rational& q) {
  const double x = rational::enclose(q).upper;
  if (!std::isfinite(x)) refuse_overflow();
  return x;
}

/// Rows of `in` from entry `first` on, those that `wanted` selects, one per column.
template <class Wanted>
Matrix columns_of(const Description& in, Wanted wanted, bool scale) {
  std::vector<RationalVector> chosen;
  for (std::size_t i = 0; i < in.rows.size(); ++i) {
    if (!wanted(in.rows[i], bool(in.linear[i]))) continue;
    chosen.emplace_back(in.rows[i]);
    if (scale) rational::scale_to_one(chosen.back());
  }
  Matrix out(in.dim, static_cast<Index>(chosen.size()));
  for (Index j = 0; j < out.cols(); ++j) {
    for (Index i = 0; i < in.dim; ++i) out(i, j) = rounded(chosen[as_size(j)][as_size(i + 1)]);
  }
  return out;
}

/// The row with a multiple of its normal in the place of that.
RationalVector with_normal(const RationalVector& row, const RationalVector& normal) {
  RationalVector out{row[0]};
  for (std::size_t i = 0; i < normal.size(); ++i) {
    if (sgn(row[i + 1]) != 0) {
      out[0] *= normal[i] / row[i + 1];
      break;
    }
  }
  out.insert(out.end(), normal.begin(), normal.end());
  return out;
}

/// Scaled so that the largest entry of the normal is about 1.
RationalVector scaled_row(const RationalVector& row) {
  RationalVector normal(row.begin() + 1, row.end());
  rational::make_primitive(normal);
  rational::scale_to_one(normal);
  return with_normal(row, normal);
}

bool is_double(const Rational& value) {
  const double near = rational::nearest(value);
  return std::isfinite(near) && rational::exact(near) == value;
}

/// The same of doubles, where a multiple of the row is made of them: beside the normal [1, 1] the
/// bound of [3, 3] x ≤ 1 is none.
RationalVector row_for_doubles(const RationalVector& row) {
  RationalVector whole = row;
  rational::make_primitive(whole);
  RationalVector normal(whole.begin() + 1, whole.end());
  rational::scale_to_one(normal);
  RationalVector out = with_normal(row, normal);
  return std::all_of(out.begin(), out.end(), is_double) ? out : scaled_row(row);
}

/// To about 15 digits; NaN where doubles have fewer.
Vector about(const RationalVector& x) {
  constexpr double smallest = 1e-280;
  Vector out(static_cast<Index>(x.size()));
  for (Index i = 0; i < out.size(); ++i) {
    const Rational& value = x[as_size(i)];
    out[i] = value.get_d();
    if (sgn(value) != 0 && std::abs(out[i]) < smallest)
      out[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

/// Points, and what doubles hold of them.
class Vertices {
 public:
  explicit Vertices(const Description& generators) : exact_(generators.rows) {
    for (const RationalVector& vertex : exact_) about_.push_back(about(vertex));
  }
  /// The largest product, exactly: of those only that rounding leaves in question (all, where a
  /// NaN leaves every one in question).
  Rational largest_product(const RationalVector& row) const {
    constexpr double relative = 1e-12;  // far above what n products of truncated doubles lose
    const Vector normal = about(row);
    std::vector<double> upper;
    double lower = -std::numeric_limits<double>::infinity();
    for (const Vector& vertex : about_) {
      const Vector terms = normal.cwiseProduct(vertex);
      const double off = relative * terms.lpNorm<1>() + std::numeric_limits<double>::min();
      upper.push_back(terms.sum() + off);
      lower = std::max(lower, terms.sum() - off);
    }
    std::optional<Rational> largest;
    for (std::size_t i = 0; i < upper.size(); ++i) {
      if (upper[i] < lower) continue;
      Rational product = rational::dot(row, exact_[i]);
      if (!largest || product > *largest) largest = std::move(product);
    }
    return *largest;
  }

 private:
  const std::vector<RationalVector>& exact_;
  std::vector<Vector> about_;
};

/// Rows of the constrained zonotope under construction, in the variables ξ of the box.
class Rows {
 public:
  Rows(const Vector& center, const Vector& radius)
      : c_(rational::exact(center)), r_(rational::exact(radius)) {}

  void add(const RationalVector& inequality, bool is_equation, const Vertices& vertices) {
    const RationalVector row = scaled_row(inequality);
    const Index n = static_cast<Index>(c_.size());
    Rational offset = row[0], error = 0, slack = 0;  // offset + aᵀGξ ∈ [0, slack] on the polytope
    Vector entries(n);
    for (Index i = 0; i < n; ++i) {
      offset += row[as_size(i + 1)] * c_[as_size(i)];
      const Rational entry = row[as_size(i + 1)] * r_[as_size(i)];
      entries[i] = rounded(entry);
      error += abs(rational::exact(entries[i]) - entry);
    }
    if (entries.isZero(0)) {  // 0 = 0, up to underflow: nothing is said
      if (sgn(error) != 0 || sgn(offset) != 0) exact_ = false;
      return;
    }
    slack = std::max(slack, vertices.largest_product(row));
    if (is_equation) {
      const double b = rounded(-offset);
      const Rational width = error + abs(rational::exact(b) + offset);
      if (sgn(width) != 0) exact_ = false;
      push(entries, b, rounded_up(width));
      return;
    }
    if (touches_box(row, offset)) return;
    double b = rounded(slack / 2 - offset);
    double width = width_of(b, offset, slack, error);
    if (sgn(error) != 0 || !reaches(b, width, offset)) {
      // a wider slack is harmless: only the end at the facet counts
      const double power = std::exp2(std::ceil(std::log2(rounded_up(slack / 2))));
      const double other = rounded(rational::exact(power) - offset);
      if (sgn(error) == 0 && std::isfinite(power) && reaches(other, power, offset)) {
        b = other, width = power;
      } else {
        exact_ = false;
      }
    }
    push(entries, b, width);
  }

  bool exact() const { return exact_; }
  Index count() const { return static_cast<Index>(b_.size()); }

  /// A and b over the factors of the box that are kept and one slack factor per row that has one;
  /// `kept` are columns.
  void fill(const std::vector<Index>& kept, LineForm& X) const {
    const Index g = static_cast<Index>(kept.size());
    const Index slacks = static_cast<Index>(
        std::count_if(width_.begin(), width_.end(), [](double w) { return w != 0; }));
    X.A = Matrix::Zero(count(), g + slacks);
    X.b = Eigen::Map<const Vector>(b_.data(), count());
    for (Index i = 0, next = g; i < count(); ++i) {
      for (Index j = 0; j < g; ++j) X.A(i, j) = entries_[as_size(i)][kept[as_size(j)]];
      if (width_[as_size(i)] != 0) X.A(i, next++) = width_[as_size(i)];
    }
  }

 private:
  /// The facet is one of the box.
  bool touches_box(const RationalVector& row, const Rational& offset) const {
    Rational reach = 0;
    for (std::size_t i = 0; i < r_.size(); ++i) reach += abs(row[i + 1]) * r_[i];
    return offset >= reach;
  }
  /// Half width of b + [-w, w] that holds Aξ = aᵀGξ + error for offset + aᵀGξ ∈ [0, slack].
  static double width_of(double b, const Rational& offset, const Rational& slack,
                         const Rational& error) {
    const Rational below = rational::exact(b) + offset + error,
                   above = slack - offset + error - rational::exact(b);
    return rounded_up(std::max(below, above));
  }
  static bool reaches(double b, double width, const Rational& offset) {
    return rational::exact(b) - rational::exact(width) == -offset;
  }
  void push(const Vector& entries, double b, double width) {
    entries_.push_back(entries);
    b_.push_back(b);
    width_.push_back(width);
  }

  RationalVector c_, r_;
  std::vector<Vector> entries_;
  std::vector<double> b_, width_;
  bool exact_ = true;
};

/// A bounded polytope: its interval hull, cut by its facets.
Polytope::Export enclose_bounded(const Description& generators, const Description& inequalities) {
  const Index n = generators.dim;
  Vector center(n), radius(n);
  std::vector<Index> kept;
  for (Index i = 0; i < n; ++i) {
    Rational lower = generators.rows[0][as_size(i + 1)], upper = lower;
    for (const RationalVector& row : generators.rows) {
      lower = std::min(lower, row[as_size(i + 1)]);
      upper = std::max(upper, row[as_size(i + 1)]);
    }
    center[i] = rounded((lower + upper) / 2);
    const Rational middle = rational::exact(center[i]);
    radius[i] = rounded_up(std::max(Rational(upper - middle), Rational(middle - lower)));
    if (radius[i] != 0) kept.push_back(i);
  }
  const Vertices vertices(generators);
  Rows rows(center, radius);
  for (std::size_t i = 0; i < inequalities.rows.size(); ++i)
    rows.add(inequalities.rows[i], inequalities.linear[i], vertices);
  LineForm X;
  X.c = center;
  rows.fill(kept, X);
  X.M.resize(n, 0);
  X.S.resize(X.b.size(), 0);
  X.G = Matrix::Zero(n, X.A.cols());
  for (Index j = 0; j < static_cast<Index>(kept.size()); ++j)
    X.G(kept[as_size(j)], j) = radius[kept[as_size(j)]];
  return {std::move(X), rows.exact() ? Tightness::exact : Tightness::outer};
}

/// Lines in echelon form; `pivots` are the coordinates that they set free.
struct Lineality {
  RationalMatrix basis;
  std::vector<Index> pivots;
};

Lineality lineality(const Description& generators) {
  std::vector<RationalVector> lines;
  for (std::size_t i = 0; i < generators.rows.size(); ++i) {
    if (sgn(generators.rows[i][0]) == 0) lines.push_back(generators.rows[i]);
  }
  Lineality out{RationalMatrix(static_cast<Index>(lines.size()), generators.dim), {}};
  for (Index i = 0; i < out.basis.rows(); ++i) {
    for (Index j = 0; j < generators.dim; ++j) out.basis(i, j) = lines[as_size(i)][as_size(j + 1)];
  }
  out.pivots = rational::reduce_rows(out.basis, generators.dim);
  return out;
}

/// {x ∈ X : pivot coordinates zero} in the other coordinates, `rest`. It is bounded, and X is its
/// sum with the lines.
struct Section {
  Description points, rows;
};

Section section_across(const Lineality& lines, const std::vector<Index>& rest,
                       const Description& generators, const Description& inequalities) {
  const Index k = static_cast<Index>(rest.size()), l = generators.dim - k;
  Section section{{k, {}, {}}, {k, {}, {}}};
  for (const RationalVector& row : generators.rows) {
    if (sgn(row[0]) == 0) continue;
    RationalVector point{row[0]};
    for (const Index i : rest) {
      Rational value = row[as_size(i + 1)];
      for (Index j = 0; j < l; ++j)
        value -= row[as_size(lines.pivots[as_size(j)] + 1)] * lines.basis(j, i);
      point.push_back(std::move(value));
    }
    section.points.add(std::move(point), false);
  }
  for (std::size_t i = 0; i < inequalities.rows.size(); ++i) {
    RationalVector row{inequalities.rows[i][0]};
    for (const Index j : rest) row.push_back(inequalities.rows[i][as_size(j + 1)]);
    section.rows.add(std::move(row), inequalities.linear[i]);
  }
  return section;
}

}  // namespace

namespace polytope {

Polytope::Export enclose(const Description& generators, const Description& inequalities) {
  const Index n = generators.dim;
  if (generators.rows.empty()) return {make_empty(n), Tightness::exact};
  for (std::size_t i = 0; i < generators.rows.size(); ++i) {
    if (sgn(generators.rows[i][0]) == 0 && !generators.linear[i]) {
      throw Error(Errc::unsupported,
                  "polytope: unbounded on one side only; the exchange form holds sets that are "
                  "unbounded along subspaces");
    }
  }
  const Lineality lines = lineality(generators);
  if (lines.basis.rows() == 0) return enclose_bounded(generators, inequalities);

  std::vector<Index> rest;
  for (Index i = 0; i < n; ++i) {
    if (!std::binary_search(lines.pivots.begin(), lines.pivots.end(), i)) rest.push_back(i);
  }
  const Index k = static_cast<Index>(rest.size()), l = n - k;
  const Section across = section_across(lines, rest, generators, inequalities);
  Polytope::Export section = enclose_bounded(across.points, across.rows);
  LineForm X = section.form;
  X.c = Vector::Zero(n);
  X.G = Matrix::Zero(n, section.form.G.cols());
  for (Index i = 0; i < k; ++i) {
    X.c[rest[as_size(i)]] = section.form.c[i];
    X.G.row(rest[as_size(i)]) = section.form.G.row(i);
  }
  X.M.resize(n, l);
  X.S = Matrix::Zero(X.b.size(), l);
  for (Index j = 0; j < l; ++j) {
    RationalVector line = lines.basis.row(j);
    rational::make_primitive(line);
    rational::scale_to_one(line);
    for (Index i = 0; i < n; ++i) X.M(i, j) = rounded(line[as_size(i)]);
    if (rational::exact(VectorIn(X.M.col(j))) == line) continue;
    // A turned line encloses nothing. Setting the coordinates free that it moves does.
    Description wider = generators;
    for (Index i = 0; i < n; ++i) {
      if (sgn(line[as_size(i)]) == 0) continue;
      wider.add(RationalVector(as_size(n + 1)), true);
      wider.rows.back()[as_size(i + 1)] = 1;
    }
    const Description wider_rows = cordon::inequalities_of(wider);
    return {enclose(cordon::generators_of(wider_rows), wider_rows).form, Tightness::outer};
  }
  return {std::move(X), section.tightness};
}

}  // namespace polytope

Polytope::Export Polytope::to_line_form() const {
  return polytope::enclose(representation_->generators(), representation_->inequalities());
}

Polytope::Generators Polytope::generators() const {
  const Description& all = representation_->generators();
  return {
      columns_of(
          all, [](const RationalVector& row, bool) { return sgn(row[0]) != 0; }, false),
      columns_of(
          all, [](const RationalVector& row, bool linear) { return sgn(row[0]) == 0 && !linear; },
          true),
      columns_of(
          all, [](const RationalVector& row, bool linear) { return sgn(row[0]) == 0 && linear; },
          true)};
}

Polytope::Inequalities Polytope::inequalities() const {
  const Description& all = representation_->inequalities();
  const Index n = dim(),
              equations =
                  static_cast<Index>(std::count(all.linear.begin(), all.linear.end(), true));
  const Index rows = static_cast<Index>(all.rows.size()) - equations;
  Inequalities out{Matrix(rows, n), Vector(rows), Matrix(equations, n), Vector(equations)};
  Index next = 0, next_equation = 0;
  for (std::size_t k = 0; k < all.rows.size(); ++k) {
    const RationalVector row = row_for_doubles(all.rows[k]);
    const Index i = all.linear[k] ? next_equation++ : next++;
    Matrix& H = all.linear[k] ? out.Q : out.H;
    (all.linear[k] ? out.q : out.h)[i] = rounded(row[0]);
    for (Index j = 0; j < n; ++j) H(i, j) = -rounded(row[as_size(j + 1)]);
  }
  return out;
}

}  // namespace cordon
