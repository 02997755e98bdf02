// SPDX-License-Identifier: GPL-3.0-or-later
// MAT-files are read as they were written, and whatever their bytes are, the program goes on.
#include "experiments/interchange/mat_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <matio.h>
#include <zlib.h>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "experiments/interchange/mat_wire.hpp"
#include "experiments/interchange/utf16.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using mat::Value;
using Kind = mat::Value::Kind;

namespace {

bool same(const Value& a, const Value& b) {
  if (a.kind != b.kind || a.text != b.text || a.rows != b.rows || a.cols != b.cols ||
      a.names != b.names)
    return false;
  if (a.numbers.rows() != b.numbers.rows() || a.numbers.cols() != b.numbers.cols() ||
      a.items.size() != b.items.size())
    return false;
  for (Index i = 0; i < a.numbers.size(); ++i) {
    const double x = a.numbers.data()[i], y = b.numbers.data()[i];
    if (x != y && !(std::isnan(x) && std::isnan(y))) return false;
  }
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    if (!same(a.items[i], b.items[i])) return false;
  }
  return true;
}

bool same(const mat::Variables& a, const mat::Variables& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].name != b[i].name || !same(a[i].value, b[i].value)) return false;
  }
  return true;
}

mat::Variables sample() {
  mat::Struct inner;
  inner.set("type", mat::text("box"))
      .set("lower", mat::matrix(Matrix{{-infinity, 0.1}}))
      .set("none", mat::matrix(Matrix(2, 0)));
  mat::Struct first, second;
  first.set("name", mat::text("Grüße an „x“ 😀")).set("x", mat::number(std::nan("")));
  second.set("name", mat::text("")).set("x", mat::matrix(Matrix{{1, 2}, {3, 4.5}}));
  return {
      {"A", mat::matrix(Matrix{{1, 2, 3}, {4, 5, 1e-300}})},
      {"s", std::move(inner).value()},
      {"modes", mat::Struct::array({first, second})},
      {"list", mat::cell({mat::number(7), mat::text("seven"), mat::cell(std::vector<Value>{})})}};
}

std::filesystem::path written(const Scratch& scratch, const std::string& bytes) {
  const auto file = scratch / "x.mat";
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

/// A file by libmatio itself.
std::filesystem::path by_matio(const Scratch& scratch, mat_ft version,
                               std::vector<matvar_t*> variables) {
  const auto file = scratch / "y.mat";
  mat_t* const out = Mat_CreateVer(file.c_str(), nullptr, version);
  REQUIRE(out);
  for (matvar_t* v : variables) {
    REQUIRE(v);
    REQUIRE(Mat_VarWrite(out, v, MAT_COMPRESSION_NONE) == 0);
    Mat_VarFree(v);
  }
  Mat_Close(out);
  return file;
}

template <class T>
matvar_t* numbers(const char* name, matio_classes kind, matio_types type, std::vector<T> data,
                  std::vector<std::size_t> dims) {
  return Mat_VarCreate(name, kind, type, static_cast<int>(dims.size()), dims.data(), data.data(),
                       0);
}

std::string reason(const std::filesystem::path& file) {
  try {
    mat::read_file(file);
  } catch (const InputError& error) {
    REQUIRE(error.diagnostics().size() == 1);
    return error.diagnostics()[0].message;
  }
  return "";
}

}  // namespace

TEST_CASE("what is written is read") {
  const Scratch scratch;
  const std::string bytes = mat::to_bytes(sample());
  CHECK(bytes == mat::to_bytes(sample()));
  CHECK(bytes.starts_with("MATLAB 5.0 MAT-file"));
  CHECK(same(mat::read_file(written(scratch, bytes)), sample()));
  CHECK(mat::read_file(written(scratch, mat::to_bytes({}))).empty());
}

TEST_CASE("all numeric classes are numbers") {
  const Scratch scratch;
  const auto file = by_matio(
      scratch, MAT_FT_MAT5,
      {numbers<float>("single", MAT_C_SINGLE, MAT_T_SINGLE, {0.5f, -2}, {1, 2}),
       numbers<std::int8_t>("i8", MAT_C_INT8, MAT_T_INT8, {-8}, {1, 1}),
       numbers<std::uint8_t>("u8", MAT_C_UINT8, MAT_T_UINT8, {200, 1}, {2, 1}),
       numbers<std::int16_t>("i16", MAT_C_INT16, MAT_T_INT16, {-300}, {1, 1}),
       numbers<std::uint16_t>("u16", MAT_C_UINT16, MAT_T_UINT16, {60000}, {1, 1}),
       numbers<std::int32_t>("i32", MAT_C_INT32, MAT_T_INT32, {-70000}, {1, 1}),
       numbers<std::uint32_t>("u32", MAT_C_UINT32, MAT_T_UINT32, {4000000000u}, {1, 1}),
       numbers<std::int64_t>("i64", MAT_C_INT64, MAT_T_INT64, {-9007199254740992}, {1, 1}),
       numbers<std::int64_t>("huge", MAT_C_INT64, MAT_T_INT64, {9007199254740993}, {1, 1}),
       numbers<double>("flat", MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 2, 3, 4}, {2, 2, 1}),
       numbers<double>("cube", MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 2, 3, 4, 5, 6, 7, 8}, {2, 2, 2})});
  const mat::Variables all = mat::read_file(file);
  REQUIRE(all.size() == 11);
  CHECK(all[0].value.numbers == Matrix{{0.5, -2}});
  CHECK(all[1].value.numbers == Matrix{{-8}});
  CHECK(all[2].value.numbers == Matrix{{200}, {1}});
  CHECK(all[3].value.numbers == Matrix{{-300}});
  CHECK(all[4].value.numbers == Matrix{{60000}});
  CHECK(all[5].value.numbers == Matrix{{-70000}});
  CHECK(all[6].value.numbers == Matrix{{4e9}});
  CHECK(all[7].value.numbers == Matrix{{-9007199254740992.0}});
  CHECK(all[8].value.is(Kind::refused));
  CHECK(all[9].value.numbers == Matrix{{1, 3}, {2, 4}});
  CHECK(all[10].value.text.find("3 dimensions") != std::string::npos);
}

TEST_CASE("integers of 64 bits are read if they are doubles") {
  const Scratch scratch;
  const std::uint64_t one = 1;
  const std::pair<std::uint64_t, bool> wide[] = {
      {(one << 53) - 1, true},  {one << 53, true},
      {(one << 53) + 1, false}, {(one << 53) + 2, true},
      {one << 63, true},        {~std::uint64_t{0}, false},
      {(one << 63) + 1, false}, {~std::uint64_t{0} << 11, true}};
  for (const auto& [x, exact] : wide) {
    CAPTURE(x);
    const auto all = mat::read_file(
        by_matio(scratch, MAT_FT_MAT5,
                 {numbers<std::uint64_t>("x", MAT_C_UINT64, MAT_T_UINT64, {x}, {1, 1})}));
    CHECK(all[0].value.is(Kind::numbers) == exact);
    if (exact) CHECK(all[0].value.numbers(0, 0) == static_cast<double>(x));
  }
  const std::pair<std::int64_t, bool> narrow[] = {{std::numeric_limits<std::int64_t>::min(), true},
                                                  {std::numeric_limits<std::int64_t>::max(), false},
                                                  {-(std::int64_t{1} << 53) - 1, false},
                                                  {-(std::int64_t{1} << 53) - 2, true}};
  for (const auto& [x, exact] : narrow) {
    CAPTURE(x);
    const auto all = mat::read_file(by_matio(
        scratch, MAT_FT_MAT5, {numbers<std::int64_t>("x", MAT_C_INT64, MAT_T_INT64, {x}, {1, 1})}));
    CHECK(all[0].value.is(Kind::numbers) == exact);
  }
}

TEST_CASE("sparse matrices are read, complex ones are not") {
  const Scratch scratch;
  std::vector<mat_uint32_t> ir{0, 2, 1}, jc{0, 2, 2, 3};
  std::vector<double> entries{1.5, -2, 7};
  mat_sparse_t sparse{3, ir.data(), 3, jc.data(), 4, 3, entries.data()};
  std::vector<double> re{1}, im{2};
  mat_complex_split_t z{re.data(), im.data()};
  std::size_t dims[2] = {3, 3}, one[2] = {1, 1};
  const auto file =
      by_matio(scratch, MAT_FT_MAT5,
               {Mat_VarCreate("S", MAT_C_SPARSE, MAT_T_DOUBLE, 2, dims, &sparse, 0),
                Mat_VarCreate("z", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, one, &z, MAT_F_COMPLEX)});
  const mat::Variables all = mat::read_file(file);
  REQUIRE(all.size() == 2);
  CHECK(all[0].value.numbers == Matrix{{1.5, 0, 0}, {0, 0, 7}, {-2, 0, 0}});
  CHECK(all[1].value.text == "it is complex");
}

TEST_CASE("a sparse matrix with places outside of it is damaged") {
  const Scratch scratch;
  for (const auto& [ir, jc] :
       std::vector<std::pair<std::vector<mat_uint32_t>, std::vector<mat_uint32_t>>>{
           {{0, 7}, {0, 1, 2}}, {{0, 1}, {0, 9, 2}}, {{0, 1}, {0, 2, 1}}}) {
    std::vector<mat_uint32_t> rows = ir, starts = jc;
    std::vector<double> entries{1, 2};
    mat_sparse_t sparse{2, rows.data(), 2, starts.data(), 3, 2, entries.data()};
    std::size_t dims[2] = {2, 2};
    const auto file =
        by_matio(scratch, MAT_FT_MAT5,
                 {Mat_VarCreate("S", MAT_C_SPARSE, MAT_T_DOUBLE, 2, dims, &sparse, 0)});
    const mat::Variables all = mat::read_file(file);
    REQUIRE(all.size() == 1);
    CHECK(all[0].value.text == "it is damaged");
  }
}

TEST_CASE("a sparse matrix with two entries at one place") {
  const Scratch scratch;
  std::vector<mat_uint32_t> ir{0, 1, 0, 0}, jc{0, 1, 4};
  std::vector<double> entries{1, 2, 3, 4};
  mat_sparse_t sparse{4, ir.data(), 4, jc.data(), 3, 4, entries.data()};
  std::size_t dims[2] = {2, 2};
  const auto file = by_matio(scratch, MAT_FT_MAT5,
                             {Mat_VarCreate("S", MAT_C_SPARSE, MAT_T_DOUBLE, 2, dims, &sparse, 0)});
  CHECK(mat::read_file(file)[0].value.text == "it has two entries at one place");
}

TEST_CASE("version 7.3 is read, version 4 is not") {
  const Scratch scratch;
  const auto make = [] {
    return numbers<double>("A", MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 2, 3, 4}, {2, 2});
  };
  const mat::Variables all = mat::read_file(by_matio(scratch, MAT_FT_MAT73, {make()}));
  REQUIRE(all.size() == 1);
  CHECK(all[0].value.numbers == Matrix{{1, 3}, {2, 4}});
  CHECK(reason(by_matio(scratch, MAT_FT_MAT4, {make()})).find("MAT-file") != std::string::npos);
}

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

TEST_CASE("files that are none") {
  const Scratch scratch;
  CHECK(reason(scratch / "absent.mat") == "there is no such file");
  CHECK(reason(scratch.path()) == "is not a regular file");
  CHECK(reason(written(scratch, "")).find("too short") != std::string::npos);
  CHECK(reason(written(scratch, std::string(1000, 'x'))).find("no MAT-file") != std::string::npos);
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

TEST_CASE("names of MATLAB") {
  CHECK(mat::valid_name("Line zonotope") == "Line_zonotope");
  CHECK(mat::valid_name("2 tanks") == "x2_tanks");
  CHECK(mat::valid_name("_a") == "x_a");
  CHECK(mat::valid_name("Größe--1") == "Gr_e_1");
  CHECK(mat::valid_name("") == "x");
  for (const std::string keyword : {"end", "for", "function", "otherwise", "do"})
    CHECK(mat::valid_name(keyword) == "x" + keyword);
  CHECK(mat::valid_name("ends") == "ends");
  CHECK(mat::valid_names({"end", "xend"}) == std::vector<std::string>{"xend", "xend_2"});
  CHECK(mat::valid_name(std::string(100, 'a')).size() == 63);
  const auto names =
      mat::valid_names({"a b", "a-b", "a_b_2", "a+b", std::string(70, 'z'), std::string(71, 'z')});
  CHECK(names == std::vector<std::string>{"a_b", "a_b_2", "a_b_2_2", "a_b_3", std::string(63, 'z'),
                                          std::string(61, 'z') + "_2"});
}

TEST_CASE("UTF-16") {
  for (const std::string text : {"", "plain", "é ü ß", "日本語", "😀 beyond 0xFFFF"})
    CHECK(mat::to_utf8(mat::to_utf16(text)) == text);
  CHECK(mat::to_utf16("\xFFx") == u"\uFFFDx");
  CHECK(mat::to_utf8(std::u16string{char16_t(0xD800), u'x', char16_t(0xDC00)}) ==
        "\xEF\xBF\xBDx\xEF\xBF\xBD");
}
