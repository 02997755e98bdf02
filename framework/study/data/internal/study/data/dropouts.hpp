// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that lack outputs.
#pragma once

#include <memory>
#include <vector>

#include "cordon/study/data.hpp"
#include "study/data/random.hpp"

namespace cordon::detail {

/// The records of another source without the outputs that its dropouts take. Every output of a
/// dropout has random numbers of its own, one per step from `from` on: what is lost of one depends
/// on no other, and nothing else that is drawn depends on it.
class DropoutData final : public DataSource {
 public:
  DropoutData(std::unique_ptr<DataSource> source, const std::vector<DropoutSpec>& specs,
              std::uint64_t seed);

  std::optional<Record> next() override;
  std::optional<std::int64_t> size() const override { return source_->size(); }

 private:
  struct Dropout {
    DropoutSpec spec;
    std::vector<RandomStream> streams;  ///< one per output
  };

  std::unique_ptr<DataSource> source_;
  std::vector<Dropout> dropouts_;
};

}  // namespace cordon::detail
