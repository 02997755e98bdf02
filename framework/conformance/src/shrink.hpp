// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "test_case.hpp"

namespace cordon::conformance {

/// The smallest case near `test` that still fails: coordinates, generators, lines, constraints are
/// dropped and entries become 0, ±1, integers and halves as long as `fails` stays true. Greedy,
/// deterministic, at most `limit` trials.
TestCase shrink(TestCase test, const std::function<bool(const TestCase&)>& fails, Index limit);

}  // namespace cordon::conformance
