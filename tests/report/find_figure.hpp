// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <doctest/doctest.h>

#include "experiments/report/figure.hpp"

inline const cordon::report::Figure* find_figure(const cordon::report::Report& report,
                                                 const std::string& id) {
  for (const cordon::report::Figure& figure : report.figures) {
    if (figure.id == id) return &figure;
  }
  return nullptr;
}

/// What a figure shows; the test fails if there is none.
template <class Content>
Content content(const cordon::report::Report& report, const std::string& id) {
  const cordon::report::Figure* figure = find_figure(report, id);
  CAPTURE(id);
  REQUIRE(figure);
  return std::get<Content>(figure->content);
}
