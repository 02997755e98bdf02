// SPDX-License-Identifier: GPL-3.0-or-later
// A file that is read: whatever its name stands for, reading ends, and an error is never taken for
// the end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace cordon {

/// What to do about a file of results that the program has not written like this.
inline const std::string not_as_written =
    "the file is not as \"cordon run\" wrote it; run the study again";

}  // namespace cordon

namespace cordon::detail {

/// A regular file, read once from its beginning to its end. Directories, pipes, devices and sockets
/// are refused without waiting for them. Every error of reading is an InputError about the file;
/// `suggestion` is what to do about one that cannot be opened.
class InputFile {
 public:
  explicit InputFile(std::filesystem::path path,
                     std::string suggestion = "check its name and its permissions");
  ~InputFile();
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Up to `most` bytes; fewer only at the end, where it is 0.
  std::size_t read(char* to, std::size_t most);
  /// The next line without its end; false behind the last one. Throws InputError for one longer
  /// than `longest` bytes.
  bool line(std::string& text, std::size_t longest);
  std::int64_t lines() const { return lines_; }  ///< handed out so far
  bool ended_line() const { return ended_; }     ///< the last one had its end: it was not cut off
  /// All that is left. Throws InputError if it is more than `most` bytes, with `suggestion`.
  std::string rest(std::size_t most, const std::string& suggestion);

 private:
  [[noreturn]] void refuse(const std::string& reason, const std::string& suggestion,
                           std::int64_t line = 0) const;
  bool fill();

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::string buffer_;  ///< of `line`
  std::size_t at_ = 0;
  std::int64_t lines_ = 0;
  bool ended_ = true;
};

}  // namespace cordon::detail
