// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of a library that the loader believes without a look are looked at before it.
#include <cstring>
#include <elf.h>
#include <functional>
#include <link.h>

#include <doctest/doctest.h>

#include "registry/temporary.hpp"

using namespace cordon;
using namespace test;

namespace {

/// A copy of a good plugin, with what `change` does to the sections of one type.
class Changed {
 public:
  explicit Changed(ElfW(Word) type,
                   const std::function<void(char* bytes, std::size_t size)>& change) {
    std::string bytes = read(good("test_box"));
    ElfW(Ehdr) header;
    std::memcpy(&header, bytes.data(), sizeof header);
    std::size_t found = 0;
    for (std::size_t i = 0; i < header.e_shnum; ++i) {
      ElfW(Shdr) section;
      std::memcpy(&section, bytes.data() + header.e_shoff + i * sizeof section, sizeof section);
      if (section.sh_type != type) continue;
      change(bytes.data() + section.sh_offset, section.sh_size);
      ++found;
    }
    REQUIRE(found > 0);
    file_ = directory_.write("changed.so", bytes);
  }

  PluginReport report() const {
    Registry registry;
    return registry.load_file(file_);
  }

 private:
  TemporaryDirectory directory_;
  fs::path file_;
};

void refuses(const Changed& changed) {
  const PluginReport report = changed.report();
  CHECK(report.state == PluginReport::State::refused);
  CHECK_MESSAGE(report.reason == "its tables are damaged", report.reason);
}

template <class T>
std::function<void(char*, std::size_t)> set(std::size_t at, T value) {
  return [=](char* bytes, std::size_t size) {
    REQUIRE(at + sizeof value <= size);
    std::memcpy(bytes + at, &value, sizeof value);
  };
}

}  // namespace

TEST_CASE("a library that was not changed is loaded") {
  CHECK(Changed(SHT_GNU_versym, [](char*, std::size_t) {}).report().state ==
        PluginReport::State::loaded);
}

TEST_CASE("symbols have versions that there are") {
  for (const std::size_t symbol : {1u, 3u, 7u, 30u}) {
    CAPTURE(symbol);
    refuses(Changed(SHT_GNU_versym, set<ElfW(Versym)>(symbol * sizeof(ElfW(Versym)), 0x0400)));
  }
}

TEST_CASE("lists of versions end within the file") {
  refuses(Changed(SHT_GNU_verneed, set<ElfW(Word)>(offsetof(ElfW(Verneed), vn_next), 0x01000000)));
  refuses(Changed(SHT_GNU_verneed, set<ElfW(Word)>(offsetof(ElfW(Verneed), vn_file), 0x01000000)));
  refuses(Changed(
      SHT_GNU_verneed,
      set<ElfW(Word)>(sizeof(ElfW(Verneed)) + offsetof(ElfW(Vernaux), vna_name), 0x01000000)));
  refuses(Changed(SHT_GNU_verneed, set<ElfW(Half)>(0, 7)));
}

TEST_CASE("tables of hashed names lead to symbols of the file") {
  refuses(Changed(SHT_GNU_HASH, set<std::uint32_t>(0, 0x01000000)));  // buckets
  refuses(Changed(SHT_GNU_HASH, set<std::uint32_t>(8, 3)));  // words of the filter, no power of two
  refuses(Changed(SHT_GNU_HASH, set<std::uint32_t>(24, 0x01000000)));  // a bucket's first symbol
}

TEST_CASE("symbols have names in the table of names") {
  refuses(Changed(SHT_DYNSYM, set<ElfW(Word)>(2 * sizeof(ElfW(Sym)), 0x01000000)));
}
