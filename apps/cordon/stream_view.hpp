// SPDX-License-Identifier: GPL-3.0-or-later
// A stream for people who look on: a picture that is drawn again and again, or lines.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common.hpp"
#include "cordon/study/online.hpp"

namespace cordon::apps {

/// Rows and columns of a terminal.
struct TerminalSize {
  std::size_t rows = 24, columns = 80;
};

class StreamView {
 public:
  /// `terminal`: of this size; nothing: lines are written, one per step, alarm and error. `session`
  /// lives longer.
  StreamView(const Study& study, const OnlineSession& session,
             std::optional<TerminalSize> terminal);

  /// What is to be written now.
  std::string show(const Taken& taken);
  std::string show(const std::vector<AlarmChange>& changes);  ///< by a request
  std::string show(const Error& error, std::int64_t line);
  std::string begin_anew();
  /// While no sample comes: how long there has been none.
  std::string idle();
  /// At the end: the last picture.
  std::string last();

 private:
  enum class Look { plain, bold, good, warning, alarm };
  struct Line {
    std::string text;
    Look look = Look::plain;
  };
  using Lines = std::vector<Line>;

  std::string drawn_if_due();
  bool is_silent() const;
  std::string drawn();
  std::string painted(const Line& line) const;
  Lines modes() const;
  Lines bounds();
  Lines alarms() const;
  Lines folded(const std::string& text, Look look) const;
  std::string counts() const;
  std::string text_of(const TakenStep& step) const;
  std::string text_of(const AlarmChange& change) const;
  void take_hull(Box hull);
  void take_diagnosis(const DiagnosisStep& step);
  std::string bar(Index i, std::size_t width) const;

  std::string title_;
  Labels labels_;
  const OnlineSession& session_;
  std::optional<TerminalSize> terminal_;
  Paint paint_;
  Index k_ = -1;
  Box hull_;  ///< of the last estimate; of dimension 0: there was none
  bool is_empty_ = false, is_stale_ = false;
  std::optional<Diagnosis> diagnosis_;
  std::vector<bool> excluded_;  ///< modes
  Box seen_;                    ///< all finite bounds so far; of diagnosers those that were drawn
  std::string news_;
  std::int64_t refused_ = 0, left_open_ = 0;
  std::size_t height_ = 0;  ///< of the picture that stands on the terminal
  std::chrono::steady_clock::time_point drawn_at_ = {},
                                        taken_at_ = std::chrono::steady_clock::now();
};

/// Of standard output; nothing: it is no terminal, or one that cannot move its cursor (TERM=dumb).
std::optional<TerminalSize> terminal_size();

}  // namespace cordon::apps
