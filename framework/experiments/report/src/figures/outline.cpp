// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/outline.hpp"

#include <optional>
#include <vector>

#include "cordon/core/error.hpp"
#include "study/text/input_file.hpp"
#include "study/text/json_text.hpp"

namespace cordon::report {

namespace {

constexpr std::size_t item_limit = std::size_t{16} << 20;
constexpr std::size_t key_limit = 64;  ///< longer keys are none of those that matter

/// Follows brackets and strings, and nothing else.
class Scanner {
 public:
  Scanner(std::string file, const ItemVisitor& visit) : file_(std::move(file)), visit_(visit) {}

  void put(char c) {
    if (in_string_) {
      put_in_string(c);
    } else {
      put_structure(c);
    }
  }

  Outline finish() { return std::move(outline_); }

 private:
  struct Level {
    bool object = false;
    bool at_key = false;    ///< the next string is a key
    std::string key = {};   ///< the current one
    std::size_t index = 0;  ///< of the current element
  };

  void put_in_string(char c) {
    keep(c);
    if (escaped_) {
      escaped_ = false;
    } else if (c == '\\') {
      escaped_ = true;
    } else if (c == '"') {
      in_string_ = false;
      if (reads_key_ && !levels_.empty()) levels_.back().key = key_;
      reads_key_ = false;
      return;
    }
    if (reads_key_ && key_.size() <= key_limit) key_ += c;
  }

  void put_structure(char c) {
    switch (c) {
      case '"':
        in_string_ = true;
        reads_key_ = !levels_.empty() && levels_.back().at_key;
        key_.clear();
        keep(c);
        break;
      case '{':
      case '[':
        open(c);
        break;
      case '}':
      case ']':
        close(c);
        break;
      case ',':
        comma();
        break;
      case ':':
        if (!levels_.empty()) levels_.back().at_key = false;
        keep(c);
        if (levels_.size() == 1 && levels_.back().key == "study")
          study_from_ = outline_.text.size();
        break;
      default:
        if (!left_out_ || (c != ' ' && c != '\n' && c != '\r' && c != '\t')) keep(c);
    }
  }

  void open(char c) {
    if (levels_.size() > static_cast<std::size_t>(json::max_depth)) refuse("is nested too deeply");
    const bool leaves_out = c == '[' && !left_out_ && is_growing_list();
    keep(c);
    levels_.push_back({c == '{', c == '{'});
    if (leaves_out) left_out_ = levels_.size();
  }

  void close(char c) {
    if (left_out_ == levels_.size()) {
      if (!item_.empty()) hand_over();
      left_out_.reset();
    }
    if (!levels_.empty()) levels_.pop_back();
    if (levels_.empty()) end_study();
    keep(c);
  }

  void comma() {
    if (left_out_ == levels_.size()) {
      hand_over();
      return;
    }
    if (!levels_.empty()) {
      levels_.back().at_key = levels_.back().object;
      ++levels_.back().index;
    }
    if (levels_.size() == 1) end_study();
    keep(',');
  }

  bool is_growing_list() const {
    if (levels_.size() == 1) return levels_[0].key == "points";
    return levels_.size() == 3 && levels_[0].key == "pipelines" && levels_[2].key == "steps";
  }

  void keep(char c) {
    std::string& text = left_out_ ? item_ : outline_.text;
    text += c;
    if (text.size() > (left_out_ ? item_limit : json::max_bytes))
      refuse("is larger than any that \"cordon run\" writes");
  }

  void hand_over() {
    if (visit_) visit_(levels_.size() > 2 ? levels_[1].index : 0, item_);
    item_.clear();
  }

  void end_study() {
    if (!study_from_) return;
    const std::size_t first = outline_.text.find_first_not_of(" \n\r\t", *study_from_);
    outline_.study = first == std::string::npos ? "" : outline_.text.substr(first);
    study_from_.reset();
  }

  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError(file_, {{"", reason, "run the study again", 0}});
  }

  std::string file_;
  const ItemVisitor& visit_;
  Outline outline_;
  std::vector<Level> levels_;
  std::string key_, item_;
  bool in_string_ = false, escaped_ = false, reads_key_ = false;
  std::optional<std::size_t> left_out_;  ///< level of the list that is left out
  std::optional<std::size_t> study_from_;
};

}  // namespace

Outline outline_of(const std::filesystem::path& file, const ItemVisitor& visit) {
  detail::InputFile input(file, "\"cordon run STUDY --out DIR\" writes it to DIR");
  Scanner scanner(file.string(), visit);
  std::vector<char> buffer(1 << 16);
  while (const std::size_t got = input.read(buffer.data(), buffer.size())) {
    for (std::size_t i = 0; i < got; ++i) scanner.put(buffer[i]);
  }
  return scanner.finish();
}

}  // namespace cordon::report
