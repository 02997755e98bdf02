// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/dropouts.hpp"

#include <limits>

namespace cordon::detail {

DropoutData::DropoutData(std::unique_ptr<DataSource> source, const std::vector<DropoutSpec>& specs,
                         std::uint64_t seed)
    : source_(std::move(source)) {
  for (const DropoutSpec& spec : specs) {
    Dropout dropout{spec, {}};
    for (const Index output : spec.outputs) {
      const std::uint64_t number = dropouts_.size();
      dropout.streams.emplace_back(seed, Purpose::dropout,
                                   (number << 32) + static_cast<std::uint64_t>(output));
    }
    dropouts_.push_back(std::move(dropout));
  }
}

std::optional<Record> DropoutData::next() {
  std::optional<Record> record = source_->next();
  if (!record) return record;
  Sample& sample = record->sample;
  std::vector<bool> lost(static_cast<std::size_t>(sample.y.size()));
  for (Dropout& dropout : dropouts_) {
    const DropoutSpec& spec = dropout.spec;
    if (sample.k < spec.from || sample.k > spec.to) continue;
    const bool is_due = spec.every > 0 && (sample.k - spec.from) % spec.every == 0;
    for (std::size_t i = 0; i < spec.outputs.size(); ++i) {
      const bool drawn = dropout.streams[i].unit() < spec.probability;
      if (drawn && !is_due) lost[static_cast<std::size_t>(spec.outputs[i])] = true;
    }
  }
  for (Index i = 0; i < sample.y.size(); ++i) {
    if (!lost[static_cast<std::size_t>(i)]) continue;
    sample.y[i] = std::numeric_limits<double>::quiet_NaN();
    sample.missing.push_back(i);
  }
  return record;
}

}  // namespace cordon::detail
