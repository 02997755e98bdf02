// SPDX-License-Identifier: GPL-3.0-or-later
// A set of files that appears whole or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "study/text/directory_lock.hpp"
#include "study/text/fingerprint.hpp"
#include "study/text/manifest.hpp"
#include "study/text/publish.hpp"
#include "study/text/sink.hpp"

namespace cordon::detail {

/// A new file; every write is checked. Throws Errc::io with the system's reason.
class OutputFile final : public Sink {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile() override;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes) override;
  void flush();                 ///< writes what is buffered
  void close();                 ///< the same, waits until it is on the disk, and closes
  ManifestEntry entry() const;  ///< of all that was written and is no longer buffered

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::string buffer_;
  std::int64_t bytes_ = 0;
  Fnv1a64 hash_;
};

/// Files under `<target>/.partial-<pid>-<n>/` until `commit` moves them into `target`. Destroyed
/// before that, it removes its files and the directories it made, and `target` is as it was.
/// Leftovers of processes that were killed are removed at the start: a living owner holds a lock on
/// its directory. Throws Errc::io: `target` is a file, or cannot be written to.
class AtomicDirectory {
 public:
  /// For files that stand beside others: each appears whole, one after another.
  explicit AtomicDirectory(std::filesystem::path target);
  /// For results: they appear all or none, with a manifest, and take the place of earlier ones.
  /// Whatever the process dies of, the directory holds the earlier results or the new ones. `lock`
  /// is held longer than this object lives.
  explicit AtomicDirectory(const DirectoryLock& lock, Rename rename = rename_file);
  ~AtomicDirectory();
  AtomicDirectory(const AtomicDirectory&) = delete;
  AtomicDirectory& operator=(const AtomicDirectory&) = delete;

  const std::filesystem::path& path() const { return target_; }
  /// Opens a new file; it belongs to this object.
  OutputFile& create(const std::string& name);
  /// Closes all files and moves them into the target in the order of creation, with signals
  /// blocked. Returns their final paths.
  std::vector<std::filesystem::path> commit();

 private:
  AtomicDirectory(std::filesystem::path target, bool whole, Rename rename);
  void remove_leftovers() const;
  void make_partial();
  void write_manifest();
  void discard() noexcept;

  std::filesystem::path target_, partial_;
  bool whole_;
  Rename rename_;
  MadeDirectories made_;
  std::vector<std::pair<std::string, std::unique_ptr<OutputFile>>> files_;
  int lock_ = -1;
};

}  // namespace cordon::detail
