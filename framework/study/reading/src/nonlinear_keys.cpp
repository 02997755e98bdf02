// SPDX-License-Identifier: GPL-3.0-or-later
#include "nonlinear_keys.hpp"

#include <string>
#include <vector>

namespace cordon::json {

namespace {

using KeyList = std::vector<std::string>;

/// What is written of formulas; a plant brings them.
const KeyList written_keys{"states", "inputs", "disturbances", "noises", "parameters",
                           "f",      "g",      "invariants"};
const KeyList other_keys{"type", "plant", "admissible", "domain", "X0",           "W",
                         "V",    "U",     "nominal",    "names",  "sampling_time"};
const KeyList matrix_keys{"A", "B", "C", "D", "E", "F", "Bw", "Dv"};

}  // namespace

void expect_nonlinear_keys(const Cursor& system) {
  for (const std::string& key : matrix_keys) {
    if (const auto at = system.find(key)) {
      at->error("is a matrix of linear systems, and this one is \"nonlinear\"",
                "remove it, and write formulas in f and g");
    }
  }
  if (const auto at = system.find("plant") ? system.find("modes") : std::nullopt)
    at->error("cannot stand beside \"plant\", whose formulas have no names",
              "remove one of the two");
  if (const auto at = system.find("continuous"))
    at->error("formulas are those of the next time, x_{k+1} = f(x_k, w_k, u_k)",
              "write the step into f, as in \"x1 + dt*(...)\"");
  for (const std::string& key : written_keys) {
    const auto at = system.find("plant") ? system.find(key) : std::nullopt;
    if (!at) continue;
    at->error("cannot stand beside \"plant\", which brings its formulas",
              "remove one of the two; W is added to the next state, V to the outputs");
  }
  KeyList all = other_keys;
  for (const KeyList* more : {&written_keys, &matrix_keys})
    all.insert(all.end(), more->begin(), more->end());
  all.insert(all.end(), {"modes", "continuous", "disturbance"});
  system.expect_keys(all, "key of a nonlinear system", "");
}

}  // namespace cordon::json
