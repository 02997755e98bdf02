// SPDX-License-Identifier: GPL-3.0-or-later
// Components of a registry, made for a case: with the backend that the case draws, and parameters
// that are completed and varied.
#pragma once

#include <memory>
#include <string>

#include "cordon/registry/registry.hpp"
#include "law.hpp"
#include "systems.hpp"

namespace cordon::conformance {

/// A backend of the project, of those that the registry has, with a way of rounding; drawn by the
/// case's seed.
struct DrawnBackend {
  std::shared_ptr<const SetBackend> backend;
  std::string text;
};
DrawnBackend backend_for(const Context& context, const TestCase& test);

/// The parameters as text, for witnesses.
std::string describe(const Params& params);

/// Parameters for the subject: those that are given; those that it requires and that have no
/// default, found by trial; in a third of the cases other choices, flags and small integers.
class ParameterDraw {
 public:
  ParameterDraw(const Context& context, const TestCase& test, const ParamSchema& schema);
  /// The one that `accepts` finds no problems in. Throws Errc::unsupported with a problem.
  Params find(const std::function<std::vector<Diagnostic>(const Params&)>& accepts);

 private:
  bool fill(Params& params, Index attempt) const;
  Params varied(const Params& params);

  const Context& context_;
  const TestCase& test_;
  const ParamSchema& schema_;
  Random random_;
};

/// A component of the subject's kind, with what it was made of.
template <class Entry>
struct MadeFor {
  std::shared_ptr<typename Entry::Made> component;
  Params params;
};
template <class Entry, class EntryContext>
MadeFor<Entry> make_for(const Context& context, const TestCase& test,
                        const EntryContext& made_for) {
  const Registry& registry = context.registry();
  const std::string& name = context.subject.component;
  ParameterDraw draw(context, test, registry.info(Entry::kind, name)->schema);
  MadeFor<Entry> made;
  made.params = draw.find(
      [&](const Params& params) { return registry.check<Entry>(name, made_for, params); });
  made.component = registry.make<Entry>(name, made_for, made.params);
  return made;
}

}  // namespace cordon::conformance
