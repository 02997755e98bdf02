// SPDX-License-Identifier: GPL-3.0-or-later
// What a study was read from, kept beside it so that its points are read without parsing the file
// again. Immutable but for the memory of questions, and shared by all copies of the study and by
// threads.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <unordered_set>
#include <vector>

#include "read_tree.hpp"

namespace cordon::json {

struct StudySource {
  std::string text;
  std::filesystem::path file, folder;
  StudyData data = StudyData::needed;
  Value tree;  ///< of studies with a sweep: the file, with a name in every pipeline
  std::vector<WrittenAxis> sweep;
  std::shared_ptr<const KnownSystem> system;  ///< of the first values

  /// Pipelines need not be asked again whether they go together with a model: they answered yes
  /// under the same values of all axes that lead into them or into the system.
  bool is_known(const Registry& registry, std::size_t pipeline,
                const std::vector<std::size_t>& at) const;
  void remember(const Registry& registry, std::size_t pipeline,
                const std::vector<std::size_t>& at) const;

 private:
  std::string question(const Registry& registry, std::size_t pipeline,
                       const std::vector<std::size_t>& at) const;

  mutable std::mutex mutex_;
  mutable std::unordered_set<std::string> known_;
};

/// The text as `Study::source`, which keeps the whole alive.
std::shared_ptr<const std::string> share(std::shared_ptr<const StudySource> source);
/// The whole again. Throws Errc::invalid if the study was not made by read_study.
const StudySource& source_of(const Study& study);

}  // namespace cordon::json
