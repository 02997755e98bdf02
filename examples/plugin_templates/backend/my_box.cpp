// SPDX-License-Identifier: GPL-3.0-or-later
// A representation of sets as a plugin: bounded axis-aligned boxes. Start from here and replace the
// box by sets of your own.
#include <cordon/core/error.hpp>
#include <cordon/core/rounding.hpp>
#include <cordon/interfaces/archive.hpp>
#include <cordon/registry/plugin.hpp>
#include <cordon/solvers/set_questions.hpp>

namespace {

using namespace cordon;

/// {x : lower ≤ x ≤ upper}; ∅ only if it has been proven.
class BoxSet final : public Set {
 public:
  BoxSet(const SetBackend& backend, Box box) : Set(backend, box.dim()), box_(std::move(box)) {}
  const Box& box() const { return box_; }

 private:
  Complexity do_complexity() const override { return {dim(), 0, 0}; }
  LineForm do_line_form() const override { return make_box(box_); }

  // For speed only: without these two the framework asks a solver about the line form.
  Box do_interval_hull(std::vector<Certificate>* why) const override {
    if (why)
      why->assign(static_cast<std::size_t>(2 * dim()),
                  {Certificate::Kind::structure, Vector(0), 0});
    return box_;
  }
  double do_support(VectorIn d, Certificate*) const override {
    if (box_.is_empty()) return -std::numeric_limits<double>::infinity();
    Vector corner(dim());
    for (Index i = 0; i < dim(); ++i) corner[i] = d[i] > 0 ? box_.upper[i] : box_.lower[i];
    return rounding::dot(d, corner).upper;
  }

  Box box_;
};

/// Every operation but `import` is left to the framework: it computes the exact result in the
/// common form and imports that.
class BoxBackend final : public SetBackend {
 public:
  BoxBackend() : SetBackend({.name = "my_box", .summary = "axis-aligned boxes", .citation = ""}) {}

 private:
  /// The smallest box around X, as far as proven; equal to X if X is a box itself.
  Made do_import(const LineForm& X) const override {
    Box hull = interval_hull(X);
    if (hull.is_empty())
      return {std::make_unique<BoxSet>(*this, std::move(hull)), Tightness::exact};
    if (!hull.is_bounded()) throw Error(Errc::unsupported, "my_box holds bounded sets only");
    bool is_box = X.lines() == 0 && X.constraints() == 0;
    for (Index j = 0; j < X.generators(); ++j)
      is_box = is_box && (X.G.col(j).array() != 0).count() <= 1;
    return {std::make_unique<BoxSet>(*this, std::move(hull)),
            is_box ? Tightness::exact : Tightness::outer};
  }

  /// The numbers of a set as they are, so that observers can go on from them after a restart.
  std::unique_ptr<const Set> do_serialize(const Set* X, Archive& archive) const override {
    Box box = X ? static_cast<const BoxSet*>(X)->box() : Box{};
    archive(box);
    if (X) return nullptr;
    if (box.lower.hasNaN() || box.upper.hasNaN()) archive.refuse("a bound that is NaN");
    return std::make_unique<BoxSet>(*this, std::move(box));
  }
};

void register_components(Registrar& registrar) {
  registrar.add(BackendEntry{{"my_box", "axis-aligned boxes", "", {}},
                             [](const Params&) { return std::make_unique<BoxBackend>(); }});
}

}  // namespace

CORDON_PLUGIN("my_box", "0.1.0", "GPL-3.0-or-later", "A. Uthor", "axis-aligned boxes",
              register_components)
