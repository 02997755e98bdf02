// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/sets_file.hpp"

#include <utility>

namespace cordon {

std::string_view to_string(KeptSets sets) {
  if (sets == KeptSets::last) return "last";
  return sets == KeptSets::none ? "none" : "all";
}

namespace detail {

namespace {

constexpr double many_bytes = 1e8, first_look = 1e6;

}  // namespace

SetsFile::SetsFile(Sink& file, std::size_t pipelines, KeptSets kept,
                   std::function<void(double bytes)> many_sets)
    : file_(file),
      pipelines_(static_cast<double>(pipelines)),
      kept_(kept),
      many_sets_(std::move(many_sets)),
      next_look_(first_look) {}

void SetsFile::begin_pipeline(std::int64_t samples) {
  samples_ = samples;
  steps_ = 0;
  last_.clear();
}

void SetsFile::write(std::string line) {
  ++steps_;
  if (kept_ == KeptSets::last) {
    last_ = std::move(line);
  } else if (kept_ == KeptSets::all) {
    file_.write(line);
    bytes_ += static_cast<double>(line.size());
    if (bytes_ >= next_look_) foresee();
  }
}

void SetsFile::end_pipeline() {
  if (kept_ == KeptSets::last) file_.write(last_);
  ++ended_;
  steps_ = 0;
}

void SetsFile::foresee() {
  next_look_ *= 2;
  if (!many_sets_) return;
  const double steps = static_cast<double>(steps_), samples = static_cast<double>(samples_);
  const double expected = samples_ > 0 ? bytes_ * pipelines_ / (ended_ + steps / samples) : 0;
  if (expected < many_bytes && bytes_ < many_bytes) return;
  many_sets_(expected);
  many_sets_ = nullptr;
}

}  // namespace detail

}  // namespace cordon
