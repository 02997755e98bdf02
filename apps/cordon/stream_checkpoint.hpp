// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a stream in a file, so that it goes on where it was killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "cordon/study/alarms.hpp"

namespace cordon::apps {

struct CheckpointState {
  std::string session;         ///< of OnlineSession::save
  std::string alarms;          ///< of Alarms::serialize
  std::int64_t lines = 0;      ///< that had been read
  std::int64_t log_bytes = 0;  ///< of the log, which may have grown since

  void restore(Alarms& into) const;
};

class Checkpoint {
 public:
  explicit Checkpoint(std::filesystem::path file) : file_(std::move(file)) {}

  /// Nothing: there is no file. Throws InputError for one that is no checkpoint, or is damaged.
  std::optional<CheckpointState> read() const;
  /// In place of the one before, which stays if this one cannot be written: Errc::io. It is on the
  /// disk afterwards.
  void write(const std::string& session, Alarms& alarms, std::int64_t lines,
             std::int64_t log_bytes) const;

 private:
  std::filesystem::path file_;
};

}  // namespace cordon::apps
