// SPDX-License-Identifier: GPL-3.0-or-later
// What a law is made of: a generator of cases and a check of one case.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cordon/conformance/conformance.hpp"
#include "generate.hpp"

namespace cordon::conformance {

/// Outcome of one case.
struct Verdict {
  enum class Kind {
    holds,
    fails,
    inapplicable  ///< says nothing about this backend: no exact claim, no such set
  };
  Kind kind = Kind::holds;
  std::string message;  ///< fails: what was expected and what was found
  std::vector<std::pair<std::string, std::string>>
      derived;  ///< fails: values that the law computed from the case

  static Verdict holds() { return {}; }
  static Verdict inapplicable() { return {Kind::inapplicable, {}, {}}; }
  static Verdict fails(std::string message) { return {Kind::fails, std::move(message), {}}; }
  bool failed() const { return kind == Kind::fails; }
};

/// Counts three-valued answers on their way.
struct Tally {
  Index questions = 0, unknown = 0;
  Answer operator()(Answer answer) {
    ++questions;
    unknown += answer == Answer::unknown;
    return answer;
  }
};

/// What a check sees besides the case.
struct Context {
  const Subject& subject;
  std::shared_ptr<const SetBackend> backend;  ///< that is checked; null of other kinds
  Tally& tally;

  const Registry& registry() const { return *subject.registry; }
  const BackendInfo& info() const { return backend->info(); }
  bool exact_exchange() const { return info().exact_exchange; }
};

/// What a generator sees: no backend, so that a case can be described when the backend has crashed.
struct Setting {
  Random& random;
  Style style;
  Shape shape;
  Index n;  ///< a dimension of this case
  Generator make() const { return {random, style}; }
};

TestCase one_set(const Setting& s);       ///< X
TestCase two_sets(const Setting& s);      ///< X and Y of one dimension
inline double stretch(const Matrix& A) {  ///< ‖A‖∞
  return A.size() ? A.cwiseAbs().rowwise().sum().maxCoeff() : 0.0;
}

struct LawEntry {
  Law law;
  std::function<TestCase(const Setting&)> generate;
  std::function<Verdict(const Context&, const TestCase&)> check;
  /// Why the law does not apply to the backend; nothing if it does.
  std::function<std::optional<std::string>(const Context&)> skip = {};
  double share = 1;  ///< of Options::cases
  Index smallest_dim = 1, largest_dim = 4;
  Shape shape = {true, 6, 2};  ///< lines only where the backend holds unbounded sets
  bool without_backend =
      false;  ///< the law makes and destroys its own, so that none is alive besides
};

/// Laws about components of another kind: a generator and a check, which makes what it needs of
/// `Subject::registry`.
LawEntry law_of(std::string kind, std::string name, std::string statement,
                std::function<TestCase(const Setting&)> generate,
                std::function<Verdict(const Context&, const TestCase&)> check, double share = 0.4);

using LawList = std::vector<LawEntry>;
void add_soundness(LawList& list);
void add_measurements(LawList& list);
void add_views(LawList& list);
void add_tightness(LawList& list);
void add_empty_set(LawList& list);
void add_algebra(LawList& list);
void add_questions(LawList& list);
void add_agreement(LawList& list);
void add_convexity(LawList& list);
void add_contract(LawList& list);
void add_lifetime(LawList& list);
void add_observers(LawList& list);
void add_observer_contract(LawList& list);
void add_diagnosers(LawList& list);
void add_designers(LawList& list);
void add_gains(LawList& list);
void add_metrics(LawList& list);
void add_plants(LawList& list);
const LawList& law_list();

}  // namespace cordon::conformance
