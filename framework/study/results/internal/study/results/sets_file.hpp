// SPDX-License-Identifier: GPL-3.0-or-later
// sets.jsonl: which sets are kept, and how large they will become.
#pragma once

#include <functional>
#include <string>

#include "cordon/study/run.hpp"
#include "study/text/sink.hpp"

namespace cordon::detail {

class SetsFile {
 public:
  /// `pipelines`: how many will leave sets. `file` lives longer.
  SetsFile(Sink& file, std::size_t pipelines, KeptSets kept,
           std::function<void(double bytes)> many_sets);

  KeptSets kept() const { return kept_; }
  /// `samples`: how many steps there will be; 0: not known.
  void begin_pipeline(std::int64_t samples);
  /// The next step's line, with its end.
  void write(std::string line);
  void end_pipeline();

 private:
  /// Speaks once, if the file will be too large.
  void foresee();

  Sink& file_;
  double pipelines_, ended_ = 0;
  KeptSets kept_;
  std::function<void(double)> many_sets_;
  std::string last_;
  std::int64_t samples_ = 0, steps_ = 0;
  double bytes_ = 0, next_look_;
};

}  // namespace cordon::detail
