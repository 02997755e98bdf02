// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the sample reports, and every figure as SVG: report_samples DIRECTORY
#include <filesystem>
#include <fstream>
#include <iostream>

#include "experiments/report/page.hpp"
#include "experiments/report/svg.hpp"
#include "report/sample_reports.hpp"

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
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
  for (const auto& report : {every, far}) {
    for (const auto& figure : report.figures)
      write(out / (figure.id + ".svg"), svg_of(figure, report));
  }
}
