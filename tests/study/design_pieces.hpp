// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of `design_study` that tests exchange.
#pragma once

#include <string>

#include "study/fakes.hpp"

namespace study_test::design_pieces {

inline const std::string designer = "\"designer\": {\"type\": \"given\", \"u\": [[1], [2], [-1]]}";
inline const std::string start =
    "{\"type\": \"box\", \"lower\": [-0.5, 0.75], \"upper\": [0.5, 1.25]}";
inline const std::string data_text =
    "\"data\": {\n\"simulate\": {\n\"seed\": 7,\n\"seeds\": 20,\n\"noise\": \"vertex\",\n\"x0\": " +
    start + "\n}\n},\n";
inline const std::string input = "\"input\": [{\"type\": \"constant\", \"offset\": 1}]";
inline const std::string observer = "\"observer\": \"descriptor\"";

/// The second pipeline has an observer: it needs data.
inline std::string mixed() {
  return exchanged(exchanged(design_study, designer, observer), "\"seed\": 7",
                   "\"seed\": 7, \"steps\": 9, " + input);
}

}  // namespace study_test::design_pieces
