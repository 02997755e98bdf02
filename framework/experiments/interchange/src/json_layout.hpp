// SPDX-License-Identifier: GPL-3.0-or-later
// JSON for people to go on with.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "cordon/core/types.hpp"

namespace cordon::json {

using Json = nlohmann::ordered_json;

/// Values that fit into a line of about 120 characters stand on one; rows of numbers always do.
/// Ends with a line break.
std::string pretty(const Json& value);

/// A number as it is written in studies: 3, not 3.0. Infinite ones are "inf" and "-inf".
Json to_json(double x);
Json to_json(MatrixIn A);    ///< a list of rows
Json to_sparse(MatrixIn A);  ///< {"rows", "cols", "entries"}, counted from 1

}  // namespace cordon::json
