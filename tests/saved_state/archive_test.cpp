// SPDX-License-Identifier: GPL-3.0-or-later
// What archives write they read with every bit, and nothing else.
#include "cordon/interfaces/archive.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/line_form_set.hpp"
#include "input_design/plugins.hpp"
#include "saved_state/damage.hpp"

using namespace cordon;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<const SetBackend> line_zonotopes() { return examples::backend("line_zonotope"); }

struct Own {
  Index a = 0;
  Vector b;
  void serialize(Archive& archive) { archive(a, b); }
};

/// One of everything.
struct All {
  bool flag = false;
  int small = 0;
  Index large = 0;
  double number = 0;
  std::string text;
  Vector vector;
  Matrix matrix;
  Answer answer = Answer::unknown;
  Tightness tightness = Tightness::exact;
  Decision decision = Decision::monitoring;
  Box box;
  LineForm form;
  Sample sample;
  Certificate certificate;
  std::optional<Contradiction> contradiction;
  std::optional<Own> none;
  std::vector<Own> list;
  std::deque<double> queue;
  std::array<Index, 3> three{};
  std::pair<std::string, double> both;
  SetPtr no_set;
  Enclosure set, same_set, other_set, form_set;

  void serialize(Archive& archive) {
    archive.section("all");
    archive(flag, small, large, number, text, vector, matrix, answer, tightness, decision, box,
            form, sample, certificate, contradiction, none, list, queue, three, both, no_set, set,
            same_set, other_set, form_set);
  }
};

All filled(const SetBackend& backend) {
  All all;
  all.flag = true;
  all.small = -7;
  all.large = std::numeric_limits<Index>::min();
  all.number = -0.0;
  all.text = std::string("a\0b", 3);
  all.vector = Vector{{1.5, nan, -infinity, 5e-324}};
  all.matrix = Matrix{{1, 2, 3}, {4, 5, .1}};
  all.answer = Answer::yes;
  all.tightness = Tightness::outer;
  all.decision = Decision::unknown_fault;
  all.box = {Vector{{-1, 0}}, Vector{{infinity, 2}}};
  all.form = make_zonotope(Vector{{1, 2}}, Matrix{{1, 0, 1}, {0, 1, 1}});
  all.sample = {4, Vector{{1}}, Vector{{2, nan}}, {1}};
  all.certificate = {Certificate::Kind::direction, Vector{{0, 1}}, .25};
  all.contradiction = Contradiction{5, 1, .5, true};
  all.list = {{1, Vector(0)}, {2, Vector{{3}}}};
  all.queue = {1, nan, 3};
  all.three = {1, -2, 3};
  all.both = {"x", 2.5};
  all.set = backend.import(all.form);
  all.same_set = {all.set.set, Tightness::outer};
  all.other_set = backend.import(make_empty(2));
  all.form_set = line_form_set(make_space(2), Rounding::outward, Tightness::outer);
  return all;
}

std::string written(All all, const std::shared_ptr<const SetBackend>& backend) {
  Archive archive(backend);
  archive(all);
  return archive.bytes();
}

All read_all(const std::string& bytes, const std::shared_ptr<const SetBackend>& backend) {
  All all;
  Archive archive(backend, bytes);
  archive(all);
  archive.expect_end();
  return all;
}

template <class Work>
std::optional<Errc> code_of(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.code();
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("what is written is read with every bit, and shared sets stay shared") {
  for (const char* name : {"line_zonotope", "constrained_zonotope", "zonotope", "interval"}) {
    CAPTURE(std::string(name));
    const auto backend = examples::backend(name);
    const std::string bytes = written(filled(*backend), backend);
    const All all = read_all(bytes, backend);
    CHECK(written(all, backend) == bytes);
    CHECK(std::signbit(all.number));
    CHECK(std::isnan(all.vector[1]));
    CHECK(all.vector[3] == 5e-324);
    CHECK(all.large == std::numeric_limits<Index>::min());
    CHECK(all.text.size() == 3);
    CHECK(!all.none);
    CHECK(!all.no_set);
    CHECK(all.set.set == all.same_set.set);
    CHECK(all.set.set != all.other_set.set);
    CHECK(all.other_set->is_empty() == Answer::yes);
    CHECK(&all.set->backend() == backend.get());
    CHECK(all.form_set->backend().info().name == "line_form");
    CHECK(all.form_set->backend().info().rounding == Rounding::outward);
    CHECK(all.form_set->line_form().lines() == 2);
  }
}

TEST_CASE("bytes that end too early, or go on, are refused") {
  const auto backend = line_zonotopes();
  const std::string bytes = written(filled(*backend), backend);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    REQUIRE(code_of([&] { read_all(bytes.substr(0, size), backend); }) == Errc::invalid);
  CHECK(code_of([&] { read_all(bytes + "x", backend); }) == Errc::invalid);
}

TEST_CASE("values of other types are refused") {
  const auto backend = line_zonotopes();
  std::vector<std::string> all;
  const auto add = [&](auto value) {
    Archive archive(backend);
    archive(value);
    all.push_back(archive.bytes());
  };
  const auto try_all = [&](auto value, std::size_t own) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      CAPTURE(own);
      CAPTURE(i);
      const auto taken = [&] {
        Archive archive(backend, all[i]);
        archive(value);
        archive.expect_end();
      };
      CHECK(code_of(taken) == (i == own ? std::nullopt : std::optional(Errc::invalid)));
    }
  };
  add(true);
  add(Index{1});
  add(1.0);
  add(std::string("abc"));
  add(Vector(Vector{{1, 2}}));
  add(Matrix(Matrix{{1, 2}}));
  try_all(true, 0);
  try_all(Index{1}, 1);
  try_all(1.0, 2);
  try_all(std::string(), 3);
  try_all(Vector(), 4);
  try_all(Matrix(), 5);
}

TEST_CASE("what does not fit a member is refused") {
  const auto backend = line_zonotopes();
  const auto refused = [&](auto write, auto take) {
    Archive writing(backend);
    write(writing);
    return code_of([&] {
             Archive reading(backend, writing.bytes());
             take(reading);
           }) == Errc::invalid;
  };
  Vector three = Vector::Zero(3), two = Vector::Zero(2);
  Matrix wide = Matrix::Zero(2, 3), high = Matrix::Zero(3, 2);
  Index number = 300;
  signed char small = 0;
  Enclosure set = backend->point(three), none;
  CHECK(refused([&](Archive& a) { a(three); }, [&](Archive& a) { a.same_shape(two); }));
  CHECK(refused([&](Archive& a) { a(wide); }, [&](Archive& a) { a.same_shape(high); }));
  CHECK(refused([&](Archive& a) { a(number); }, [&](Archive& a) { a(small); }));
  CHECK(refused([&](Archive& a) { a(set); }, [&](Archive& a) { a.set(set, 2); }));
  CHECK(refused([&](Archive& a) { a(none); }, [&](Archive& a) { a.set(set, 3); }));
  CHECK(refused([](Archive& a) { a.section("one"); }, [](Archive& a) { a.section("two"); }));
}

TEST_CASE("a set of another backend is not written") {
  const auto backend = line_zonotopes(), other = examples::backend("zonotope");
  Enclosure set = other->point(Vector::Zero(2));
  Archive archive(backend);
  CHECK(code_of([&] { archive(set); }) == Errc::unsupported);
}

TEST_CASE("lengths beyond the end ask for no memory") {
  const auto backend = line_zonotopes();
  for (const std::uint64_t size : {std::uint64_t{1} << 40, std::uint64_t{1} << 61,
                                   std::uint64_t{1} << 63, ~std::uint64_t{0}}) {
    std::string length(sizeof size, '\0');
    std::memcpy(length.data(), &size, sizeof size);
    const auto refuses = [&](auto value, const std::string& bytes) {
      return code_of([&] {
               Archive archive(backend, bytes);
               archive(value);
             }) == Errc::invalid;
    };
    CHECK(refuses(Vector(), "vn" + length));
    CHECK(refuses(std::string(), "n" + length));
    CHECK(refuses(std::vector<Vector>(), "n" + length));
    CHECK(refuses(Matrix(), "mi" + length + "i" + length));
  }
}

TEST_CASE("damaged bytes are refused, or read as something else") {
  for (const char* name :
       {"line_zonotope", "constrained_zonotope", "zonotope", "interval", "ellipsoid", "polytope"}) {
    CAPTURE(std::string(name));
    const auto backend = examples::backend(name);
    const std::string bytes = written(filled(*backend), backend);
    std::mt19937_64 random(1);
    int refused = 0;
    for (int i = 0; i < 10'000; ++i) {
      const std::string damaged = damage(bytes, random);
      const auto code = code_of([&] {
        const All all = read_all(damaged, backend);
        for (const Enclosure* set : {&all.set, &all.other_set, &all.form_set})
          if (set->set) (*set)->interval_hull();
      });
      if (!code) continue;
      ++refused;
      REQUIRE(*code == Errc::invalid);
    }
    CHECK(refused > 1000);
  }
}
