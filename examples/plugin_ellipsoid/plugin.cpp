// SPDX-License-Identifier: GPL-3.0-or-later
// Ellipsoids for every observer of Cordon: the objects of the framework around the arithmetic of
// ellipsoid.hpp.
#include <cordon/core/error.hpp>
#include <cordon/registry/plugin.hpp>

#include "ellipsoid.hpp"

namespace {

using namespace cordon;
using ellipsoid::Criterion;
using ellipsoid::Ellipsoid;

class EllipsoidSet final : public Set {
 public:
  EllipsoidSet(const SetBackend& backend, Ellipsoid value)
      : Set(backend, value.dim()), value_(std::move(value)) {}
  const Ellipsoid& value() const { return value_; }

 private:
  Complexity do_complexity() const override { return {value_.axes(), 0, 0}; }
  LineForm do_line_form() const override { return ellipsoid::principal_box(value_); }

  // The defaults would ask about the box of do_line_form, and know less.
  Answer do_is_empty(Certificate* why) const override {
    if (why) *why = {Certificate::Kind::structure, Vector(0), 0};
    return value_.empty ? Answer::yes : Answer::no;  // the centre is a point of the set
  }
  Answer do_contains(VectorIn x, Certificate*) const override {
    return ellipsoid::contains(value_, x);
  }
  Answer do_is_bounded() const override { return Answer::yes; }
  double do_support(VectorIn d, Certificate*) const override {
    return ellipsoid::support(value_, d);
  }
  Box do_interval_hull(std::vector<Certificate>* why) const override {
    if (why)
      why->assign(static_cast<std::size_t>(2 * dim()),
                  {Certificate::Kind::structure, Vector(0), 0});
    return ellipsoid::interval_hull(value_);
  }
  std::optional<Volume> do_volume() const override {
    return Volume{ellipsoid::volume(value_), true};
  }

  Ellipsoid value_;
};

class EllipsoidBackend final : public SetBackend {
 public:
  explicit EllipsoidBackend(Criterion criterion)
      : SetBackend({.name = "ellipsoid",
                    .exact_exchange = false,
                    .summary = "ellipsoids, possibly flat",
                    .citation = "Kurzhanski1997"}),
        criterion_(criterion) {}

 private:
  /// The framework hands over sets of this backend only.
  static const Ellipsoid& value(const Set& X) {
    return static_cast<const EllipsoidSet&>(X).value();
  }
  static const Ellipsoid& value(const Term& term) { return value(*term.set); }

  Made make(Ellipsoid X, bool exact) const {
    return {std::make_unique<EllipsoidSet>(*this, std::move(X)),
            exact ? Tightness::exact : Tightness::outer};
  }
  /// Empty only on a proof, and then the exact result; else an enclosure.
  Made make_outer(Ellipsoid X) const {
    const bool empty = X.empty;
    return make(std::move(X), empty);
  }

  Made do_import(const LineForm& X) const override {
    auto [set, exact] = ellipsoid::enclose(X, criterion_);
    return make(std::move(set), exact);
  }

  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    std::vector<Ellipsoid> summands{ellipsoid::affine_map(value(X), p.A, p.f)};
    for (const Term& term : p.terms) {
      summands.push_back(ellipsoid::affine_map(value(term), term.T, Vector::Zero(p.A.rows())));
    }
    auto [set, exact] = ellipsoid::sum(summands);
    return make(std::move(set), exact);
  }

  /// Row by row: z_i - C_i x ∈ T_i V is a strip, whose width is the support of V along T_i.
  Made do_correct(const Set& X, const CorrectionArgs& c) const override {
    const Ellipsoid& noise = value(c.noise);
    if (noise.empty) return make(ellipsoid::make_empty(X.dim()), true);
    Ellipsoid result = value(X);
    for (Index i = 0; i < c.C.rows() && !result.empty; ++i) {
      const Vector row = c.noise.T.row(i).transpose();
      const double above = ellipsoid::support(noise, row), below = ellipsoid::support(noise, -row);
      const double error = std::numeric_limits<double>::epsilon() *
                           (std::abs(c.z[i]) + std::abs(above) + std::abs(below));
      result = ellipsoid::cut(
          result, {c.C.row(i).transpose(), c.z[i] - above, c.z[i] + below, error}, criterion_);
    }
    return make_outer(std::move(result));
  }

  Made do_intersection(const Set& X, MatrixIn R, const Set& Y) const override {
    return make_outer(ellipsoid::intersection(value(X), R, value(Y), criterion_));
  }

  Made do_convex_hull(const Set& X, const Set& Y) const override {
    return make(ellipsoid::convex_hull(value(X), value(Y)), false);
  }

  Criterion criterion_;
};

void register_components(Registrar& registrar) {
  ParamSchema schema;
  schema.choice("criterion",
                "what a measurement makes smallest: the sum of squared half axes, or the volume",
                {"trace", "volume"}, "trace");
  registrar.add(BackendEntry{{"ellipsoid", "ellipsoids, possibly flat", "Kurzhanski1997", schema},
                             [](const Params& params) {
                               const bool volume = params.text("criterion") == "volume";
                               return std::make_unique<EllipsoidBackend>(volume ? Criterion::volume
                                                                                : Criterion::trace);
                             }});
}

}  // namespace

CORDON_PLUGIN("ellipsoid", "0.1.0", "GPL-3.0-or-later", "the Cordon authors", "ellipsoids",
              register_components)
