// SPDX-License-Identifier: GPL-3.0-or-later
// Errors are for broken contracts; outcomes of a computation (empty, unknown, infeasible) are
// values.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cordon {

/// Reason of an Error, for programs; the text is for people.
enum class Errc {
  dimension,     ///< sizes do not fit together
  not_finite,    ///< NaN or infinity where a number is needed
  invalid,       ///< a value outside its domain (negative radius, unknown parameter, …)
  unsupported,   ///< the operation cannot enclose its result in this representation
  not_enclosed,  ///< values of formulas over a set have no bounded enclosure
  solver,        ///< a solver broke down in a way that leaves no sound answer
  time_limit,    ///< a limit of time was reached before there was an answer
  plugin,        ///< a plugin was refused or broke its contract
  io,            ///< reading or writing failed
  violated,      ///< a component said something that is proven false
  internal       ///< a defect of this program
};

std::string_view to_string(Errc code) noexcept;

/// The exception of every public function of the framework.
class Error : public std::runtime_error {
 public:
  Error(Errc code, const std::string& message) : std::runtime_error(message), code_(code) {}
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;  // defined in the framework: an error thrown by a plugin must be readable
                      // after its library has gone
  Errc code() const noexcept { return code_; }

 private:
  Errc code_;
};

/// One problem of an input file: where, what, and what to do about it.
struct Diagnostic {
  std::string
      pointer;  ///< JSON pointer (RFC 6901) of the offending value; "" is the whole document
  std::string message;     ///< the reason, without the place
  std::string suggestion;  ///< what to do about it; may be empty
  int line = 0;            ///< 1-based line in the file; 0: not known
};

/// An invalid input with all its problems. `what()` is the text that the command line prints.
class InputError : public Error {
 public:
  InputError(std::string file, std::vector<Diagnostic> diagnostics);
  InputError(const InputError&) = default;
  InputError& operator=(const InputError&) = default;
  ~InputError() override;
  const std::string& file() const noexcept { return file_; }
  const std::vector<Diagnostic>& diagnostics() const noexcept { return diagnostics_; }

 private:
  std::string file_;
  std::vector<Diagnostic> diagnostics_;
};

/// The candidate nearest to `word` by edit distance, or "" when none is near (for "did you mean
/// …?").
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// `did you mean "x"?`, or the list of what there is; "" when there is nothing to suggest.
std::string suggest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace cordon
