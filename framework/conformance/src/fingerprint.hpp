// SPDX-License-Identifier: GPL-3.0-or-later
// A run of all operations, and sets as text to the last bit.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "law.hpp"

namespace cordon::conformance {

/// Everything that a set says about itself.
std::string fingerprint(const Set& X);
std::string fingerprint(const std::optional<Enclosure>& X);

using Run = std::function<Enclosure()>;
/// Every operation on X and Y (of one dimension), with the first matrix and vector of the case.
std::vector<std::pair<std::string, Run>> program(const SetBackend& backend, const Enclosure& X,
                                                 const Enclosure& Y, const TestCase& test);

/// The result, or nothing where the backend refuses (Errc::unsupported, Errc::solver).
std::optional<Enclosure> attempt_operation(const Run& run);

}  // namespace cordon::conformance
