// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_bar.hpp"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "core/text.hpp"

namespace cordon::apps {

namespace {

std::string duration(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string bar_of(double fraction) {
  const auto filled = static_cast<std::size_t>(30 * fraction);
  return fmt::format("[{}] {:3.0f} %", std::string(filled, '#') + std::string(30 - filled, ' '),
                     100 * fraction);
}

}  // namespace

std::string progress_line(const SweepProgress& progress) {
  const double fraction =
      progress.total > 0 ? static_cast<double>(progress.done) / static_cast<double>(progress.total)
                         : 1;
  std::string line =
      fmt::format("{}  {}/{} points", bar_of(fraction), progress.done, progress.total);
  if (progress.failed > 0) line += fmt::format("  {} failed", progress.failed);
  const std::int64_t done_here = progress.done - progress.resumed,
                     left = progress.total - progress.done;
  if (done_here <= 0) return line;
  return line + fmt::format("  {} left", duration(progress.elapsed_s * static_cast<double>(left) /
                                                  static_cast<double>(done_here)));
}

std::string progress_line(const std::string& name, double fraction, std::int64_t done,
                          std::int64_t total, double elapsed_s) {
  const std::string shown = fmt::format("{:.20}", detail::printable(name));
  if (total <= 0) return fmt::format("{}  {}", shown, done);
  const std::string left =
      fraction > 0 ? duration(elapsed_s * (1 - fraction) / fraction) + " left" : "";
  return fmt::format("{}  {}  {}/{}  {}", bar_of(fraction), shown, done, total, left);
}

ProgressBar::ProgressBar(std::vector<std::string> pipelines, bool visible)
    : pipelines_(std::move(pipelines)),
      visible_(visible),
      begin_(Clock::now()),
      drawn_at_(begin_) {}

void ProgressBar::show(std::size_t pipeline, std::int64_t done, std::int64_t total) {
  if (pipeline >= pipelines_.size() || !is_due()) return;
  const double part = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 0;
  const double fraction =
      (static_cast<double>(pipeline) + part) / static_cast<double>(pipelines_.size());
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  draw(progress_line(pipelines_[pipeline], fraction, done, total, elapsed));
}

void ProgressBar::show(const std::string& line) {
  if (is_due()) draw(line);
}

bool ProgressBar::is_due() {
  const Clock::time_point now = Clock::now();
  if (!visible_ || now - begin_ < std::chrono::seconds(1) ||
      now - drawn_at_ < std::chrono::milliseconds(100))
    return false;
  drawn_at_ = now;
  return true;
}

void ProgressBar::draw(const std::string& line) {
  std::fputs(("\r\x1b[K" + line).c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace cordon::apps
