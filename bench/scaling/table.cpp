// SPDX-License-Identifier: GPL-3.0-or-later
#include "table.hpp"

#include <fmt/format.h>

#include "fit.hpp"

namespace cordon::bench {

namespace {

std::string number(std::optional<double> value, int digits = 4) {
  return value ? fmt::format("{:.{}g}", *value, digits) : "-";
}
std::string kilobytes(long bytes) { return number(static_cast<double>(bytes) / 1e3); }

void print_heading(const Axis& axis) {
  fmt::print("\n{} {}: {}\n", axis.name, axis.symbol, axis.held);
  fmt::print("{:<21} {:>4} {:>5} {:>4}  {:>14} {:>5} {:>10} {:>12} {:>10} {:>9} {:>9}\n", "BACKEND",
             "n", "g", "m", "USED g, l, m", "STEPS", "STEP µs", "QUESTION µs", "HULL µs", "PEAK kB",
             "KEPT kB");
}

void print_row(const Measurement& m) {
  const std::string used =
      fmt::format("{}, {}, {}", m.used.generators, m.used.lines, m.used.constraints);
  fmt::print("{:<21} {:>4} {:>5} {:>4}  {:>14} {:>5} {:>10} {:>12} {:>10} {:>9} {:>9}\n", m.backend,
             m.budget.n, m.budget.g, m.budget.m, used, m.steps, number(m.step), number(m.question),
             number(m.hull), kilobytes(m.step_bytes), kilobytes(m.kept_bytes));
}

void print_remarks(const Curve& curve) {
  for (const std::string& trouble : curve.troubles) fmt::print("{}: {}\n", curve.backend, trouble);
  if (const auto& s = curve.skipped) {
    fmt::print("{}: skipped from n = {}, g = {}, m = {} on, a step would take seconds\n",
               curve.backend, s->n, s->g, s->m);
  }
  if (const auto& s = curve.without_hull) {
    fmt::print("{}: no hulls from n = {}, g = {}, m = {} on, one would take seconds\n",
               curve.backend, s->n, s->g, s->m);
  }
}

void print_exponents(const AxisResult& result) {
  const Axis& axis = result.axis;
  fmt::print("Exponents of {}, upper half of the sizes{:<2} {:>10} {:>10}{}\n", axis.symbol, ":",
             "STEP", "PEAK", axis.hull ? "       HULL" : "");
  for (const Curve& curve : result.curves) {
    fmt::print("  {:<40} {:>10} {:>10}", curve.backend, exponent_text(curve.time_exponent(axis)),
               exponent_text(curve.memory_exponent(axis)));
    if (axis.hull) fmt::print(" {:>10}", exponent_text(curve.hull_exponent(axis)));
    fmt::print("\n");
  }
}

}  // namespace

void print_preamble(int rounds) {
  fmt::print(
      "Random stable systems, observer prediction_correction, in the steady state, when the "
      "budgets are reached.\n"
      "Medians, the smallest of {} rounds. STEP: predict, correct and reduce. QUESTION: the "
      "emptiness test after it.\n"
      "HULL: the certified interval hull. PEAK: most bytes of heap live during step and question "
      "beyond those before.\n"
      "KEPT: what the observer holds, its model included.\n",
      rounds);
}

void print(const AxisResult& result) {
  print_heading(result.axis);
  for (const Curve& curve : result.curves) {
    for (const Measurement& m : curve.measurements) print_row(m);
    print_remarks(curve);
  }
  print_exponents(result);
}

std::string csv(const std::vector<AxisResult>& results) {
  std::string text =
      "axis,backend,states,generator_budget,constraint_budget,generators,lines,constraints,steps,"
      "step_us,question_us,hull_us,"
      "peak_bytes,kept_bytes\n";
  for (const AxisResult& result : results) {
    for (const Curve& curve : result.curves) {
      for (const Measurement& m : curve.measurements) {
        text += fmt::format("{},{},{},{},{},{},{},{},{},{:.6g},{:.6g},{},{},{}\n", result.axis.name,
                            m.backend, m.budget.n, m.budget.g, m.budget.m, m.used.generators,
                            m.used.lines, m.used.constraints, m.steps, m.step, m.question,
                            m.hull ? number(m.hull, 6) : "", m.step_bytes, m.kept_bytes);
      }
    }
  }
  return text;
}

}  // namespace cordon::bench
