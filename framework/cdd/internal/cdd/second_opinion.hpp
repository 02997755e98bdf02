// SPDX-License-Identifier: GPL-3.0-or-later
// What the project's own engine was asked, asked again of another one.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "solvers/exact_engine.hpp"
#include "solvers/polytope_representation.hpp"

namespace cordon::cdd {

/// Is "" where both describe one polyhedron by as many rows: lines or equations that span the same
/// space and, modulo them, the same other rows up to order and positive factors. Else names a row
/// that only one of them has.
std::string difference(const Description& ours, const Description& theirs, polytope::Form form);

/// Estimates of what cddlib does for a question, by which it is asked or not: it cannot be
/// interrupted, and the own engine's limits are far beyond what it can do.
///   Conversion: rows · columns · (binary digits of question and answer, 128 more per number).
///   Random polytopes in one to eight dimensions take 0.1 to 10 seconds per 10⁹ of it: 2048 rows of
///   doubles in two dimensions 5.3 s (own engine: 15 ms), 256 in four 4.9 s (31 ms), 64 in six
///   6.9 s (140 ms), 16 rows of 1600 digits per number in four 2.9 s (185 ms).
///   Program, with an inequality for each bound and two for each equation: rows · columns² ·
///   (equations + 2) · binary digits of the longest coefficient. Random programs of doubles with 1
///   to 40 equations and 3 to 192 boxed variables take 0.2 to 8 seconds per 10⁹ of it, 15 where
///   coefficients spread over 180 decades: one equation with 96 variables 1.5 s (0.2 ms), 10 with
///   90 2.5 s (1.9 ms), 20 with 73 5.7 s (8.2 ms), 40 with 42 9.8 s (21 ms).
double conversion_work(const Description& question, const Description& answer);
double program_work(const ExactProgram& question);

/// So a question takes at most about 5 s. Just below the limit, the slowest of 54 conversions took
/// 2.9 s: 116 rows of 380 digits per number in three dimensions.
inline constexpr double most_conversion_work = 5e8, most_program_work = 3e8;

/// Asks the other engine whatever its thread asks the own one, while it is installed as an observer
/// (ObservedExactly), and compares the answers as rational numbers. What the own engine goes on
/// with is its own answer.
class SecondOpinion : public ExactObserver {
 public:
  struct Count {
    std::int64_t agree = 0, disagree = 0;
    std::int64_t too_large = 0;   ///< not asked: the work may exceed the limit
    std::int64_t unanswered = 0;  ///< the other engine has failed
  };

  /// Asks nothing any more once `stop` is set.
  explicit SecondOpinion(ExactEngine& other, const std::atomic<bool>* stop = nullptr)
      : other_(other), stop_(stop) {}

  /// What asks from now on, for messages, e.g. `pipeline "a", k = 3`.
  void asked_by(std::string place) { place_ = std::move(place); }

  void converted_to_generators(const Description& inequalities, const Description& answer) override;
  void converted_to_inequalities(const Description& generators, const Description& answer) override;
  void maximized(const ExactProgram& program, const ExactProgram::Result& answer) override;

  const Count& conversions() const { return conversions_; }
  const Count& programs() const { return programs_; }
  /// One sentence with the place, the question and what differs; "" if there is none.
  const std::string& first_disagreement() const { return first_disagreement_; }
  const std::string& first_unanswered() const { return first_unanswered_; }

 private:
  /// Counts a question. `compare` asks the other engine and says what differs, "" for nothing.
  void ask(Count& count, bool too_large, const std::string& question,
           const std::function<std::string()>& compare);

  ExactEngine& other_;
  const std::atomic<bool>* stop_;
  Count conversions_, programs_;
  std::string place_, first_disagreement_, first_unanswered_;
};

}  // namespace cordon::cdd
