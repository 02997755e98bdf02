// SPDX-License-Identifier: GPL-3.0-or-later
// A study from the tree of its file, without plugins being loaded and without its sweep.
#pragma once

#include <functional>
#include <memory>

#include "study/reading/read_parts.hpp"

namespace cordon::json {

/// A system that was read, to be taken again for trees that share it.
struct KnownSystem {
  std::shared_ptr<const Parts> source;
  SystemPart part;
  std::vector<std::string> warnings;
};

struct TreeOptions {
  std::filesystem::path file, folder;  ///< of the study; the folder absolute
  StudyData data = StudyData::needed;
  bool checks = true;  ///< nothing was wrong with the text: check the study as a whole
  std::optional<std::size_t> only = {};  ///< the only pipeline that must go together with the rest
  std::function<bool(std::size_t)> asks =
      {};  ///< which pipelines are asked about the model; none: all
  std::shared_ptr<const KnownSystem> known = {};  ///< may be null
};

struct TreeReading {
  Study study;  ///< without source, sweep and resolved text
  Written written;
  std::vector<Diagnostic> refusals;          ///< components that plugins failed to provide
  std::shared_ptr<const KnownSystem> known;  ///< the system, if it is right
};

TreeReading read_tree(const Value& tree, const Registry& registry, const TreeOptions& options,
                      Problems& problems);

}  // namespace cordon::json
