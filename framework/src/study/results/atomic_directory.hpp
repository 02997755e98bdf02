// SPDX-License-Identifier: GPL-3.0-or-later
// A set of files that appears whole or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "study/results/sink.hpp"

namespace cordon::detail {

/// A new file; every write is checked. Throws Errc::io with the system's reason.
class OutputFile final : public Sink {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile() override;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes) override;
  void close();  ///< writes what is buffered, waits until it is on the disk, and closes

 private:
  void flush();

  std::filesystem::path path_;
  int descriptor_;
  std::string buffer_;
};

/// Files under `<target>/.partial-<pid>-<n>/` until `commit` moves them into `target`. Destroyed before that, it removes its
/// files and the directories it made, and `target` is as it was. Leftovers of processes that were killed are removed at the
/// start: a living owner holds a lock on its directory. Throws Errc::io: `target` is a file, or cannot be written to.
class AtomicDirectory {
 public:
  explicit AtomicDirectory(std::filesystem::path target);
  ~AtomicDirectory();
  AtomicDirectory(const AtomicDirectory&) = delete;
  AtomicDirectory& operator=(const AtomicDirectory&) = delete;

  const std::filesystem::path& path() const { return target_; }
  /// Opens a new file; it belongs to this object.
  OutputFile& create(const std::string& name);
  /// Closes all files and renames them into the target in the order of creation, with signals blocked. Returns their final paths.
  /// Before the last one, files of the target that are `outdated` and were not created anew are removed.
  std::vector<std::filesystem::path> commit(const std::vector<std::string>& outdated = {});

 private:
  void make_target();
  void remove_leftovers() const;
  void make_partial();
  void remove(const std::vector<std::string>& outdated) const;
  void discard() noexcept;

  std::filesystem::path target_, partial_;
  std::vector<std::filesystem::path> made_;  ///< directories that did not exist before, outermost first
  std::vector<std::pair<std::string, std::unique_ptr<OutputFile>>> files_;
  int lock_ = -1;
  bool committed_ = false;
};

}  // namespace cordon::detail
