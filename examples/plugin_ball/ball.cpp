// SPDX-License-Identifier: GPL-3.0-or-later
// A representation with arithmetic of its own, as a plugin: balls, whose size is one number and
// which the exchange form cannot hold exactly.
#include <cmath>
#include <cordon/core/error.hpp>
#include <cordon/core/rounding.hpp>
#include <cordon/registry/plugin.hpp>
#include <cordon/solvers/set_questions.hpp>

namespace {

using namespace cordon;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A set is called empty, a point outside, if this share of the terms cannot explain it.
constexpr double proof_margin = 1e-10;

/// Upper bound of the 2-norm of what doubles hold.
double length(MatrixIn A) {
  return A.size() ? A.stableNorm() * (1 + rounding::gamma(2 * A.size() + 8)) : 0;
}

/// {x : ‖x - c‖₂ ≤ radius}; ∅ for a negative radius.
struct Ball {
  Vector c;
  double radius = -1;

  bool empty() const { return radius < 0; }
};

class BallSet final : public Set {
 public:
  BallSet(const SetBackend& backend, Ball ball)
      : Set(backend, ball.c.size()), ball_(std::move(ball)) {}
  const Ball& ball() const { return ball_; }

 private:
  Complexity do_complexity() const override { return {ball_.radius > 0 ? dim() : 0, 0, 0}; }
  LineForm do_line_form() const override { return make_box(hull()); }

  // The defaults would ask about the box of do_line_form, and know less.
  Answer do_is_empty(Certificate* why) const override {
    if (why) *why = {Certificate::Kind::structure, Vector(0), 0};
    return ball_.empty() ? Answer::yes : Answer::no;  // the centre is a point of the set
  }
  Answer do_contains(VectorIn x, Certificate*) const override {
    if (ball_.empty()) return Answer::no;
    const double far = length(Vector(x - ball_.c)), terms = length(x) + length(ball_.c);
    if (far + 4 * rounding::unit * terms <= ball_.radius) return Answer::yes;
    return far > ball_.radius + proof_margin * terms ? Answer::no : Answer::unknown;
  }
  double do_support(VectorIn d, Certificate*) const override {
    if (ball_.empty()) return -infinity;
    return rounding::up(rounding::dot(d, ball_.c).upper + rounding::up(length(d) * ball_.radius));
  }
  Box do_interval_hull(std::vector<Certificate>* why) const override {
    if (why)
      why->assign(static_cast<std::size_t>(2 * dim()),
                  {Certificate::Kind::structure, Vector(0), 0});
    return hull();
  }

  Box hull() const {
    if (ball_.empty()) return dim() > 0 ? Box::empty(dim()) : Box{Vector(0), Vector(0)};
    Box box{ball_.c, ball_.c};
    for (Index i = 0; i < dim() && ball_.radius > 0; ++i) {
      box.lower[i] = rounding::down(ball_.c[i] - ball_.radius);
      box.upper[i] = rounding::up(ball_.c[i] + ball_.radius);
    }
    return box;
  }

  Ball ball_;
};

class BallBackend final : public SetBackend {
 public:
  explicit BallBackend(bool frobenius)
      : SetBackend({.name = "ball", .exact_exchange = false, .summary = "balls", .citation = ""}),
        frobenius_(frobenius) {}

 private:
  /// The framework hands over sets of this backend only.
  static const Ball& ball(const Set& X) { return static_cast<const BallSet&>(X).ball(); }

  Made make(Ball X, Tightness tightness = Tightness::outer) const {
    if (!X.c.allFinite() || !std::isfinite(X.radius))
      throw Error(Errc::not_finite, "ball: an operation overflows; scale the problem");
    return {std::make_unique<BallSet>(*this, std::move(X)), tightness};
  }

  /// The ball around the certified box; a point is exact.
  Made do_import(const LineForm& X) const override {
    const Box hull = interval_hull(X);
    if (hull.is_empty()) return make({X.c, -1}, Tightness::exact);
    if (!hull.is_bounded()) throw Error(Errc::unsupported, "ball holds bounded sets only");
    const Vector c = hull.lower / 2 + hull.upper / 2;
    const Vector reach = (hull.upper - c).cwiseMax(c - hull.lower);
    const bool point = X.lines() + X.generators() == 0 && reach.isZero(0);
    if (point) return make({c, 0}, Tightness::exact);
    return make({c, length(reach) * (1 + 4 * rounding::unit)});
  }

  /// Upper bound of ‖T‖₂.
  double stretch(MatrixIn T) const {
    if (T.size() == 0) return 0;
    if (frobenius_) return length(T);
    const double rows = T.cwiseAbs().rowwise().sum().maxCoeff(),
                 columns = T.cwiseAbs().colwise().sum().maxCoeff();
    return std::sqrt(rows) * std::sqrt(columns) * (1 + rounding::gamma(T.rows() + T.cols() + 8));
  }

  /// Radii are stretched and added; so are bounds of what is rounded about the centre.
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    Ball sum{p.f, 0};
    double rounded = 0;
    const auto add = [&](MatrixIn T, const Ball& Y) {
      if (Y.empty()) sum.radius = -infinity;
      rounded += length(rounding::product_error(T, Y.c));
      sum.c += T * Y.c;
      rounded += 2 * rounding::unit * length(sum.c);
      sum.radius += stretch(T) * Y.radius;
    };
    add(p.A, ball(X));
    for (const Term& term : p.terms) add(term.T, ball(*term.set));
    if (sum.radius < 0) return make({p.f, -1}, Tightness::exact);
    const auto terms = static_cast<Index>(p.terms.size());
    sum.radius = (sum.radius + rounded) * (1 + rounding::gamma(4 * terms + 16));
    return make(std::move(sum));
  }

  /// Row by row: z_i - C_i x ∈ T_i V is a strip, whose width is the support of V along T_i.
  Made do_correct(const Set& X, const CorrectionArgs& c) const override {
    const Ball& noise = ball(*c.noise.set);
    if (ball(X).empty() || noise.empty()) return make({ball(X).c, -1}, Tightness::exact);
    Ball result = ball(X);
    for (Index i = 0; i < c.C.rows() && !result.empty(); ++i) {
      const Vector a = c.C.row(i).transpose(), row = c.noise.T.row(i).transpose();
      const double above = c.noise.set->support(row), below = c.noise.set->support(-row);
      const Interval at = rounding::dot(a, result.c);
      const double slack =
          4 * rounding::unit *
          (std::abs(c.z[i]) + std::abs(at.upper) + std::abs(above) + std::abs(below));
      const double beyond = c.z[i] - above - at.upper - slack,
                   before = at.lower - c.z[i] - below - slack;
      result = cut(result, beyond >= before ? a : Vector(-a), std::max(beyond, before));
    }
    return make(std::move(result));
  }

  /// The smallest ball around {x ∈ X : aᵀ(x - c) ≥ gap}: for a gap beyond the centre, that around
  /// the circle of the cut. Empty if the gap is wider than the ball by more than rounding.
  static Ball cut(const Ball& X, const Vector& a, double gap) {
    const double norm = length(a);
    if (!(gap > 0) || norm == 0) return X;
    const double t = gap / norm;
    if (t > X.radius + proof_margin * (t + length(X.c))) return {X.c, -1};
    if (t >= X.radius) return X;
    const double left = std::sqrt((X.radius - t) * (X.radius + t));
    const double rounded = 8 * rounding::unit * (length(X.c) + static_cast<double>(a.size()) * t);
    return {X.c + (t / norm) * a, left * (1 + 16 * rounding::unit) + rounded};
  }

  bool frobenius_;
};

void register_components(Registrar& registrar) {
  ParamSchema schema;
  schema.choice("stretch",
                "how ‖A‖₂ is bounded: by the root of the largest sums of rows and columns, or by "
                "the Frobenius norm",
                {"sums", "frobenius"}, "sums");
  registrar.add(BackendEntry{{"ball", "balls", "", schema}, [](const Params& params) {
                               return std::make_unique<BallBackend>(params.text("stretch") ==
                                                                    "frobenius");
                             }});
}

}  // namespace

CORDON_PLUGIN("ball", "0.1.0", "GPL-3.0-or-later", "the Cordon authors", "balls",
              register_components)
