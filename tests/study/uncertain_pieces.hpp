// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of `uncertain_study` that tests exchange.
#pragma once

#include <string>

namespace study_test::uncertain_pieces {

inline const std::string A =
    "{\"center\": [[0.5, 0.25], [0, 0.75]], \"radius\": [[0.125, 0], [0, 0.0625]]}";
inline const std::string A_radius = "\"radius\": [[0.125, 0], [0, 0.0625]]";
inline const std::string B = "{\"lower\": [[0.9], [1]], \"upper\": [[1.1], [1]]}";
inline const std::string C = "\"C\": [[1, 0], [0, 1]]", F = "\"F\": [[1, 0.5], [0, 2]]";
inline const std::string fault_0 =
    "{\"fault\": 2, \"from\": 3, \"to\": 9, \"signal\": {\"type\": \"sine\", \"amplitude\": 1, "
    "\"omega\": 0.5}}";
inline const std::string fault_1 =
    "{\"fault\": 1, \"signal\": {\"type\": \"table\", \"values\": [0, 0.5, 0]}}";
inline const std::string constant = "\"signal\": {\"type\": \"constant\", \"offset\": 1}}";

}  // namespace study_test::uncertain_pieces
