// SPDX-License-Identifier: GPL-3.0-or-later
// What observers do with samples that lack outputs: they work with the model of the others.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon::estimators {

/// Parts of an observer, one for each choice of outputs that samples have lacked so far, made when
/// it is first needed. Few choices are kept: where outputs are lost at random, they hardly return.
template <class Part>
class PerOutputs {
 public:
  /// The part for the outputs that `sample` has; `make` makes it from these outputs.
  template <class Make>
  std::shared_ptr<Part> at(const Sample& sample, Make&& make) {
    if (const auto found = parts_.find(sample.missing); found != parts_.end()) return found->second;
    if (parts_.size() >= most_kept) parts_.clear();
    return parts_.emplace(sample.missing, make(present_outputs(sample))).first->second;
  }

  void clear() { parts_.clear(); }

  /// The choices that are kept, of `outputs` outputs; `each` takes what a part has beside them.
  template <class Make, class Each>
  void serialize(Archive& archive, Index outputs, Make&& make, Each&& each) {
    std::vector<std::vector<Index>> choices;
    for (const auto& [missing, part] : parts_) choices.push_back(missing);
    archive(choices);
    if (choices.size() > most_kept) archive.refuse("more choices of outputs than are kept");
    if (archive.is_reading()) parts_.clear();
    for (const std::vector<Index>& missing : choices) {
      if (archive.is_reading()) {
        check(archive, missing, outputs);
        const Sample sample{0, Vector(0), Vector::Zero(outputs), missing};
        if (!parts_.emplace(missing, make(present_outputs(sample))).second)
          archive.refuse("a choice of outputs that is there twice");
      }
      each(*parts_.at(missing));
    }
  }

 private:
  static void check(const Archive& archive, const std::vector<Index>& missing, Index outputs) {
    Index last = -1;
    for (const Index i : missing) {
      if (i <= last || i >= outputs) archive.refuse("no choice of outputs");
      last = i;
    }
  }

  static constexpr std::size_t most_kept = 64;
  std::map<std::vector<Index>, std::shared_ptr<Part>> parts_;
};

}  // namespace cordon::estimators
