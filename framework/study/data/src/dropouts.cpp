// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/dropouts.hpp"

#include <functional>
#include <limits>

namespace cordon::detail {

namespace {

/// Calls `hit` with the outputs that are drawn at time k, and their streams.
template <class Drawn>
void draw(std::vector<Drawn>& all, Index k,
          const std::function<void(Index, double, RandomStream&)>& hit) {
  for (Drawn& one : all) {
    const DropoutSpec& spec = one.spec;
    if (k < spec.from || k > spec.to) continue;
    const bool is_spared = spec.every > 0 && (k - spec.from) % spec.every == 0;
    for (std::size_t i = 0; i < spec.outputs.size(); ++i) {
      const bool is_hit = one.streams[i].unit() < spec.probability;
      if (is_hit && !is_spared) hit(spec.outputs[i], one.shift, one.streams[i]);
    }
  }
}

}  // namespace

DisturbedData::Drawn DisturbedData::drawn(const DropoutSpec& spec, double shift, std::uint64_t seed,
                                          Purpose purpose, std::size_t number) {
  Drawn made{spec, shift, {}};
  for (const Index output : spec.outputs) {
    made.streams.emplace_back(
        seed, purpose,
        (static_cast<std::uint64_t>(number) << 32) + static_cast<std::uint64_t>(output));
  }
  return made;
}

DisturbedData::DisturbedData(std::unique_ptr<DataSource> source, const SimulateSpec& spec)
    : source_(std::move(source)) {
  for (const DropoutSpec& one : spec.dropouts)
    dropouts_.push_back(drawn(one, 0, spec.seed, Purpose::dropout, dropouts_.size()));
  for (const OutlierSpec& one : spec.outliers)
    outliers_.push_back(drawn(one.when, one.shift, spec.seed, Purpose::outlier, outliers_.size()));
}

std::optional<Record> DisturbedData::next() {
  std::optional<Record> record = source_->next();
  if (!record) return record;
  Sample& sample = record->sample;
  std::vector<bool> wrong(static_cast<std::size_t>(sample.y.size())), lost(wrong.size());
  draw<Drawn>(outliers_, sample.k, [&](Index output, double shift, RandomStream& random) {
    sample.y[output] += shift * random.sign();
    wrong[static_cast<std::size_t>(output)] = true;
  });
  draw<Drawn>(dropouts_, sample.k, [&](Index output, double, RandomStream&) {
    lost[static_cast<std::size_t>(output)] = true;
  });
  for (Index i = 0; i < sample.y.size(); ++i) {
    if (wrong[static_cast<std::size_t>(i)]) record->outliers.push_back(i);
    if (!lost[static_cast<std::size_t>(i)]) continue;
    sample.y[i] = std::numeric_limits<double>::quiet_NaN();
    sample.missing.push_back(i);
  }
  return record;
}

}  // namespace cordon::detail
