// SPDX-License-Identifier: GPL-3.0-or-later
#include "registry/elf_file.hpp"

#include <cerrno>
#include <cstring>
#include <elf.h>
#include <fstream>
#include <link.h>
#include <system_error>
#include <vector>

#include <fmt/format.h>

namespace cordon::registry {

namespace {

namespace fs = std::filesystem;

using Header = ElfW(Ehdr);  // of the class (32 or 64 bits) that this program was compiled for
using Segment = ElfW(Phdr);

constexpr const char* copy_again = "copy or build the library again";
constexpr const char* not_a_plugin = "move it out of the plugin directory, or build the plugin with cordon_add_plugin";

std::optional<Refusal> check_kind(const fs::path& file) {
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(file, error)) && !fs::exists(file, error)) {
    return Refusal{fmt::format("it is a symbolic link to \"{}\", which does not exist", fs::read_symlink(file, error).string()),
                   "mend or remove the link"};
  }
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return Refusal{"there is no such file", "check the path"};
  if (status.type() == fs::file_type::none) return Refusal{"it cannot be examined: " + error.message(), "check its permissions"};
  if (status.type() == fs::file_type::directory) return Refusal{"it is a directory, not a library", "rename or remove it"};
  if (status.type() != fs::file_type::regular) return Refusal{"it is not a regular file", "remove it"};
  return {};
}

template <class T>
bool read_at(std::ifstream& in, std::uint64_t offset, T* data, std::size_t count) {
  in.seekg(static_cast<std::streamoff>(offset));
  return static_cast<bool>(in.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(count * sizeof(T))));
}

/// offset + count * size ≤ limit, without overflow.
bool fits(std::uint64_t offset, std::uint64_t count, std::uint64_t size, std::uint64_t limit) {
  return offset <= limit && (size == 0 || count <= (limit - offset) / size);
}

/// The header of the running program: what a library must agree with.
bool own_header(Header& header) {
  std::ifstream self("/proc/self/exe", std::ios::binary);
  return self && read_at(self, 0, &header, 1);
}

std::optional<Refusal> check_header(const Header& header) {
  Header own{};
  const bool known = own_header(own);
  if (known && header.e_ident[EI_CLASS] != own.e_ident[EI_CLASS]) {
    return Refusal{"it is a library for a different word size (32 or 64 bits)", "build the plugin for this machine"};
  }
  if (known && (header.e_ident[EI_DATA] != own.e_ident[EI_DATA] || header.e_machine != own.e_machine)) {
    return Refusal{
        fmt::format("it is built for another processor (ELF machine {}, this program has {})", header.e_machine, own.e_machine),
        "build the plugin for this machine"};
  }
  if (header.e_type != ET_DYN) return Refusal{"it is an ELF file but no shared library", not_a_plugin};
  if (header.e_phnum == 0 || header.e_phnum == PN_XNUM || header.e_phentsize != sizeof(Segment)) {
    return Refusal{"its ELF header is damaged", copy_again};
  }
  return {};
}

std::optional<Refusal> check_extent(std::ifstream& in, const Header& header, std::uint64_t size) {
  const Refusal truncated{fmt::format("it is truncated: {} bytes do not hold what its ELF header announces", size), copy_again};
  if (!fits(header.e_phoff, header.e_phnum, header.e_phentsize, size)) return truncated;
  if (header.e_shoff != 0 && !fits(header.e_shoff, header.e_shnum, header.e_shentsize, size)) return truncated;
  std::vector<Segment> segments(header.e_phnum);
  if (!read_at(in, header.e_phoff, segments.data(), segments.size())) return truncated;
  for (const Segment& segment : segments) {
    if (segment.p_type != PT_NULL && !fits(segment.p_offset, segment.p_filesz, 1, size)) return truncated;
  }
  return {};
}

}  // namespace

std::optional<Refusal> check_library_file(const fs::path& file) {
  if (auto refusal = check_kind(file)) return refusal;
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error) return Refusal{"it cannot be examined: " + error.message(), "check its permissions"};
  if (size == 0) return Refusal{"it is empty", copy_again};
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) return Refusal{fmt::format("it cannot be read: {}", std::strerror(errno)), "check its permissions"};
  unsigned char magic[SELFMAG] = {};
  if (size < SELFMAG || !read_at(in, 0, magic, SELFMAG) || std::memcmp(magic, ELFMAG, SELFMAG) != 0) {
    return Refusal{"it is not a shared library (no ELF file)", not_a_plugin};
  }
  Header header{};
  if (size < sizeof header || !read_at(in, 0, &header, 1)) {
    return Refusal{fmt::format("it is truncated: {} bytes are less than an ELF header", size), copy_again};
  }
  if (auto refusal = check_header(header)) return refusal;
  return check_extent(in, header, size);
}

}  // namespace cordon::registry
