// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/manifest.hpp"

#include <algorithm>
#include <array>

#include "cordon/core/error.hpp"
#include "study/text/directory_lock.hpp"
#include "study/text/fingerprint.hpp"
#include "study/text/input_file.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/json_writer.hpp"
#include "study/text/publish.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::detail {

namespace {

namespace fs = std::filesystem;
using json::Cursor;
using Kind = json::Value::Kind;

constexpr std::size_t most_bytes = std::size_t{1} << 20, most_files = 1000, longest_name = 255;
const std::string run_again = "run the study again";

[[noreturn]] void refuse(const fs::path& file, const std::string& reason,
                         const std::string& what_to_do) {
  throw InputError(file.string(), {{"", reason, what_to_do}});
}

/// A plain name: none of another folder, none that is hidden.
bool is_plain(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.size() <= longest_name &&
         name != manifest_name && std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return c > ' ' && c < 0x7f && c != '/';
         });
}

ManifestEntry read_entry(const Cursor& at) {
  ManifestEntry entry;
  if (!at.expect(Kind::object, run_again)) return entry;
  const auto name = at.need("name", run_again), bytes = at.need("bytes", run_again),
             checksum = at.need("fnv1a64", run_again);
  if (name) entry.name = json::read_text(*name, longest_name).value_or("");
  if (name && !is_plain(entry.name)) name->error("is no name of a file of results", run_again);
  if (bytes) entry.bytes = json::read_integer(*bytes, 0, json::max_integer).value_or(0);
  if (checksum) entry.fnv1a64 = json::read_text(*checksum, 16).value_or("");
  return entry;
}

/// The bytes of a file as an entry.
ManifestEntry entry_of(const fs::path& directory, const std::string& name) {
  InputFile file(directory / name, run_again);
  Fnv1a64 hash;
  ManifestEntry entry{name, 0, ""};
  std::array<char, 1 << 16> piece;
  while (const std::size_t got = file.read(piece.data(), piece.size())) {
    hash.add({piece.data(), got});
    entry.bytes += static_cast<std::int64_t>(got);
  }
  entry.fnv1a64 = hash.digits();
  return entry;
}

}  // namespace

std::string manifest_text(const std::vector<ManifestEntry>& files) {
  StringSink sink;
  JsonWriter json(sink);
  json.begin_object(JsonWriter::Layout::lines)
      .member("cordon_manifest", 1)
      .key("files")
      .begin_array(JsonWriter::Layout::lines);
  for (const ManifestEntry& file : files) {
    json.begin_object()
        .member("name", file.name)
        .member("bytes", file.bytes)
        .member("fnv1a64", file.fnv1a64)
        .end_object();
  }
  json.end_array().end_object();
  return sink.text + "\n";
}

std::vector<ManifestEntry> read_manifest(const fs::path& file) {
  json::Problems problems;
  const json::Value tree =
      json::parse(InputFile(file, run_again).rest(most_bytes, run_again), problems);
  const Cursor root(tree, "", problems);
  std::vector<ManifestEntry> entries;
  if (root.expect(Kind::object, run_again)) {
    if (const auto version = root.need("cordon_manifest", run_again))
      json::read_integer(*version, 1, 1);
    const auto files = root.need("files", run_again);
    if (files && files->expect(Kind::array, run_again)) {
      if (files->size() > most_files) files->error("lists more files than results have", run_again);
      for (std::size_t i = 0; i < std::min(files->size(), most_files); ++i)
        entries.push_back(read_entry(files->item(i)));
    }
  }
  if (problems.any()) throw InputError(file.string(), problems.sorted());
  return entries;
}

RecordedFiles::RecordedFiles(fs::path directory) : directory_(std::move(directory)) {
  if (is_there(directory_ / committed_folder))
    const DirectoryLock finishing(directory_);  // which it does as it begins
  const fs::path manifest = directory_ / manifest_name;
  listed_ = is_there(manifest);
  if (listed_) files_ = read_manifest(manifest);
}

fs::path RecordedFiles::file(const std::string& name) const {
  if (!listed_) return directory_ / name;
  const auto listed = std::find_if(files_.begin(), files_.end(),
                                   [&](const ManifestEntry& entry) { return entry.name == name; });
  if (listed == files_.end()) {
    refuse(directory_ / name,
           "does not belong to the results in this directory: manifest.json does not list it",
           run_again);
  }
  if (entry_of(directory_, name) == *listed) return directory_ / name;
  refuse(directory_ / name,
         "is not the file that manifest.json lists: it was changed, cut off, or is of another run",
         run_again + "; who changes a file on purpose removes manifest.json");
}

void RecordedFiles::check_unchanged() const {
  const fs::path manifest = directory_ / manifest_name;
  const bool same =
      listed_ ? is_there(manifest) && read_manifest(manifest) == files_ : !is_there(manifest);
  if (!same) refuse(directory_, "was given other results while it was read", "read it again");
}

}  // namespace cordon::detail
