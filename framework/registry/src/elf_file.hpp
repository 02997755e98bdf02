// SPDX-License-Identifier: GPL-3.0-or-later
// A library's file, looked at without any of it being executed.
#pragma once

#include <cstdint>
#include <elf.h>
#include <filesystem>
#include <link.h>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "refusal.hpp"

namespace cordon::registry {

/// Bytes; anything larger is no plugin that is worth reading for a name.
inline constexpr std::uintmax_t largest_library = 256u << 20;

/// offset + count * size ≤ limit, without overflow.
bool fits(std::uint64_t offset, std::uint64_t count, std::uint64_t size, std::uint64_t limit);

/// The whole file in memory, and the tables by which the loader finds its way in it.
class ElfFile {
 public:
  /// Reads the file. Refused, and of no further use, unless it is a regular, readable ELF shared
  /// object of this machine whose segments and tables lie within it, with relocations that write
  /// into its own data only, and symbols that have a name and a version. The loader checks none of
  /// that: it dies of SIGBUS on a truncated library, writes wherever a damaged relocation leads,
  /// and takes whatever stands behind the table of versions for one. O(bytes).
  std::optional<Refusal> read(const std::filesystem::path& file);

  const std::string& bytes() const { return bytes_; }
  /// What stands in the file at an object that the library defines and exports (pointers among it
  /// are not relocated); nothing if it exports no such object, or none that lies within the file.
  /// Found by the hash table that the loader uses.
  std::string_view exported(std::string_view symbol) const;

 private:
  using Address = ElfW(Addr);
  using Segment = ElfW(Phdr);
  using Symbol = ElfW(Sym);

  std::optional<Refusal> check_extent(const ElfW(Ehdr) & header);
  bool segments_are_apart() const;
  bool is_loaded(const Segment& part) const;
  bool read_dynamic();
  std::optional<std::uint64_t> symbol_count() const;
  std::optional<std::uint64_t> version_count() const;
  bool symbol_is_sound(std::uint64_t index) const;
  bool symbols_are_sound();
  bool relocations_are_sound() const;
  bool table_is_sound(std::int64_t address_tag, std::int64_t size_tag, std::uint64_t entry) const;
  bool is_writable(Address address) const;
  std::string_view at(Address address) const;
  template <class T>
  std::optional<T> get(Address address) const;
  std::optional<Address> dynamic(std::int64_t tag) const;
  std::optional<Symbol> defined_as(std::string_view name, std::uint64_t index) const;
  std::optional<Symbol> find_by_gnu_hash(Address table, std::string_view name) const;
  std::optional<Symbol> find_by_hash(Address table, std::string_view name) const;

  std::string bytes_;
  std::vector<Segment> segments_;
  std::map<std::int64_t, Address> dynamic_;
  std::uint64_t versions_ = 0;  ///< their numbers are less
};

}  // namespace cordon::registry
