// SPDX-License-Identifier: GPL-3.0-or-later
// The finished points of a sweep that is not finished, on the disk: what is left when the process
// dies.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "experiments/sweep/rows.hpp"
#include "study/text/directory_lock.hpp"
#include "study/text/input_file.hpp"

namespace cordon::detail {

/// What has to be the same for a sweep to go on, but for `started`.
struct JournalHead {
  std::string study_hash, version, abi_tag;
  std::vector<std::string> plugins;  ///< names and versions
  Shard shard;
  double limit_s = 0;
  std::string started;  ///< of the first process
};

/// Parts and time limits for messages.
std::string name_of(const Shard& shard);
std::string name_of_limit(double seconds);

/// Lines in OUT/.sweep/journal, each with a checksum: the head, then a point each. A line that is
/// cut off or damaged counts for nothing. OUT is held by a lock while the object lives, so that two
/// processes cannot write into it; symbolic links are not followed. Errors of writing are Errc::io;
/// what was written stays.
class Journal {
 public:
  enum class Start { fresh, resume, restart };

  /// Hands what an earlier process has left to `earlier`. Throws InputError: another process holds
  /// it; `fresh`, and there is a journal; `resume`, and it is of another sweep.
  Journal(const std::filesystem::path& out, const JournalHead& head, Start start,
          const std::function<void(PointResult)>& earlier);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Is there one in `out`?
  static bool is_in(const std::filesystem::path& out);
  /// Removes the folder of one that was removed itself: all that is left of a process that died
  /// between the two.
  static void remove_empty_folder(const DirectoryLock& out) noexcept;

  const DirectoryLock& lock() const { return lock_; }  ///< of OUT
  const JournalHead& head() const { return head_; }    ///< `started` is that of the first process
  void add(const std::string& line);                   ///< of line_of; from any thread
  void sync();                                         ///< returns when all is on the disk
  void remove();                                       ///< the sweep is finished

 private:
  void make_folder() const;
  void check_head(InputFile& old);
  void begin(std::optional<InputFile>& old, const std::function<void(PointResult)>& earlier);
  void write(std::string_view bytes);

  DirectoryLock lock_;
  std::filesystem::path directory_, file_;
  JournalHead head_;
  int descriptor_ = -1;
  std::string broken_ = {};  ///< why nothing can be written any more
  std::mutex writing_;
};

}  // namespace cordon::detail
