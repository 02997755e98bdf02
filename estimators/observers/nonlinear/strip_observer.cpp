// SPDX-License-Identifier: GPL-3.0-or-later
// The five observers by strips as a component, on backends whose sets of X0, W and V are zonotopes.
#include <memory>

#include "components.hpp"
#include "observers/nonlinear/formula_outputs.hpp"
#include "observers/nonlinear/strip_recursion.hpp"
#include "observers/observer_parameters.hpp"

namespace cordon::estimators {

namespace {

const std::vector<std::string>& variant_names() {
  static const std::vector<std::string> names{"frad_a", "frad_b", "frad_c", "vol_min_a",
                                              "vol_min_b"};
  return names;
}

StripVariant variant_from(const Params& params) {
  const auto& names = variant_names();
  const auto found = std::ranges::find(names, params.text("variant"));
  return static_cast<StripVariant>(found - names.begin());
}

/// The same model with sets that the backend makes of its own.
Model represented(const Model& model, const SetBackend& backend) {
  Model made = model;
  for (LineForm* set : {&made.W, &made.V}) *set = backend.import(*set)->line_form();
  return made;
}

bool holds_zonotopes(const SetBackend& backend) {
  const Matrix slanted{{1, 1}, {0, 1}};
  return backend.import(make_zonotope(Vector::Zero(2), slanted)).tightness == Tightness::exact;
}

class StripObserver final : public Observer {
 public:
  StripObserver(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        X0_(initial_set_from(model(), params)),
        variant_(variant_from(params)),
        recursion_(represented(model(), *context.backend), variant_,
                   budget_from(params).generators),
        outputs_(model(), *context.backend) {}

  LineForm initial_set() const override { return X0_; }
  Tightness claim() const override { return Tightness::outer; }
  /// A representation that encloses its zonotopes is told more than the recursion goes on with.
  bool follows_its_sets() const override {
    return uses_outputs_of_its_time() && (model().states() == 1 || holds_zonotopes(backend()));
  }
  bool takes_missing_outputs() const override { return true; }
  bool uses_outputs_of_its_time() const override { return variant_ != StripVariant::frad_c; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    recursion_.start((X0 ? backend().import(*X0) : backend().import(X0_))->line_form());
    return corrected(first);
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    timed(Phase::predict, [&] {
      recursion_.predict(before);
      return true;
    });
    return corrected(now);
  }

  void do_replace(const Enclosure& X) override { recursion_.start(X->line_form()); }
  void do_serialize(Archive& archive) override { archive(recursion_); }

  Enclosure corrected(const Sample& now) {
    if (!timed(Phase::correct, [&] { return recursion_.correct(now); }))
      return backend().empty(model().states());
    return backend().import(make_zonotope(recursion_.center(), recursion_.generators()),
                            Tightness::outer);
  }

  OutputBounds output_bounds(const Set& X, Index output, const Sample& now) override {
    const auto [bounds, error] = outputs_.bounds(X.interval_hull(), output, now);
    return {bounds.lower, bounds.upper, error};
  }

  LineForm X0_;
  StripVariant variant_;
  StripRecursion recursion_;
  FormulaOutputs outputs_;
};

void check_zonotope(const ObserverContext& context, const LineForm& set, const char* name,
                    std::vector<Diagnostic>& problems) {
  const LineForm form = context.backend->import(set)->line_form();
  if (form.constraints() > 0 || form.lines() > 0)
    problems.push_back({"",
                        std::string(name) + " is no zonotope, and this observer knows no others",
                        "use the backend \"zonotope\", which encloses it"});
}

std::vector<Diagnostic> check_strips(const ObserverContext& context, const Params& params) {
  if (context.model.is_linear()) {
    return {{"/type", "takes systems of type \"nonlinear\", and this one is linear",
             "use the observer \"prediction_correction\""}};
  }
  std::vector<Diagnostic> problems = check_common(context, params);
  if (!problems.empty()) return problems;
  check_bounded_start(context, params, problems);
  check_noises(context, problems);
  if (!problems.empty()) return problems;
  if (context.backend->info().rounding != Rounding::nominal)
    problems.push_back({"", "computes in doubles, and the backend encloses their rounding errors",
                        "use the observer \"nonlinear\", or nominal rounding"});
  check_zonotope(context, initial_set_from(context.model, params), "X0", problems);
  check_zonotope(context, context.model.W, "W", problems);
  check_zonotope(context, context.model.V, "V", problems);
  if (variant_from(params) == StripVariant::vol_min_a && context.model.states() > 3)
    problems.push_back({"/variant", "\"vol_min_a\" is for at most three states",
                        "use \"vol_min_b\", or an F-radius"});
  return problems;
}

}  // namespace

CORDON_COMPONENT(observer, nonlinear_strips) {
  ParamSchema schema = common_parameters();
  schema.choice("variant",
                "strips of least F-radius row by row (frad_a) or with one gain (frad_b), a gain on "
                "the outputs before (frad_c), strips of least volume (vol_min_a: by a linear "
                "program, at most three states; vol_min_b: by columns)",
                variant_names(), "frad_a");
  registrar.add(ObserverEntry{
      {"nonlinear_strips",
       "zonotopes linearised at their centres and cut by strips, for comparison with \"nonlinear\"",
       "Holzinger2026; Alamo2005; Bravo2006; Combastel2005", std::move(schema)},
      check_strips,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        return std::make_unique<StripObserver>(context, params);
      },
      false,
      false,
      true});
}

}  // namespace cordon::estimators
