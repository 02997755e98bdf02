// SPDX-License-Identifier: GPL-3.0-or-later
// Variables of MAT-files that are read as a system, and the problems of doing so.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/experiments/interchange.hpp"
#include "cordon/registry/registry.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "run/scratch.hpp"
#include "study/fakes.hpp"

namespace interchange_test {

using namespace cordon;
using mat::Value;

inline void put(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

inline std::filesystem::path mat_of(const Scratch& scratch, const mat::Variables& variables) {
  put(scratch / "in.mat", mat::to_bytes(variables));
  return scratch / "in.mat";
}

inline Study read(const std::filesystem::path& file) {
  Registry registry;
  registry.add(study_test::register_fakes);
  return read_study(file, registry, SearchPath{});
}

/// The problems of reading this struct as a system.
inline std::vector<Diagnostic> problems_of(const mat::Variables& variables,
                                           const std::string& variable = "") {
  const Scratch scratch;
  try {
    mat_to_json(mat_of(scratch, variables), {scratch / "out.json"}, variable);
  } catch (const InputError& error) {
    CHECK_FALSE(std::filesystem::exists(scratch / "out.json"));
    return error.diagnostics();
  }
  return {};
}

inline void expect_problem(const mat::Variables& variables, const std::string& pointer,
                           const std::string& message) {
  const auto problems = problems_of(variables);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == pointer);
  CHECK(problems[0].message.find(message) != std::string::npos);
  CHECK(problems[0].line == 0);
}

inline Value box(const Matrix& lower, const Matrix& upper) {
  mat::Struct set;
  set.set("lower", mat::matrix(lower)).set("upper", mat::matrix(upper));
  return std::move(set).value();
}

/// Two states, one input, one output.
inline mat::Variables plain() {
  return {{"A", mat::matrix(Matrix{{1, 0.1}, {0, 1}})},
          {"B", mat::matrix(Matrix{{0}, {0.1}})},
          {"C", mat::matrix(Matrix{{1, 0}})},
          {"D", mat::matrix(Matrix{{0}})},
          {"W", box(Matrix{{-0.1}, {-0.1}}, Matrix{{0.1}, {0.1}})},
          {"V", box(Matrix{{-0.1}}, Matrix{{0.1}})}};
}

inline mat::Variables with(mat::Variables all, const std::string& name, Value value) {
  for (mat::Variable& v : all) {
    if (v.name != name) continue;
    v.value = std::move(value);
    return all;
  }
  all.push_back({name, std::move(value)});
  return all;
}

}  // namespace interchange_test
