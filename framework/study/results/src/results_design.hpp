// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cordon/core/types.hpp"
#include "cordon/study/labels.hpp"
#include "study/text/sink.hpp"

namespace cordon::detail {

/// Columns of summary.csv that tell of designers, in studies that have some.
const std::vector<std::string>& design_summary_columns();

/// The first row of inputs.csv.
void write_inputs_header(Sink& file, Index inputs, const Labels& labels);

}  // namespace cordon::detail
