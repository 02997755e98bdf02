// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/exact_engine.hpp"

#include <utility>

namespace cordon {

namespace {

thread_local ExactObserver* observer_of_this_thread = nullptr;

class OwnEngine : public ExactEngine {
 public:
  Description generators_of(const Description& inequalities) override {
    return cordon::generators_of(inequalities);
  }
  Description inequalities_of(const Description& generators) override {
    return cordon::inequalities_of(generators);
  }
  Optimum maximum(const ExactProgram& program) override {
    const ExactProgram::Result result = program.maximum();
    return {result.status, result.value};
  }
};

}  // namespace

ExactEngine::~ExactEngine() = default;
ExactObserver::~ExactObserver() = default;

ExactEngine& own_engine() {
  static OwnEngine engine;
  return engine;
}

ObservedExactly::ObservedExactly(ExactObserver* observer)
    : before_(std::exchange(observer_of_this_thread, observer)) {}

ObservedExactly::~ObservedExactly() { observer_of_this_thread = before_; }

ExactObserver* exact_observer() noexcept { return observer_of_this_thread; }

}  // namespace cordon
