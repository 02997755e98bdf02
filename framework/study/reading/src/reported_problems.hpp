// SPDX-License-Identifier: GPL-3.0-or-later
// Problems that components find, told at their place in the study.
#pragma once

#include "study/reading/read_parts.hpp"

namespace cordon::json {

/// At the value that the relative pointer of the problem leads to, or the last one on the way.
void report(const Cursor& at, const Diagnostic& relative);

/// What making or asking a component threw becomes a problem of its place: of the installation if
/// the plugin is at fault.
inline void report_failure(const Cursor& at, const Error& error, const ComponentContext& context) {
  if (error.code() == Errc::plugin) {
    context.refusals.push_back(
        {at.pointer(), error.what(), "report this to the author of the plugin", at.value().line});
  } else {
    at.error(error.what(), "");
  }
}

/// Asks a component what it says to its pipeline, and reports it at its place.
template <class Ask>
void ask(const Cursor& at, const ComponentContext& context, Ask&& check) {
  try {
    for (const Diagnostic& problem : check()) report(at, problem);
  } catch (const InputError& error) {  // of a nested component
    for (const Diagnostic& problem : error.diagnostics()) report(at, problem);
  } catch (const Error& error) {
    report_failure(at, error, context);
  }
}

}  // namespace cordon::json
