// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <stdlib.h>
#include <string>

#include "cordon/registry/registry.hpp"

namespace test {

namespace fs = std::filesystem;

/// A directory that goes with the object.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (fs::temp_directory_path() / "cordon_test_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("mkdtemp failed");
    path_ = fs::canonical(name);
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  fs::path operator/(const fs::path& name) const { return path_ / name; }
  const fs::path& path() const { return path_; }

  fs::path add(const fs::path& file, const std::string& name = "") const {
    const fs::path copy = path_ / (name.empty() ? file.filename().string() : name);
    fs::copy_file(file, copy);
    return copy;
  }
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  fs::path path_;
};

inline std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Is the library part of this process now?
inline bool is_mapped(const fs::path& file) {
  return read("/proc/self/maps").find(file.string()) != std::string::npos;
}

inline bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

inline const cordon::PluginReport* report_of(const cordon::Registry& registry,
                                             const fs::path& file) {
  for (const auto& report : registry.reports()) {
    if (report.file == file) return &report;
  }
  return nullptr;
}

inline fs::path good(const std::string& name) {
  return fs::path(CORDON_GOOD_PLUGINS) / (name + ".so");
}
inline fs::path bad(const std::string& name) {
  return fs::path(CORDON_BAD_PLUGINS) / (name + ".so");
}

}  // namespace test
