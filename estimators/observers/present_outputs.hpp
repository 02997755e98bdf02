// SPDX-License-Identifier: GPL-3.0-or-later
// What observers do with samples that lack outputs: they work with the model of the others.
#pragma once

#include <map>
#include <memory>
#include <vector>

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

 private:
  static constexpr std::size_t most_kept = 64;
  std::map<std::vector<Index>, std::shared_ptr<Part>> parts_;
};

}  // namespace cordon::estimators
