// SPDX-License-Identifier: GPL-3.0-or-later
// What changes from one diagnosis to the next, told as events. Knows neither sets nor the truth.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cordon/interfaces/archive.hpp"
#include "cordon/study/outcome.hpp"

namespace cordon::detail {

/// What of a diagnosis its successor is compared with.
struct DiagnosisBefore {
  DiagnosisBefore() = default;
  explicit DiagnosisBefore(const Diagnosis& diagnosis);
  bool monitors() const { return decision == Decision::monitoring; }
  /// Is the mode that was monitored here given up in `now`, the next diagnosis? A reset gives it up
  /// too, even if it is isolated again at once.
  bool is_given_up_in(const Diagnosis& now) const;

  void serialize(Archive& archive);

  Decision decision = Decision::isolating;
  Index mode = -1;
  std::vector<char> candidate;
};

/// Those that do not hold 0.
std::vector<FaultBound> without_0(const std::vector<FaultBound>& bounds);

/// Does a diagnosis tell modes apart? In a bank of one mode nothing is excluded when that mode is
/// monitored again.
bool names_modes(const Diagnosis& now);

/// What the program relies on in a diagnosis of a bank of so many modes. Throws Errc::plugin.
void check_fits(const Diagnosis& diagnosis, std::size_t modes, const std::string& diagnoser);

/// Makes events of what changes from step to step.
class DiagnosisTimeline {
 public:
  void step(const Diagnosis& now, const std::function<void(DiagnosisEvent)>& tell);
  void serialize(Archive& archive);
  /// Is it new, or of a bank of so many modes?
  bool fits(std::size_t modes) const {
    return (!before_ || before_->candidate.size() == modes) && left_open_.size() <= modes;
  }

 private:
  void exclusions(const Diagnosis& now, const std::function<void(DiagnosisEvent)>& tell);

  void tell_left_open(const Diagnosis& now, const std::function<void(DiagnosisEvent)>& tell);

  std::optional<DiagnosisBefore> before_;
  std::vector<char> left_open_;  ///< by mode
  /// Exclusions since the last reset outside the bank, told when they lead to another decision.
  std::vector<DiagnosisEvent> untold_;
};

}  // namespace cordon::detail
