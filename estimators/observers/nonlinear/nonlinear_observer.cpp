// SPDX-License-Identifier: GPL-3.0-or-later
// The recursion for models by formulas as a component:
//   X̂_0 = X0 corrected by y_0;   X̂_k = f(X̂_{k-1}, W, u_{k-1}, k-1) enclosed, corrected by y_k and
//   the invariants, reduced to the budget.
// A box is carried beside the set: the estimate is their intersection.
#include <algorithm>
#include <cmath>
#include <memory>

#include "components.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/interfaces/line_form_set.hpp"
#include "observers/nonlinear/formula_outputs.hpp"
#include "observers/nonlinear/recursion.hpp"
#include "observers/observer_parameters.hpp"

namespace cordon::estimators {

namespace {

bool has_boxes_only(const Params& params) {
  return params.text("method") == "natural" || params.text("method") == "interval";
}

NonlinearOptions options_from(const Params& params, const BackendInfo& backend) {
  NonlinearOptions options;
  // Cuts by the box make sets wider where intersections are enclosed.
  options.row_by_row = !backend.intersections;
  const std::string& method = params.text("method");
  options.natural_only = method == "natural";
  options.boxes_only = has_boxes_only(params);
  options.relaxes = method == "relaxation";
  options.lifts = method == "lifted";
  if (method == "mean_value") options.form = formulas::AffineForm::mean_value;
  if (method == "dc") options.form = formulas::AffineForm::convex_differences;
  options.contracts = params.flag("contraction");
  options.carries_box = params.flag("box");
  options.parts = params.integer("parts");
  options.budget = budget_from(params);
  return options;
}

class NonlinearObserver final : public Observer {
 public:
  NonlinearObserver(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        X0_(initial_set_from(model(), params)),
        recursion_(model(), context.backend, options_from(params, context.backend->info())),
        outputs_(model(), *context.backend) {}

  LineForm initial_set() const override { return X0_; }
  std::optional<LineForm> admissible_set() const override { return model().nonlinear->admissible; }
  Tightness claim() const override { return Tightness::outer; }
  bool follows_its_sets() const override { return true; }
  bool takes_missing_outputs() const override { return true; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    const bool is_there =
        timed(Phase::predict, [&] { return recursion_.start(X0 ? *X0 : backend().import(X0_)); });
    return corrected(is_there, first);
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    const bool is_there =
        timed(Phase::predict, [&] { return recursion_.predict(before.u, before.k); });
    return corrected(is_there, now);
  }

  void do_replace(const Enclosure& X) override { recursion_.start(X); }
  void do_serialize(Archive& archive) override { archive(recursion_); }

  Enclosure corrected(bool is_there, const Sample& now) {
    is_there = is_there && timed(Phase::correct, [&] { return recursion_.correct(now); });
    if (!is_there) return backend().empty(model().states());
    timed(Phase::reduce, [&] {
      recursion_.reduce();
      return true;
    });
    return estimate();
  }

  /// X ∩ B; where the backend cannot hold it, in exchange form.
  Enclosure estimate() const {
    const Box& box = recursion_.box();
    const Enclosure& X = recursion_.set();
    if (!recursion_.is_box_narrower()) return X;
    const Matrix unit = Matrix::Identity(box.dim(), box.dim());
    if (backend().info().intersections) {
      return backend().intersection(X, unit, backend().box(box));
    }
    const LineForm form = X->line_form();
    Box wider = box;  // by what the difference of the centres is rounded
    for (Index i = 0; i < box.dim(); ++i) {
      const double terms =
          std::abs(form.c[i]) + std::max(std::abs(box.lower[i]), std::abs(box.upper[i]));
      wider.lower[i] -= 4 * rounding::unit * terms;
      wider.upper[i] += 4 * rounding::unit * terms;
    }
    return line_form_set(intersection(form, unit, make_box(wider)), backend().info().rounding,
                         Tightness::outer);
  }

  OutputBounds output_bounds(const Set& X, Index output, const Sample& now) override {
    const auto [bounds, error] = outputs_.bounds(X.interval_hull(), output, now);
    return {bounds.lower, bounds.upper, error};
  }

  LineForm X0_;
  NonlinearRecursion recursion_;
  FormulaOutputs outputs_;
};

/// What formulas are made of, for people.
std::string language() {
  std::string text =
      "Formulas: + - * / ^ ( ), decimal numbers, pi, k (the number of the step), names of the "
      "study, and\n";
  for (const formulas::FunctionName& function : formulas::function_names()) {
    const std::string domain = function.domain;
    text += std::string("  ") + function.name + (function.arguments == 2 ? "(x, y)" : "(x)") +
            (domain.empty() ? "" : ", " + domain) + "\n";
  }
  return text + "docs/nonlinear.md describes systems, methods and assumptions.\n";
}

/// Every part may become a variable with inequalities, which are dense.
void check_relaxed_size(const ObserverContext& context, std::vector<Diagnostic>& problems) {
  constexpr std::size_t most_parts = 2000;
  const NonlinearModel& model = *context.model.nonlinear;
  const std::size_t parts = std::max(model.f->tape().size(), model.g->tape().size());
  if (parts <= most_parts) return;
  problems.push_back({"/method",
                      "\"relaxation\" takes formulas of at most " + std::to_string(most_parts) +
                          " parts, and these have " + std::to_string(parts),
                      "use another method, or a plant with fewer \"substeps\""});
}

std::vector<Diagnostic> check_nonlinear(const ObserverContext& context, const Params& params) {
  if (context.model.is_linear()) {
    return {{"/type", "\"nonlinear\" takes systems of type \"nonlinear\", and this one is linear",
             "use the observer \"prediction_correction\""}};
  }
  std::vector<Diagnostic> problems = check_common(context, params);
  if (!problems.empty()) return problems;
  if (params.text("method") == "relaxation" && !context.backend->info().intersections)
    problems.push_back({"/method",
                        "\"relaxation\" needs sets with exact intersections, and \"" +
                            context.backend->info().name + "\" encloses them",
                        "use the backend \"constrained_zonotope\", or another method"});
  if (params.integer("parts") > 1 && !params.flag("box") && !has_boxes_only(params))
    problems.push_back({"/parts", "parts narrow the box beside the set, and there is none",
                        "leave out \"box\": false"});
  if (params.text("method") == "relaxation") check_relaxed_size(context, problems);
  check_bounded_start(context, params, problems);
  check_noises(context, problems);
  return problems;
}

}  // namespace

CORDON_COMPONENT(observer, nonlinear) {
  ParamSchema schema = common_parameters();
  schema.choice(
      "method",
      "the enclosure of f and g: boxes alone, by natural extensions (natural) or the best "
      "range (interval); or a set of the backend by the mean value, by the first order "
      "with bounded second derivatives, the same with squares and products kept "
      "(lifted) or bounded by differences of convex functions as well (dc), or by linear "
      "relaxations (exact intersections only)",
      {"natural", "interval", "mean_value", "first_order", "lifted", "dc", "relaxation"},
      "first_order");
  schema.flag("contraction", "contract a box by the outputs and invariants (HC4)", true);
  schema.flag("box", "carry a box beside the set: the estimate is their intersection", true);
  schema.integer("parts",
                 "at most so many parts into which the box is cut for its prediction and the "
                 "contraction that follows",
                 1, 1, 64);
  registrar.add(ObserverEntry{
      {"nonlinear",
       "prediction and correction for formulas, enclosed by ranges and derivatives over boxes; any "
       "backend",
       "Kuhn1998; Combastel2005; Rego2020a; Rego2025b; Benhamou1999", std::move(schema),
       language()},
      check_nonlinear,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        return std::make_unique<NonlinearObserver>(context, params);
      },
      false,
      false,
      true});
}

}  // namespace cordon::estimators
