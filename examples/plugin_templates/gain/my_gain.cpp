// SPDX-License-Identifier: GPL-3.0-or-later
// A gain as a plugin: L = A C⁺, which moves the eigenvalues of A - L C towards 0 as far as one
// sample of the outputs shows the state. Start from here and replace the formula by your own.
#include <cordon/core/linalg.hpp>
#include <cordon/registry/plugin.hpp>
#include <cordon/solvers/exact_modes.hpp>

namespace {

using namespace cordon;

class MyGain final : public GainDesigner {
 private:
  GainDesign do_design(const Model& model) const override {
    const LinearModel& m = model.linear;
    GainDesign design;
    design.gain.type = "my_gain";
    design.gain.L = m.A * linalg::pseudo_inverse(m.C);
    if (!exact::is_schur(m.A, design.gain.L, m.C)) {  // without rounding
      design.reason = "A - A C⁺ C is not stable";     // unknown: another gain may do
      design.suggestion = "use the gain \"kalman\"";
      return design;
    }
    design.feasible = Answer::yes;
    design.gain.certificate.monotone =
        exact::is_nonnegative(m.A, design.gain.L, m.C) ? Answer::yes : Answer::no;
    return design;
  }
};

std::vector<Diagnostic> problems_of(const GainContext& context, const Params&) {
  if (!context.model.linear.has_ranges()) return {};
  return {{"", "takes effectiveness that is known exactly", "give numbers in place of ranges"}};
}

void register_components(Registrar& registrar) {
  registrar.add(GainEntry{
      {"my_gain", "L = A C⁺", "", {}},
      problems_of,
      [](const Params&) -> std::unique_ptr<GainDesigner> { return std::make_unique<MyGain>(); }});
}

}  // namespace

CORDON_PLUGIN("my_gain", "0.1.0", "GPL-3.0-or-later", "A. Uthor", "a gain of my own",
              register_components)
