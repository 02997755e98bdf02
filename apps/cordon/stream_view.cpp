// SPDX-License-Identifier: GPL-3.0-or-later
#include "stream_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "core/text.hpp"
#include "stream_lines.hpp"

namespace cordon::apps {

namespace {

constexpr auto between_pictures = std::chrono::milliseconds(100);
constexpr auto silent_from = std::chrono::seconds(2);
constexpr std::size_t most_named = 24, least_bar = 8, most_bar = 30;

/// The first characters of a line, so that it does not run over to the next one.
std::string cut(const std::string& text, std::size_t columns) {
  std::size_t at = 0;
  for (std::size_t shown = 0; at < text.size() && shown < columns; ++shown)
    at += std::max<std::size_t>(1, detail::utf8_length(std::string_view(text).substr(at)));
  return text.substr(0, at);
}

std::size_t width_of(const std::string& text) {
  std::size_t width = 0;
  for (std::size_t at = 0; at < text.size(); ++width)
    at += std::max<std::size_t>(1, detail::utf8_length(std::string_view(text).substr(at)));
  return width;
}

std::string padded(const std::string& text, std::size_t width) {
  const std::string shown = cut(text, width);
  return shown + std::string(width - std::min(width, width_of(shown)), ' ');
}

/// A text over as many lines as it needs, broken at spaces; the later ones are indented.
std::vector<std::string> lines_of(const std::string& text, std::size_t columns) {
  constexpr std::size_t indent = 2;
  std::vector<std::string> lines(1);
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, end - from);
    const std::size_t width = width_of(lines.back());
    if (width > indent && width + 1 + width_of(word) > columns) lines.emplace_back(indent, ' ');
    if (width_of(lines.back()) > indent || (lines.size() == 1 && !lines.back().empty()))
      lines.back() += ' ';
    lines.back() += word;
    from = end + 1;
  }
  return lines;
}

bool is_standing_out(const Alarm& alarm) { return alarm.is_active && !alarm.acknowledged; }

}  // namespace

std::optional<TerminalSize> terminal_size() {
  const char* const kind = std::getenv("TERM");
  if (isatty(STDOUT_FILENO) != 1 || (kind && std::string_view(kind) == "dumb")) return std::nullopt;
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 || size.ws_col == 0)
    return TerminalSize{};
  return TerminalSize{size.ws_row, size.ws_col};
}

StreamView::StreamView(const Study& study, const OnlineSession& session,
                       std::optional<TerminalSize> terminal)
    : title_(detail::printable(study.title + ": " + session.session().name())),
      labels_(study.labels),
      session_(session),
      terminal_(terminal),
      paint_(stdout) {}

std::string StreamView::show(const Taken& taken) {
  std::string lines;
  const auto tell = [&](const std::string& text) {
    if (!terminal_) lines += text + "\n";
  };
  taken_at_ = std::chrono::steady_clock::now();
  if (taken.how != Taken::How::taken) tell(taken.said);
  for (const TakenStep& step : taken.steps) {
    k_ = step.k;
    left_open_ += step.left_open;
    if (step.estimate && step.estimate->is_last) {
      if (!step.estimate->hull.is_empty()) take_hull(step.estimate->hull);
      is_empty_ = step.estimate->estimate.consistent == Answer::no;
    }
    if (step.diagnosis) take_diagnosis(*step.diagnosis);
    tell(text_of(step));
    lines += show(step.alarms);
  }
  return terminal_ ? drawn_if_due() : lines;
}

std::string StreamView::show(const std::vector<AlarmChange>& changes) {
  std::string lines;
  for (const AlarmChange& change : changes) {
    news_ = fmt::format("alarm {} at {}", to_string(change.what), time_text(labels_, change.k));
    if (!terminal_) lines += text_of(change) + "\n";
  }
  is_stale_ = is_stale_ || !changes.empty();
  return lines;
}

std::string StreamView::show(const Error& error, std::int64_t line) {
  ++refused_;
  news_ = fmt::format("line {} is refused: {}", line, detail::printable(error_text(error)));
  return terminal_ ? drawn_if_due() : news_ + "\n";
}

std::string StreamView::begin_anew() {
  hull_ = {};
  diagnosis_.reset();
  excluded_.clear();
  is_empty_ = false;
  news_ = "begun anew";
  return terminal_ ? "" : news_ + "\n";
}

std::string StreamView::idle() {
  if (!terminal_) return "";
  if (is_stale_) return drawn_if_due();
  const auto now = std::chrono::steady_clock::now();
  if (!is_silent() || (height_ > 0 && now - drawn_at_ < std::chrono::seconds(1))) return "";
  drawn_at_ = now;
  return drawn();
}

bool StreamView::is_silent() const {
  return std::chrono::steady_clock::now() - taken_at_ >= silent_from;
}

std::string StreamView::last() { return terminal_ && k_ >= 0 ? drawn() : ""; }

std::string StreamView::text_of(const TakenStep& step) const {
  std::string text = time_text(labels_, step.k);
  if (const auto& found = step.diagnosis) {
    const Diagnosis& diagnosis = found->diagnosis;
    text += fmt::format("  {}", to_string(diagnosis.decision));
    const auto& names = session_.session().modes();
    for (std::size_t j = 0; j < names.size(); ++j) {
      const bool is_it = diagnosis.mode == static_cast<Index>(j);
      if (diagnosis.mode < 0 ? diagnosis.modes[j].candidate : is_it)
        text += "  " + detail::printable(names[j]);
    }
  } else if (!step.estimate->is_last) {
    text += "  no estimate yet";
  } else if (step.estimate->estimate.consistent == Answer::no) {
    text += "  proven empty";
  } else {
    const Box& hull = step.estimate->hull;
    for (Index i = 0; i < hull.dim(); ++i)
      text +=
          fmt::format("  {} [{:.4g}, {:.4g}]", detail::printable(label_of(labels_.states, "x", i)),
                      hull.lower[i], hull.upper[i]);
  }
  return step.left_open ? text + "  (questions left open)" : text;
}

std::string StreamView::text_of(const AlarmChange& change) const {
  return fmt::format("alarm {} at {}: {}", to_string(change.what), time_text(labels_, change.k),
                     detail::printable(change.alarm.text));
}

/// Where the interval lies among all bounds so far, between the ends of these.
std::string StreamView::bar(Index i, std::size_t width) const {
  const double from = seen_.lower[i], all = seen_.upper[i] / 2 - from / 2;
  const auto at = [&](double x) {
    const double share = all > 0 ? (x / 2 - from / 2) / all : 0.5;
    const double kept = std::isnan(share) ? 0.5 : std::clamp(share, 0.0, 1.0);
    return static_cast<std::size_t>(kept * static_cast<double>(width - 1));
  };
  std::string text(width, ' ');
  const std::size_t first = at(hull_.lower[i]), end = std::max(at(hull_.upper[i]), first);
  for (std::size_t j = first; j <= end; ++j) text[j] = '#';
  return fmt::format("  {:>9.4g} |{}| {:.4g}", from, text, seen_.upper[i]);
}

void StreamView::take_hull(Box hull) {
  hull_ = std::move(hull);
  const Index n = hull_.dim();
  if (seen_.dim() != n) seen_ = {Vector::Constant(n, HUGE_VAL), Vector::Constant(n, -HUGE_VAL)};
  for (Index i = 0; i < n; ++i) {
    for (const double bound : {hull_.lower[i], hull_.upper[i]}) {
      if (!std::isfinite(bound)) continue;
      seen_.lower[i] = std::min(seen_.lower[i], bound);
      seen_.upper[i] = std::max(seen_.upper[i], bound);
    }
  }
}

StreamView::Lines StreamView::bounds() {
  if (is_empty_) return {{"proven empty: no state explains the samples", Look::alarm}};
  if (diagnosis_ && diagnosis_->estimate) {
    try {
      take_hull(diagnosis_->estimate->set->interval_hull());
    } catch (const Error&) {  // there is no picture of it
    }
  }
  std::vector<std::string> names;
  std::size_t widest = 0;
  for (Index i = 0; i < hull_.dim(); ++i) {
    names.push_back(detail::printable(label_of(labels_.states, "x", i)));
    widest = std::min(std::max(widest, width_of(names.back())), most_named);
  }
  constexpr std::size_t numbers = 2 + 10 + 2 + 10 + 1, ends = 2 + 9 + 3 + 2 + 9;
  const std::size_t used = widest + numbers + ends + 1,
                    room = terminal_->columns > used ? terminal_->columns - used : 0;
  Lines lines;
  for (std::size_t j = 0; j < names.size(); ++j) {
    const auto i = static_cast<Index>(j);
    std::string text = fmt::format("{} [{:>10.4g}, {:>10.4g}]", padded(names[j], widest),
                                   hull_.lower[i], hull_.upper[i]);
    if (room >= least_bar && seen_.lower[i] <= seen_.upper[i])
      text += bar(i, std::min(room, most_bar));
    lines.push_back({text});
  }
  return lines;
}

/// A mode stays excluded until it is possible again; what is not possible otherwise, as beside a
/// mode that was assumed at the start, was not looked at.
void StreamView::take_diagnosis(const DiagnosisStep& step) {
  diagnosis_ = step.diagnosis;
  excluded_.resize(diagnosis_->modes.size());
  for (const DiagnosisEvent& event : step.events) {
    const bool excludes = event.what == DiagnosisEvent::Kind::excluded ||
                          event.what == DiagnosisEvent::Kind::detected;
    const auto mode = static_cast<std::size_t>(event.mode);
    if (excludes && event.mode >= 0 && mode < excluded_.size()) excluded_[mode] = true;
  }
  for (std::size_t j = 0; j < excluded_.size(); ++j) {
    if (diagnosis_->modes[j].consistent == Answer::no) excluded_[j] = true;
    if (diagnosis_->modes[j].candidate) excluded_[j] = false;
  }
}

StreamView::Lines StreamView::modes() const {
  if (!diagnosis_) return {};
  Lines lines;
  const auto& names = session_.session().modes();
  for (std::size_t j = 0; j < names.size(); ++j) {
    const bool is_it = diagnosis_->mode == static_cast<Index>(j),
               is_possible = diagnosis_->modes[j].candidate;
    const char* const said = is_it          ? "monitored"
                             : is_possible  ? "possible"
                             : excluded_[j] ? "excluded"
                                            : "not looked at";
    lines.push_back(
        {padded(detail::printable(names[j]), most_named) + " " + said, !is_it   ? Look::plain
                                                                       : j == 0 ? Look::good
                                                                                : Look::warning});
  }
  if (diagnosis_->decision == Decision::unknown_fault)
    lines.push_back({"a fault that the bank does not have", Look::alarm});
  return lines;
}

StreamView::Lines StreamView::folded(const std::string& text, Look look) const {
  Lines lines;
  for (const std::string& line : lines_of(text, terminal_->columns - 1))
    lines.push_back({line, look});
  return lines;
}

StreamView::Lines StreamView::alarms() const {
  if (session_.alarms().empty()) return {{"no alarm stands", Look::good}};
  Lines lines;
  for (const Alarm& alarm : session_.alarms()) {
    const char* const state = is_standing_out(alarm) ? "ALARM"
                              : alarm.is_active      ? "acknowledged"
                                                     : "passed, not acknowledged";
    const Lines more =
        folded(fmt::format("{}, raised at {}: {}", state, time_text(labels_, alarm.raised_at),
                           detail::printable(alarm.text)),
               is_standing_out(alarm) ? Look::alarm : Look::warning);
    lines.insert(lines.end(), more.begin(), more.end());
  }
  return lines;
}

std::string StreamView::counts() const {
  const TakenCounts& taken = session_.counts();
  std::string text = count(taken.taken + taken.filled, "sample") + counts_text(taken, refused_);
  if (left_open_ > 0) text += fmt::format(", {} with questions left open", left_open_);
  return text;
}

std::string StreamView::drawn_if_due() {
  const auto now = std::chrono::steady_clock::now();
  is_stale_ = height_ > 0 && now - drawn_at_ < between_pictures;
  if (is_stale_) return "";
  drawn_at_ = now;
  terminal_ = terminal_size().value_or(*terminal_);
  return drawn();
}

std::string StreamView::painted(const Line& line) const {
  const std::string text = cut(line.text, terminal_->columns - 1);
  switch (line.look) {
    case Look::bold:
      return paint_.bold(text);
    case Look::good:
      return paint_.green(text);
    case Look::warning:
      return paint_.yellow(text);
    case Look::alarm:
      return paint_.red(text);
    case Look::plain:
      break;
  }
  return text;
}

/// Over the picture before; at most as high as the terminal, so that the cursor finds back.
std::string StreamView::drawn() {
  Lines lines{{(k_ < 0 ? "no sample yet" : time_text(labels_, k_)) + "  " + title_, Look::bold}};
  if (is_silent())
    lines.push_back(
        {fmt::format("no sample for {} s", std::chrono::duration_cast<std::chrono::seconds>(
                                               std::chrono::steady_clock::now() - taken_at_)
                                               .count()),
         Look::warning});
  const auto append = [](Lines& some, const Lines& more) {
    some.insert(some.end(), more.begin(), more.end());
  };
  Lines below = alarms();
  if (!news_.empty()) append(below, folded("last: " + news_, Look::plain));
  below.push_back({counts()});
  append(lines, modes());
  append(lines, bounds());
  const std::size_t room = std::max<std::size_t>(terminal_->rows, 2) - 1;
  const auto shorten = [](Lines& some, std::size_t most) {
    if (some.size() <= most) return;
    if (most == 1) return some.resize(1);  // the one that says most
    const std::size_t left = some.size() - most + 1;
    some.resize(std::max<std::size_t>(most, 1) - 1);
    if (most > 0) some.push_back({fmt::format("… and {} lines more", left)});
  };
  shorten(below, room / 2);
  shorten(lines, room - below.size());
  append(lines, below);
  std::string text = height_ > 0 ? fmt::format("\x1b[{}A\r", height_) : "";
  for (std::size_t i = 0; i < lines.size(); ++i)  // what is left of the picture before is erased
    text += painted(lines[i]) + (i + 1 < lines.size() ? "\x1b[K\n" : "\x1b[J\n");
  height_ = lines.size();
  return text;
}

}  // namespace cordon::apps
