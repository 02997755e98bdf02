// SPDX-License-Identifier: GPL-3.0-or-later
// Damaged plugin files: each is refused or works, `cordon list` lives, and what else there is goes
// on working.
//   CORDON_PLUGIN_FILES    how many (150; the nightly test takes 10,000), from number
//   CORDON_CAMPAIGN_FIRST (0) on CORDON_CAMPAIGN_SEED   which (1) CORDON_CAMPAIGN_KEEP   a
//   directory that keeps the files on which a check failed
#include <algorithm>
#include <array>
#include <cstring>
#include <elf.h>
#include <link.h>
#include <map>
#include <random>

#include <doctest/doctest.h>

#include "registry/temporary.hpp"
#include "run/program.hpp"

using namespace test;

namespace {

std::size_t number_in(const char* variable, std::size_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::stoul(text) : otherwise;
}

/// Damages of every kind, chosen by a seed alone.
class Damage {
 public:
  Damage(const std::string& bytes, std::uint64_t seed) : bytes_(bytes), random_(seed) {
    std::memcpy(&header_, bytes_.data(), sizeof header_);
    sections_.resize(header_.e_shnum);
    std::memcpy(sections_.data(), bytes_.data() + header_.e_shoff,
                sections_.size() * sizeof sections_[0]);
    std::erase_if(sections_,
                  [](const Section& s) { return s.sh_type == SHT_NOBITS || s.sh_size == 0; });
  }

  std::string make() {
    switch (below(8)) {
      case 0:
        kind = "truncated";
        bytes_.resize(below(bytes_.size()));
        break;
      case 1:
        kind = "bit in a header";
        flip(below(sizeof header_ + header_.e_phnum * sizeof(ElfW(Phdr))));
        break;
      case 2:
        kind = "bit anywhere";
        flip(below(bytes_.size()));
        break;
      case 3:
      case 4:
        kind = "bits in a section";
        for (std::size_t i = 0, bits = 1 + below(8); i < bits; ++i) flip(within_section());
        break;
      case 5:
        kind = "random bytes in a section";
        overwrite(within_section());
        break;
      case 6:
        kind = "a page of zeros or ones";
        fill_page(below(bytes_.size() - page));
        break;
      default:
        kind = "bytes inserted";
        insert(below(bytes_.size()));
        break;
    }
    return bytes_;
  }

  std::string kind;

 private:
  using Section = ElfW(Shdr);
  static constexpr std::size_t page = 4096;

  std::size_t below(std::size_t end) { return static_cast<std::size_t>(random_() % end); }
  void flip(std::size_t at) { bytes_[at] = static_cast<char>(bytes_[at] ^ (1 << below(8))); }
  void overwrite(std::size_t at) {
    const std::size_t end = std::min(at + 1 + below(64), bytes_.size());
    for (std::size_t i = at; i < end; ++i) bytes_[i] = static_cast<char>(below(256));
  }
  void fill_page(std::size_t at) {
    const char byte = below(2) ? '\0' : '\xff';
    std::fill_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at), page, byte);
  }
  void insert(std::size_t at) {
    const std::size_t count = 1 + below(32);
    const auto byte = static_cast<char>(below(256));
    bytes_.insert(at, count, byte);
  }
  /// Every section is as likely: tables are short, and what the loader reads first.
  std::size_t within_section() {
    const Section& section = sections_[below(sections_.size())];
    return section.sh_offset + below(section.sh_size);
  }

  std::string bytes_;
  std::mt19937_64 random_;
  ElfW(Ehdr) header_;
  std::vector<Section> sections_;
};

constexpr std::size_t other_components = 5;

enum class Became { working, refused, neither };

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Plugins are searched beside the libraries too: the program alone has its own.
void copy_libraries() {
  const fs::path built = fs::path(CORDON_BUILT_PROGRAM).parent_path().parent_path() / "lib";
  for (const fs::directory_entry& entry : fs::directory_iterator(built)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("libcordon") && name.ends_with(".so.0"))
      fs::copy_file(entry.path(), fs::path(CORDON_ALONE "/lib") / name,
                    fs::copy_options::overwrite_existing);
  }
}

/// What `cordon list` says of the file; whatever that is, the other plugin must work. A working one
/// adds its components, under whatever name is left of theirs.
Became listed(const fs::path& file, const std::string& cache) {
  const Outcome outcome =
      cordon_with("list --plugins " + file.parent_path().string(),
                  "LD_LIBRARY_PATH=" CORDON_ALONE "/lib XDG_CACHE_HOME=" + cache);
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  CHECK_MESSAGE(contains(outcome.out, "throws_own"), outcome.out);
  const std::size_t reason = outcome.err.find("warning: " + file.string() + " was refused: ");
  const bool refused =
      reason != std::string::npos && outcome.err.find("; ", reason) != std::string::npos;
  const bool works = lines_of(outcome.out) > other_components + 1;
  if (refused == works) MESSAGE(outcome.out << outcome.err);
  return refused == works ? Became::neither : refused ? Became::refused : Became::working;
}

}  // namespace

TEST_CASE("a damaged plugin file is refused or works, and nothing else suffers") {
  const std::size_t files = number_in("CORDON_PLUGIN_FILES", 150),
                    seed = number_in("CORDON_CAMPAIGN_SEED", 1);
  const std::size_t begin = number_in("CORDON_CAMPAIGN_FIRST", 0);
  const char* keep = std::getenv("CORDON_CAMPAIGN_KEEP");
  fs::create_directories(CORDON_ALONE "/bin");
  fs::create_directories(CORDON_ALONE "/lib/cordon/plugins-v1");
  fs::copy_file(CORDON_BUILT_PROGRAM, CORDON_PROGRAM, fs::copy_options::overwrite_existing);
  fs::copy_file(CORDON_OTHER_PLUGIN, CORDON_ALONE "/lib/cordon/plugins-v1/other.so",
                fs::copy_options::overwrite_existing);
  copy_libraries();
  const TemporaryDirectory directory, cache;
  const std::string bytes = read(CORDON_DAMAGED_PLUGIN);
  const fs::path file = directory.write("damaged.so", bytes);
  REQUIRE(listed(file, cache.path().string()) == Became::working);
  std::map<std::string, std::array<std::size_t, 2>> counts;
  for (std::size_t k = begin; k < begin + files; ++k) {
    Damage damage(bytes, 1'000'003 * seed + k);
    directory.write("damaged.so", damage.make());
    INFO("seed ", seed, ", file ", k, ": ", damage.kind);
    const Became first = listed(file, cache.path().string());
    CHECK(first != Became::neither);
    // once more, with what is remembered of the first time; at other addresses a damaged library
    // may do otherwise
    const Became second = listed(file, cache.path().string());
    CHECK(second != Became::neither);
    if (keep && (first == Became::neither || second == Became::neither))
      fs::copy_file(file, fs::path(keep) / (std::to_string(k) + ".so"),
                    fs::copy_options::overwrite_existing);
    ++counts[damage.kind][first == Became::refused];
  }
  for (const auto& [kind, count] : counts)
    MESSAGE(kind << ": " << count[1] << " refused, " << count[0] << " work");
}
