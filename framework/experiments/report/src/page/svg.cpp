// SPDX-License-Identifier: GPL-3.0-or-later
// Figures as SVG files: which drawing is of which kind.
#include "experiments/report/svg.hpp"

#include "page/svg_parts.hpp"

namespace cordon::report {

std::string svg_of(const Figure& figure, const Report& report) {
  struct {
    const Figure& figure;
    const Report& report;
    std::string operator()(const Projection& projection) const {
      return draw(projection, figure, report);
    }
    std::string operator()(const Plot& plot) const { return draw(plot, figure); }
    std::string operator()(const Timeline& timeline) const { return draw(timeline, figure); }
    std::string operator()(const Intervals& intervals) const { return draw(intervals, figure); }
    std::string operator()(const Table& table) const { return draw(table, figure); }
  } const drawer{figure, report};
  return std::visit(drawer, figure.content);
}

}  // namespace cordon::report
