// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/designer_parameters.hpp"

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::designers {

namespace {

constexpr double most_entries = 4e6;  ///< of the rows of a pair, and of the combinations that they
                                      ///< come from, before elimination
constexpr double most_cost = 1e100;   ///< leaves room for the products of a search

Index inputs_of(const ModeBank& bank) { return bank[0].model.inputs(); }

/// Rⁿ, as far as it shows: a set without lines left out.
bool is_space(const LineForm& X) {
  return X.dim() > 0 && X.constraints() == 0 && X.lines() == X.dim();
}

void check_schedule(const Params& params, const char* name, Index inputs, bool weights,
                    std::vector<Diagnostic>& problems) {
  if (!params.has(name)) return;
  const Matrix& rows = params.matrix(name);
  if (rows.rows() == 0 || rows.cols() != inputs) {
    problems.push_back({fmt::format("/{}", name),
                        fmt::format("is {} × {}, must have {} column{}, one per input", rows.rows(),
                                    rows.cols(), inputs, inputs == 1 ? "" : "s"),
                        "a row per time k = 0, 1, …; the last row stands for all later times"});
  } else if (weights && rows.minCoeff() < 0) {
    problems.push_back(
        {fmt::format("/{}", name), "holds a negative weight", "weights are 0 or more"});
  }
}

/// Row k of a table whose last row stands for all later times, for k = 0 … N, stacked.
Vector scheduled(const Params& params, const char* name, Index inputs, Index horizon,
                 double otherwise) {
  Vector all = Vector::Constant(inputs * (horizon + 1), otherwise);
  if (!params.has(name)) return all;
  const Matrix& rows = params.matrix(name);
  for (Index k = 0; k <= horizon; ++k)
    all.segment(k * inputs, inputs) = rows.row(std::min(k, rows.rows() - 1)).transpose();
  return all;
}

/// Of the sequences with all u_k in a box, one that is as far from the reference as any.
Vector farthest(const Box& box, VectorIn reference) {
  const Index inputs = box.dim(), times = inputs > 0 ? reference.size() / inputs : 0;
  const Vector lower = box.lower.replicate(times, 1), upper = box.upper.replicate(times, 1);
  return ((reference - lower).array() >= (upper - reference).array()).select(lower, upper);
}

void check_backend(const DesignerContext& context, const Params& params,
                   std::vector<Diagnostic>& problems) {
  const BackendInfo& info = context.backend->info();
  bool descriptor = false;
  for (const Mode& mode : context.bank.modes)
    descriptor = descriptor || mode.model.linear.is_descriptor();
  if (descriptor && !info.intersections) {
    problems.push_back(
        {"", fmt::format("\"{}\" cannot hold the static rows of a descriptor system", info.name),
         "use the backend \"line_zonotope\" or \"constrained_zonotope\""});
  } else if (descriptor && !info.unbounded && !params.has("admissible_set")) {
    problems.push_back(
        {"/admissible_set",
         fmt::format("is missing: with \"{}\" what E does not determine must be bounded",
                     info.name),
         "give a set that holds the state at all times, or use the backend \"line_zonotope\", "
         "which needs none"});
  }
}

void check_admissible_set(const DesignerContext& context, const LineForm& XA,
                          std::vector<Diagnostic>& problems) {
  const Index states = context.bank[0].model.states();
  if (XA.dim() != states) {
    problems.push_back(
        {"/admissible_set",
         fmt::format("is of dimension {}, the number of states is {}", XA.dim(), states), ""});
  } else if (is_empty(XA) == Answer::yes) {
    problems.push_back({"/admissible_set", "is empty", "no state is admissible: widen the set"});
  } else if (!context.backend->info().unbounded && is_bounded(XA) != Answer::yes) {
    problems.push_back(
        {"/admissible_set",
         fmt::format("is unbounded, which the backend \"{}\" cannot hold",
                     context.backend->info().name),
         "give a bounded set, or use the backend \"line_zonotope\", which needs none"});
  }
}

void check_sets(const DesignerContext& context, std::vector<Diagnostic>& problems) {
  for (const Mode& mode : context.bank.modes) {
    const std::pair<const char*, const LineForm*> sets[] = {
        {"X0", &mode.model.X0}, {"W", &mode.model.W}, {"V", &mode.model.V}};
    for (const auto& [name, set] : sets) {
      if ((!mode.model.is_linear() || mode.model.region) && is_bounded(*set) != Answer::yes) {
        problems.push_back(
            {"",
             fmt::format("{} of mode \"{}\" is not bounded, and states are followed from "
                         "bounds of it",
                         name, mode.name),
             "give a bounded set"});
        continue;
      }
      try {
        context.backend->import(*set);
      } catch (const Error& error) {
        if (error.code() != Errc::unsupported) throw;
        problems.push_back(
            {"", fmt::format("{} of mode \"{}\" cannot be held: {}", name, mode.name, error.what()),
             "use a backend that can hold it, such as \"line_zonotope\""});
      }
    }
  }
}

void check_input_set(const ModeBank& bank, const Params& params,
                     std::vector<Diagnostic>& problems) {
  const Index inputs = inputs_of(bank);
  const bool own = params.has("input_set");
  const LineForm U = input_set_from(bank, params);
  if (U.dim() != inputs || (!own && is_space(U))) {
    if (own) {
      problems.push_back(
          {"/input_set",
           fmt::format("is of dimension {}, the number of inputs is {}", U.dim(), inputs), ""});
    } else {
      problems.push_back({"/input_set", "is missing",
                          "give the set that every u_k is taken from, here or as /system/U"});
    }
    return;
  }
  const std::string at = own ? "/input_set" : "";
  const std::string what = own ? "" : "/system/U ";
  if (is_empty(U) == Answer::yes) {
    problems.push_back({at, what + "is empty", "no input may be applied at all: widen the set"});
  } else if (is_bounded(U) != Answer::yes) {
    problems.push_back({at, what + "is not bounded",
                        "inputs of any size separate what can be separated at all: bound them"});
  } else if (params.has("first_input") && params.vector("first_input").size() == inputs &&
             contains(U, params.vector("first_input")) == Answer::no) {
    problems.push_back(
        {"/first_input", "lies outside the input set", "choose it inside, or widen the set"});
  }
}

/// The largest pair at the largest horizon, so that a study cannot ask for more than the memory
/// holds, nor for more than a few seconds between two looks at the clock: r rows and c columns take
/// O(r² c), and r max(r, c) ≤ 4·10⁶ makes that 8·10⁹ at most.
void check_size(const DesignerContext& context, const Params& params,
                std::vector<Diagnostic>& problems) {
  double rows = 0, columns = 0;
  const double times = static_cast<double>(horizons_from(params).last) + 1;
  for (const Mode& mode : context.bank.modes) {
    const Model& m = mode.model;
    const Index outputs = m.outputs(), errors = m.is_linear() ? 0 : m.states() + outputs;
    rows = std::max(rows, times * static_cast<double>(m.states() + outputs + m.W.constraints() +
                                                      m.V.constraints()));
    columns = std::max(
        columns, times * static_cast<double>(m.states() + m.W.generators() + m.W.lines() +
                                             m.V.generators() + m.V.lines() + m.inputs() + errors) +
                     static_cast<double>(m.X0.generators() + m.X0.lines()));
  }
  if (4 * rows * std::max(rows, columns) <= most_entries) return;
  const char* name = params.has("horizon") || params.has("horizon_at_most") ? "/horizon"
                     : params.has("max_horizon")                            ? "/max_horizon"
                                                                            : "/input";
  problems.push_back(
      {name,
       fmt::format("makes programs of up to {:.0f} rows and {:.0f} columns", 2 * rows, 2 * columns),
       fmt::format(
           "rows times columns, and rows times rows, may be {:.0f}: choose a shorter horizon",
           most_entries)});
}

/// Does some input of the set leave the model an output at all?
void check_tubes(const DesignerContext& context, const Params& params,
                 std::vector<Diagnostic>& problems) {
  const Index horizon = horizons_from(params).first;
  const InputSequences U = inputs_from(context.bank, params, horizon);
  for (const Mode& mode : context.bank.modes) {
    if (!mode.model.is_linear()) continue;  // formulas lead on from every state
    const TubeConditions rows =
        conditions_of(output_tube(mode.model, *context.backend, span_from(params, horizon)));
    if (rows.b.size() == 0) continue;
    // A ξ - Ω G_u ξ_u = b + Ω c_u,  A_u ξ_u = b_u
    const Index m = rows.b.size(), m_u = U.b.size(), g = rows.A.cols(), g_u = U.G.cols();
    Matrix A = Matrix::Zero(m + m_u, g + g_u);
    A.topLeftCorner(m, g) = rows.A;
    A.topRightCorner(m, g_u) = -linalg::product(rows.Omega, U.G);
    A.bottomRightCorner(m_u, g_u) = U.A;
    Vector b(m + m_u);
    b << rows.b + linalg::product(rows.Omega, U.c), U.b;
    const LineForm joint{Matrix(0, 0),       Matrix(0, g + g_u), Vector(0),
                         Matrix(m + m_u, 0), std::move(A),       std::move(b)};
    if (is_empty(joint) != Answer::yes) continue;
    problems.push_back(
        {"", fmt::format("the output tube of mode \"{}\" is empty for every input", mode.name),
         params.has("admissible_set")
             ? "its equations contradict the admissible set: widen it, or check X0 and W"
             : "its static rows contradict X0 and W: check them"});
  }
}

}  // namespace

ParamSchema& add_statement_parameters(ParamSchema& schema) {
  return schema
      .real("epsilon",
            "ε: every pair of modes is asked to be apart by κ ≥ ε, which leaves room for (1 + ε) "
            "times the disturbances",
            1e-4, 0, 1e6)
      .choice("outputs",
              "which outputs tell the modes apart: those of all times, or the last one only",
              {"all", "last"}, "all")
      .set("admissible_set",
           "a set that holds the state of descriptor systems at all times, as far as E does not "
           "determine it; the "
           "results rest on it")
      .choice("cost",
              "what is minimised, of u - r with weights ω: Σ ω|u - r|, max ω|u - r| or Σ ω(u - r)²",
              {"norm_1", "norm_inf", "quadratic"}, "norm_1")
      .matrix("weights",
              "weights ω ≥ 0, a row per time k = 0, 1, … and a column per input; the last row "
              "stands for all later times "
              "(absent: 1)")
      .matrix("reference", "the sequence r that is wanted, rows as in \"weights\" (absent: 0)");
}

ParamSchema& add_search_parameters(ParamSchema& schema) {
  return schema
      .integer("horizon",
               "N: inputs u_0 … u_N, outputs y_0 … y_N; {\"at_most\": N}: the cheapest input of "
               "all horizons up to N (absent: the smallest that works, up to \"max_horizon\")",
               std::nullopt, 1, most_horizon)
      .or_at_most("horizon_at_most")
      .integer("horizon_at_most",
               "N of \"horizon\": {\"at_most\": N}: all horizons 1, …, N are searched, and the "
               "cheapest input is taken, of equal ones the shortest",
               std::nullopt, 1, most_horizon)
      .integer("max_horizon", "largest horizon that is tried if none is given", 6, 1, most_horizon)
      .set("input_set",
           "the set that every u_k is taken from: a box or another bounded polytope (absent: "
           "/system/U)")
      .vector("first_input",
              "u_0, if it is decided already (absent: it is designed like the others)")
      .real("time_limit", "seconds until the work on one horizon ends with what it has", 60, 0.001,
            1e6);
}

std::vector<Diagnostic> check_tube_data(const DesignerContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  if (params.has("admissible_set"))
    check_admissible_set(context, params.set_form("admissible_set"), problems);
  for (const Mode& mode : context.bank.modes) {
    if (mode.model.outputs() == context.bank[0].model.outputs()) continue;
    problems.push_back(
        {"",
         fmt::format("mode \"{}\" has {} outputs, \"{}\" has {}", mode.name, mode.model.outputs(),
                     context.bank[0].name, context.bank[0].model.outputs()),
         "modes are compared by their outputs: all need the same"});
  }
  check_backend(context, params, problems);
  check_sets(context, problems);
  check_size(context, params, problems);
  return problems;
}

std::vector<Diagnostic> check_statement(const DesignerContext& context, const Params& params) {
  std::vector<Diagnostic> problems = check_tube_data(context, params);
  const Index inputs = inputs_of(context.bank);
  if (inputs == 0)
    problems.push_back({"", "the system has no input", "there is nothing to design"});
  check_schedule(params, "weights", inputs, true, problems);
  check_schedule(params, "reference", inputs, false, problems);
  return problems;
}

void check_cost(const Params& params, Index inputs, VectorIn u, std::vector<Diagnostic>& problems) {
  Cost cost = cost_from(params, inputs, u.size() / inputs - 1);
  const double worst = cost.at(u);
  if (worst <= most_cost) return;
  cost.reference.setZero();
  const bool far = params.has("reference") && cost.at(u) <= most_cost;
  const bool heavy = params.has("weights") && cost.weights.maxCoeff() > 1;
  problems.push_back(
      {far     ? "/reference"
       : heavy ? "/weights"
               : "/cost",
       fmt::format("makes costs of up to {:.3g}, at most {:.0e} can be compared", worst, most_cost),
       "choose weights, a reference and units of the inputs that are nearer to 1"});
}

std::vector<Diagnostic> check_search(const DesignerContext& context, const Params& params) {
  std::vector<Diagnostic> problems = check_statement(context, params);
  const Index inputs = inputs_of(context.bank);
  if (params.has("horizon") && params.has("horizon_at_most")) {
    problems.push_back({"/horizon_at_most", "stands beside a fixed \"horizon\"",
                        "give one of them: N, or {\"at_most\": N}"});
  }
  if (params.has("first_input") && params.vector("first_input").size() != inputs) {
    problems.push_back({"/first_input",
                        fmt::format("has {} entries, the number of inputs is {}",
                                    params.vector("first_input").size(), inputs),
                        ""});
  }
  if (inputs > 0) check_input_set(context.bank, params, problems);
  if (problems.empty()) {
    const Index horizon = horizons_from(params).last;
    const Box box = interval_hull(input_set_from(context.bank, params));
    check_cost(params, inputs, farthest(box, cost_from(params, inputs, horizon).reference),
               problems);
  }
  if (problems.empty()) check_tubes(context, params, problems);
  return problems;
}

TubeSpan span_from(const Params& params, Index horizon) {
  TubeSpan span{horizon, params.text("outputs") == "last", std::nullopt};
  if (params.has("admissible_set")) span.admissible_set = params.set_form("admissible_set");
  return span;
}

Cost cost_from(const Params& params, Index inputs, Index horizon) {
  const std::string& name = params.text("cost");
  const Cost::Kind kind = name == "norm_1"     ? Cost::Kind::norm_1
                          : name == "norm_inf" ? Cost::Kind::norm_inf
                                               : Cost::Kind::quadratic;
  return {kind, scheduled(params, "weights", inputs, horizon, 1),
          scheduled(params, "reference", inputs, horizon, 0)};
}

LineForm input_set_from(const ModeBank& bank, const Params& params) {
  return eliminate_lines(params.has("input_set") ? params.set_form("input_set")
                                                 : bank[bank.nominal].model.U);
}

InputSequences inputs_from(const ModeBank& bank, const Params& params, Index horizon) {
  const LineForm U = input_set_from(bank, params);
  const Index inputs = U.dim(), m = U.constraints(), g = U.generators();
  const bool first = params.has("first_input");
  const Index free = first ? horizon : horizon + 1;
  InputSequences all{Vector(inputs * (horizon + 1)), Matrix::Zero(inputs * (horizon + 1), g * free),
                     Matrix::Zero(m * free, g * free), Vector(m * free)};
  for (Index k = 0, place = 0; k <= horizon; ++k) {
    if (k == 0 && first) {
      all.c.head(inputs) = params.vector("first_input");
      continue;
    }
    all.c.segment(k * inputs, inputs) = U.c;
    all.G.block(k * inputs, place * g, inputs, g) = U.G;
    all.A.block(place * m, place * g, m, g) = U.A;
    all.b.segment(place * m, m) = U.b;
    ++place;
  }
  return all;
}

Horizons horizons_from(const Params& params) {
  if (params.has("horizon")) return {params.integer("horizon"), params.integer("horizon")};
  if (params.has("horizon_at_most")) return {1, params.integer("horizon_at_most"), true};
  if (params.has("max_horizon")) return {1, params.integer("max_horizon")};
  return {params.matrix("input").rows() - 1,
          params.matrix("input").rows() - 1};  // of an input that is given
}

}  // namespace cordon::designers
