// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of studies that commands write.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "cordon/study/study.hpp"

namespace cordon::apps {

nlohmann::ordered_json list_of(VectorIn x);
nlohmann::ordered_json rows_of(MatrixIn A);
/// A box where it is one, its bounds rounded outward; else the type of its blocks.
nlohmann::ordered_json set_of(const LineForm& set);
/// Lower and upper bounds as they are, infinite ones as texts.
nlohmann::ordered_json bounds_of(const Box& box);

/// Names recorded data from where the study is written.
void name_data_from(const std::filesystem::path& file, const Study& study,
                    nlohmann::ordered_json& json);

}  // namespace cordon::apps
