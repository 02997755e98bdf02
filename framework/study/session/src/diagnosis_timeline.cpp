// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/session/diagnosis_timeline.hpp"

#include <algorithm>
#include <iterator>

namespace cordon::detail {

namespace {

void serialize(DiagnosisEvent& event, Archive& archive) {
  ModeEvidence& evidence = event.evidence;
  archive(event.k);
  archive.choice(event.what, static_cast<int>(DiagnosisEvent::Kind::left_open) + 1);
  archive(event.mode, evidence.candidate, evidence.consistent, evidence.why, evidence.residual,
          evidence.reset_residual, evidence.left_open);
}

}  // namespace

std::vector<FaultBound> without_0(const std::vector<FaultBound>& bounds) {
  std::vector<FaultBound> found;
  std::copy_if(bounds.begin(), bounds.end(), std::back_inserter(found),
               [](const FaultBound& bound) { return bound.lower > 0 || bound.upper < 0; });
  return found;
}

bool names_modes(const Diagnosis& now) { return now.modes.size() > 1; }

void check_fits(const Diagnosis& diagnosis, std::size_t modes, const std::string& diagnoser) {
  const bool mode_fits = diagnosis.decision == Decision::monitoring
                             ? diagnosis.mode >= 0 && diagnosis.mode < static_cast<Index>(modes)
                             : diagnosis.mode == -1;
  if (diagnosis.modes.size() == modes && mode_fits) return;
  throw Error(Errc::plugin, "the diagnoser \"" + diagnoser +
                                "\" gave a diagnosis that does not fit its bank at k = " +
                                std::to_string(diagnosis.k));
}

DiagnosisBefore::DiagnosisBefore(const Diagnosis& diagnosis)
    : decision(diagnosis.decision), mode(diagnosis.mode) {
  for (const ModeEvidence& evidence : diagnosis.modes) candidate.push_back(evidence.candidate);
}

bool DiagnosisBefore::is_given_up_in(const Diagnosis& now) const {
  return monitors() && (now.reset || now.decision != Decision::monitoring || now.mode != mode);
}

void DiagnosisBefore::serialize(Archive& archive) {
  archive.choice(decision, 4);
  archive(mode, candidate);
}

void DiagnosisTimeline::serialize(Archive& archive) {
  std::size_t untold = untold_.size();
  archive(before_, left_open_, untold);
  // Those that wait are exclusions without faults and estimates, of each mode one at most.
  if (untold > (before_ ? before_->candidate.size() : 0)) archive.refuse("more events than modes");
  untold_.resize(untold);
  for (DiagnosisEvent& event : untold_) detail::serialize(event, archive);
}

void DiagnosisTimeline::step(const Diagnosis& now,
                             const std::function<void(DiagnosisEvent)>& tell) {
  using Kind = DiagnosisEvent::Kind;
  if (!before_) {
    tell({now.k, Kind::starts, now.mode, {}});
    tell_left_open(now, tell);
    before_.emplace(now);
    return;
  }
  exclusions(now, tell);
  tell_left_open(now, tell);
  const bool given_up = before_->is_given_up_in(now);
  if (given_up || now.decision != before_->decision) {
    switch (now.decision) {
      case Decision::monitoring:
        tell({now.k, names_modes(now) ? Kind::isolated : Kind::resumed, now.mode, {}});
        break;
      case Decision::isolating:
        if (!given_up) tell({now.k, Kind::isolating, -1, {}});  // else it is what `detected` says
        break;
      case Decision::ambiguous:
        tell({now.k, Kind::ambiguous, -1, {}});
        break;
      case Decision::unknown_fault:
        tell({now.k, Kind::unknown_fault, -1, {}});
        break;
    }
  }
  before_.emplace(now);
}

void DiagnosisTimeline::tell_left_open(const Diagnosis& now,
                                       const std::function<void(DiagnosisEvent)>& tell) {
  if (now.reset) left_open_.clear();
  left_open_.resize(std::max(left_open_.size(), now.modes.size()));
  for (std::size_t j = 0; j < now.modes.size(); ++j) {
    const bool is_open = !now.reset && !now.modes[j].left_open.empty();
    if (is_open && !left_open_[j])
      tell({now.k, DiagnosisEvent::Kind::left_open, static_cast<Index>(j), now.modes[j]});
    left_open_[j] = is_open;
  }
}

void DiagnosisTimeline::exclusions(const Diagnosis& now,
                                   const std::function<void(DiagnosisEvent)>& tell) {
  using Kind = DiagnosisEvent::Kind;
  const bool given_up = before_->is_given_up_in(now);
  if (given_up) {
    const auto j = static_cast<std::size_t>(before_->mode);
    tell({now.k, Kind::detected, before_->mode,
          j < now.modes.size() ? now.modes[j] : ModeEvidence{}, without_0(now.faults)});
  }
  // outside the bank all modes are excluded again and again: told only if they lead elsewhere
  const bool was_outside = before_->decision == Decision::unknown_fault,
             is_outside = now.decision == Decision::unknown_fault;
  if (was_outside && now.reset) untold_.clear();
  for (std::size_t j = 0; j < now.modes.size(); ++j) {
    if (given_up && static_cast<Index>(j) == before_->mode) continue;
    // after a reset all modes are candidates again: what it rests on is told by the evidence
    const bool gone = now.reset ? now.modes[j].consistent == Answer::no : !now.modes[j].candidate;
    if (gone && before_->candidate[j])
      untold_.push_back({now.k, Kind::excluded, static_cast<Index>(j), now.modes[j]});
  }
  if (was_outside && is_outside) return;
  for (DiagnosisEvent& event : untold_) tell(std::move(event));
  untold_.clear();
}

}  // namespace cordon::detail
