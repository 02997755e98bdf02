// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas as results keep them: their nodes, exactly, so that a finished run is checked without
// the plugin whose plant they are.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cordon/formulas/function.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::json {

/// Writes {"nodes": [[operation, ...], ...], "rows": [...]}: a node is ["variable", number],
/// ["constant", lower, upper], ["power", a, exponent], ["real_power", a, lower, upper], or an
/// operation with its one or two operands; operands and rows are numbers of nodes, from 0 on.
void write_graph(const formulas::Function& function, detail::JsonWriter& json);

/// The function that was written, over these variables, with derivatives of order 2 by the first
/// `differentiated` ones. Null: the first thing that is wrong was reported.
std::shared_ptr<const formulas::Function> read_graph(const Cursor& at,
                                                     std::vector<std::string> variables,
                                                     Index differentiated);

}  // namespace cordon::json
