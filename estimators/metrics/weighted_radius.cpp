// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/weighted_radius.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "components.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "cordon/sets/generator_reduction.hpp"

namespace cordon::estimators {

double f_w_radius(MatrixIn R, MatrixIn W) {
  const double size = R.size() == 0 ? 0 : R.cwiseAbs().maxCoeff();
  if (size == 0) return 0;
  // In a unit of the generators' size, a power of two: their squares may be no double numbers.
  const double unit = std::exp2(std::clamp(std::floor(std::log2(size)), -1000.0, 1000.0));
  const Matrix scaled = R / unit;
  return unit * std::sqrt(std::max(0.0, linalg::product(W, scaled).cwiseProduct(scaled).sum()));
}

WRadius w_radius(MatrixIn R, MatrixIn W) {
  const std::optional<Matrix> root = linalg::cholesky(W);
  if (!root) throw Error(Errc::invalid, "the weight is not positive definite");
  Matrix scaled = linalg::product(root->transpose(), R);  // ‖R b‖²_W = ‖scaled b‖²
  const bool exact = scaled.cols() <= most_enumerated;
  if (!exact) {
    if (scaled.rows() > most_enumerated)
      throw Error(Errc::unsupported,
                  "w_radius takes at most " + std::to_string(most_enumerated) + " states");
    scaled = sets::reduce_generators(scaled, most_enumerated);
  }
  if (scaled.cols() == 0) return {0, exact};
  // The maximum of a convex function is attained at a vertex of the box; b and -b give the same. In
  // the order of Gray's code one sign changes from vertex to vertex.
  Vector point = scaled.rowwise().sum();
  Vector sign = Vector::Ones(scaled.cols());
  double largest = point.squaredNorm();
  const std::uint32_t count = std::uint32_t{1} << (scaled.cols() - 1);
  for (std::uint32_t i = 1; i < count; ++i) {
    const Index g = std::countr_zero(i);
    sign[g] = -sign[g];
    point += 2 * sign[g] * scaled.col(g);
    largest = std::max(largest, point.squaredNorm());
  }
  return {largest, exact};
}

namespace {

bool is_weight(const Matrix& W) {
  return W.rows() == W.cols() && W == W.transpose() && linalg::cholesky(W);
}

/// What `Weighted` would find out when it is made, or at the first step of a run.
std::vector<Diagnostic> check_weight(const MetricContext& context, const Params& params) {
  if (!params.has("weight")) return {};
  const Matrix& W = params.matrix("weight");
  const Index n = context.model.states();
  std::vector<Diagnostic> problems;
  if (W.rows() != n || W.cols() != n) {
    problems.push_back({"/weight",
                        "is " + std::to_string(W.rows()) + " × " + std::to_string(W.cols()) +
                            ", the state has " + std::to_string(n) +
                            (n == 1 ? " entry" : " entries"),
                        "give a row and a column per state"});
  } else if (!is_weight(W)) {
    problems.push_back({"/weight", "is not symmetric and positive definite",
                        "give W = Wᵀ with positive eigenvalues"});
  }
  return problems;
}

/// The weight, and the generators of a zonotope around the estimate.
class Weighted {
 public:
  explicit Weighted(const Params& params) {
    if (!params.has("weight")) return;
    given_ = true;
    weight_ = params.matrix("weight");
    if (!is_weight(weight_))
      throw Error(Errc::invalid, "/weight must be symmetric and positive definite");
  }

  struct View {
    Matrix R;
    bool exact;
  };
  /// Nothing for sets that are empty or unbounded.
  std::optional<View> see(const StepView& view) {
    const LineForm form = view.estimate.set->line_form();
    if (weight_.size() == 0) weight_ = Matrix::Identity(form.dim(), form.dim());
    if (weight_.rows() != form.dim()) {
      throw Error(Errc::dimension, "/weight is " + std::to_string(weight_.rows()) + " × " +
                                       std::to_string(weight_.cols()) + ", the state has " +
                                       std::to_string(form.dim()));
    }
    if (view.estimate.consistent == Answer::no || !view.hull.is_bounded()) return std::nullopt;
    if (form.lines() == 0 && form.constraints() == 0)
      return View{invariant::enclosing_zonotope(form).G, view.estimate.set->has_exact_form()};
    return View{view.hull.radius().asDiagonal(), false};
  }
  const Matrix& weight() const { return weight_; }
  bool is_given() const { return given_; }

 private:
  Matrix weight_;
  bool given_ = false;
};

/// Both metrics: a value per step, what it is the value of, and their mean and largest.
template <class Size>
class WeightedRadius final : public Metric {
 public:
  explicit WeightedRadius(const Params& params) : weighted_(params) {}

 private:
  std::vector<MetricValue> do_step(const StepView& view) override {
    const auto seen = weighted_.see(view);
    if (!seen)
      return {{Size::name, not_available}, {std::string(Size::name) + "_of", std::string("none")}};
    const WRadius found = Size::of(seen->R, weighted_.weight());
    ++count_;
    sum_ += found.value;
    largest_ = std::max(largest_, found.value);
    return {{Size::name, found.value},
            {std::string(Size::name) + "_of", std::string(!seen->exact  ? "hull"
                                                          : found.exact ? "set"
                                                                        : "reduced set")}};
  }
  std::vector<MetricValue> do_summary() const override {
    const std::string name = Size::name;
    return {{name + "_mean", count_ ? sum_ / static_cast<double>(count_) : not_available},
            {name + "_max", count_ ? largest_ : not_available}};
  }

  std::vector<Measure> do_measures() const override {
    const std::string name = Size::name, title = Size::title;
    const auto quantity = weighted_.is_given() ? Measure::Quantity::number : Size::quantity;
    return {{.name = name + "_mean",
             .of = name,
             .title = "mean " + title,
             .quantity = quantity,
             .better = Preference::less,
             .ranked = true},
            {.name = name + "_max",
             .of = name,
             .title = "max " + title,
             .quantity = quantity,
             .better = Preference::less,
             .in_comparison = Measure::Shown::never}};
  }

  Weighted weighted_;
  Index count_ = 0;
  double sum_ = 0, largest_ = 0;
};

struct FWRadius {
  static constexpr const char* name = "f_w_radius";
  static constexpr const char* title = "F-W-radius";
  static constexpr auto quantity = Measure::Quantity::length;
  static WRadius of(const Matrix& R, const Matrix& W) { return {f_w_radius(R, W), true}; }
};
struct SquaredRadius {
  static constexpr const char* name = "w_radius";
  static constexpr const char* title = "W-radius";
  static constexpr auto quantity = Measure::Quantity::squared_length;
  static WRadius of(const Matrix& R, const Matrix& W) { return w_radius(R, W); }
};

template <class Size>
void add(Registrar& registrar, const char* summary) {
  ParamSchema schema;
  schema.matrix(
      "weight",
      "W, symmetric and positive definite, a row and a column per state; the identity by default");
  registrar.add(MetricEntry{{Size::name, summary, "Pourasghar2021", std::move(schema)},
                            [](const Params& params) -> std::unique_ptr<Metric> {
                              return std::make_unique<WeightedRadius<Size>>(params);
                            },
                            check_weight});
}

}  // namespace

CORDON_COMPONENT(metric, f_w_radius) {
  add<FWRadius>(registrar,
                "√tr(Rᵀ W R) of the estimate's generators R; of the interval hull where there are "
                "constraints");
}

CORDON_COMPONENT(metric, w_radius) {
  add<SquaredRadius>(registrar,
                     "largest (z - c)ᵀ W (z - c) over the estimate; an upper bound beyond 16 "
                     "generators or with constraints");
}

}  // namespace cordon::estimators
