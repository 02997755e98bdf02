// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of `diagnosis_study` that tests exchange.
#pragma once

#include <string>

namespace study_test::diagnosis_pieces {

inline const std::string other_A = "\"A\": [[0.7, 0], [0, 0.8]]";
inline const std::string fault_0 =
    "{\"mode\": \"weak\", \"from\": 3, \"to\": 5, \"actuator\": [0.3, [0.2, 0.5]]}";
inline const std::string fault_1 = "{\"mode\": \"deaf\", \"from\": 6, \"to\": 9}";

}  // namespace study_test::diagnosis_pieces
