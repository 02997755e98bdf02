// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdicts.hpp"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "build_info.hpp"
#include "cordon/registry/abi.hpp"

namespace cordon::registry {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t slots = 4096;
constexpr std::size_t longest_entry = 16384;  // bytes; the file is input like any other
constexpr const char* works = "works";

/// Every step is one-to-one in both arguments: a change within one word always shows.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t sum = bytes.size();
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
    sum = (sum ^ word) * 0x9E3779B97F4A7C15u;
    sum ^= sum >> 32;
  }
  return sum;
}

/// Empty if the environment names no place.
fs::path cache_directory() {
  const auto absolute = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value && *value == '/' ? fs::path(value) : fs::path();
  };
  fs::path base = absolute("XDG_CACHE_HOME");
  if (base.empty() && !absolute("HOME").empty()) base = absolute("HOME") / ".cache";
  return base.empty() ? base : base / "cordon/plugins";
}

struct Memory {
  std::mutex mutex;
  std::map<std::string, std::string> entries;
};
Memory& memory() {
  static Memory memory;
  return memory;
}

std::string read_entry(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(longest_entry, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return text;
}

/// Under another name first: who reads meanwhile finds the old entry or the new one. Failures are
/// nobody's loss.
void write_entry(const fs::path& directory, const std::string& slot, const std::string& text) {
  std::error_code error;
  fs::create_directories(directory, error);
  const fs::path partial = directory / fmt::format(".{}-{}", slot, getpid());
  std::ofstream out(partial, std::ios::binary);
  out << text;
  out.close();
  if (out) fs::rename(partial, directory / slot, error);
  if (!out || error) fs::remove(partial, error);
}

/// The entry's verdict, if it is about this very file.
std::optional<Verdict> verdict_in(const std::string& entry, const FileIdentity& file) {
  if (!entry.starts_with(file.text)) return std::nullopt;
  const std::string rest = entry.substr(file.text.size());
  if (rest == works) return Verdict{};
  const std::size_t middle = rest.find('\n');
  if (middle == std::string::npos || middle == 0 || !rest.ends_with('\n')) return std::nullopt;
  return Verdict{
      Refusal{rest.substr(0, middle), rest.substr(middle + 1, rest.size() - middle - 2)}};
}

std::string entry_of(const FileIdentity& file, const Verdict& verdict) {
  if (!verdict.refusal) return file.text + works;
  return fmt::format("{}{}\n{}\n", file.text, verdict.refusal->reason, verdict.refusal->fix);
}

}  // namespace

FileIdentity::FileIdentity(const fs::path& file, const std::string& bytes)
    : slot(fmt::format("{:03x}", checksum(file.native()) % slots)) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) status = {};
  text = fmt::format("{}\ninode {} size {} time {}.{:09} checksum {:016x}\n{} {}\n", file.native(),
                     status.st_ino, bytes.size(), status.st_mtim.tv_sec, status.st_mtim.tv_nsec,
                     checksum(bytes), CORDON_VERSION, CORDON_ABI_TAG);
}

std::optional<Verdict> recall(const FileIdentity& file) {
  Memory& mine = memory();
  const std::lock_guard lock(mine.mutex);
  if (const auto found = mine.entries.find(file.slot); found != mine.entries.end()) {
    if (auto verdict = verdict_in(found->second, file)) return verdict;
  }
  const fs::path directory = cache_directory();
  if (directory.empty()) return std::nullopt;
  std::string entry = read_entry(directory / file.slot);
  auto verdict = verdict_in(entry, file);
  if (verdict) mine.entries[file.slot] = std::move(entry);
  return verdict;
}

void remember(const FileIdentity& file, const Verdict& verdict, bool lasting) {
  Memory& mine = memory();
  const std::lock_guard lock(mine.mutex);
  std::string& entry = mine.entries[file.slot] = entry_of(file, verdict);
  if (const fs::path directory = cache_directory(); lasting && !directory.empty())
    write_entry(directory, file.slot, entry);
}

}  // namespace cordon::registry
