// SPDX-License-Identifier: GPL-3.0-or-later
// A library's file as a whole: its kind, header and segments.
#include "elf_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

namespace cordon::registry {

namespace {

namespace fs = std::filesystem;

using Header = ElfW(Ehdr);  // of the class (32 or 64 bits) that this program was compiled for

constexpr const char* copy_again = "copy or build the library again";
constexpr const char* not_a_plugin =
    "move it out of the plugin directory, or build the plugin with cordon_add_plugin";

std::optional<Refusal> check_kind(const fs::path& file) {
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(file, error)) && !fs::exists(file, error)) {
    return Refusal{fmt::format("it is a symbolic link to \"{}\", which does not exist",
                               fs::read_symlink(file, error).string()),
                   "repair or remove the link"};
  }
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    return Refusal{"there is no such file", "check the path"};
  if (status.type() == fs::file_type::none)
    return Refusal{"it cannot be examined: " + error.message(), "check its permissions"};
  if (status.type() == fs::file_type::directory)
    return Refusal{"it is a directory, not a library", "rename or remove it"};
  if (status.type() != fs::file_type::regular)
    return Refusal{"it is not a regular file", "remove it"};
  return {};
}

/// The header of the running program: what a library must agree with.
bool own_header(Header& header) {
  std::ifstream self("/proc/self/exe", std::ios::binary);
  return static_cast<bool>(self.read(reinterpret_cast<char*>(&header), sizeof header));
}

std::optional<Refusal> check_header(const Header& header) {
  Header own{};
  const bool known = own_header(own);
  if (known && header.e_ident[EI_CLASS] != own.e_ident[EI_CLASS]) {
    return Refusal{"it is a library for a different word size (32 or 64 bits)",
                   "build the plugin for this machine"};
  }
  if (known &&
      (header.e_ident[EI_DATA] != own.e_ident[EI_DATA] || header.e_machine != own.e_machine)) {
    return Refusal{
        fmt::format("it is built for another processor (ELF machine {}, this program has {})",
                    header.e_machine, own.e_machine),
        "build the plugin for this machine"};
  }
  if (header.e_type != ET_DYN)
    return Refusal{"it is an ELF file but no shared library", not_a_plugin};
  if (header.e_phnum == 0 || header.e_phnum == PN_XNUM ||
      header.e_phentsize != sizeof(ElfW(Phdr))) {
    return Refusal{"its ELF header is damaged", copy_again};
  }
  return {};
}

std::optional<Refusal> read_whole(const fs::path& file, std::string& bytes) {
  if (auto refusal = check_kind(file)) return refusal;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return Refusal{"it cannot be examined: " + error.message(), "check its permissions"};
  if (size == 0) return Refusal{"it is empty", copy_again};
  if (size > largest_library)
    return Refusal{fmt::format("it has {} bytes, at most {} are read", size, largest_library),
                   not_a_plugin};
  std::ifstream in(file, std::ios::binary);
  if (!in)
    return Refusal{fmt::format("it cannot be read: {}", std::strerror(errno)),
                   "check its permissions"};
  bytes.resize(size);
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (in.bad()) return Refusal{"it cannot be read", "check the disk"};
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return {};
}

}  // namespace

bool fits(std::uint64_t offset, std::uint64_t count, std::uint64_t size, std::uint64_t limit) {
  return offset <= limit && (size == 0 || count <= (limit - offset) / size);
}

std::optional<Refusal> ElfFile::read(const fs::path& file) {
  if (auto refusal = read_whole(file, bytes_)) return refusal;
  if (bytes_.compare(0, SELFMAG, ELFMAG) != 0)
    return Refusal{"it is not a shared library (no ELF file)", not_a_plugin};
  Header header{};
  if (bytes_.size() < sizeof header) {
    return Refusal{
        fmt::format("it is truncated: {} bytes are less than an ELF header", bytes_.size()),
        copy_again};
  }
  std::memcpy(&header, bytes_.data(), sizeof header);
  if (auto refusal = check_header(header)) return refusal;
  if (auto refusal = check_extent(header)) return refusal;
  if (!read_dynamic() || !symbols_are_sound() || !relocations_are_sound())
    return Refusal{"its tables are damaged", copy_again};
  return {};
}

std::optional<Refusal> ElfFile::check_extent(const Header& header) {
  const std::uint64_t size = bytes_.size();
  const Refusal truncated{
      fmt::format("it is truncated: {} bytes do not hold what its ELF header announces", size),
      copy_again};
  if (!fits(header.e_phoff, header.e_phnum, header.e_phentsize, size)) return truncated;
  if (header.e_shoff != 0 && !fits(header.e_shoff, header.e_shnum, header.e_shentsize, size))
    return truncated;
  segments_.resize(header.e_phnum);
  std::memcpy(segments_.data(), bytes_.data() + header.e_phoff, segments_.size() * sizeof(Segment));
  for (const Segment& segment : segments_) {
    if (segment.p_type != PT_NULL && !fits(segment.p_offset, segment.p_filesz, 1, size))
      return truncated;
    if (!is_loaded(segment)) return Refusal{"its program headers are damaged", copy_again};
  }
  if (!segments_are_apart()) return Refusal{"its program headers are damaged", copy_again};
  return {};
}

/// Loaded parts come in the order of their addresses and share no page: where one reaches into the
/// next, or beyond what is reserved for all, it depends on the addresses of a process what is
/// overwritten.
bool ElfFile::segments_are_apart() const {
  constexpr Address page = 1u << 12;
  Address end = 0;
  for (const Segment& s : segments_) {
    if (s.p_type != PT_LOAD) continue;
    const bool aligned = s.p_align >= page && (s.p_align & (s.p_align - 1)) == 0 &&
                         (s.p_vaddr - s.p_offset) % s.p_align == 0;
    if (!aligned || s.p_vaddr / page * page < end || s.p_vaddr > largest_library) return false;
    end = (s.p_vaddr + s.p_memsz + page - 1) / page * page;
  }
  return true;
}

/// What a header describes must lie in memory that is loaded: tables for exceptions among it, which
/// are read when one is thrown.
bool ElfFile::is_loaded(const Segment& part) const {
  constexpr Address page = 1u << 16;  // the largest in use; a part may end with its page
  if (part.p_type == PT_LOAD)
    return part.p_memsz >= part.p_filesz && part.p_memsz <= largest_library;
  if (part.p_type == PT_NULL || part.p_type == PT_GNU_STACK || part.p_memsz == 0) return true;
  return std::any_of(segments_.begin(), segments_.end(), [&](const Segment& s) {
    return s.p_type == PT_LOAD && part.p_vaddr >= s.p_vaddr &&
           fits(part.p_vaddr - s.p_vaddr, part.p_memsz, 1, s.p_memsz + page) &&
           (part.p_type == PT_GNU_RELRO || part.p_filesz == 0 ||
            part.p_vaddr - s.p_vaddr == part.p_offset - s.p_offset);
  });
}

}  // namespace cordon::registry
