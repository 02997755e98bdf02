// SPDX-License-Identifier: GPL-3.0-or-later
#include "glpk_program.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "cordon/core/error.hpp"

namespace cordon::glpk {

namespace {

bool are_bounds(const Vector& lower, const Vector& upper) {
  return !lower.hasNaN() && !upper.hasNaN() && (lower.array() <= upper.array()).all() &&
         (lower.array() < infinity).all() && (upper.array() > -infinity).all();
}

}  // namespace

void check(const SparseProgram& p, const char* what) {
  const auto require = [&](bool fine, Errc code, const char* problem) {
    if (!fine) throw Error(code, std::string(what) + ": " + problem);
  };
  const Index n = p.cost.size(), m = p.row_lower.size();
  require(p.lower.size() == n && p.upper.size() == n && p.row_upper.size() == m, Errc::dimension,
          "the sizes of cost and bounds differ");
  require(n > 0, Errc::dimension, "no column");
  require(m <= 1'000'000 && n <= 1'000'000 && p.entries.size() <= 50'000'000, Errc::dimension,
          "more than a million rows or columns");
  require(p.cost.allFinite(), Errc::not_finite, "a NaN or infinite cost");
  require(are_bounds(p.row_lower, p.row_upper) && are_bounds(p.lower, p.upper), Errc::not_finite,
          "a NaN or crossed bound");
  std::vector<std::pair<Index, Index>> places;
  places.reserve(p.entries.size());
  for (const auto& [row, col, value] : p.entries) {
    require(row >= 0 && row < m && col >= 0 && col < n, Errc::dimension,
            "an entry outside of the matrix");
    require(std::isfinite(value), Errc::not_finite, "a NaN or infinite coefficient");
    places.emplace_back(row, col);
  }
  std::sort(places.begin(), places.end());
  require(std::adjacent_find(places.begin(), places.end()) == places.end(), Errc::invalid,
          "two entries at one place");
}

Entries::Entries(const SparseProgram& program) {
  for (const auto& entry : program.entries) {
    if (entry.value == 0) continue;
    row.push_back(static_cast<int>(entry.row) + 1);
    col.push_back(static_cast<int>(entry.col) + 1);
    value.push_back(entry.value);
  }
}

void load(glp_prob* problem, const SparseProgram& p, const Entries& entries) {
  const int m = static_cast<int>(p.row_lower.size()), n = static_cast<int>(p.cost.size());
  glp_set_obj_dir(problem, GLP_MIN);
  if (m > 0) glp_add_rows(problem, m);
  glp_add_cols(problem, n);
  for (int i = 0; i < m; ++i) {
    glp_set_row_bnds(problem, i + 1, bound_type(p.row_lower[i], p.row_upper[i]), p.row_lower[i],
                     p.row_upper[i]);
  }
  for (int j = 0; j < n; ++j) {
    glp_set_col_bnds(problem, j + 1, bound_type(p.lower[j], p.upper[j]), p.lower[j], p.upper[j]);
    glp_set_obj_coef(problem, j + 1, p.cost[j]);
  }
  glp_load_matrix(problem, static_cast<int>(entries.value.size()) - 1, entries.row.data(),
                  entries.col.data(), entries.value.data());
}

}  // namespace cordon::glpk
