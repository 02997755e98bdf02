// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "cordon/conformance/conformance.hpp"
#include "cordon/core/error.hpp"
#include "law.hpp"
#include "shrink.hpp"

namespace cordon::conformance {

namespace {

/// Trials of the search for a smaller case: enough to bring sets of this size down to a few
/// numbers.
constexpr Index shrinking_limit = 1500;

const LawEntry& entry_of(std::string_view name) {
  for (const LawEntry& entry : law_list()) {
    if (entry.law.name == name) return entry;
  }
  std::vector<std::string> names;
  for (const LawEntry& entry : law_list()) names.push_back(entry.law.name);
  throw Error(Errc::invalid, "no law \"" + std::string(name) + "\"; " + suggest(name, names));
}

Index planned_cases(const LawEntry& entry, const Options& options) {
  return std::max<Index>(
      1, static_cast<Index>(std::ceil(entry.share * static_cast<double>(options.cases))));
}

/// Case `number` of a law: small dimensions and plain numbers first, so that a defect shows early
/// and plainly.
TestCase generate(const LawEntry& entry, const Options& options, const BackendInfo& info,
                  Index number) {
  Random random(seed_of(options.seed, entry.law.name, number));
  const Style style = number % 3 == 0      ? Style::tame
                      : number % 3 == 1    ? Style::full
                      : random.chance(0.5) ? Style::tame
                                           : Style::scaled;
  const Index span = entry.largest_dim - entry.smallest_dim + 1;
  Shape shape = entry.shape;
  shape.lines = shape.lines && info.unbounded;
  TestCase test = entry.generate({random, style, shape, entry.smallest_dim + (number / 2) % span});
  test.seed = random.bits();
  return test;
}

struct Outcome {
  Verdict verdict;
  bool unsupported = false;
  std::string refusal = {};
};

/// An exception is an outcome: a refusal, or a broken contract.
Outcome attempt(const LawEntry& entry, const Context& context, const TestCase& test) {
  try {
    return {entry.check(context, test), false};
  } catch (const Error& error) {
    if (error.code() == Errc::unsupported || error.code() == Errc::solver)
      return {{}, true, error.what()};
    return {Verdict::fails("a call with legal operands threw Errc::" +
                           std::string(to_string(error.code())) + ": " + error.what()),
            false};
  } catch (const std::exception& error) {
    return {Verdict::fails(std::string("an exception that is no cordon::Error was thrown: ") +
                           error.what()),
            false};
  } catch (...) {
    return {Verdict::fails("an exception that is no std::exception was thrown"), false};
  }
}

std::string replay_line(const Subject& subject, const LawEntry& entry, const Options& options) {
  return subject.command + " --law " + entry.law.name + " --seed " + std::to_string(options.seed) +
         " --cases " + std::to_string(options.cases);
}

void report_failure(const LawEntry& entry, const Context& context, const Options& options,
                    TestCase test, const std::function<void()>& sign_of_life, Result& result) {
  const auto fails = [&](const TestCase& candidate) {
    sign_of_life();
    return attempt(entry, context, candidate).verdict.failed();
  };
  test = shrink(std::move(test), fails, shrinking_limit);
  const Verdict verdict = attempt(entry, context, test).verdict;
  result.status = Status::failed;
  // a defect that comes and goes may have gone by now
  if (verdict.failed()) result.reason = verdict.message;
  result.witness = describe(test);
  for (const auto& [name, value] : verdict.derived) result.witness += name + " = " + value + "\n";
  result.replay = replay_line(context.subject, entry, options);
}

/// Of a law that nothing was found by.
void tell_skipped(const std::string& kind, const std::string& refusal, Result& result) {
  const bool is_backend = kind == "backend";
  if (result.unsupported == result.cases) {
    result.status = Status::skipped;
    result.reason = is_backend ? "the backend refused every case (Errc::unsupported)"
                               : "the " + kind + " refused every case: " + refusal;
  } else if (result.unsupported + result.inapplicable == result.cases) {
    result.status = Status::skipped;
    result.reason = "no case bears on this law for this " + kind;
  }
}

Result check_entry(const LawEntry& entry, const Subject& subject, const Options& options,
                   const Progress& progress) {
  Result result;
  result.law = entry.law.name;
  const Index planned = planned_cases(entry, options);
  if (progress) progress(entry.law, -1, planned);
  Tally tally;
  const Context context{subject, entry.without_backend ? nullptr : subject.make(subject.params),
                        tally};
  if (entry.skip) {
    if (const auto why = entry.skip(context)) {
      result.status = Status::skipped;
      result.reason = *why;
      return result;
    }
  }
  std::string refusal;  // the first
  for (Index k = 0; k < planned; ++k) {
    if (progress) progress(entry.law, k, planned);
    TestCase test =
        generate(entry, options, entry.without_backend ? BackendInfo{} : context.info(), k);
    ++result.cases;
    const Outcome outcome = attempt(entry, context, test);
    if (outcome.unsupported && refusal.empty()) refusal = outcome.refusal;
    result.unsupported += outcome.unsupported;
    result.inapplicable += outcome.verdict.kind == Verdict::Kind::inapplicable;
    if (!outcome.verdict.failed()) continue;
    result.questions = tally.questions;
    result.unknown = tally.unknown;
    result.reason = outcome.verdict.message;
    const auto sign_of_life = [&] {
      if (progress) progress(entry.law, k, planned);
    };
    report_failure(entry, context, options, std::move(test), sign_of_life, result);
    return result;
  }
  result.questions = tally.questions;
  result.unknown = tally.unknown;
  tell_skipped(entry.law.kind, refusal, result);
  return result;
}

}  // namespace

std::string_view to_string(Status status) noexcept {
  return status == Status::passed ? "passed" : status == Status::failed ? "failed" : "skipped";
}

const LawList& law_list() {
  static const LawList list = [] {
    LawList all;
    add_lifetime(all);  // first: afterwards a library may be pinned by what other laws made it do
    add_soundness(all);
    add_measurements(all);
    add_views(all);
    add_tightness(all);
    add_empty_set(all);
    add_algebra(all);
    add_questions(all);
    add_agreement(all);
    add_convexity(all);
    add_contract(all);
    add_observers(all);
    add_observer_contract(all);
    add_diagnosers(all);
    add_designers(all);
    add_gains(all);
    add_metrics(all);
    add_plants(all);
    return all;
  }();
  return list;
}

std::vector<Law> laws() {
  std::vector<Law> found;
  for (const LawEntry& entry : law_list()) found.push_back(entry.law);
  return found;
}

bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern.front() == '*') {
    return matches(pattern.substr(1), name) || (!name.empty() && matches(pattern, name.substr(1)));
  }
  return !name.empty() && (pattern.front() == '?' || pattern.front() == name.front()) &&
         matches(pattern.substr(1), name.substr(1));
}

Result check(const Subject& subject, std::string_view law, const Options& options,
             const Progress& progress) {
  return check_entry(entry_of(law), subject, options, progress);
}

std::vector<Result> check(const Subject& subject, const Options& options,
                          const Progress& progress) {
  std::vector<Result> results;
  for (const LawEntry& entry : law_list()) {
    if (entry.law.kind == subject.kind && matches(options.laws, entry.law.name))
      results.push_back(check_entry(entry, subject, options, progress));
  }
  return results;
}

std::string describe_case(std::string_view law, const Options& options, const BackendInfo& info,
                          Index number) {
  return describe(generate(entry_of(law), options, info, number));
}

}  // namespace cordon::conformance
