// SPDX-License-Identifier: GPL-3.0-or-later
// manifest.json: which files belong together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace cordon::detail {

inline constexpr const char* manifest_name = "manifest.json";

/// A file as it was written.
struct ManifestEntry {
  std::string name;  ///< without a folder
  std::int64_t bytes = 0;
  std::string fnv1a64;
  friend bool operator==(const ManifestEntry&, const ManifestEntry&) = default;
};

std::string manifest_text(const std::vector<ManifestEntry>& files);

/// Throws InputError: the file cannot be read, or is no manifest.
std::vector<ManifestEntry> read_manifest(const std::filesystem::path& file);

/// Results that are read. Where there is a manifest.json, every file that is read must be the one
/// it lists; results without one, of earlier versions or changed by hand, are taken as they are.
class RecordedFiles {
 public:
  /// Finishes what a writer that has died while it put its results in place has left. Throws
  /// InputError, Errc::io: that is not possible, or the manifest is damaged.
  explicit RecordedFiles(std::filesystem::path directory);

  const std::filesystem::path& directory() const { return directory_; }
  /// The file of this name, which is as the manifest lists it. Reads it once. Throws InputError.
  std::filesystem::path file(const std::string& name) const;
  /// To be called when all files were read. Throws InputError if others took their place meanwhile.
  void check_unchanged() const;

 private:
  std::filesystem::path directory_;
  bool listed_ = false;  ///< there is a manifest
  std::vector<ManifestEntry> files_;
};

}  // namespace cordon::detail
