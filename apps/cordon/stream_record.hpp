// SPDX-License-Identifier: GPL-3.0-or-later
// The samples of a stream as a study with recorded data, which is run at the end.
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <string>

#include "common.hpp"
#include "cordon/study/online.hpp"
#include "study/text/atomic_directory.hpp"

namespace cordon::apps {

class StreamRecord {
 public:
  /// Makes DIRECTORY/recorded.json, the study of this pipeline with DIRECTORY/recorded.csv for
  /// data, and begins the latter. Throws Errc::io, and InputError for a directory that has a
  /// record.
  StreamRecord(std::filesystem::path directory, const Study& study, const std::string& pipeline);

  /// What the sample has become: outputs that came late take their place. Throws Errc::io, and
  /// Errc::invalid for times that no recorded data have.
  void take(const Sample& sample);
  /// Writes the samples that late outputs could still have changed. Throws Errc::io.
  void finish();
  /// Have there been any?
  bool has_samples() const { return taken_ > 0; }
  const std::filesystem::path& study() const { return study_; }

 private:
  void write_row(const Sample& sample);

  std::filesystem::path directory_, study_;
  std::size_t most_waiting_;
  std::unique_ptr<detail::OutputFile> file_;
  std::deque<Sample> waiting_;  ///< that late outputs may still change
  std::int64_t taken_ = 0;
};

}  // namespace cordon::apps
