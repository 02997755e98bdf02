// SPDX-License-Identifier: GPL-3.0-or-later
// What every reader of results.json looks at first.
#pragma once

#include "study/text/json_cursor.hpp"

namespace cordon::json {

/// Is this a results file of "cordon run", in a version of the format that this program reads?
/// Otherwise the problem is reported.
bool expect_results(const Cursor& root);

/// Are the sets of all steps there? Otherwise the problem is reported.
bool expect_all_sets(const Cursor& root);

}  // namespace cordon::json
