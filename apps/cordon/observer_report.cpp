// SPDX-License-Identifier: GPL-3.0-or-later
#include "observer_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "needed_bounds.hpp"

namespace cordon::apps {

namespace {

using nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

constexpr Index most_states = 8;  // beside each other
constexpr Index most_width_rows = 30;
constexpr std::size_t longest_matrix = 60;

std::string titled(const std::string& title, const Rows& rows, const Paint& paint) {
  return rows.size() < 2 ? "" : title + "\n" + table(rows, paint) + "\n";
}

/// Six decimals where they show the number well.
std::string width_text(double width) {
  if (std::isinf(width)) return "unbounded";
  const bool fixed = width == 0 || (width >= 1e-2 && width < 1e7);
  return fixed ? fmt::format("{:.6f}", width) : fmt::format("{:.6e}", width);
}

/// [a b; c d], row by row; the size of a matrix that is too long for that.
std::string matrix_text(const Matrix& L) {
  std::string text = "[";
  for (Index i = 0; i < L.rows(); ++i) {
    text += i > 0 ? "; " : "";
    for (Index j = 0; j < L.cols(); ++j)
      text += fmt::format("{}{:.4g}", j > 0 ? " " : "", L(i, j) + 0.0);
  }
  return text.size() < longest_matrix ? text + "]" : fmt::format("{}×{}", L.rows(), L.cols());
}

std::string number_text(double value) {
  if (std::isnan(value)) return "-";
  return std::isinf(value) ? "∞" : fmt::format("{:.5g}", value);
}

/// Both bounds of a norm as one number where they agree in the digits that are shown.
std::string norm_text(const GainCertificate& known) {
  const std::string lower = number_text(known.norm_lower), upper = number_text(known.norm_upper);
  return lower == upper ? lower : fmt::format("[{}, {}]", lower, upper);
}

constexpr double optimum_share = 1e-3;

std::string objective_text(const GainCertificate& known) {
  if (known.objective.empty()) return "-";
  std::string text = fmt::format("{} = {}", known.objective, number_text(known.optimum));
  if (known.margin < 0) return text + fmt::format(", not shown: missed by {:.2g}", -known.margin);
  // the least value, as far as it is known: said where it may be less
  const bool is_close = !(known.optimum_bound < known.optimum * (1 - optimum_share));
  return is_close ? text : text + fmt::format(", least ≥ {}", number_text(known.optimum_bound));
}

ordered_json numbers(const Vector& values) {
  ordered_json all = ordered_json::array();
  for (const double value : values) all.push_back(json_number(value));
  return all;
}

/// "gauge 1 [m] lies 0.3 beyond its prediction".
std::string missed_text(const Labels& labels, const Contradiction& found) {
  if (found.before) return "no state is left, whatever the outputs are";
  if (found.output < 0) return "the outputs together contradict the prediction, which none misses";
  const std::string name = label_of(labels.outputs, "y", found.output);
  if (!(found.distance > 0)) return name + " contradicts the prediction, next to its bounds";
  return fmt::format("{} lies {:.4g} beyond its prediction", name, found.distance);
}

std::string state_name(const Labels& labels, Index i) {
  return labels.states.empty() ? fmt::format("x{}", i + 1) : label_of(labels.states, "x", i);
}

/// "gauge 1 [m] and gauge 2 [m]"
std::string outputs_text(const Labels& labels, const std::vector<Index>& outputs) {
  std::vector<std::string> names;
  for (const Index output : outputs) names.push_back(label_of(labels.outputs, "y", output));
  return fmt::format("{}", fmt::join(names, " and "));
}

/// How many samples, and what became of the first of them.
std::string outliers_text(const Labels& labels, const std::string& name,
                          const EstimationOutcome& found) {
  const auto told = std::min<std::int64_t>(3, std::ssize(found.left_out));
  std::string text =
      fmt::format("{}: outputs of {} left out as outliers, assumed not to keep to V:", name,
                  count(found.outliers, "sample"));
  for (std::int64_t i = 0; i < told; ++i) {
    const auto& [worst, outputs] = found.left_out[static_cast<std::size_t>(i)];
    text += fmt::format("{} at {} {}", i > 0 ? ";" : "", time_text(labels, worst.k),
                        missed_text(labels, worst));
    if (outputs.size() > 1) text += fmt::format(" ({} left out)", outputs_text(labels, outputs));
  }
  if (found.outliers > told) text += fmt::format("; and {} more", found.outliers - told);
  return text + "\n";
}

}  // namespace

std::string units_text(const RunOutcome& outcome, const Labels& labels) {
  std::vector<std::string> units, titles;
  for (const std::string& state : labels.states) {
    const std::string unit = unit_of(state);
    if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
  }
  for (const Measure& measure : outcome.measures) {
    const bool lengths = measure.quantity == Measure::Quantity::length ||
                         measure.quantity == Measure::Quantity::squared_length;
    if (lengths && measure.in_run != Measure::Shown::never)
      titles.push_back(measure.title.empty() ? measure.name : measure.title);
  }
  if (units.size() < 2 || titles.empty()) return "";
  std::replace(units.begin(), units.end(), std::string(), std::string("1"));
  return fmt::format(
      "Units: {} take{} states in {} as they are; to weigh them, see \"cordon info\" of the "
      "metric\n",
      fmt::join(titles, ", "), titles.size() == 1 ? "s" : "", fmt::join(units, ", "));
}

std::string times_begun(std::int64_t times) {
  return times == 1 ? "begun once" : fmt::format("begun {} times", times);
}

std::string contradictions_text(const Study& study, const RunOutcome& outcome, const Paint& paint) {
  const Labels& labels = study.labels;
  std::string text;
  Index empty_from = -1;
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    const EstimationOutcome& found = *pipeline.estimation();
    if (const auto& first = found.contradiction) {
      text += fmt::format("{}: {}: at {} {}. {}\n", pipeline.name, paint.yellow("Empty"),
                          time_text(labels, first->k), missed_text(labels, *first),
                          first->before ? "Model, bounds, assumptions or a sample before are wrong"
                                        : "Model, bounds, assumptions or this sample are wrong");
    }
    if (found.restarts > 0) {
      text += fmt::format(
          "{}: {} anew from the restart set: what follows rests on the state being in it\n",
          pipeline.name, times_begun(found.restarts));
    }
    if (found.not_enclosed > 0) {
      text += fmt::format("{}: {} anew from the admissible set, at {} first: {}\n", pipeline.name,
                          times_begun(found.not_enclosed),
                          time_text(labels, found.not_enclosed_from), found.why_not_enclosed);
    }
    if (found.outliers > 0) text += outliers_text(labels, pipeline.name, found);
    if (found.contradiction && (empty_from < 0 || found.contradiction->k < empty_from))
      empty_from = found.contradiction->k;
  }
  return empty_from < 0 ? text : text + needed_bounds_text(study, empty_from);
}

NamedGains gains_of(const RunOutcome& outcome) {
  NamedGains all;
  for (const PipelineOutcome& pipeline : outcome.pipelines)
    all.emplace_back(pipeline.name, pipeline.estimation()->gains);
  return all;
}

std::string gains_text(const NamedGains& all, const Paint& paint) {
  Rows rows{
      {"PIPELINE", "PARAMETER", "GAIN", "L", "SPECTRAL RADIUS ≤", "MONOTONE", "‖G‖∞", "OPTIMUM"}};
  for (const auto& [pipeline, gains] : all) {
    for (const Gain& gain : gains) {
      const GainCertificate& known = gain.certificate;
      rows.push_back({pipeline, gain.name, gain.type, matrix_text(gain.L),
                      number_text(known.spectral_radius),
                      known.monotone == Answer::unknown ? "but for rounding"
                                                        : std::string(to_string(known.monotone)),
                      norm_text(known), objective_text(known)});
    }
  }
  return titled("Gains", rows, paint);
}

std::string widths_text(const RunOutcome& outcome, const Labels& labels, const Paint& paint) {
  std::vector<const PipelineOutcome*> shown;
  Index states = 0;
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    const Index n = pipeline.estimation()->last_hull.dim();
    states = std::max(states, n);
    if (n > 0) shown.push_back(&pipeline);
  }
  const bool across = states <= most_states;  // a row per pipeline, else one per state
  const Index listed = across ? states : std::min(states, most_width_rows);
  Rows rows{{across ? "PIPELINE" : "STATE"}};
  for (Index i = 0; i < listed; ++i) {
    if (across) {
      rows[0].push_back(state_name(labels, i));
    } else {
      rows.push_back({state_name(labels, i)});
    }
  }
  for (const PipelineOutcome* pipeline : shown) {
    const Box& hull = pipeline->estimation()->last_hull;
    auto& own = across ? rows.emplace_back() : rows[0];
    own.push_back(pipeline->name);
    for (Index i = 0; i < std::min(listed, hull.dim()); ++i) {
      const std::string width =
          hull.is_empty() ? "empty" : width_text(hull.upper[i] - hull.lower[i]);
      (across ? own : rows[static_cast<std::size_t>(i) + 1]).push_back(width);
    }
  }
  std::string text = titled("Widths at the last step", rows, paint);
  for (const PipelineOutcome* pipeline : shown) {
    const Index lag = pipeline->estimation()->lag;
    if (lag == 0) continue;
    text.pop_back();
    text += fmt::format("{}: its last step is {} before the last sample, all of which it uses\n\n",
                        pipeline->name, count(lag, "step"));
  }
  if (listed < states && !shown.empty()) {
    text.pop_back();
    text += fmt::format("… and {} more states, in steps.csv\n\n", states - listed);
  }
  return text;
}

std::string inner_text(const RunOutcome& outcome, const Labels& labels, const Paint& paint) {
  Rows rows{{"PIPELINE", "STEPS", "MEAN SHARE OF THE WIDTH", "INSIDE THE HULL"}};
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    const EstimationOutcome& found = *pipeline.estimation();
    if (found.inner_steps == 0) continue;
    const bool inside = found.inner_outside < 0;
    rows.push_back({pipeline.name, fmt::format("{}", found.inner_steps),
                    number_text(found.inner_share),
                    inside ? "always" : "NOT at " + time_text(labels, found.inner_outside)});
  }
  return titled("Inner estimates", rows, paint);
}

std::string growth_text(const RunOutcome& outcome, const Labels& labels, const Paint& paint) {
  Rows rows{{"PIPELINE", "STATE", "SMALLEST WIDTH", "AT k", "LAST WIDTH", "FACTOR"}};
  std::string advice;
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    if (!pipeline.estimation()->growth) continue;
    const WidthGrowth& growth = *pipeline.estimation()->growth;
    rows.push_back({pipeline.name, state_name(labels, growth.state), width_text(growth.smallest),
                    fmt::format("{}", growth.smallest_at), width_text(growth.last),
                    fmt::format("{:.4g}", growth.factor)});
    advice = advice_on(growth);
  }
  const std::string text = titled("Warning: bounds that grow", rows, paint);
  return text.empty() ? ""
                      : text.substr(0, text.size() - 1) + "Cause and remedy: " + advice + "\n\n";
}

ordered_json growth_json(const EstimationOutcome& found) {
  if (!found.growth) return nullptr;
  const WidthGrowth& growth = *found.growth;
  return {{"state", growth.state + 1},
          {"smallest", json_number(growth.smallest)},
          {"smallest_at", growth.smallest_at},
          {"last", json_number(growth.last)},
          {"factor", json_number(growth.factor)},
          {"advice", advice_on(growth)}};
}

ordered_json json_number(double value) {
  if (std::isnan(value)) return nullptr;
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

ordered_json matrix_json(const Matrix& matrix) {
  ordered_json rows = ordered_json::array();
  for (Index i = 0; i < matrix.rows(); ++i) rows.push_back(numbers(matrix.row(i).transpose()));
  return rows;
}

ordered_json gains_json(const std::vector<Gain>& gains) {
  ordered_json all = ordered_json::array();
  for (const Gain& gain : gains) {
    const GainCertificate& known = gain.certificate;
    const bool has_norm = !std::isnan(known.norm_lower) || !std::isnan(known.norm_upper);
    const ordered_json norm{{"lower", json_number(known.norm_lower)},
                            {"upper", json_number(known.norm_upper)}};
    ordered_json one{{"name", gain.name},
                     {"type", gain.type},
                     {"matrix", matrix_json(gain.L)},
                     {"spectral_radius", json_number(known.spectral_radius)},
                     {"monotone", known.monotone == Answer::unknown
                                      ? ordered_json(nullptr)
                                      : ordered_json(known.monotone == Answer::yes)},
                     {"norm", has_norm ? norm : ordered_json(nullptr)}};
    if (!known.objective.empty()) {
      one["objective"] = known.objective;
      one["optimum"] = json_number(known.optimum);
      one["optimum_bound"] = json_number(known.optimum_bound);
      one["margin"] = json_number(known.margin);
    }
    all.push_back(std::move(one));
  }
  return all;
}

ordered_json last_json(const EstimationOutcome& found) {
  const Box& hull = found.last_hull;
  if (hull.dim() == 0) return nullptr;
  return {{"hull", {{"lower", numbers(hull.lower)}, {"upper", numbers(hull.upper)}}},
          {"width", hull.is_empty() ? ordered_json(nullptr) : numbers(hull.upper - hull.lower)}};
}

}  // namespace cordon::apps
