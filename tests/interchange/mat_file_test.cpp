// SPDX-License-Identifier: GPL-3.0-or-later
// MAT-files are read as they were written; what cannot be read is told.
#include "experiments/interchange/mat_file.hpp"

#include <cstdint>
#include <limits>
#include <matio.h>

#include <doctest/doctest.h>

#include "experiments/interchange/utf16.hpp"
#include "interchange/mat_files.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using namespace interchange_test;

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

TEST_CASE("files that are none") {
  const Scratch scratch;
  CHECK(reason(scratch / "absent.mat") == "there is no such file");
  CHECK(reason(scratch.path()) == "is not a regular file");
  CHECK(reason(written(scratch, "")).find("too short") != std::string::npos);
  CHECK(reason(written(scratch, std::string(1000, 'x'))).find("no MAT-file") != std::string::npos);
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
