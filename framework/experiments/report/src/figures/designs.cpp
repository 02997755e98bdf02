// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/interfaces/input_designer.hpp"
#include "experiments/report/separation.hpp"
#include "figures/columns.hpp"
#include "figures/figures.hpp"
#include "study/checks/common_runs.hpp"
#include "study/reading/read_parts.hpp"
#include "study/results/recorded_run.hpp"

namespace cordon::report {

namespace {

using json::Cursor;
using Kind = json::Value::Kind;

constexpr Index most_numbers =
    500;  ///< states and outputs of all times, to be seen along a direction
constexpr std::size_t most_modes = 60;  ///< whose pairs are shown

std::vector<std::string> texts_of(const Cursor& object, const char* key) {
  std::vector<std::string> texts;
  for (const Cursor& item : items_of(object, key))
    texts.push_back(json::read_text(item, 1000).value_or(""));
  return texts;
}

/// A design as results.json tells of it.
struct Design {
  std::size_t pipeline = 0;
  Cursor tree;
  std::vector<std::string> modes;
  Matrix u;
  bool last_output_only = false;
  std::optional<LineForm> admissible_set;
  std::vector<Box> tubes;          ///< by mode; dimension 0: not told
  std::vector<Cursor> exact = {};  ///< pairs, as far as they are proven
};

std::optional<Vector> bounds(const Cursor& box, const char* key) {
  const auto at = box.find(key);
  return at ? json::read_bounds(*at) : std::nullopt;
}

std::optional<Design> design_of(const RunFiles& files, std::size_t pipeline, Index states) {
  const Cursor tree = files.tree(pipeline);
  const auto at = tree.find("design");
  if (!at || !at->is(Kind::object)) return std::nullopt;
  Design design{
      pipeline,     *at, texts_of(tree, "modes"), Matrix(0, 0), text_of(*at, "outputs") == "last",
      std::nullopt, {}};
  if (const auto u = at->find("u"); u && !u->is(Kind::null))
    design.u = json::read_matrix(*u).value_or(Matrix(0, 0));
  const auto admissible = at->find("admissible_set");
  if (admissible && !admissible->is(Kind::null))
    design.admissible_set = verification::read_form(*admissible, states);
  for (const Cursor& tube : items_of(*at, "tubes")) {
    Box box;
    if (const auto outputs = tube.is(Kind::object) ? tube.find("outputs") : std::nullopt;
        outputs && outputs->is(Kind::object)) {
      auto lower = bounds(*outputs, "lower"), upper = bounds(*outputs, "upper");
      if (lower && upper && lower->size() == upper->size())
        box = {std::move(*lower), std::move(*upper)};
    }
    design.tubes.push_back(std::move(box));
  }
  if (const auto exact = tree.find("exact"); exact && exact->is(Kind::object))
    design.exact = items_of(*exact, "pairs");
  return design;
}

void add_inputs(const RunFiles& files, Report& report) {
  ColumnReader table(files.files().file("inputs.csv"));
  const std::size_t name = table.need("pipeline"), k = table.need("k");
  const std::vector<std::size_t> channels = table.numbered("u_");
  std::vector<Plot> plots;
  for (std::size_t i = 0; i < channels.size(); ++i)
    plots.push_back({"k", axis_of(files.labels().inputs, "u", i), false, {}});
  while (table.next()) {
    const int pipeline = files.pipeline(table.text(name), "inputs.csv");
    for (std::size_t i = 0; i < channels.size(); ++i) {
      std::vector<Series>& series = plots[i].series;
      if (series.empty() || series.back().pipeline != pipeline) {
        series.push_back({Series::Kind::steps, table.text(name), pipeline, {}, {}});
      }
      series.back().x.push_back(static_cast<double>(table.integer(k)));
      series.back().y.push_back(table.number(channels[i]));
    }
  }
  for (std::size_t i = 0; i < plots.size(); ++i) {
    if (plots[i].series.empty()) continue;
    report.figures.push_back({fmt::format("designed_input_{}", i + 1), section::designs,
                              title_of(files.labels().inputs, "Input", i),
                              "Designed and given inputs; each value holds until the next time.",
                              std::move(plots[i])});
  }
}

void add_tubes(const RunFiles& files, const Design& design, Report& report) {
  if (design.tubes.empty() || design.u.rows() == 0) return;
  const Index times = design.last_output_only ? 1 : design.u.rows(),
              all = design.tubes.front().dim();
  const Index outputs = all / times, first = design.u.rows() - times;
  if (outputs * times != all) return;
  for (Index i = 0; i < outputs; ++i) {
    const Labels::Names& names = files.labels().outputs;
    Plot plot{"k", label_of(names, "y", i), false, {}};
    for (std::size_t m = 0; m < design.tubes.size(); ++m) {
      const Box& tube = design.tubes[m];
      if (tube.dim() != all || tube.is_empty()) continue;
      Series band{Series::Kind::band,
                  m < design.modes.size() ? design.modes[m] : "",
                  static_cast<int>(design.pipeline),
                  {},
                  {}};
      band.shade = static_cast<int>(m);
      for (Index k = 0; k < times; ++k) {
        band.x.push_back(static_cast<double>(first + k));
        band.y.push_back(tube.lower[k * outputs + i]);
        band.upper.push_back(tube.upper[k * outputs + i]);
      }
      plot.series.push_back(std::move(band));
    }
    if (plot.series.empty()) continue;
    report.figures.push_back({fmt::format("tube_{}_{}", design.pipeline + 1, i + 1),
                              section::designs,
                              fmt::format("{} under the input of {}",
                                          title_of(names, "Output", static_cast<std::size_t>(i)),
                                          files.pipelines()[design.pipeline].name),
                              "Hulls of the outputs that each mode can show. Modes may be apart "
                              "although their hulls overlap: by several "
                              "outputs and times together.",
                              std::move(plot), static_cast<int>(design.pipeline)});
  }
}

/// The tubes themselves, made from the study; none if they are too large, or known by ranges only.
std::vector<LineForm> exact_tubes(const Design& design, const std::vector<const Model*>& bank) {
  std::vector<LineForm> tubes;
  if (design.u.rows() == 0 || bank.size() != design.modes.size()) return tubes;
  for (const Model* model : bank) {
    const LinearModel& m = model->linear;
    const bool fits = design.u.cols() == model->inputs() &&
                      model->outputs() == bank[0]->outputs() &&
                      (!design.admissible_set || design.admissible_set->dim() == model->states());
    if (!fits || m.has_ranges() || m.is_uncertain() ||
        design.u.rows() * (model->outputs() + model->states()) > most_numbers)
      return {};
    try {
      tubes.push_back(eliminate_lines(
          verification::output_tube(model_under(*model, design.u),
                                    {design.u, design.last_output_only, design.admissible_set})));
    } catch (const Error&) {
      return {};
    }
  }
  return tubes;
}

/// The output and time at which two hulls are farthest apart, or overlap least.
Index best_coordinate(const Box& X, const Box& Y) {
  Index best = 0;
  double most = -infinity;
  for (Index i = 0; i < X.dim(); ++i) {
    const double up = Y.lower[i] - X.upper[i], down = X.lower[i] - Y.upper[i],
                 width = X.upper[i] - X.lower[i] + Y.upper[i] - Y.lower[i];
    const double gap = std::max(up, down) / (width > 0 && std::isfinite(width) ? width : 1);
    if (!(gap > most)) continue;
    most = gap;
    best = i;
  }
  return best;
}

/// The proof of a pair, if there is one.
const Cursor* proof_of(const Design& design, std::size_t q) {
  const bool told = q < design.exact.size() && design.exact[q].is(Kind::object);
  return told && text_of(design.exact[q], "disjoint") != "unknown" ? &design.exact[q] : nullptr;
}

/// What of a pair is proven, else what its designer claims.
std::string verdict_of(const Cursor& claim, const Cursor* proof) {
  const std::string disjoint = text_of(proof ? *proof : claim, "disjoint");
  if (disjoint == "yes" && proof)
    return fmt::format("proven disjoint, κ ≥ {}", shown(value_of(*proof, "kappa_lower")));
  if (disjoint == "yes") return "claimed to be disjoint";
  if (disjoint == "no") return proof ? "proven to meet" : "claimed to meet";
  return "not decided";
}

/// One pair of modes, along what separates them.
std::optional<Intervals::Row> row_of(const Design& design, const std::vector<LineForm>& tubes,
                                     std::size_t i, std::size_t j, const Cursor& pair,
                                     const Cursor* proof) {
  const Box &X = design.tubes[i], &Y = design.tubes[j];
  Intervals::Row row{fmt::format("{} – {}", design.modes[i], design.modes[j]),
                     design.modes[i],
                     design.modes[j],
                     0,
                     0,
                     0,
                     0,
                     verdict_of(pair, proof)};
  const bool apart = text_of(proof ? *proof : pair, "disjoint") == "yes";
  if (apart && !tubes.empty()) {
    try {
      if (const auto d = separating_direction(tubes[i], tubes[j])) {
        std::tie(row.first_lower, row.first_upper) = range_along(tubes[i], *d);
        std::tie(row.second_lower, row.second_upper) = range_along(tubes[j], *d);
        return row;
      }
    } catch (const Error&) {  // an overflow: as if there were no direction
    }
  }
  if (X.dim() == 0 || X.dim() != Y.dim() || X.is_empty() || Y.is_empty()) return std::nullopt;
  const Index best = best_coordinate(X, Y);
  row.first_lower = X.lower[best];
  row.first_upper = X.upper[best];
  row.second_lower = Y.lower[best];
  row.second_upper = Y.upper[best];
  if (apart && row.first_upper >= row.second_lower && row.second_upper >= row.first_lower)
    row.verdict += ", by several outputs together";
  return row;
}

void add_pairs(const RunFiles& files, const Design& design, const std::vector<const Model*>& bank,
               Report& report) {
  const std::vector<Cursor> pairs = items_of(design.tree, "pairs");
  const std::size_t count = design.modes.size();
  if (count > most_modes || pairs.size() != count * (count - 1) / 2 || design.tubes.size() != count)
    return;
  const std::vector<LineForm> tubes = exact_tubes(design, bank);
  Intervals intervals;
  std::size_t q = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j, ++q) {
      if (!pairs[q].expect(Kind::object, "")) continue;
      if (auto row = row_of(design, tubes, i, j, pairs[q], proof_of(design, q)))
        intervals.rows.push_back(std::move(*row));
    }
  }
  if (intervals.rows.empty()) return;
  report.figures.push_back(
      {fmt::format("pairs_{}", design.pipeline + 1), section::designs,
       fmt::format("Pairs of modes: {}", files.pipelines()[design.pipeline].name),
       "The outputs of both modes along one direction: that of the proof where they are apart, "
       "else the output and time at which "
       "their hulls overlap least. κ is the share by which all disturbances can grow until the "
       "tubes meet.",
       std::move(intervals), static_cast<int>(design.pipeline)});
}

void add_experiments(const RunFiles& files, std::size_t pipeline, Report& report) {
  const Cursor tree = files.tree(pipeline);
  const std::vector<std::string> modes = texts_of(tree, "modes");
  Table table{{"True mode", "Experiments"}, {}};
  for (const std::string& mode : modes) table.header.push_back(mode);
  for (const char* name : {"Isolated", "Wrong", "Unknown fault", "Undecided", "Isolated from k"})
    table.header.emplace_back(name);
  for (const Cursor& row : items_of(tree, "experiments")) {
    if (!row.expect(Kind::object, "")) continue;
    const double runs = value_of(row, "runs");
    std::vector<Table::Cell> cells{text_cell(text_of(row, "mode")), number_cell(runs, 6)};
    const std::vector<Cursor> possible = items_of(row, "possible");
    for (std::size_t m = 0; m < modes.size(); ++m) {
      const double times =
          m < possible.size() ? json::read_number(possible[m]).value_or(0) : std::nan("");
      cells.push_back(number_cell(times, 6));
      cells.back().share = runs > 0 && times > 0 ? std::min(times / runs, 1.0) : 0;
    }
    for (const char* key : {"isolated", "wrong", "unknown_fault", "undecided"})
      cells.push_back(number_cell(value_of(row, key), 6));
    const auto isolation = row.find("isolation");
    cells.push_back(number_cell(
        isolation && isolation->is(Kind::object) ? value_of(*isolation, "median") : std::nan(""),
        6));
    table.rows.push_back(std::move(cells));
  }
  if (table.rows.empty()) return;
  report.figures.push_back({fmt::format("experiments_{}", pipeline + 1), section::designs,
                            fmt::format("Experiments: {}", files.pipelines()[pipeline].name),
                            "Per true mode: in how many experiments each mode was possible at the "
                            "end, what was decided last, and the median of the "
                            "first time from which on the true mode stays isolated.",
                            std::move(table), static_cast<int>(pipeline)});
}

/// Does the input separate the modes? With "(claimed)" where that is not proven.
std::string separates(const RunFiles& files, const Design& design) {
  const auto exact = files.tree(design.pipeline).find("exact");
  const std::string proven =
      exact && exact->is(Kind::object) ? text_of(*exact, "separates") : "unknown";
  if (proven != "unknown") return proven;
  const std::string claim = text_of(design.tree, "separates");
  return claim == "yes" || claim == "no" ? claim + " (claimed)" : claim;
}

void add_overview(const RunFiles& files, const std::vector<Design>& designs, Report& report) {
  Table table{{"Pipeline", "Designer", "Status", "Horizon", "Cost", "Claimed lower bound",
               "Claimed gap", "Separates", "Smallest κ proven"},
              {}};
  for (const Design& design : designs) {
    const PipelineHead& head = files.pipelines()[design.pipeline];
    double kappa = infinity;
    const std::vector<Cursor> pairs = items_of(design.tree, "pairs");
    for (std::size_t q = 0; q < pairs.size(); ++q) {
      const Cursor* proof = proof_of(design, q);
      const bool apart = proof && text_of(*proof, "disjoint") == "yes";
      const double lower = apart ? value_of(*proof, "kappa_lower") : std::nan("");
      if (!std::isnan(kappa)) kappa = std::isnan(lower) ? lower : std::min(kappa, lower);
    }
    table.rows.push_back(
        {text_cell(head.name), text_cell(head.component), text_cell(text_of(design.tree, "status")),
         number_cell(value_of(design.tree, "horizon")),
         number_cell(value_of(design.tree, "cost"), 6),
         number_cell(value_of(design.tree, "lower_bound"), 6),
         number_cell(value_of(design.tree, "gap")), text_cell(separates(files, design)),
         number_cell(pairs.empty() ? std::nan("") : kappa)});
  }
  if (!table.rows.empty()) {
    report.figures.push_back({"designs", section::designs, "Designs",
                              "Cost of the input and lower bound of any input's, as the designer "
                              "says; the input separates if every "
                              "pair of modes is proven disjoint in exact arithmetic.",
                              std::move(table)});
  }
}

}  // namespace

void add_designs(const RunFiles& files, Report& report) {
  json::SystemPart system;
  const auto study = files.root().find("study");
  const auto at = study && study->is(Kind::object) ? study->find("system") : std::nullopt;
  std::vector<std::string> warnings;
  if (at && at->is(Kind::object)) system = json::read_recorded_system(*at, warnings);
  std::vector<Design> designs;
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    if (files.pipelines()[p].kind != PipelineKind::design) continue;
    if (auto design = design_of(files, p, system.model.states()))
      designs.push_back(std::move(*design));
  }
  files.check();  // what follows computes with the models
  std::vector<const Model*> bank;
  if (system.good) {
    bank.push_back(&system.model);
    for (const Mode& mode : system.modes) bank.push_back(&mode.model);
  }
  add_overview(files, designs, report);
  add_inputs(files, report);
  for (const Design& design : designs) {
    add_pairs(files, design, bank, report);
    add_tubes(files, design, report);
  }
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    if (files.pipelines()[p].kind == PipelineKind::design) add_experiments(files, p, report);
  }
}

}  // namespace cordon::report
