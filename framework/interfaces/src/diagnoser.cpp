// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/diagnoser.hpp"

#include <chrono>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/archive.hpp"
#include "interfaces/sample_check.hpp"

namespace cordon {

std::string_view to_string(Decision decision) noexcept {
  switch (decision) {
    case Decision::monitoring:
      return "monitoring";
    case Decision::isolating:
      return "isolating";
    case Decision::ambiguous:
      return "ambiguous";
    case Decision::unknown_fault:
      return "unknown_fault";
  }
  return "isolating";
}

void Diagnoser::start() {
  before_.reset();
  step_us_ = 0;
  do_start();
  started_ = true;
}

Diagnosis Diagnoser::step(const Sample& now) {
  detail::check_sample(now, before_ ? std::optional(before_->k) : std::nullopt,
                       bank_[bank_.nominal].model);
  if (!now.is_complete() && !takes_missing_outputs()) detail::refuse_missing(now, "diagnoser");
  if (!started_) start();
  const auto begin = std::chrono::steady_clock::now();
  Diagnosis diagnosis = do_step(before_ ? &*before_ : nullptr, now);
  step_us_ =
      std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
  before_ = now;
  return diagnosis;
}

void Diagnoser::serialize(Archive& archive) {
  archive.section("diagnoser");
  archive(before_, started_);
  if (archive.is_reading()) do_start();
  step_us_ = 0;
  if (!before_) return;
  if (archive.is_reading()) detail::check_saved(*before_, bank_[bank_.nominal].model, archive);
  do_serialize(archive);
}

void Diagnoser::do_serialize(Archive&) {
  throw Error(Errc::unsupported, "the state of this diagnoser cannot be saved");
}

}  // namespace cordon
