// SPDX-License-Identifier: GPL-3.0-or-later
// How results.json and run.json begin, of a run and of a sweep.
#pragma once

#include <string>

#include "cordon/study/study.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::detail {

/// Opens the object, which stays open: versions, title, and the resolved study.
void begin_results_file(JsonWriter& json, const Study& study, const Registry& registry,
                        const std::vector<Measure>& measures);
/// The same: file of the study, host, files of the plugins, warnings.
void begin_run_file(JsonWriter& json, const Study& study, const Registry& registry,
                    const std::string& started);

}  // namespace cordon::detail
