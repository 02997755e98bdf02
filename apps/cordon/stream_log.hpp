// SPDX-License-Identifier: GPL-3.0-or-later
// What a stream has taken, and the alarms that this has led to: a file of lines that can be
// replayed.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace cordon::apps {

class StreamLog {
 public:
  /// A new file; with `keep` > 0 one that is there, of which so many bytes are kept: what was
  /// written after the checkpoint comes again, or not, and is added to FILE.cut. `lost` lines could
  /// not be written before. Throws InputError, Errc::io.
  StreamLog(std::filesystem::path file, const std::string& pipeline, std::int64_t keep,
            std::int64_t lost);
  ~StreamLog();
  StreamLog(const StreamLog&) = delete;
  StreamLog& operator=(const StreamLog&) = delete;

  /// Throws Errc::io; of a line that could not be written nothing is left, and the next one that
  /// can be follows a line that says how many are missing.
  void write(const std::string& line);
  void flush();
  std::int64_t bytes() const { return bytes_; }
  std::int64_t lost() const { return lost_; }  ///< lines, since the last one that was written
  std::int64_t cut() const { return cut_; }    ///< bytes that went to FILE.cut

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  void append(const std::string& text);
  void cut_off(std::int64_t keep);

  std::int64_t bytes_ = 0, lost_ = 0, cut_ = 0;
};

class ReplayedLog {
 public:
  /// Throws InputError for what is no log of this pipeline.
  ReplayedLog(const std::filesystem::path& file, const std::string& pipeline);

  /// The next sample or request; false: there is none.
  bool next(std::string& line);
  /// An alarm that has changed, as JSON.
  void compare(const std::string& alarm);

  std::int64_t agreed() const { return agreed_; }
  /// Lines could not be written: the replay ends before them.
  bool lacks_lines() const { return lacks_lines_; }
  /// Does its last line lack its end?
  bool is_torn() const { return torn_; }
  /// For people; once all has been taken.
  std::vector<std::string> differences() const;
  /// Alarm changes of the last sample that the log ends before: a kill has cut it there.
  std::int64_t cut_off() const { return cut_off_; }

 private:
  static bool is_alarm(const std::string& line);
  static std::string alarm_in(const std::string& line);
  /// The next line that has an end.
  bool read(std::string& line);

  std::ifstream stream_;
  std::string waiting_;  ///< a line that has been read
  std::vector<std::string> expected_;
  std::size_t at_ = 0;
  std::int64_t agreed_ = 0, others_ = 0, cut_off_ = 0;
  bool torn_ = false, lacks_lines_ = false;
  std::string first_difference_;
};

}  // namespace cordon::apps
