// SPDX-License-Identifier: GPL-3.0-or-later
// The curves of steps.csv and data.csv.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/report/thinning.hpp"
#include "figures/columns.hpp"
#include "figures/run_files.hpp"

namespace cordon::report {

/// Steps of one pipeline.
struct StepCurves {
  std::vector<Thinner> hull, inner;  ///< by state
  std::vector<Thinner> width;        ///< by state, of the hull; none of ∅
  std::vector<Thinner> error;    ///< by state: the hull less the true state; none: it is not known
  std::vector<Thinner> metrics;  ///< by column
  std::int64_t first = -1, last = -1;  ///< k; -1: there are no steps
  std::int64_t exact = 0;              ///< steps that are claimed to be exact
  std::vector<std::int64_t>
      empty_from;  ///< where an estimate is proven empty and the one before was not
  std::vector<std::int64_t>
      anew;                     ///< where the one before was and a later one is not: the first ones
  std::int64_t times_anew = 0;  ///< how many there are
};

struct Curves {
  std::size_t states = 0;  ///< of which there are curves
  std::size_t all_states = 0;
  std::vector<std::string> metrics;  ///< columns that hold numbers
  std::vector<StepCurves> pipelines;
  std::vector<Thinner> truth;  ///< by state; none: it is not known
  std::vector<PlantEvent> events;
  bool thinned = false;
};

/// States beyond `page_states` are left out of a page.
inline constexpr std::size_t page_states = 12;

Curves read_curves(const RunFiles& files);

/// data.csv; nothing for a run whose pipelines all have inputs of their own: no data were read
/// then.
std::optional<ColumnReader> open_data_table(const RunFiles& files);

/// The true states at these times, as far as data.csv tells them.
std::vector<std::pair<std::int64_t, std::vector<double>>> truth_at(
    const RunFiles& files, const std::set<std::int64_t>& times);

}  // namespace cordon::report
