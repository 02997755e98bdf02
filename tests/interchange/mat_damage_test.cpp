// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever the bytes of a MAT-file are, the program goes on, and takes nothing for what it is not.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <matio.h>
#include <string>
#include <vector>
#include <zlib.h>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "experiments/interchange/mat_wire.hpp"
#include "interchange/mat_files.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using namespace interchange_test;

namespace {

/// Refused, or nothing but what the undamaged file holds.
void expect_same_or_refused(const std::filesystem::path& file, const mat::Variables& whole) {
  try {
    for (const mat::Variable& v : mat::read_file(file)) {
      if (v.value.is(Kind::refused)) continue;
      const auto found = std::find_if(whole.begin(), whole.end(),
                                      [&](const mat::Variable& one) { return one.name == v.name; });
      REQUIRE(found != whole.end());
      CHECK(same(v.value, found->value));
    }
  } catch (const InputError&) {
  }
}

/// One variable of each kind. No number and no name has a word below 2^16, so that small words are
/// sizes, types and flags.
std::vector<matvar_t*> one_of_each() {
  std::size_t one[2] = {1, 1}, two[2] = {1, 2};
  const char* fields[] = {"gain", "name"};
  std::string name = "abcdefghijkl";
  std::size_t length[2] = {1, name.size()};
  matvar_t* s = Mat_VarCreateStruct("ssss", 2, one, fields, 2);
  Mat_VarSetStructFieldByIndex(
      s, 0, 0,
      numbers<double>("gain", MAT_C_DOUBLE, MAT_T_DOUBLE, {0.1, 0.3, 1 / 3.0, 1e-7}, {2, 2}));
  Mat_VarSetStructFieldByIndex(
      s, 1, 0, Mat_VarCreate("name", MAT_C_CHAR, MAT_T_UINT8, 2, length, name.data(), 0));
  matvar_t* items[] = {
      numbers<float>(nullptr, MAT_C_SINGLE, MAT_T_SINGLE, {0.1f, 0.7f, 0.9f}, {3, 1}),
      numbers<std::int32_t>(nullptr, MAT_C_INT32, MAT_T_INT32, {1 << 20, 1 << 21}, {1, 2})};
  std::vector<mat_uint32_t> ir{0, 1, 2, 0}, jc{0, 1, 3, 4};
  std::vector<double> entries{0.1, 0.2, 0.3, 0.7};
  mat_sparse_t sparse{4, ir.data(), 4, jc.data(), 4, 4, entries.data()};
  std::size_t square[2] = {3, 3};
  return {numbers<double>("AAAA", MAT_C_DOUBLE, MAT_T_DOUBLE, {0.1, 0.7, 1 / 3.0, 1e-7}, {2, 2}), s,
          Mat_VarCreate("cccc", MAT_C_CELL, MAT_T_CELL, 2, two, static_cast<void*>(items), 0),
          Mat_VarCreate("SSSS", MAT_C_SPARSE, MAT_T_DOUBLE, 2, square, &sparse, 0)};
}

}  // namespace

TEST_CASE("sizes are refused before memory is taken for them") {
  const Scratch scratch;
  std::string bytes = [&] {
    return bytes_of(
        by_matio(scratch, MAT_FT_MAT5,
                 {numbers<double>("A", MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 2, 3, 4}, {2, 2})}));
  }();
  const std::size_t dims =
      128 + 8 + 16 + 8;  // header, tag of the variable, its flags, tag of its dimensions
  REQUIRE(bytes.substr(dims, 8) == std::string("\2\0\0\0\2\0\0\0", 8));
  bytes.replace(dims, 8, std::string("\0\0\0\1\0\0\0\1", 8));
  const mat::Variables all = mat::read_file(written(scratch, bytes));
  REQUIRE(all.size() == 1);
  CHECK(all[0].value.text.find("more than") != std::string::npos);
}

TEST_CASE("truncated at every byte") {
  const Scratch scratch;
  const std::string bytes = mat::to_bytes(sample());
  for (std::size_t size = 0; size < bytes.size(); size += 3) {
    try {
      const mat::Variables all = mat::read_file(written(scratch, bytes.substr(0, size)));
      CHECK(all.size() <= sample().size());
    } catch (const InputError& error) {
      CHECK(!error.diagnostics().empty());
    }
  }
}

TEST_CASE("sizes that do not fit are refused, never filled up") {
  const Scratch scratch;
  for (matvar_t* const v : one_of_each()) {
    const auto file = by_matio(scratch, MAT_FT_MAT5, {v});
    const mat::Variables whole = mat::read_file(file);
    REQUIRE(whole.size() == 1);
    std::size_t changed = 0;
    REQUIRE_FALSE(whole[0].value.is(Kind::refused));
    const std::string bytes = bytes_of(file);
    for (std::size_t size = 128; size < bytes.size(); size += 4) {
      CAPTURE(size);
      expect_same_or_refused(written(scratch, bytes.substr(0, size)), whole);
    }
    if (whole[0].name == "SSSS") continue;  // its places are small words, too
    for (std::size_t at = 128; at < bytes.size(); at += 4) {
      const auto word_at = [&](std::size_t place) {
        std::uint32_t x = 0;
        std::memcpy(&x, &bytes[place], 4);
        return x;
      };
      const std::uint32_t word = word_at(at), before = word_at(at - 4);
      const bool flags = before == 8 && word_at(at - 8) == 6,
                 type = at > 128 && before != 0x40005 && (before == 0 || before > 4096);
      if (word == 0 || word > 4096 || flags || type)
        continue;  // a change of these is another meaning, not another size
      for (const int change : {-8, -4, -2, -1, 1, 4, 8, 64}) {
        CAPTURE(at);
        CAPTURE(change);
        ++changed;
        const std::uint32_t other = word + static_cast<std::uint32_t>(change);
        std::string damaged = bytes;
        std::memcpy(&damaged[at], &other, 4);
        expect_same_or_refused(written(scratch, damaged), whole);
      }
    }
    CHECK((changed > 40 || whole[0].name == "SSSS"));
  }
}

TEST_CASE("data that are shorter or longer than the dimensions") {
  const Scratch scratch;
  const auto element = [](std::uint32_t type, const std::string& data) {
    const std::uint32_t tag[2] = {type, static_cast<std::uint32_t>(data.size())};
    return std::string(reinterpret_cast<const char*>(tag), 8) + data +
           std::string((8 - data.size() % 8) % 8, '\0');
  };
  const std::string head = mat::to_bytes({}).substr(0, 128);
  const auto variable = [&](std::size_t count, bool packed) {
    const std::vector<double> numbers(count, 0.5);
    const std::string body =
        element(6, std::string("\6\0\0\0\0\0\0\0", 8)) +
        element(5, std::string("\2\0\0\0\2\0\0\0", 8)) + element(1, "A") +
        element(9, std::string(reinterpret_cast<const char*>(numbers.data()), 8 * count));
    const std::string plain = element(14, body);
    if (!packed) return head + plain;
    uLongf size = compressBound(plain.size());
    std::string small(size, '\0');
    REQUIRE(compress(reinterpret_cast<Bytef*>(small.data()), &size,
                     reinterpret_cast<const Bytef*>(plain.data()), plain.size()) == Z_OK);
    const std::uint32_t tag[2] = {15, static_cast<std::uint32_t>(size)};
    return head + std::string(reinterpret_cast<const char*>(tag), 8) + small.substr(0, size);
  };
  for (const bool packed : {false, true}) {
    CAPTURE(packed);
    CHECK(mat::read_file(written(scratch, variable(4, packed)))[0].value.numbers ==
          Matrix::Constant(2, 2, 0.5));
    for (const std::size_t count : {0, 1, 2, 3, 5, 6}) {
      CAPTURE(count);
      CHECK(reason(written(scratch, variable(count, packed))).find("damaged") != std::string::npos);
    }
    const std::string whole = variable(4, packed);
    for (std::size_t size = 129; size < whole.size(); ++size)
      CHECK(reason(written(scratch, whole.substr(0, size))) != "");
    CHECK(reason(written(scratch, whole + "x")) != "");
  }
  std::string wrong_sum = variable(4, true);
  wrong_sum.back() = static_cast<char>(wrong_sum.back() ^ 1);
  CHECK(reason(written(scratch, wrong_sum)) != "");
}

TEST_CASE("version 7.3, cut off anywhere") {
  const Scratch scratch;
  const auto file = by_matio(
      scratch, MAT_FT_MAT73,
      {numbers<double>("A", MAT_C_DOUBLE, MAT_T_DOUBLE, {0.1, 0.7, 1 / 3.0, 1e-7}, {2, 2})});
  const mat::Variables whole = mat::read_file(file);
  const std::string bytes = bytes_of(file);
  for (std::size_t size = 128; size < bytes.size(); size += 61)
    expect_same_or_refused(written(scratch, bytes.substr(0, size)), whole);
}

TEST_CASE("damaged bytes") {
  const Scratch scratch;
  const std::string plain = [&] {
    std::vector<double> data{1, 2, 3, 4};
    std::size_t one[2] = {1, 1};
    const char* fields[] = {"A", "b"};
    matvar_t* s = Mat_VarCreateStruct("s", 2, one, fields, 2);
    Mat_VarSetStructFieldByIndex(
        s, 0, 0, numbers<double>("A", MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 2, 3, 4}, {2, 2}));
    Mat_VarSetStructFieldByIndex(s, 1, 0,
                                 numbers<double>("b", MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 2}, {2, 1}));
    return bytes_of(by_matio(scratch, MAT_FT_MAT5,
                             {s, numbers<float>("f", MAT_C_SINGLE, MAT_T_SINGLE, {1}, {1, 1})}));
  }();
  const std::string packed = mat::to_bytes(sample());
  CHECK(rc::check("read or refused", [&] {
    std::string bytes = *rc::gen::arbitrary<bool>() ? plain : packed;
    for (int edits = *rc::gen::inRange(1, 4); edits > 0; --edits) {
      const auto at = *rc::gen::inRange<std::size_t>(100, bytes.size());
      bytes[at] = static_cast<char>(*rc::gen::element(0, 1, 2, 5, 6, 14, 15, 17, 127, 128, 255));
    }
    try {
      mat::read_file(written(scratch, bytes));
    } catch (const InputError& error) {
      RC_ASSERT(!error.diagnostics().empty());
    }
  }));
}

TEST_CASE("bytes between the processes are checked") {
  const std::string wire = mat::to_wire(sample());
  CHECK(same(*mat::from_wire(wire), sample()));
  for (std::size_t size = 1; size < wire.size(); ++size) {
    const auto read = mat::from_wire(wire.substr(0, size));
    if (read) CHECK(read->size() < sample().size());
  }
  CHECK(rc::check("damaged wires", [&] {
    std::string bytes = wire;
    for (int edits = *rc::gen::inRange(1, 5); edits > 0; --edits) {
      bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] =
          static_cast<char>(*rc::gen::inRange(0, 256));
    }
    mat::from_wire(bytes);
  }));
}
