// SPDX-License-Identifier: GPL-3.0-or-later
#include "feasible_sequence.hpp"

#include "cordon/core/error.hpp"

namespace cordon::verification {

namespace {

constexpr Index most_states_of_polytopes = 4;
constexpr std::size_t most_kept_polytopes = 5000, most_kept_bits = std::size_t{1} << 31;
constexpr std::size_t most_bits_in_all = std::size_t{1} << 25;  // of the exact sets of a run

bool same(const Matrix& A, const Matrix& B) {
  return A.rows() == B.rows() && A.cols() == B.cols() && A == B;
}
bool same(const LineForm& X, const LineForm& Y) {
  return same(X.M, Y.M) && same(X.G, Y.G) && same(X.c, Y.c) && same(X.S, Y.S) && same(X.A, Y.A) &&
         same(X.b, Y.b);
}
bool same_assumptions(const RecordedEstimation& a, const RecordedEstimation& b) {
  if (!same(a.initial_set, b.initial_set) ||
      a.admissible_set.has_value() != b.admissible_set.has_value())
    return false;
  return !a.admissible_set || same(*a.admissible_set, *b.admissible_set);
}

}  // namespace

FeasibleSequence::FeasibleSequence(const Model& model, const RecordedEstimation& estimation)
    : model_(model), estimation_(estimation), uncertain_(model.linear.is_uncertain()) {
  if (model.is_linear() && model.states() <= most_states_of_polytopes)
    begin_from(estimation.initial_set);
}

void FeasibleSequence::begin_from(const LineForm& initial_set) {
  try {
    sets_.emplace(model_, initial_set, estimation_.admissible_set);
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
  }
}

bool FeasibleSequence::serves(const RecordedEstimation& other) const {
  const auto is_plain = [](const RecordedEstimation& one) {
    return !one.restart_set && !one.leaves_out();
  };
  return is_plain(estimation_) && is_plain(other) && same_assumptions(estimation_, other);
}

std::optional<Polytope> FeasibleSequence::at(std::size_t i, const Sample& sample) {
  if (i < kept_.size()) return kept_[i];
  std::optional<Polytope> F;
  if (sets_ && i < estimation_.steps.size() && estimation_.begins_anew(i))
    begin_from(*estimation_.restart_set);
  if (sets_) {
    try {
      F = sets_->step(sample);
      bits_ += F->bits();
      if (uncertain_ &&
          F->is_empty()) {  // which says nothing about other matrices of the intervals
        F.reset();
        sets_.reset();
      }
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported) throw;
      F.reset();
      sets_.reset();
    }
  }
  if (bits_ > most_bits_in_all) sets_.reset();  // a long run goes on by directions
  keeps_ = keeps_ && kept_.size() < most_kept_polytopes && bits_ <= most_kept_bits;
  if (keeps_) kept_.push_back(F);
  return F;
}

}  // namespace cordon::verification
