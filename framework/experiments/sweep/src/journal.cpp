// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/journal.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <utility>

#include "study/text/fingerprint.hpp"
#include "study/text/json_writer.hpp"
#include "study/text/numbers.hpp"
#include "study/text/publish.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::detail {

namespace fs = std::filesystem;

namespace {

constexpr const char* journal_folder = ".sweep";
constexpr std::size_t longest_line = json::max_bytes;
const std::string discard =
    "\"--restart\" throws the unfinished sweep away; another \"--out\" keeps it";

std::string why_not_written(const fs::path& path, int reason) {
  const std::string suggestion =
      reason == ENOSPC || reason == EDQUOT ? "; free some space, then go on with --resume" : "";
  return "cannot write " + path.string() + ": " + std::strerror(reason) + suggestion +
         "; points that were finished are kept";
}

[[noreturn]] void fail_to_write(const fs::path& path, int reason) {
  throw Error(Errc::io, why_not_written(path, reason));
}

[[noreturn]] void refuse_journal(const fs::path& file, const std::string& reason,
                                 const std::string& suggestion) {
  throw InputError(file.string(), {{"", reason, suggestion}});
}

std::string with_checksum(const std::string& text) { return fnv1a64(text) + ' ' + text + '\n'; }

/// The text of a line that is whole.
std::optional<std::string> checked(const std::string& line) {
  constexpr std::size_t digits = 16;
  if (line.size() < digits + 2 || line[digits] != ' ') return std::nullopt;
  std::string text = line.substr(digits + 1);
  return fnv1a64(text) == line.substr(0, digits) ? std::optional(std::move(text)) : std::nullopt;
}

std::string text_of(const JournalHead& head) {
  StringSink sink;
  JsonWriter json(sink);
  json.begin_object().member("cordon_journal", 1).member("study_hash", head.study_hash);
  json.member("version", head.version).member("abi_tag", head.abi_tag).key("plugins").begin_array();
  for (const std::string& plugin : head.plugins) json.value(plugin);
  json.end_array()
      .member("part", head.shard.part)
      .member("of", head.shard.of)
      .member("limit", head.limit_s);
  json.member("started", head.started).end_object();
  return std::move(sink.text);
}

std::optional<JournalHead> head_of(const std::string& text) {
  json::Problems problems;
  const json::Value tree = json::parse(text, problems);
  const json::Cursor root(tree, "", problems);
  if (!root.expect(json::Value::Kind::object, "")) return std::nullopt;
  JournalHead head;
  const auto word = [&](const char* key) {
    const auto at = root.need(key, "");
    return at && at->expect(json::Value::Kind::text, "") ? at->value().text() : std::string();
  };
  const auto whole = [&](const char* key) {
    const auto at = root.need(key, "");
    return at ? json::read_integer(*at, 1, json::max_integer).value_or(1) : 1;
  };
  head.study_hash = word("study_hash");
  head.version = word("version");
  head.abi_tag = word("abi_tag");
  head.started = word("started");
  head.shard = {whole("part"), whole("of")};
  if (const auto plugins = root.need("plugins", "")) {
    for (const json::Value& plugin : plugins->value().items())
      head.plugins.push_back(plugin.text());
  }
  const auto limit = root.need("limit", "");
  head.limit_s = limit && limit->is(json::Value::Kind::number) ? limit->value().number : HUGE_VAL;
  if (whole("cordon_journal") != 1 || problems.any()) return std::nullopt;
  return head;
}

/// Why points of one sweep are no points of the other, and the suggestion; two empty texts if they
/// are.
std::pair<std::string, std::string> difference(const JournalHead& old, const JournalHead& now) {
  if (old.study_hash != now.study_hash)
    return {"holds the unfinished sweep of another study, or of an earlier version of this one",
            discard};
  if (old.version != now.version || old.abi_tag != now.abi_tag)
    return {
        "holds an unfinished sweep of another build of this program (version " + old.version + ")",
        discard};
  if (old.plugins != now.plugins) return {"holds an unfinished sweep with other plugins", discard};
  if (old.shard.part != now.shard.part || old.shard.of != now.shard.of)
    return {"holds " + name_of(old.shard) + ", and " + name_of(now.shard) + " was asked for",
            "every part needs an \"--out\" of its own"};
  if (old.limit_s != now.limit_s)
    return {"was begun with " + name_of_limit(old.limit_s) + " per point, now there is " +
                name_of_limit(now.limit_s),
            "go on with the same limit; " + discard};
  return {};
}

}  // namespace

std::string name_of(const Shard& shard) {
  return shard.of == 1 ? "all points"
                       : "part " + std::to_string(shard.part) + " of " + std::to_string(shard.of);
}

std::string name_of_limit(double seconds) {
  return std::isfinite(seconds) ? "a limit of " + to_text(seconds) + " s" : "no limit";
}

bool Journal::is_in(const fs::path& out) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(out / journal_folder / "journal", ignored));
}

void Journal::remove_empty_folder(const DirectoryLock& out) noexcept {
  ::rmdir((out.directory() / journal_folder).c_str());
}

Journal::Journal(const fs::path& out, const JournalHead& head, Start start,
                 const std::function<void(PointResult)>& earlier)
    : lock_(out),
      directory_(lock_.directory() / journal_folder),
      file_(directory_ / "journal"),
      head_(head) {
  try {
    make_folder();
    std::optional<InputFile> old;
    if (is_in(out) && start == Start::fresh) {
      refuse_journal(out, "holds an unfinished sweep",
                     "\"--resume\" goes on with it, \"--restart\" throws it away");
    }
    if (is_in(out) && start == Start::resume) {
      if (!fs::is_regular_file(fs::symlink_status(file_)))
        refuse_journal(file_, "is no regular file", discard);
      check_head(old.emplace(file_, discard));
    }
    begin(old, earlier);
  } catch (...) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

/// A link in its place could lead to files that are none of this program's.
void Journal::make_folder() const {
  std::error_code error;
  if (!fs::create_directory(directory_, error) && error) {
    throw Error(Errc::io,
                "cannot make the directory " + directory_.string() + ": " + error.message());
  }
  if (!fs::is_directory(fs::symlink_status(directory_)))
    refuse_journal(directory_, "is a symbolic link", "remove the link");
}

/// Leaves the file behind the head.
void Journal::check_head(InputFile& old) {
  std::string line;
  std::optional<std::string> text;
  if (old.line(line, longest_line) && old.ended_line()) text = checked(line);
  const std::optional<JournalHead> head = text ? head_of(*text) : std::nullopt;
  if (!head)
    refuse_journal(file_, "is damaged: it does not tell which sweep it belongs to", discard);
  const auto [reason, suggestion] = difference(*head, head_);
  if (!reason.empty()) refuse_journal(lock_.directory(), reason, suggestion);
  head_.started = head->started;
}

/// A new file takes the place of the old one, with its lines that are whole, and is left open at
/// its end.
void Journal::begin(std::optional<InputFile>& old,
                    const std::function<void(PointResult)>& earlier) {
  const fs::path fresh = directory_ / "journal.new";
  ::unlink(fresh.c_str());  // whatever it is
  descriptor_ = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail_to_write(fresh, errno);
  write(with_checksum(text_of(head_)));
  for (std::string line; old && old->line(line, longest_line) &&
                         old->ended_line();) {  // a last line without its end is torn
    const std::optional<std::string> text = checked(line);
    auto point = text ? point_of(*text) : std::nullopt;
    if (!point) continue;
    write(line + '\n');
    earlier(std::move(*point));
  }
  sync();
  if (::rename(fresh.c_str(), file_.c_str()) != 0) fail_to_write(file_, errno);
  sync_names(directory_);
}

void Journal::add(const std::string& line) {
  const std::lock_guard guard(writing_);
  write(with_checksum(line));
}

void Journal::write(std::string_view bytes) {
  // A torn line must stay the last one; other jobs that come here tell the same reason.
  if (!broken_.empty()) throw Error(Errc::io, broken_);
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      broken_ = why_not_written(file_, errno);
      throw Error(Errc::io, broken_);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void Journal::sync() {
  int result = ::fsync(descriptor_);
  while (result != 0 && errno == EINTR) result = ::fsync(descriptor_);
  if (result != 0 && errno != EINVAL && errno != EROFS)
    fail_to_write(file_, errno);  // those two: it cannot be synchronised
}

void Journal::remove() {
  ::unlink(file_.c_str());
  ::rmdir(directory_.c_str());
}

}  // namespace cordon::detail
