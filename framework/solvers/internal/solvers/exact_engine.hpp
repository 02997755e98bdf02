// SPDX-License-Identifier: GPL-3.0-or-later
// What an engine for exact polyhedra can do, and how somebody is told what the project's own one
// was asked and what it answered.
#pragma once

#include "solvers/double_description.hpp"
#include "solvers/exact_program.hpp"

namespace cordon {

/// Conversions and linear programs in rational numbers; what they mean is said beside the functions
/// of these names. An engine that gives no answer throws.
class ExactEngine {
 public:
  struct Optimum {
    ExactProgram::Status status = ExactProgram::Status::infeasible;
    rational::Rational value = 0;  ///< for `optimal`
  };

  ExactEngine() = default;
  ExactEngine(const ExactEngine&) = delete;
  ExactEngine& operator=(const ExactEngine&) = delete;
  virtual ~ExactEngine();
  virtual Description generators_of(const Description& inequalities) = 0;
  virtual Description inequalities_of(const Description& generators) = 0;
  virtual Optimum maximum(const ExactProgram& program) = 0;
};

/// The project's own one, which everything in this library asks: cordon::generators_of,
/// cordon::inequalities_of and ExactProgram::maximum. Any number of threads.
ExactEngine& own_engine();

/// Is told every question that the own engine has answered, right after the answer. Questions that
/// it refused with an error are not told; what follows from an answer is told as one.
class ExactObserver {
 public:
  ExactObserver() = default;
  ExactObserver(const ExactObserver&) = delete;
  ExactObserver& operator=(const ExactObserver&) = delete;
  virtual ~ExactObserver();
  virtual void converted_to_generators(const Description& inequalities,
                                       const Description& answer) = 0;
  virtual void converted_to_inequalities(const Description& generators,
                                         const Description& answer) = 0;
  virtual void maximized(const ExactProgram& program, const ExactProgram::Result& answer) = 0;
};

/// As long as it lives, the observer (nullptr for nobody) is told what its thread asks, in place of
/// one before. Other threads go on unobserved, so that an observer needs no lock. It is destroyed
/// on the same thread.
class ObservedExactly {
 public:
  explicit ObservedExactly(ExactObserver* observer);
  ObservedExactly(const ObservedExactly&) = delete;
  ObservedExactly& operator=(const ObservedExactly&) = delete;
  ~ObservedExactly();

 private:
  ExactObserver* before_;
};

/// Who is told on this thread; nullptr for nobody, which costs a question one look.
ExactObserver* exact_observer() noexcept;

/// Calls tell(observer) if there is one. What it asks the own engine meanwhile, nobody is told.
template <class Tell>
void tell_exact_observer(Tell tell) {
  ExactObserver* const observer = exact_observer();
  if (!observer) return;
  const ObservedExactly unobserved(nullptr);
  tell(*observer);
}

}  // namespace cordon
