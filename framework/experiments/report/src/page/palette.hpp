// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of pipelines, told apart by readers with any kind of colour vision (after Okabe and Ito).
#pragma once

#include <array>
#include <string_view>

namespace cordon::report {

inline constexpr std::array<std::string_view, 8> on_white = {
    "#0072b2", "#d55e00", "#009e73", "#b5548a", "#d99000", "#4ba3dc", "#6b4c9a", "#8a8000"};
inline constexpr std::array<std::string_view, 8> on_black = {
    "#4fa8e8", "#f0803c", "#2cc59a", "#dd8fb9", "#f0b030", "#8ccdf5", "#a98bd8", "#d6cc3c"};

}  // namespace cordon::report
