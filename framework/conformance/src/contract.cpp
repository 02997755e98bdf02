// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for every call: errors by code, operands that stay as they are, the same result every
// time, from any thread.
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "cordon/interfaces/archive.hpp"
#include "enclosure.hpp"
#include "fingerprint.hpp"
#include "law.hpp"
#include "thrown_errors.hpp"

namespace cordon::conformance {

namespace {

TestCase generate_program(const Setting& s) {
  TestCase test = two_sets(s);
  const Index p = s.random.between(1, 2);
  test.matrices.push_back({"A", 'p', 'n', s.make().map(p, s.n)});
  test.vectors.push_back({"f", 'p', s.make().vector(p)});
  return test;
}

Verdict check_operands_unchanged(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Enclosure X = b.import(test.set(0).form), Y = b.import(test.set(1).form);
  const std::string before_X = fingerprint(*X), before_Y = fingerprint(*Y);
  for (const auto& [name, run] : program(b, X, Y, test)) {
    attempt_operation(run);
    if (fingerprint(*X) != before_X || fingerprint(*Y) != before_Y) {
      const bool first = fingerprint(*X) != before_X;
      Verdict verdict = Verdict::fails(name + " changes its operand " + (first ? "X" : "Y"));
      verdict.derived.emplace_back("before", first ? before_X : before_Y);
      verdict.derived.emplace_back("after", fingerprint(first ? *X : *Y));
      return verdict;
    }
  }
  return {};
}

/// Results of all operations as text.
std::vector<std::string> outcomes(const SetBackend& b, const TestCase& test) {
  const Enclosure X = b.import(test.set(0).form), Y = b.import(test.set(1).form);
  std::vector<std::string> texts;
  for (const auto& [name, run] : program(b, X, Y, test))
    texts.push_back(name + ": " + fingerprint(attempt_operation(run)));
  return texts;
}

Verdict compare(const std::vector<std::string>& expected, const std::vector<std::string>& found,
                const std::string& when) {
  for (std::size_t k = 0; k < expected.size(); ++k) {
    if (expected[k] == found[k]) continue;
    Verdict verdict = Verdict::fails("an operation gives another result " + when);
    verdict.derived.emplace_back("first", expected[k]);
    verdict.derived.emplace_back("then", found[k]);
    return verdict;
  }
  return {};
}

Verdict check_determinism(const Context& context, const TestCase& test) {
  const auto expected = outcomes(*context.backend, test);
  Verdict verdict = compare(expected, outcomes(*context.backend, test), "when it is repeated");
  if (verdict.failed()) return verdict;
  return compare(expected, outcomes(*context.subject.make(context.subject.params), test),
                 "on another backend with the same parameters");
}

/// As it is after it was written and read.
Enclosure read_again(const std::shared_ptr<const SetBackend>& backend, Enclosure X) {
  Archive writing(backend);
  writing(X);
  Archive reading(backend, writing.bytes());
  Enclosure read;
  reading(read);
  reading.expect_end();
  return read;
}

/// Of operands and results; a backend that does not save its sets refuses the case.
Verdict check_saved_sets(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Enclosure X = b.import(test.set(0).form), Y = b.import(test.set(1).form);
  const auto first = program(b, X, Y, test);
  const auto then =
      program(b, read_again(context.backend, X), read_again(context.backend, Y), test);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto result = attempt_operation(first[i].second);
    const std::string text = fingerprint(result);
    Verdict verdict = compare({text}, {fingerprint(attempt_operation(then[i].second))},
                              "of operands that were saved and read (" + first[i].first + ")");
    if (!verdict.failed() && result)
      verdict = compare({text}, {fingerprint(std::optional(read_again(context.backend, *result)))},
                        "after it was saved and read (" + first[i].first + ")");
    if (verdict.failed()) return verdict;
  }
  return {};
}

/// Threads work on different operands at the same time, each on all of them in turn: what one
/// leaves in a place that another uses shows as a difference.
Verdict check_threads(const Context& context, const TestCase& test) {
  constexpr int threads = 4, rounds = 12;
  const SetBackend& b = *context.backend;
  std::vector<TestCase> variants(threads, test);
  for (int k = 0; k < threads; ++k) {
    for (TestSet& X : variants[static_cast<std::size_t>(k)].sets) X.form.c.array() += 1.0 + 2.0 * k;
    variants[static_cast<std::size_t>(k)].matrices[0].value *= k + 1;
  }
  std::vector<std::vector<std::string>> expected;
  for (const TestCase& variant : variants) expected.push_back(outcomes(b, variant));
  std::vector<Verdict> verdicts(threads);
  std::atomic<int> ready = 0;
  std::atomic<bool> failed = false;
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t) {
    workers.emplace_back([&, t] {
      ++ready;
      while (ready < threads) std::this_thread::yield();
      for (int round = 0; round < rounds && !failed; ++round) {
        const auto k = static_cast<std::size_t>((t + round) % threads);
        Verdict& verdict = verdicts[static_cast<std::size_t>(t)];
        try {
          verdict = compare(expected[k], outcomes(b, variants[k]),
                            "when other threads work at the same time");
        } catch (const std::exception& error) {
          verdict = Verdict::fails(
              std::string("an operation throws when other threads work at the same time: ") +
              error.what());
        } catch (...) {
          verdict = Verdict::fails("an operation throws when other threads work at the same time");
        }
        if (verdict.failed()) failed = true;
      }
    });
  }
  for (std::thread& worker : workers) worker.join();
  for (Verdict& verdict : verdicts) {
    if (verdict.failed()) return verdict;
  }
  return {};
}

// ---- parameters ----

std::optional<std::string> needs_schema(const Context& context) {
  if (context.subject.schema) return std::nullopt;
  return "the parameters' schema is not known";
}

/// A backend with this one parameter set works: it imports a box, adds it, and reduces.
Verdict check_value(const Context& context, const TestCase& test, const std::string& name,
                    const Params::Value& value) {
  Params params = context.subject.params;
  params.set(name, value);
  const Context with{context.subject, context.subject.make(params), context.tally};
  const Operand X = import_operand(with, test.set(0));
  const Enclosure result =
      with.backend->reduce(with.backend->sum(X.set, X.set), {test.set(0).form.dim(), 0});
  Truth truth;
  std::vector<Vector> points;
  for (const Vector& x : X.points) points.push_back(x + X.points.front());
  truth.add(minkowski_sum(X.form, X.form), points, 2 * X.size, 0);
  Verdict verdict = encloses(with, result, truth, points, test.tame() && X.sure, test.seed);
  if (verdict.failed())
    verdict.message = "with another value of parameter \"" + name + "\": " + verdict.message;
  return verdict;
}

TestCase one_box(const Setting& s) {
  TestCase test;
  test.sets.push_back(s.make().set("X", 'n', s.n, {false, 5, 0}));
  return test;
}

Verdict check_parameters(const Context& context, const TestCase& test) {
  const BackendInfo& info = context.info();
  if (!context.subject.component.empty() && info.name != context.subject.component) {
    return Verdict::fails("the backend is registered as \"" + context.subject.component +
                          "\" and calls itself \"" + info.name + "\"");
  }
  if (info.summary.empty()) return Verdict::fails("BackendInfo::summary is empty");
  for (const ParamSpec& spec : context.subject.schema->specs()) {
    if (spec.doc.empty())
      return Verdict::fails("parameter \"" + spec.name + "\" has no documentation");
    std::vector<Params::Value> values;
    if (spec.kind == ParamKind::choice) values.assign(spec.choices.begin(), spec.choices.end());
    if (spec.kind == ParamKind::flag) values = {true, false};
    constexpr double largest = 1e4;  // of a limit that is tried: beyond, it may stand for a size
    for (const double limit : {spec.lowest, spec.highest}) {
      if (!(std::abs(limit) <= largest)) continue;
      if (spec.kind == ParamKind::integer) values.emplace_back(static_cast<std::int64_t>(limit));
      if (spec.kind == ParamKind::real) values.emplace_back(limit);
    }
    for (const Params::Value& value : values) {
      if (Verdict verdict = check_value(context, test, spec.name, value); verdict.failed())
        return verdict;
    }
  }
  return {};
}

bool has_nan(const Vector& x) { return x.array().isNaN().any(); }

Verdict finite(const Set& X, const std::string& what, const std::vector<Vector>& along) {
  const LineForm form = X.line_form();
  for (const Matrix* block : {&form.M, &form.G, &form.S, &form.A}) {
    if (!block->allFinite())
      return Verdict::fails(what + ": the exchange form is not finite: " + describe(form));
  }
  if (!form.c.allFinite() || !form.b.allFinite())
    return Verdict::fails(what + ": the exchange form is not finite: " + describe(form));
  const Box hull = X.interval_hull();
  if (has_nan(hull.lower) || has_nan(hull.upper)) {
    return Verdict::fails(what + ": the interval hull holds a NaN: " + describe_vector(hull.lower) +
                          " to " + describe_vector(hull.upper));
  }
  const double volume = X.volume().value;
  if (!(volume >= 0)) return Verdict::fails(what + ": the volume is " + describe(volume));
  for (const Vector& d : along) {
    const double h = X.support(d);
    if (std::isnan(h))
      return Verdict::fails(what + ": the support function in direction d = " + describe_vector(d) +
                            " is NaN");
    // Set::support replaces a NaN by +inf; without constraints and lines there is no program that
    // could stay unsolved
    if (h == infinity && form.constraints() == 0 && form.lines() == 0 && hull.is_bounded()) {
      return Verdict::fails(what + ": the support function in direction d = " + describe_vector(d) +
                            " is NaN or +inf, although the set is bounded");
    }
  }
  return {};
}

Verdict check_no_nan(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Enclosure X = b.import(test.set(0).form), Y = b.import(test.set(1).form);
  const Index n = X->dim();
  Random random(test.seed);
  const auto along = directions({test.set(0).form}, n, random, 3);
  Verdict verdict = finite(*X, "X", along);
  if (verdict.failed()) return verdict;
  const Enclosure point = b.point(test.set(0).form.c), empty = b.empty(n);
  for (const auto& [name, set] : {std::pair{"a point", point}, std::pair{"the empty set", empty}}) {
    verdict = finite(*set, name, along);
    if (verdict.failed()) return verdict;
  }
  for (const auto& [name, run] : program(b, X, Y, test)) {
    const auto result = attempt_operation(run);
    if (!result) continue;
    const Index m = (*result)->dim();
    verdict = finite(**result, name, directions({}, m, random, 2));
    if (verdict.failed()) return verdict;
  }
  return {};
}

}  // namespace

void add_contract(LawList& list) {
  list.push_back({{"contract.dimension_errors", "operands that do not fit throw Errc::dimension"},
                  two_sets,
                  check_dimension_errors,
                  {},
                  0.2});
  list.push_back(
      {{"contract.not_finite_errors", "NaN and infinite operands throw Errc::not_finite"},
       two_sets,
       check_not_finite_errors,
       {},
       0.2});
  list.push_back({{"contract.operands_unchanged", "no operation changes an operand"},
                  generate_program,
                  check_operands_unchanged,
                  {},
                  0.5});
  list.push_back({{"contract.threads", "operations on different threads do not disturb each other"},
                  generate_program,
                  check_threads,
                  {},
                  0.1});
  list.push_back(
      {{"contract.determinism", "the same operation on the same operands gives the same bits"},
       generate_program,
       check_determinism,
       {},
       0.5});
  list.push_back({{"contract.saved_sets",
                   "a set that was saved and read is the same, and gives the same bits"},
                  generate_program,
                  check_saved_sets,
                  {},
                  0.3});
  list.push_back({{"contract.parameters_documented",
                   "every parameter is documented, and every value that it allows works"},
                  one_box,
                  check_parameters,
                  needs_schema,
                  0.05});
  list.push_back(
      {{"contract.only_cordon_errors", "whatever the call, what is thrown is a cordon::Error"},
       two_sets,
       check_only_cordon_errors,
       {},
       0.5});
  list.push_back(
      {{"contract.no_nan",
        "no NaN in exchange forms, hulls, volumes, and support functions of bounded sets"},
       generate_program,
       check_no_nan,
       {},
       0.5});
}

}  // namespace cordon::conformance
