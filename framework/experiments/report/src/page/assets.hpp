// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a page is made of; they become a part of the library when it is built.
#pragma once

#include <string_view>

namespace cordon::report::page {

struct Asset {
  std::string_view text;
  std::string_view sha256;  ///< hexadecimal
};

extern const Asset report_html, report_css, chart_licence, chart_js, parts_js, plot_js,
    projection_js, report_js;

}  // namespace cordon::report::page
