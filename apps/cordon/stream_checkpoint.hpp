// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a stream in a file, so that it goes on where it was killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "file_lock.hpp"

namespace cordon::apps {

struct CheckpointState {
  std::string session = {};    ///< of OnlineSession::save
  std::int64_t lines = 0;      ///< that had been read
  std::int64_t log_bytes = 0;  ///< of the log, which may have grown since
};

class Checkpoint {
 public:
  explicit Checkpoint(std::filesystem::path file) : file_(std::move(file)) {}

  /// Nothing: there is no file. Throws InputError for one that is no checkpoint, is damaged, or
  /// belongs to another stream that is at work; from now on it belongs to this one.
  std::optional<CheckpointState> read();
  /// In place of the one before, which stays if this one cannot be written: Errc::io. It is on the
  /// disk afterwards.
  void write(CheckpointState state);

 private:
  std::filesystem::path file_;
  FileLock lock_;
};

}  // namespace cordon::apps
