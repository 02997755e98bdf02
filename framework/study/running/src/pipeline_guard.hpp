// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <new>
#include <system_error>

#include "cordon/study/run.hpp"

namespace cordon::detail {

/// Ends a pipeline, or its design, with an error; the first one is kept.
template <class Outcome>
void stop(Outcome& outcome, Errc code, const std::string& message) {
  if (!outcome.error.empty()) return;
  outcome.error_code = code;
  outcome.error = message.empty() ? std::string(to_string(code)) : message;
}

/// Runs code of components: what it throws stops this pipeline and no other. What the machine does
/// not give (memory, a thread) is no fault of a component: it is thrown on, and ends the run.
template <class Outcome, class Work>
void guarded(Outcome& outcome, Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    stop(outcome, error.code(), error.what());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again) throw;
    stop(outcome, Errc::plugin, error.what());
  } catch (const std::exception& error) {
    stop(outcome, Errc::plugin, error.what());
  } catch (...) {
    stop(outcome, Errc::plugin, "an exception of unknown type");
  }
}

}  // namespace cordon::detail
