// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that lack outputs, or have wrong ones.
#pragma once

#include <memory>
#include <vector>

#include "cordon/study/data.hpp"
#include "study/data/random.hpp"

namespace cordon::detail {

/// The records of another source with the outliers of a simulation, and without the outputs that
/// its dropouts take. Every output of a dropout or outlier has random numbers of its own, one per
/// step from `from` on: what becomes of one depends on no other, and nothing else that is drawn
/// depends on it.
class DisturbedData final : public DataSource {
 public:
  DisturbedData(std::unique_ptr<DataSource> source, const SimulateSpec& spec);

  std::optional<Record> next() override;
  std::optional<std::int64_t> size() const override { return source_->size(); }

 private:
  /// Outputs at times that are drawn.
  struct Drawn {
    DropoutSpec spec;
    double shift = 0;
    std::vector<RandomStream> streams;  ///< one per output
  };
  static Drawn drawn(const DropoutSpec& spec, double shift, std::uint64_t seed, Purpose purpose,
                     std::size_t number);

  std::unique_ptr<DataSource> source_;
  std::vector<Drawn> dropouts_, outliers_;
};

}  // namespace cordon::detail
