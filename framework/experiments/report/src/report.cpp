// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/experiments/report.hpp"

#include <algorithm>
#include <optional>

#include "cordon/core/error.hpp"
#include "experiments/report/figure_csv.hpp"
#include "experiments/report/page.hpp"
#include "experiments/report/pdf.hpp"
#include "experiments/report/read_report.hpp"
#include "experiments/report/svg.hpp"
#include "study/text/atomic_directory.hpp"

namespace cordon {

namespace {

using Files = std::vector<std::filesystem::path>;

void commit(detail::AtomicDirectory& directory, Files& files) {
  for (std::filesystem::path& file : directory.commit()) files.push_back(std::move(file));
}

/// Figures of earlier results: drawings and tables that are none of this report.
void remove_others(const std::filesystem::path& directory, const report::Report& report) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  Files others;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::string name = entry.path().stem().string(), kind = entry.path().extension().string();
    if (!entry.is_regular_file() || (kind != ".svg" && kind != ".pdf" && kind != ".csv") ||
        !std::all_of(name.begin(), name.end(), plain))
      continue;
    const auto is_it = [&](const report::Figure& figure) { return figure.id == name; };
    if (std::none_of(report.figures.begin(), report.figures.end(), is_it))
      others.push_back(entry.path());
  }
  for (const std::filesystem::path& file : others) std::filesystem::remove(file);
}

}  // namespace

namespace {

Files write_figures(const std::filesystem::path& directory, const ReportOptions& options) {
  Files files;
  // Others' figures go from that folder: a link in its place could lead to files that are none of
  // this program's.
  if ((options.svg || options.pdf || options.csv) &&
      std::filesystem::is_symlink(directory / "figures")) {
    throw InputError((directory / "figures").string(),
                     {{"", "is a symbolic link", "remove the link"}});
  }
  if (options.html || options.svg || options.pdf) {
    const report::Report page = report::read_report(directory);
    if (options.html) {
      detail::AtomicDirectory out(directory);
      out.create("report.html").write(report::page_of(page));
      commit(out, files);
    }
    if (options.svg || options.pdf) {
      detail::AtomicDirectory out(directory / "figures");
      std::optional<report::PdfConverter> converter;
      if (options.pdf) converter.emplace();
      for (const report::Figure& figure : page.figures) {
        const std::string svg = report::svg_of(figure, page);
        if (options.svg) out.create(figure.id + ".svg").write(svg);
        if (options.pdf) out.create(figure.id + ".pdf").write(converter->pdf_of(svg));
      }
      commit(out, files);
      remove_others(directory / "figures", page);
    }
  }
  if (options.csv) {
    const report::Report all = report::read_report(directory, report::Detail::all);
    detail::AtomicDirectory out(directory / "figures");
    for (const report::Figure& figure : all.figures)
      out.create(figure.id + ".csv").write(report::csv_of(figure, all));
    commit(out, files);
    remove_others(directory / "figures", all);
  }
  return files;
}

}  // namespace

Files write_report(const std::filesystem::path& directory, const ReportOptions& options) {
  std::error_code failed;
  if (!std::filesystem::is_directory(directory, failed)) {
    throw InputError(directory.string(),
                     {{"", "is no directory",
                       "name the directory that \"cordon run\" wrote its results to", 0}});
  }
  const detail::DirectoryLock lock(directory);
  return write_figures(directory, options);
}

std::string add_report(const std::filesystem::path& directory,
                       std::vector<std::filesystem::path>& files) noexcept {
  try {
    for (std::filesystem::path& file : write_figures(directory, {}))
      files.push_back(std::move(file));
    return "";
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception of unknown type";
  }
}

std::string svg_of(const Curve& curve) {
  report::Plot plot;
  plot.x_label = curve.x_label;
  plot.y_label = curve.y_label;
  for (const auto kind : {report::Series::Kind::line, report::Series::Kind::points})
    plot.series.push_back({kind, "", report::of_data, curve.x, curve.y});
  report::Report report;
  report.title = curve.title;
  return report::svg_of({"curve", "", curve.title, "", std::move(plot)}, report);
}

}  // namespace cordon
