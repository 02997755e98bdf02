// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the sample reports, every figure as SVG, and what axes show: report_samples DIRECTORY
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <nlohmann/json.hpp>

#include "experiments/report/page.hpp"
#include "experiments/report/svg.hpp"
#include "experiments/report/ticks.hpp"
#include "report/sample_reports.hpp"

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

/// Ticks and texts of many axes: the page makes its own, which must be the same.
std::string axes() {
  using namespace cordon::report;
  nlohmann::json all = nlohmann::json::array();
  for (const double span : {1e-9, 3e-4, .7, 1., 6.3, 20., 99., 12345., 8e8}) {
    for (const double lower : {0., -.31 * span, 2.5 * span, -40 * span, 1e3 * span, 1e7}) {
      const double upper = lower + span;
      if (!(upper > lower)) continue;
      nlohmann::json axis{
          {"lower", lower}, {"upper", upper}, {"digits", digits_within(lower, upper)}};
      for (const int count : {3, 6, 9})
        axis["ticks"].push_back({count, nice_ticks(lower, upper, count),
                                 nice_ticks(lower, upper, count, true),
                                 upright_ticks(lower, upper, count)});
      for (const double tick : nice_ticks(lower, upper, 6))
        axis["texts"].push_back(
            {tick, short_text(tick, digits_within(lower, upper)), short_text(tick / 3)});
      if (lower > 0) {
        axis["log_ticks"] = log_ticks(lower, upper);
        for (const double tick : log_ticks(lower, upper))
          axis["log_texts"].push_back({tick, log_text(tick, has_powers(lower, upper))});
      }
      all.push_back(std::move(axis));
    }
  }
  for (int decades = 1; decades < 40; decades += 3) {
    const double lower = std::pow(10., -decades / 2) * 1.7, upper = lower * std::pow(10., decades);
    all.push_back({{"lower", lower}, {"upper", upper}, {"log_ticks", log_ticks(lower, upper)}});
  }
  return all.dump();
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "report_samples DIRECTORY\n";
    return 2;
  }
  const std::filesystem::path out = arguments[1];
  std::filesystem::create_directories(out);
  const auto every = sample::every_kind();
  write(out / "every_kind.html", page_of(every));
  write(out / "hostile.html", page_of(sample::with_names(sample::hostile)));
  write(out / "large.html", page_of(sample::large()));
  const auto far = sample::far_from_origin();
  write(out / "far.html", page_of(far));
  write(out / "axes.json", axes());
  for (const auto& report : {every, far}) {
    for (const auto& figure : report.figures)
      write(out / (figure.id + ".svg"), svg_of(figure, report));
  }
}
