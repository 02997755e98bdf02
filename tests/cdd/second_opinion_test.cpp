// SPDX-License-Identifier: GPL-3.0-or-later
// Both engines for exact polyhedra say the same, and where one of them is made to lie, that is
// found.
#include "cdd/second_opinion.hpp"

#include <atomic>
#include <string>
#include <thread>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cdd/cddlib.hpp"
#include "cordon/core/error.hpp"

namespace {

using namespace cordon;
using polytope::Form;
using rational::Rational;
using rational::RationalVector;
using Status = ExactProgram::Status;

using Rows = std::vector<std::vector<int>>;

Description description(Index n, const Rows& rows, const Rows& linear = {}) {
  Description out{n, {}, {}};
  for (const auto& row : rows) out.add(RationalVector(row.begin(), row.end()), false);
  for (const auto& row : linear) out.add(RationalVector(row.begin(), row.end()), true);
  return out;
}

/// An observer of this thread, with cddlib.
struct Listening {
  cdd::Cddlib cddlib;
  cdd::SecondOpinion opinion{cddlib};
  ObservedExactly observed{&opinion};
};

/// Both engines agree on the generators, which are these, and on the way back.
void check_generators(const Description& inequalities, const Description& expected) {
  Listening listening;
  const Description found = generators_of(inequalities);
  CHECK(cdd::difference(found, expected, Form::generators) == "");
  if (!found.rows.empty()) inequalities_of(found);
  CHECK(listening.opinion.first_disagreement() == "");
  CHECK(listening.opinion.first_unanswered() == "");
  CHECK(listening.opinion.conversions().agree == (found.rows.empty() ? 1 : 2));
}

Rational small_number() { return {*rc::gen::inRange(-4, 5), *rc::gen::inRange(1, 4)}; }

/// Few different numbers, so that rows are redundant, parallel or contradict each other.
Description random_description(Form form) {
  const Index n = *rc::gen::inRange<Index>(1, 5);
  const int count = *rc::gen::inRange(0, 11);
  Description out{n, {}, {}};
  for (int i = 0; i < count; ++i) {
    RationalVector row;
    for (Index j = 0; j <= n; ++j) {
      Rational x = small_number();
      x.canonicalize();
      row.push_back(x);
    }
    bool linear = *rc::gen::inRange(0, 6) == 0;
    if (form == Form::generators) {
      const bool point = i == 0 || *rc::gen::inRange(0, 4) > 0;  // a set has a point, if anything
      row[0] = point ? 1 : 0;
      linear = linear && !point;
    }
    out.add(std::move(row), linear);
  }
  return out;
}

ExactProgram random_program() {
  const auto m = *rc::gen::inRange<Index>(0, 5), l = *rc::gen::inRange<Index>(0, 4),
             g = *rc::gen::inRange<Index>(0, 7);
  ExactProgram p{Matrix(m, l), Matrix(m, g), {}, {}, {}};
  const auto entry = [] { return *rc::gen::inRange(-4, 5) / 4.0; };
  for (Index i = 0; i < m; ++i) {
    for (Index j = 0; j < l; ++j) p.S(i, j) = entry();
    for (Index j = 0; j < g; ++j) p.A(i, j) = entry();
    p.b.push_back(rational::exact(entry()));
  }
  for (Index j = 0; j < l; ++j)
    p.f.push_back(*rc::gen::inRange(0, 3) == 0 ? rational::exact(entry()) : Rational(0));
  for (Index j = 0; j < g; ++j) p.g.push_back(rational::exact(entry()));
  return p;
}

/// Answers like the own engine, but for one row, or by one more than the optimum.
class Liar : public ExactEngine {
 public:
  Description generators_of(const Description& inequalities) override {
    return with_a_lie(own_engine().generators_of(inequalities));
  }
  Description inequalities_of(const Description& generators) override {
    return with_a_lie(own_engine().inequalities_of(generators));
  }
  Optimum maximum(const ExactProgram& program) override {
    Optimum optimum = own_engine().maximum(program);
    optimum.value += 1;
    return optimum;
  }

 private:
  static Description with_a_lie(Description answer) {
    answer.rows.at(0).back() += Rational(1, 1'000'000'000);
    return answer;
  }
};

class Mute : public ExactEngine {
 public:
  Description generators_of(const Description&) override { refuse(); }
  Description inequalities_of(const Description&) override { refuse(); }
  Optimum maximum(const ExactProgram&) override { refuse(); }

 private:
  [[noreturn]] static void refuse() { throw Error(Errc::solver, "no answer"); }
};

const Description unit_square =
    description(2, {{1, -1, 0}, {1, 1, 0}, {1, 0, -1}, {1, 0, 1}, {5, 1, 1}});

ExactProgram one_variable(int objective) {
  return {Matrix(0, 0), Matrix(0, 1), {}, {}, {Rational(objective)}};
}

}  // namespace

TEST_CASE("points, rays, lines and empty sets are the same for both engines") {
  SUBCASE("a square with a redundant row") {
    check_generators(unit_square, description(2, {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}}));
  }
  SUBCASE("a point, by inequalities and by equations") {
    check_generators(description(1, {{-1, 1}, {1, -1}}), description(1, {{1, 1}}));
    check_generators(description(2, {}, {{-1, 2, 0}, {1, 0, 1}}), description(2, {{2, 1, -2}}));
    check_generators(description(2, {}, {{0, 1, 0}, {0, 0, 1}}), description(2, {{1, 0, 0}}));
  }
  SUBCASE("a half-line and a cone at the origin") {
    check_generators(description(1, {{-2, 1}, {7, 3}}), description(1, {{1, 2}, {0, 1}}));
    check_generators(description(2, {{0, 1, 0}, {0, 0, 1}}),
                     description(2, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  }
  SUBCASE("a strip and a whole space") {
    check_generators(description(3, {{1, 1, 1, 0}, {1, -1, -1, 0}}),
                     description(3, {{1, 1, 0, 5}, {1, -1, 0, 0}}, {{0, 1, -1, 3}, {0, 0, 0, 2}}));
    check_generators(description(2, {{3, 0, 0}}),
                     description(2, {{1, 0, 0}}, {{0, 1, 1}, {0, 1, -1}}));
  }
  SUBCASE("empty sets") {
    check_generators(description(1, {{-1, 1}, {-1, -1}}), description(1, {}));
    check_generators(description(2, {{-1, 0, 0}}), description(2, {}));
    check_generators(description(4, {}, {{1, 1, 0, 0, 0}, {2, 1, 0, 0, 0}}), description(4, {}));
    Listening listening;
    CHECK(inequalities_of(description(3, {})).rows.size() == 1);
    CHECK(listening.opinion.conversions().agree == 1);
  }
}

TEST_CASE("engines agree on random polyhedra") {
  std::atomic<int> with_points = 0;
  CHECK(rc::check("random polyhedra", [&] {
    Listening listening;
    const Description inequalities = random_description(Form::inequalities);
    const Description found = generators_of(inequalities);
    with_points += found.rows.empty() ? 0 : 1;
    inequalities_of(random_description(Form::generators));
    inequalities_of(found);
    if (!listening.opinion.first_disagreement().empty())
      RC_FAIL(listening.opinion.first_disagreement());
    RC_ASSERT(listening.opinion.conversions().agree == 3);
  }));
  CHECK(with_points > 10);
}

TEST_CASE("engines agree on random programs") {
  std::atomic<int> optimal = 0, infeasible = 0, unbounded = 0;
  CHECK(rc::check("random programs", [&] {
    Listening listening;
    const ExactProgram::Result result = random_program().maximum();
    optimal += result.status == Status::optimal ? 1 : 0;
    infeasible += result.status == Status::infeasible ? 1 : 0;
    unbounded += result.status == Status::unbounded ? 1 : 0;
    if (!listening.opinion.first_disagreement().empty())
      RC_FAIL(listening.opinion.first_disagreement());
    RC_ASSERT(listening.opinion.programs().agree == 1);
  }));
  CHECK(optimal > 5);
  CHECK(infeasible > 5);
  CHECK(unbounded > 5);
}

TEST_CASE("a lie is found, and told with the question") {
  Liar liar;
  cdd::SecondOpinion opinion(liar);
  opinion.asked_by("pipeline \"a\", k = 3");
  {
    const ObservedExactly observed(&opinion);
    CHECK(generators_of(unit_square).rows.size() == 4);
    inequalities_of(description(1, {{1, 0}, {1, 2}}));
    CHECK(one_variable(3).maximum().value == 3);
  }
  CHECK(opinion.conversions().disagree == 2);
  CHECK(opinion.conversions().agree == 0);
  CHECK(opinion.programs().disagree == 1);
  const std::string& first = opinion.first_disagreement();
  CAPTURE(first);
  CHECK(first.find("pipeline \"a\", k = 3: the conversion of 5 inequalities in dimension 2: only "
                   "the own engine has the row (") == 0);
}

TEST_CASE("false answers of the own engine are found by cddlib") {
  cdd::Cddlib cddlib;
  cdd::SecondOpinion opinion(cddlib);
  const Description square = generators_of(unit_square);
  Description lacking = square, line = square;
  lacking.rows.pop_back(), lacking.linear.pop_back();
  line.add({0, 1, 0}, true);
  opinion.converted_to_generators(unit_square, square);
  CHECK(opinion.conversions().agree == 1);
  opinion.converted_to_generators(unit_square, lacking);
  opinion.converted_to_generators(unit_square, line);
  opinion.converted_to_generators(unit_square, description(2, {}));
  opinion.converted_to_inequalities(square, description(2, {{1, 1, 0}}));
  CHECK(opinion.conversions().disagree == 4);
  opinion.maximized(one_variable(1), {Status::optimal, Rational(1)});
  CHECK(opinion.programs().agree == 1);
  opinion.maximized(one_variable(1), {Status::optimal, Rational(2)});
  opinion.maximized(one_variable(1), {Status::infeasible, 0});
  opinion.maximized(one_variable(1), {Status::unbounded, 0});
  CHECK(opinion.programs().disagree == 3);
}

TEST_CASE("an engine without an answer disagrees with nobody") {
  Mute mute;
  cdd::SecondOpinion opinion(mute);
  const ObservedExactly observed(&opinion);
  generators_of(unit_square);
  one_variable(1).maximum();
  CHECK(opinion.conversions().unanswered == 1);
  CHECK(opinion.programs().unanswered == 1);
  CHECK(opinion.first_unanswered().find("no answer") != std::string::npos);
  CHECK(opinion.first_disagreement() == "");
}

TEST_CASE("what is too large is not asked, and nothing is after a stop") {
  Mute mute;
  std::atomic<bool> stop = false;
  cdd::SecondOpinion opinion(mute, &stop);
  Description many{2, {}, {}};
  for (int i = 0; i < 2000; ++i) many.add({Rational(i + 1), i % 2 == 0 ? 1 : -1, i % 7}, false);
  const ExactProgram wide{
      Matrix(0, 0), Matrix::Ones(20, 200), RationalVector(20), {}, RationalVector(200)};
  CHECK(cdd::conversion_work(many, many) > cdd::most_conversion_work);
  CHECK(cdd::program_work(wide) > cdd::most_program_work);
  opinion.converted_to_generators(many, many);
  opinion.maximized(wide, {Status::optimal, 0});
  CHECK(opinion.conversions().too_large == 1);
  CHECK(opinion.programs().too_large == 1);
  stop = true;
  opinion.converted_to_generators(unit_square, unit_square);
  CHECK(opinion.conversions().unanswered == 0);
}

TEST_CASE("one thread is observed, and only as long as the observer is installed") {
  Liar liar;
  cdd::SecondOpinion inner(liar), outer(liar);
  {
    const ObservedExactly observed(&outer);
    {
      const ObservedExactly nested(&inner);
      one_variable(1).maximum();
      std::thread([] { one_variable(1).maximum(); }).join();
    }
    one_variable(1).maximum();
  }
  one_variable(1).maximum();
  CHECK(inner.programs().disagree == 1);
  CHECK(outer.programs().disagree == 1);
  CHECK(exact_observer() == nullptr);
}

TEST_CASE("threads wait for each other before cddlib") {
  std::vector<std::thread> threads;
  std::atomic<int> agree = 0;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      Listening listening;
      for (int round = 0; round < 20; ++round) generators_of(unit_square);
      agree += static_cast<int>(listening.opinion.conversions().agree);
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(agree == 80);
}
