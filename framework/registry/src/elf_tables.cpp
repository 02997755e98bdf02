// SPDX-License-Identifier: GPL-3.0-or-later
// The tables by which a loader finds its way in a library: the dynamic section, symbols with their
// versions, relocations, hashed names.
#include <algorithm>
#include <cstring>

#include "elf_file.hpp"

namespace cordon::registry {

namespace {

std::uint32_t gnu_hash(std::string_view name) {
  std::uint32_t hash = 5381;
  for (const char c : name) hash = 33 * hash + static_cast<unsigned char>(c);
  return hash;
}

/// The beginning of a table of hashed names: a filter, `buckets` numbers of symbols and the chains
/// that start there follow.
struct GnuHash {
  std::uint32_t buckets, first, filter_words, filter_shift;

  ElfW(Addr) first_bucket(ElfW(Addr) table) const {
    return table + sizeof(GnuHash) + filter_words * sizeof(ElfW(Addr));
  }
  ElfW(Addr) first_chain(ElfW(Addr) table) const {
    return first_bucket(table) + ElfW(Addr){4} * buckets;
  }
};

std::uint64_t symbol_of(ElfW(Xword) info) {
#if __ELF_NATIVE_CLASS == 64
  return ELF64_R_SYM(info);
#else
  return ELF32_R_SYM(info);
#endif
}

}  // namespace

/// What stands in the file at an address, to the end of its segment.
std::string_view ElfFile::at(Address address) const {
  for (const Segment& segment : segments_) {
    if (segment.p_type != PT_LOAD || address < segment.p_vaddr ||
        address - segment.p_vaddr >= segment.p_filesz)
      continue;
    const Address into = address - segment.p_vaddr;
    return std::string_view(bytes_).substr(segment.p_offset + into, segment.p_filesz - into);
  }
  return {};
}

template <class T>
std::optional<T> ElfFile::get(Address address) const {
  const std::string_view there = at(address);
  if (there.size() < sizeof(T)) return std::nullopt;
  T value;
  std::memcpy(&value, there.data(), sizeof value);
  return value;
}

std::optional<ElfFile::Address> ElfFile::dynamic(std::int64_t tag) const {
  const auto found = dynamic_.find(tag);
  return found == dynamic_.end() ? std::nullopt : std::optional(found->second);
}

/// The dynamic section, with the names in it inside the table of strings.
bool ElfFile::read_dynamic() {
  std::vector<Address> names;
  for (const Segment& segment : segments_) {
    if (segment.p_type != PT_DYNAMIC) continue;
    for (Address next = segment.p_vaddr;; next += sizeof(ElfW(Dyn))) {
      const auto entry = get<ElfW(Dyn)>(next);
      if (!entry) return false;
      if (entry->d_tag == DT_NULL) break;
      if (entry->d_tag == DT_NEEDED) names.push_back(entry->d_un.d_val);
      dynamic_[entry->d_tag] = entry->d_un.d_val;
    }
  }
  if (!dynamic(DT_SYMTAB) || dynamic(DT_SYMENT) != sizeof(Symbol) || !dynamic(DT_STRTAB) ||
      !dynamic(DT_STRSZ))
    return false;
  const std::string_view strings = at(*dynamic(DT_STRTAB));
  const Address size = *dynamic(DT_STRSZ);
  if (size == 0 || size > strings.size() || strings[size - 1] != '\0') return false;
  return std::all_of(names.begin(), names.end(), [&](Address name) { return name < size; });
}

/// Those that can be found by name, and what stands before them. Nothing where the hash table does
/// not lie within the file.
std::optional<std::uint64_t> ElfFile::symbol_count() const {
  if (const auto older = dynamic(DT_HASH)) {
    const auto chains = get<std::uint32_t>(*older + 4);
    return chains ? std::optional<std::uint64_t>(*chains) : std::nullopt;
  }
  const auto table = dynamic(DT_GNU_HASH);
  const auto head = table ? get<GnuHash>(*table) : std::nullopt;
  const bool is_whole = head && head->filter_words != 0 &&
                        (head->filter_words & (head->filter_words - 1)) == 0 &&
                        fits(head->first_bucket(0), head->buckets, 4, at(*table).size());
  if (!is_whole) return std::nullopt;
  std::uint64_t last = 0;
  for (std::uint32_t i = 0; i < head->buckets; ++i) {
    const std::uint32_t first =
        get<std::uint32_t>(head->first_bucket(*table) + Address{4} * i).value_or(1);
    if (first != 0 && first < head->first) return std::nullopt;
    last = std::max<std::uint64_t>(last, first);
  }
  if (last == 0) return head->first;  // nothing is exported
  for (;; ++last) {
    const auto link = get<std::uint32_t>(head->first_chain(*table) + 4 * (last - head->first));
    if (!link) return std::nullopt;
    if (*link & 1) return last + 1;  // the end of its chain
  }
}

/// The versions that are needed and defined have numbers below this one. Nothing where their lists
/// leave the file.
std::optional<std::uint64_t> ElfFile::version_count() const {
  constexpr std::size_t most = 10'000;  // records that stand in a circle end here
  std::uint64_t count = 2;              // local and global
  std::size_t records = 0;
  const Address names = *dynamic(DT_STRSZ);
  const auto note = [&](std::uint64_t number) { count = std::max(count, (number & 0x7fff) + 1); };
  Address next = dynamic(DT_VERNEED).value_or(0);
  while (next != 0) {
    const auto library = get<ElfW(Verneed)>(next);
    if (!library || library->vn_version != VER_NEED_CURRENT || library->vn_file >= names)
      return std::nullopt;
    Address part = next + library->vn_aux;
    for (bool more = true; more;) {
      const auto version = get<ElfW(Vernaux)>(part);
      if (!version || version->vna_name >= names || ++records > most) return std::nullopt;
      note(version->vna_other);
      more = version->vna_next != 0;
      part += version->vna_next;
    }
    next = library->vn_next != 0 ? next + library->vn_next : 0;
  }
  next = dynamic(DT_VERDEF).value_or(0);
  while (next != 0) {
    const auto version = get<ElfW(Verdef)>(next);
    if (!version || version->vd_version != VER_DEF_CURRENT || ++records > most) return std::nullopt;
    const auto name = get<ElfW(Verdaux)>(next + version->vd_aux);
    if (!name || name->vda_name >= names) return std::nullopt;
    note(version->vd_ndx);
    next = version->vd_next != 0 ? next + version->vd_next : 0;
  }
  return count;
}

/// Has it a name, and one of the versions that there are?
bool ElfFile::symbol_is_sound(std::uint64_t index) const {
  const auto symbol = get<Symbol>(*dynamic(DT_SYMTAB) + index * sizeof(Symbol));
  if (!symbol || symbol->st_name >= *dynamic(DT_STRSZ)) return false;
  if (!dynamic(DT_VERSYM)) return true;
  const auto version = get<ElfW(Versym)>(*dynamic(DT_VERSYM) + index * sizeof(ElfW(Versym)));
  return version && (*version & 0x7fff) < versions_;
}

bool ElfFile::symbols_are_sound() {
  const auto symbols = symbol_count(), versions = version_count();
  if (!symbols || !versions) return false;
  versions_ = *versions;
  for (std::uint64_t i = 0; i < *symbols; ++i) {
    if (!symbol_is_sound(i)) return false;
  }
  return true;
}

bool ElfFile::is_writable(Address address) const {
  return std::any_of(segments_.begin(), segments_.end(), [&](const Segment& s) {
    return s.p_type == PT_LOAD && (s.p_flags & PF_W) && address >= s.p_vaddr &&
           s.p_memsz >= sizeof(Address) && address - s.p_vaddr <= s.p_memsz - sizeof(Address);
  });
}

/// One table of relocations: each writes into data and refers to a symbol of the file.
bool ElfFile::table_is_sound(std::int64_t address_tag, std::int64_t size_tag,
                             std::uint64_t entry) const {
  if (!dynamic(address_tag)) return true;
  const auto size = dynamic(size_tag);
  const std::string_view table = at(*dynamic(address_tag));
  if (!size || *size > table.size() || *size % entry != 0) return false;
  for (std::size_t i = 0; i < *size; i += entry) {
    ElfW(Rel) relocation;  // those with an addend begin alike
    std::memcpy(&relocation, table.data() + i, sizeof relocation);
    const std::uint64_t symbol = symbol_of(relocation.r_info);
    if (!is_writable(relocation.r_offset) || !symbol_is_sound(symbol)) return false;
  }
  return true;
}

bool ElfFile::relocations_are_sound() const {
  const bool addends = dynamic(DT_PLTREL).value_or(DT_RELA) == DT_RELA;
  return table_is_sound(DT_RELA, DT_RELASZ, sizeof(ElfW(Rela))) &&
         table_is_sound(DT_REL, DT_RELSZ, sizeof(ElfW(Rel))) &&
         table_is_sound(DT_JMPREL, DT_PLTRELSZ, addends ? sizeof(ElfW(Rela)) : sizeof(ElfW(Rel)));
}

/// The symbol of this number, if it is defined and has this name.
std::optional<ElfFile::Symbol> ElfFile::defined_as(std::string_view name,
                                                   std::uint64_t index) const {
  const auto symbol = get<Symbol>(*dynamic(DT_SYMTAB) + index * sizeof(Symbol));
  if (!symbol || symbol->st_shndx == SHN_UNDEF || symbol->st_name >= *dynamic(DT_STRSZ))
    return std::nullopt;
  const std::string_view text = at(*dynamic(DT_STRTAB)).substr(symbol->st_name);
  if (text.size() <= name.size() || !text.starts_with(name) || text[name.size()] != '\0')
    return std::nullopt;
  return symbol;
}

std::optional<ElfFile::Symbol> ElfFile::find_by_gnu_hash(Address table,
                                                         std::string_view name) const {
  const auto head = get<GnuHash>(table);
  if (!head || head->buckets == 0) return std::nullopt;
  const std::uint32_t hash = gnu_hash(name);
  const auto first =
      get<std::uint32_t>(head->first_bucket(table) + Address{4} * (hash % head->buckets));
  if (!first || *first < head->first) return std::nullopt;
  for (std::uint64_t index = *first;; ++index) {
    const auto link = get<std::uint32_t>(head->first_chain(table) + 4 * (index - head->first));
    if (!link) return std::nullopt;
    if ((*link | 1) == (hash | 1)) {
      if (const auto symbol = defined_as(name, index)) return symbol;
    }
    if (*link & 1) return std::nullopt;  // the end of its chain
  }
}

std::optional<ElfFile::Symbol> ElfFile::find_by_hash(Address table, std::string_view name) const {
  const auto symbols =
      get<std::uint32_t>(table + 4);  // of the two sizes in front, that of the chains
  for (std::uint64_t index = 0;
       symbols && index < *symbols && get<Symbol>(*dynamic(DT_SYMTAB) + index * sizeof(Symbol));
       ++index) {
    if (const auto symbol = defined_as(name, index)) return symbol;
  }
  return std::nullopt;
}

std::string_view ElfFile::exported(std::string_view name) const {
  std::optional<Symbol> symbol;
  if (const auto table = dynamic(DT_GNU_HASH)) {
    symbol = find_by_gnu_hash(*table, name);
  } else if (const auto older = dynamic(DT_HASH)) {
    symbol = find_by_hash(*older, name);
  }
  return symbol ? at(symbol->st_value).substr(0, symbol->st_size) : std::string_view{};
}

}  // namespace cordon::registry
