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
  std::int64_t log_lost = 0;   ///< its last lines that could not be written
};

class Checkpoint {
 public:
  /// Nothing is kept where the file has no name. Throws InputError where it belongs to another
  /// stream that is at work: FILE.lock, which stays, tells.
  explicit Checkpoint(std::filesystem::path file);

  /// Nothing: there is no file. Throws InputError for one that is no checkpoint, or is damaged.
  std::optional<CheckpointState> read() const;
  /// In place of the one before, which stays if this one cannot be written: Errc::io. It is on the
  /// disk afterwards.
  void write(CheckpointState state) const;
  /// Would another file of this name get in the way?
  bool uses(const std::filesystem::path& other) const;

 private:
  std::filesystem::path beside(const char* ending) const { return file_.string() + ending; }

  std::filesystem::path file_;
  std::optional<FileLock> lock_;
};

}  // namespace cordon::apps
