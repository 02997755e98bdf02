// SPDX-License-Identifier: GPL-3.0-or-later
// A study of linear models that are proven in a region.
#pragma once

#include <filesystem>
#include <vector>

#include "cordon/linearisation/linearise.hpp"
#include "cordon/study/study.hpp"

namespace cordon::apps {

/// The study with `linear`, of the nominal mode and then the others, in place of its formulas,
/// which make the data where they are simulated. Of its pipelines the backends stay, each with a
/// linear observer, and a bank of them where there are modes; a sweep is left out. The file must be
/// a new one.
void write_linearised(const Study& study, const std::vector<Linearised>& linear,
                      const std::filesystem::path& file);

}  // namespace cordon::apps
