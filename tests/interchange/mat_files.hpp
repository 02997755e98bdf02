// SPDX-License-Identifier: GPL-3.0-or-later
// MAT-files, by the program itself and by libmatio, and what reading them gives.
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <limits>
#include <matio.h>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "run/scratch.hpp"

namespace interchange_test {

using namespace cordon;
using mat::Value;
using Kind = mat::Value::Kind;

inline bool same(const Value& a, const Value& b) {
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

inline bool same(const mat::Variables& a, const mat::Variables& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].name != b[i].name || !same(a[i].value, b[i].value)) return false;
  }
  return true;
}

inline mat::Variables sample() {
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

inline std::filesystem::path written(const Scratch& scratch, const std::string& bytes) {
  const auto file = scratch / "x.mat";
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

/// A file by libmatio itself.
inline std::filesystem::path by_matio(const Scratch& scratch, mat_ft version,
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

inline std::string reason(const std::filesystem::path& file) {
  try {
    mat::read_file(file);
  } catch (const InputError& error) {
    REQUIRE(error.diagnostics().size() == 1);
    return error.diagnostics()[0].message;
  }
  return "";
}

}  // namespace interchange_test
