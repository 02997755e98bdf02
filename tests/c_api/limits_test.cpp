// SPDX-License-Identifier: GPL-3.0-or-later
// What a program beside a plant must be able to rely on: threads, memory, arithmetic.
#include <atomic>
#include <cfenv>
#include <cstdlib>
#include <malloc.h>
#include <new>
#include <thread>

#include <doctest/doctest.h>

#include "c_api/allocations.hpp"
#include "c_api/opened.hpp"

using namespace c_test;

namespace {

std::vector<std::string> lines_of(const char* pipeline) {
  Opened session(pipeline);
  LeakyPlant plant;
  std::vector<std::string> lines;
  for (int k = 0; k < 200; ++k) {
    lines.emplace_back(session.step(plant.next(k >= 100)) == CORDON_OK
                           ? cordon_result_json(session, 0)
                           : cordon_last_error());
    if (k % 20 != 0) continue;
    cordon_state_name(session, k + 2);
    lines.push_back(last_error());
  }
  return lines;
}

}  // namespace

TEST_CASE("threads with sessions of their own do not disturb each other") {
  const char* const pipelines[] = {"bank", "constrained", "bank", "zonotope"};
  std::vector<std::string> wanted[4], got[4];
  for (std::size_t i = 0; i < 4; ++i) wanted[i] = lines_of(pipelines[i]);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i)
    threads.emplace_back([&, i] { got[i] = lines_of(pipelines[i]); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < 4; ++i) CHECK(got[i] == wanted[i]);
}

TEST_CASE("the last error is that of the thread") {
  cordon_states(nullptr);
  std::string other;
  std::thread([&] { other = cordon_last_error(); }).join();
  CHECK(other.empty());
  CHECK(says("cordon_states: the session is NULL"));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_CASE("100,000 steps do not grow") {
  for (const auto& [pipeline, steps] : {std::pair{"interval", 110000}, std::pair{"bank", 20000}}) {
    CAPTURE(pipeline);
    Opened session(pipeline);
    LeakyPlant plant;
    std::size_t before = 0;
    for (int k = 0; k < steps; ++k) {
      if (k == 10000) before = mallinfo2().uordblks;
      REQUIRE(session.step(plant.next()) == CORDON_OK);
      REQUIRE(cordon_result_json(session, 0)[0] == '{');
      cordon_step(session, nullptr, 1, nullptr, 2);
    }
    const std::size_t after = mallinfo2().uordblks;
    CAPTURE(before);
    CAPTURE(after);
    CHECK(after <= before + 4096);
  }
}

TEST_CASE("opening and closing does not grow") {
  std::size_t before = 0;
  for (int i = 0; i < 30; ++i) {
    if (i == 10) before = mallinfo2().uordblks;
    Opened session("bank");
    REQUIRE(session.step(sample_of(0, 0, 0)) == CORDON_OK);
  }
  const std::size_t after = mallinfo2().uordblks;
  CAPTURE(before);
  CAPTURE(after);
  CHECK(after <= before + 65536);
}

TEST_CASE("no memory is a code, wherever it is missing") {
  for (const char* const pipeline : {"interval", "bank"}) {
    CAPTURE(pipeline);
    Opened session(pipeline), other(pipeline);
    LeakyPlant plant;
    const GivenSample first = plant.next(), second = plant.next();
    REQUIRE(other.step(first) == CORDON_OK);
    REQUIRE(other.step(second) == CORDON_OK);
    const std::string wanted = cordon_result_json(other, 0);
    int refused = 0;
    for (std::int64_t n = 0;; ++n) {
      REQUIRE(cordon_reset(session) == CORDON_OK);
      REQUIRE(session.step(first) == CORDON_OK);
      fail_after(n);
      const int code = session.step(second);
      const bool failed = has_failed();
      if (!failed && code == CORDON_OK) break;
      if (code == CORDON_OK) continue;  // somebody did without
      ++refused;
      CAPTURE(n);
      CAPTURE(last_error());
      CHECK(code == CORDON_NO_MEMORY);
      CHECK(cordon_result_count(session) == 0);
      if (cordon_has_ended(session) == 1) continue;
      REQUIRE(session.step(second) == CORDON_OK);
      CHECK(cordon_result_json(session, 0) == wanted);
    }
    CHECK(refused >= 2);  // most of what a step needs it has from the step before
    CHECK(cordon_result_json(session, 0) == wanted);
  }
}
#endif

TEST_CASE("results do not depend on the arithmetic of the program") {
  Opened session("constrained"), other("constrained");
  LeakyPlant plant;
  std::vector<GivenSample> samples;
  for (int k = 0; k < 30; ++k) samples.push_back(plant.next());
  for (const GivenSample& sample : samples) {
    REQUIRE(other.step(sample) == CORDON_OK);
    std::fesetround(FE_UPWARD);
#ifdef __SSE2__
    __builtin_ia32_ldmxcsr(__builtin_ia32_stmxcsr() | 0x8040);  // flush subnormal numbers to zero
    const unsigned control = __builtin_ia32_stmxcsr() & ~0x3fU;
#endif
    const int code = session.step(sample);
    const std::string line = cordon_result_json(session, 0);
    const int rounding = std::fegetround();
#ifdef __SSE2__
    const unsigned control_after = __builtin_ia32_stmxcsr() & ~0x3fU;
    __builtin_ia32_ldmxcsr(0x1f80);
    CHECK(control_after == control);
#endif
    std::fesetround(FE_TONEAREST);
    CHECK(rounding == FE_UPWARD);
    REQUIRE(code == CORDON_OK);
    CHECK(line == cordon_result_json(other, 0));
  }
}
