// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/large_json.hpp"

#include <memory>
#include <unordered_set>

#include <nlohmann/json.hpp>

#include "cordon/core/error.hpp"
#include "study/text/byte_iterator.hpp"
#include "study/text/input_file.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;

/// The bytes of a file, one after another, with the line of the last one.
class Bytes {
 public:
  explicit Bytes(const std::filesystem::path& file)
      : file_(file, "\"cordon run\" writes it"), chunk_(std::size_t{1} << 16) {
    fill();
  }

  bool ended() const { return at_ == size_; }
  /// U+0001, which is JSON nowhere, in place of NUL, which the parser takes for the end.
  char now() const { return chunk_[at_] == '\0' ? '\x01' : chunk_[at_]; }
  void advance() {
    if (++since_event_ > max_bytes)
      throw InputError(file_.path().string(), {{"", "is larger than any that \"cordon run\" writes",
                                                "run the study again", line_}});
    if (copy_ && copy_->size() <= max_bytes) *copy_ += chunk_[at_];
    line_ += after_line_;
    after_line_ = chunk_[at_] == '\n';
    if (++at_ == size_) fill();
  }
  /// Of the byte before `now`, a line end being part of its line: the parser reads one byte beyond
  /// a number.
  int line() const { return line_; }
  /// The parser has understood what there was so far.
  void event() { since_event_ = 0; }
  /// What comes from now on is added to `copy`; null: no more.
  void copy_to(std::string* copy) { copy_ = copy; }

 private:
  void fill() {
    size_ = file_.read(chunk_.data(), chunk_.size());
    at_ = 0;
  }

  detail::InputFile file_;
  std::vector<char> chunk_;
  std::size_t size_ = 0, at_ = 0;
  int line_ = 1;
  bool after_line_ = false;
  std::size_t since_event_ = 0;
  std::string* copy_ = nullptr;
};

using Pattern = std::vector<std::string>;

Pattern split(const std::string& pointer) {
  Pattern steps;
  for (std::size_t at = 0; at < pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', at + 1), pointer.size());
    steps.push_back(pointer.substr(at + 1, end - at - 1));
    at = end;
  }
  return steps;
}

/// Receives the events of the library's parser, and keeps what is wanted.
class Builder {
 public:
  Builder(const Wanted& wanted, Bytes& bytes, Problems& problems)
      : wanted_(wanted), bytes_(bytes), problems_(problems), copied_(split(wanted.copied)) {
    for (const std::string& pointer : wanted.kept) patterns_.push_back({split(pointer), false});
    for (const std::string& pointer : wanted.streamed) patterns_.push_back({split(pointer), true});
  }

  LargeJson take() { return {std::move(root_), std::move(copy_)}; }

  bool null() {
    return leaf(Kind::null, [](Value&) {});
  }
  bool boolean(bool flag) {
    return leaf(Kind::boolean, [&](Value& value) { value.flag = flag; });
  }
  /// A negative integer, or -0.
  bool number_integer(std::int64_t number) {
    return number_float(number == 0 ? -0.0 : static_cast<double>(number), {});
  }
  bool number_unsigned(std::uint64_t number) {
    return number_float(static_cast<double>(number), {});
  }
  bool number_float(double number, const std::string&) {
    return leaf(Kind::number, [&](Value& value) { value.number = number; });
  }
  bool string(std::string& text) {
    return leaf(Kind::text, [&](Value& value) {
      const auto parts = std::make_shared<Parts>();
      parts->text = std::move(text);
      value.parts = parts;
    });
  }
  bool binary(const std::vector<std::uint8_t>&) { return false; }  // not part of JSON text
  bool start_object(std::size_t) { return open(Kind::object); }
  bool start_array(std::size_t) { return open(Kind::array); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& text) {
    bytes_.event();
    if (skipped_ == 0) open_.back().key = std::move(text);
    return true;
  }
  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::json::exception& problem) {
    const bool overflow = problem.id == 406;
    problems_.add(pointer(), bytes_.line(),
                  overflow ? "a number is beyond the range of double numbers"
                           : "is not JSON in UTF-8 at byte " + std::to_string(position),
                  "the file is not as \"cordon run\" wrote it; is it complete?");
    return false;
  }

 private:
  /// How a value stands to a pattern.
  enum class Wish { none, way, keep, stream };

  struct Level {
    Value value;
    std::shared_ptr<Parts> parts =
        std::make_shared<Parts>();  ///< of the value, once it is complete
    Wish wish = Wish::way;
    std::string key;                            ///< of the member that is read
    std::size_t index = 0;                      ///< of the element that is read
    std::unordered_set<std::string> seen = {};  ///< keys so far
    bool in_array() const { return value.kind == Kind::array; }
  };

  struct Place {
    Pattern steps;
    bool streamed;
  };

  std::string pointer() const {
    std::string text;
    for (const Level& level : open_)
      text = level.in_array() ? child(text, level.index) : child(text, level.key);
    return text;
  }

  /// The wish for the value that begins now, a child of the innermost open one.
  Wish wish() const {
    if (open_.empty()) return Wish::way;
    const Wish parent = open_.back().wish;
    if (parent == Wish::stream) return Wish::keep;
    const bool kept = parent == Wish::keep;
    Wish found = kept ? Wish::keep : Wish::none;
    for (const auto& [steps, streamed] : patterns_) {
      if (kept && (!streamed || steps.size() != open_.size())) continue;
      if (steps.size() < open_.size() || !matches(steps)) continue;
      if (steps.size() == open_.size()) return streamed ? Wish::stream : Wish::keep;
      found = Wish::way;
    }
    return found;
  }

  bool matches(const Pattern& steps) const {
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const Level& level = open_[i];
      if (level.in_array() ? steps[i] != "*" : steps[i] != level.key) return false;
    }
    return true;
  }

  template <class Fill>
  bool leaf(Kind kind, Fill&& fill) {
    bytes_.event();
    if (skipped_ > 0) return true;
    const Wish wished = wish();
    Value value = begun(kind);
    if (wished != Wish::none) fill(value);
    return put(std::move(value), wished);
  }

  bool open(Kind kind) {
    bytes_.event();
    begin_copy(kind);
    const Wish wished = skipped_ > 0 ? Wish::none : wish();
    if (wished == Wish::none) {
      ++skipped_;
      return true;
    }
    if (open_.size() >= static_cast<std::size_t>(max_depth))
      return refuse("nested deeper than 64 levels");
    Level& level = open_.emplace_back();
    level.wish = wished;
    level.value = begun(kind);
    return true;
  }

  /// The bracket of a value that is copied has been read.
  void begin_copy(Kind kind) {
    if (copied_.empty() || skipped_ > 0 || copied_.size() != open_.size() || !matches(copied_))
      return;
    copy_ = kind == Kind::object ? "{" : "[";
    bytes_.copy_to(&copy_);
  }
  void end_copy() {
    if (open_.size() + skipped_ == copied_.size()) bytes_.copy_to(nullptr);
  }

  bool close() {
    bytes_.event();
    if (skipped_ > 0) {
      --skipped_;
      end_copy();
      return skipped_ > 0 || put({}, Wish::none);
    }
    Level level = std::move(open_.back());
    open_.pop_back();
    end_copy();
    level.value.parts = level.parts;
    return put(std::move(level.value), level.wish);
  }

  Value begun(Kind kind) const {
    Value value;
    value.kind = kind;
    value.line = bytes_.line();
    return value;
  }

  bool refuse(std::string message) {
    problems_.add(pointer(), bytes_.line(), std::move(message),
                  "the file is not as \"cordon run\" wrote it");
    return false;
  }

  /// A complete value goes into the one around it.
  bool put(Value value, Wish wished) {
    if (open_.empty()) {
      root_ = std::move(value);
      return true;
    }
    Level& parent = open_.back();
    if (wished != Wish::none && ++values_ > max_values)
      return refuse("the file holds more than 10 million values");
    if (!parent.in_array() && wished != Wish::none && !parent.seen.insert(parent.key).second) {
      problems_.add(pointer(), value.line, "the key is repeated", "remove one of the two");
    } else if (wished == Wish::stream) {
      std::vector<std::size_t> at;
      for (const Level& level : open_) {
        if (level.in_array()) at.push_back(level.index);
      }
      if (wanted_.take) wanted_.take(Cursor(value, pointer(), problems_), at);
      values_ = 0;
    } else if (wished != Wish::none) {
      if (!parent.in_array()) parent.parts->keys.push_back(parent.key);
      parent.parts->items.push_back(std::move(value));
    }
    ++parent.index;
    return true;
  }

  const Wanted& wanted_;
  Bytes& bytes_;
  Problems& problems_;
  Pattern copied_;
  std::string copy_ = {};
  std::vector<Place> patterns_;
  std::vector<Level> open_;
  std::size_t skipped_ = 0;  ///< how deep inside of a value that is not wanted
  std::size_t values_ = 0;   ///< that were kept since the last one was handed over
  Value root_;
};

}  // namespace

LargeJson read_large(const std::filesystem::path& file, const Wanted& wanted, Problems& problems) {
  Bytes bytes(file);
  Builder builder(wanted, bytes, problems);
  if (nlohmann::json::sax_parse(json::ByteIterator<Bytes>(&bytes),
                                json::ByteIterator<Bytes>(nullptr), &builder))
    return builder.take();
  LargeJson broken;
  broken.tree.kind = Kind::broken;
  return broken;
}

}  // namespace cordon::json
