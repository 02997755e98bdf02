// SPDX-License-Identifier: GPL-3.0-or-later
// Studies, results and sets in the files of others: MAT-files of MATLAB and Octave, and matrices in
// sparse form (docs/interchange.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cordon/study/study.hpp"

namespace cordon {

/// Where to write. Files appear whole or not at all.
struct Target {
  std::filesystem::path file;
  bool replace = false;  ///< false: a file that is there is an error
};

/// Writes `system`, and `data` unless they are left out, as a MAT-file of version 5. Errc::invalid
/// if the data are too large.
void study_to_mat(const Study& study, const Target& target, bool with_data = true);

/// Writes what a finished run or sweep has left in `directory`: `system`, `data`, and `results` or
/// `sweep`; with the sets of every step if asked for. Throws InputError.
void results_to_mat(const std::filesystem::path& directory, const Target& target,
                    bool with_sets = false);

/// Writes a JSON file of one set, or of a list of sets: `set`, or `sets`. Throws InputError.
void sets_to_mat(const std::filesystem::path& json, const Target& target);

struct ImportedStudy {
  std::vector<std::filesystem::path> files;  ///< the study, and its data if there are any
  bool sets_only = false;                    ///< what was written is a set or a list of sets
  std::vector<std::string>
      missing;  ///< what has to be added to the study before it can run: "W", "V"
  std::vector<std::string>
      ignored;  ///< fields and variables of the file that are no part of the system
};

/// Reads a MAT-file and writes its system as the beginning of a study; data beside it become a CSV
/// file of the same name. A file that holds sets and no system becomes a JSON file of sets.
/// `variable`: the one to take; empty: `system`, or the only one that fits. Throws InputError.
ImportedStudy mat_to_json(const std::filesystem::path& mat, const Target& target,
                          const std::string& variable = "");

/// What a JSON file holds, by its keys. Throws InputError for a text that is not JSON.
enum class JsonFile { study, sets, results, other };
JsonFile json_file(const std::filesystem::path& json);

enum class MatrixForm { dense, sparse };

/// Rewrites a study, or a file of sets, with every matrix in this form; `sparse`: where it is
/// shorter. All else stays as it is, apart from line breaks. Throws InputError.
void rewrite_matrices(const std::filesystem::path& json, const Target& target, MatrixForm form);

}  // namespace cordon
