// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of a finished run or sweep tell of its numbers, and of where they were measured.
#pragma once

#include <map>

#include "cordon/study/result_table.hpp"

namespace cordon::detail {

struct RecordedTable {
  ResultTable table;
  std::string abi_tag;
  std::map<std::string, std::string> tools;  ///< versions of what the program was built with
  std::string host, processor;
};

/// Reads results.json and run.json of a directory. Memory does not depend on the number of steps.
/// Throws InputError.
RecordedTable read_recorded_table(const std::filesystem::path& directory);

}  // namespace cordon::detail
