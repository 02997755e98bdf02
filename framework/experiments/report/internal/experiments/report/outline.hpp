// SPDX-License-Identifier: GPL-3.0-or-later
// A results file without the lists that grow with the run: their items are handed over one by one.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace cordon::report {

struct Outline {
  std::string text;   ///< the file with [] in place of `steps` of every pipeline and of `points`
  std::string study;  ///< the text of `study`
};

/// Called for each item of a left-out list: index of the pipeline (0 for `points`), and the item's
/// text.
using ItemVisitor = std::function<void(std::size_t, const std::string&)>;

/// Reads `file` from beginning to end in constant memory. What is malformed stays so in `text`: its
/// reader reports it. Throws InputError: cannot be read, too deep, an item or the rest of the file
/// too large.
Outline outline_of(const std::filesystem::path& file, const ItemVisitor& visit = {});

}  // namespace cordon::report
