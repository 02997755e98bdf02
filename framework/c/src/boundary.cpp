// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary.hpp"

#include <new>

#include "cordon/registry/build.hpp"

namespace cordon::c {

namespace {

struct LastError {
  int code = CORDON_OK;
  std::string text;
  const char* fixed = nullptr;  ///< in place of `text`, where there was no memory for one
  std::vector<Diagnostic> problems;
};
thread_local LastError last;

int code_of(Errc code) {
  switch (code) {
    case Errc::dimension:
      return CORDON_DIMENSION;
    case Errc::not_finite:
      return CORDON_NOT_FINITE;
    case Errc::invalid:
      return CORDON_INVALID;
    case Errc::unsupported:
      return CORDON_UNSUPPORTED;
    case Errc::not_enclosed:
      return CORDON_NOT_ENCLOSED;
    case Errc::solver:
      return CORDON_SOLVER;
    case Errc::time_limit:
      return CORDON_TIME_LIMIT;
    case Errc::plugin:
      return CORDON_PLUGIN;
    case Errc::io:
      return CORDON_IO;
    case Errc::violated:
      return CORDON_VIOLATED;
    case Errc::internal:
      return CORDON_INTERNAL;
  }
  return CORDON_INTERNAL;
}

int keep_fixed(int code, const char* text) {
  last.code = code;
  last.fixed = text;
  last.problems.clear();
  return code;
}

int keep(int code, const char* function, const char* what,
         const std::vector<Diagnostic>& problems = {}) {
  last.text = std::string(function) + ": " + what;
  last.problems = problems;
  last.fixed = nullptr;
  return last.code = code;
}

/// Throws std::bad_alloc where there is no memory for the text.
int sorted(const char* function) {
  try {
    throw;
  } catch (const NullArgument& argument) {
    return keep(CORDON_NULL, function, (std::string(argument.what) + " is NULL").c_str());
  } catch (const InputError& error) {
    return keep(code_of(error.code()), function, error.what(), error.diagnostics());
  } catch (const Error& error) {
    return keep(code_of(error.code()), function, error.what());
  } catch (const std::bad_alloc&) {
    return keep_fixed(CORDON_NO_MEMORY, "there is not enough memory");
  } catch (const std::exception& error) {
    return keep(CORDON_INTERNAL, function, error.what());
  } catch (...) {
    return keep(CORDON_INTERNAL, function, "an exception of an unknown type");
  }
}

const Diagnostic* problem(int i) {
  const bool there = i >= 0 && static_cast<std::size_t>(i) < last.problems.size();
  return there ? &last.problems[static_cast<std::size_t>(i)] : nullptr;
}

}  // namespace

int keep_error(const char* function) noexcept {
  try {
    return sorted(function);
  } catch (...) {
    return keep_fixed(CORDON_NO_MEMORY, "there is not enough memory to say what is wrong");
  }
}

}  // namespace cordon::c

using namespace cordon;

extern "C" {

int cordon_abi_version(void) { return CORDON_C_ABI_VERSION; }

const char* cordon_version(void) {
  return c::got(__func__, "", [] {
    static const std::string version = build_info().version;
    return version.c_str();
  });
}

int cordon_last_code(void) { return c::last.code; }
const char* cordon_last_error(void) { return c::last.fixed ? c::last.fixed : c::last.text.c_str(); }
int cordon_problem_count(void) { return c::count_of(c::last.problems); }

const char* cordon_problem_place(int i) {
  const Diagnostic* const problem = c::problem(i);
  return problem ? problem->pointer.c_str() : "";
}
int cordon_problem_line(int i) {
  const Diagnostic* const problem = c::problem(i);
  return problem ? problem->line : CORDON_REFUSED;
}
const char* cordon_problem_message(int i) {
  const Diagnostic* const problem = c::problem(i);
  return problem ? problem->message.c_str() : "";
}
const char* cordon_problem_suggestion(int i) {
  const Diagnostic* const problem = c::problem(i);
  return problem ? problem->suggestion.c_str() : "";
}

}  // extern "C"
