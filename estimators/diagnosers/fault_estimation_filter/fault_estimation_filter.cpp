// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoser "fault_estimation_filter": bounds of additive faults n in E x⁺ = A x + B u + Bw w + F
// n, y = C x + D u + Dv v, from the first sample of the nominal mode on. [Wang2017] With ỹ = y - D
// u - Dv v̄ and the centres w̄, v̄ of W and V:
//   x̂_{k+1} = TA x̂_k + T (B u_k + Bw w̄) + G_k (ỹ_k - C x̂_k) + N ỹ_{k+1},   r_k = M (ỹ_k - C x̂_k)
//   n_i(k - ρ_i) ∈ r_{k,i} ± h_{k,i}
// G_k and h_k are those of filter_recursion.hpp and do not depend on the data. The bounds are
// widened by what rounding can have done to them (filter_rounding.hpp). They hold for any faults,
// past ones included; bounds that exclude 0 prove that the plant has not been in the nominal mode,
// where n = 0, at the time k - ρ_i. `ModeEvidence::why` is then the direction, a unit vector with
// its sign in the space of faults, that separates 0 from the box of these bounds, and the margin
// its distance. A step that excludes is a reset: the next one is judged anew, on its own bounds. A
// fault in a gap may put the state anywhere: no bounds are told while outputs are missing, and the
// filter begins anew with the next complete sample, from the admissible set in place of X0. In a
// bank of several modes the filter cannot tell which of them the plant is in after that: the
// decision is "ambiguous" as long as the bounds hold 0.
#include <optional>
#include <string>

#include "components.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "diagnosers/fault_estimation_filter/filter_rounding.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

using linalg::product;

namespace {

/// A model with zonotopes around its sets.
struct FilterModel {
  LinearModel linear;
  sets::Zonotope X0, W, V;
};

FilterModel filter_model(const Model& model) {
  return {model.linear, invariant::enclosing_zonotope(model.X0, "X0"),
          invariant::enclosing_zonotope(model.W, "W"), invariant::enclosing_zonotope(model.V, "V")};
}

FilterNoise noise_of(const FilterModel& m) {
  return {product(m.linear.Bw, m.W.G), product(m.linear.Dv, m.V.G)};
}

Matrix free_matrix(const LinearModel& m, const Params& params) {
  return params.has("free_matrix") ? params.matrix("free_matrix")
                                   : Matrix::Zero(m.states(), m.states() + m.outputs());
}

FilterDesign design_of(const LinearModel& m, const Params& params) {
  std::vector<Diagnostic> problems;
  auto design = design_filter(m, free_matrix(m, params), problems);
  if (!design) throw InputError("diagnoser \"fault_estimation_filter\"", std::move(problems));
  return *std::move(design);
}

class FaultEstimationFilter final : public Diagnoser {
 public:
  FaultEstimationFilter(const DiagnoserContext& context, const Params& params)
      : Diagnoser(context.bank, context.backend),
        model_(filter_model(bank()[bank().nominal].model)),
        design_(design_of(model_.linear, params)),
        recursion_(design_, model_.linear, noise_of(model_), params.integer("max_columns"),
                   params.text("noise_coupling") == "shared" ? NoiseCoupling::shared
                                                             : NoiseCoupling::independent),
        rounding_(design_, model_.linear, noise_of(model_)) {
    const LinearModel& m = model_.linear;
    TA_ = product(design_.T, m.A);
    TB_ = product(design_.T, m.B);
    Tw_ = product(design_.T, product(m.Bw, model_.W.c));
    v_ = product(m.Dv, model_.V.c);
    D_size_ = m.D.cwiseAbs();
    constant_size_ = product(m.Bw.cwiseAbs(), model_.W.c.cwiseAbs());
    if (params.has("admissible_set"))
      admissible_ = invariant::enclosing_zonotope(params.set_form("admissible_set"));
  }

 private:
  /// ỹ, and the size of the numbers that it is made of.
  struct Output {
    Vector value, size;
  };

  bool do_takes_missing_outputs() const override { return true; }
  void do_start() override { unfinished_ = excluded_ = was_gap_ = false; }

  void do_serialize(Archive& archive) override {
    serialize_time(archive, since_);
    archive(excluded_, was_gap_, unfinished_);
    if (was_gap_ && !admissible_) archive.refuse("a gap without an admissible set");
    if (was_gap_) return;  // it begins anew
    serialize_time(archive, first_);
    archive(recursion_, rounding_, x_, y_.value);
    if (x_.size() != model_.linear.states() || y_.value.size() != model_.linear.outputs())
      archive.refuse("a sample of other sizes");
  }

  Diagnosis do_step(const Sample* before, const Sample& now) override {
    if (unfinished_)
      throw Error(Errc::invalid,
                  "the last step ended with an error, and left the filter half way; start anew");
    if (!now.is_complete()) return in_gap(before, now);
    unfinished_ = true;
    Output y = output(now);
    const bool begins = !before || was_gap_;
    if (begins) {
      const sets::Zonotope& start = was_gap_ ? *admissible_ : model_.X0;
      x_ = start.c;
      recursion_.start(start.G);
      first_ = now.k;
      if (!before) since_ = now.k;
      was_gap_ = false;
    } else {
      advance(*before, y);
    }
    y_ = std::move(y);
    r_ = product(design_.M, y_.value - product(model_.linear.C, x_));
    const FilterRounding::Input input{x_, y_.size, r_.cwiseAbs() + recursion_.half_widths()};
    if (begins)
      rounding_.start(input, recursion_);
    else
      rounding_.advance(input, recursion_, before->u.cwiseAbs(), constant_size_);
    half_width_ = recursion_.half_widths() + rounding_.slack();
    Diagnosis result = diagnosis(now.k);
    unfinished_ = false;
    return result;
  }

  Diagnosis in_gap(const Sample* before, const Sample& now) {
    if (!admissible_) {
      throw Error(Errc::unsupported,
                  "output " + std::to_string(now.missing.front() + 1) +
                      " is missing at k = " + std::to_string(now.k) +
                      ", and a fault in a gap may put the state anywhere: give an admissible_set, "
                      "from which the filter begins anew, or fill the gaps");
    }
    if (!before) since_ = now.k;
    was_gap_ = true;
    return diagnosis(now.k);
  }

  Output output(const Sample& now) const {
    const Vector input = product(model_.linear.D, now.u);
    return {now.y - input - v_,
            now.y.cwiseAbs() + product(D_size_, now.u.cwiseAbs()) + v_.cwiseAbs()};
  }

  /// From x̂ of the sample before to that of ỹ = y.
  void advance(const Sample& before, const Output& y) {
    recursion_.advance();
    const Vector residual = y_.value - product(model_.linear.C, x_);
    x_ = product(TA_, x_) + product(TB_, before.u) + Tw_ + product(recursion_.gain(), residual) +
         product(design_.N, y.value);
  }

  std::vector<FaultBound> bounds(Index k) const {
    if (was_gap_) return {};
    if (!(r_ + half_width_).allFinite())
      throw Error(Errc::not_finite, "the estimate of a fault has outgrown the numbers");
    std::vector<FaultBound> all;
    for (Index i = 0; i < r_.size(); ++i) {
      const Index at = k - design_.delays[static_cast<std::size_t>(i)];
      if (at >= first_)
        all.push_back({i, at, r_[i] - half_width_[i], r_[i] + half_width_[i], r_[i]});
    }
    return all;
  }

  Diagnosis diagnosis(Index k) {
    Diagnosis result;
    result.k = k;
    result.mode = bank().nominal;
    result.since = since_;
    result.modes.resize(bank().modes.size());
    result.faults = bounds(k);
    ModeEvidence& nominal = result.modes[static_cast<std::size_t>(bank().nominal)];
    for (const FaultBound& bound : result.faults) {
      const double distance = std::max(bound.lower, -bound.upper);
      if (!(distance > 0)) continue;
      result.since = result.reset ? std::min(result.since, bound.at) : bound.at;
      result.reset = true;
      if (nominal.why.kind != Certificate::Kind::none && nominal.why.margin >= distance) continue;
      Vector direction = Vector::Zero(model_.linear.faults());
      direction[bound.fault] = bound.lower > 0 ? -1 : 1;
      nominal.why = {Certificate::Kind::direction, std::move(direction), distance};
    }
    if (!result.reset) {
      if (!excluded_ || bank().size() == 1) return result;
      result.mode = -1;
      result.decision = Decision::ambiguous;
      return result;
    }
    excluded_ = true;
    nominal.candidate = false;
    nominal.consistent = Answer::no;
    result.mode = -1;
    // another mode may be the reason as well: the filter does not tell them
    result.decision = bank().size() == 1 ? Decision::unknown_fault : Decision::isolating;
    since_ = k;
    return result;
  }

  std::optional<Guarantees> do_guarantees() const override {
    Guarantees result;
    result.method = recursion_.is_reduced()
                        ? "the filter's own recursion of gains and error sets, which does not "
                          "depend on the data, until it repeats bit by bit"
                        : "the filter's own recursion of gains and error sets, which does not "
                          "depend on the data, and from its last gain on "
                          "the sum of the powers of its error map";
    Vector widths = lasting_half_widths(recursion_, model_.X0.G);
    if (admissible_)  // where it begins anew after a gap, its gains may come to rest elsewhere
      widths = widths.cwiseMax(lasting_half_widths(recursion_, admissible_->G));
    for (Index i = 0; i < widths.size(); ++i) {
      result.faults.push_back({i, design_.delays[static_cast<std::size_t>(i)], widths[i]});
    }
    return result;
  }

  FilterModel model_;
  std::optional<sets::Zonotope> admissible_;  ///< holds the state at all times
  FilterDesign design_;
  FilterRecursion recursion_;
  FilterRounding rounding_;
  Matrix TA_, TB_, D_size_;
  Vector Tw_, v_, constant_size_;  ///< T Bw w̄, Dv v̄, sizes of Bw w̄
  Vector x_, r_, half_width_;      ///< x̂; estimates of the faults
  Output y_;                       ///< of the last sample
  Index first_ = 0, since_ = 0;
  bool excluded_ = false;    ///< the nominal mode has been, once
  bool was_gap_ = false;     ///< the last sample lacked outputs
  bool unfinished_ = false;  ///< a step ended with an error half way
};

/// Why X has no zonotope around it, if so.
void check_bounded(const LineForm& X, const std::string& where, const std::string& name,
                   std::vector<Diagnostic>& problems) {
  try {
    invariant::enclosing_zonotope(X, (where.empty() ? "the system's " : "") + name);
  } catch (const Error& error) {
    problems.push_back(
        {where, error.what(), "give a bounded " + name + (where.empty() ? " in the system" : "")});
  }
}

void check_parameters(const LinearModel& m, const Params& params,
                      std::vector<Diagnostic>& problems) {
  const Index n = m.states(), columns = params.integer("max_columns");
  if (columns != 0 && columns < n) {
    problems.push_back(
        {"/max_columns",
         "is " + std::to_string(columns) + ", fewer than the " + std::to_string(n) + " states",
         "give at least " + std::to_string(n) + ", or 0 for no limit"});
  }
  if (params.has("admissible_set") && params.set_form("admissible_set").dim() != n) {
    problems.push_back({"/admissible_set",
                        "has " + std::to_string(params.set_form("admissible_set").dim()) +
                            " coordinates, the system has " + std::to_string(n) + " states",
                        "give a set of states"});
  }
  const Matrix S = free_matrix(m, params);
  if (S.rows() != n || S.cols() != n + m.outputs()) {
    problems.push_back({"/free_matrix",
                        "is " + std::to_string(S.rows()) + " × " + std::to_string(S.cols()) +
                            ", must be " + std::to_string(n) + " × " +
                            std::to_string(n + m.outputs()),
                        "a row per state, a column per state and per output"});
  }
}

std::vector<Diagnostic> check_filter(const DiagnoserContext& context, const Params& params) {
  const Model& model = context.bank[context.bank.nominal].model;
  std::vector<Diagnostic> problems;
  if (context.backend->info().rounding != Rounding::nominal) {
    problems.push_back({"/type",
                        "computes in ordinary doubles, the backend promises " +
                            std::string(to_string(context.backend->info().rounding)) + " rounding",
                        "use a backend with nominal rounding"});
  }
  if (model.linear.has_ranges()) {
    problems.push_back({"/type",
                        "does not take a nominal mode whose effectiveness is known by ranges",
                        "describe changes of actuators by columns of F"});
  }
  check_bounded(model.X0, "", "X0", problems);
  check_bounded(model.W, "", "W", problems);
  check_bounded(model.V, "", "V", problems);
  check_parameters(model.linear, params, problems);
  if (params.has("admissible_set"))
    check_bounded(params.set_form("admissible_set"), "/admissible_set", "admissible_set", problems);
  if (problems.empty()) design_filter(model.linear, free_matrix(model.linear, params), problems);
  return problems;
}

ParamSchema filter_parameters() {
  ParamSchema schema;
  schema.integer(
      "max_columns",
      "most columns of the error sets after each step, at least one per state; 0: no limit", 20, 0,
      100'000);
  schema.choice("noise_coupling",
                "the noise of a sample in its two places: one value (shared), or two independent "
                "ones as published",
                {"shared", "independent"}, "shared");
  schema.matrix("free_matrix",
                "S in [T N] = [E;C]⁺ + S (I - [E;C][E;C]⁺), a row per state, a column per state "
                "and output; absent: 0");
  schema.set("admissible_set",
             "holds the state at all times: the filter begins anew from it after samples that lack "
             "outputs; without it they are an error");
  return schema;
}

constexpr const char* filter_details =
    "With Θ = [E; C], rank Θ = n, and ỹ = y - D u less the centre of Dv V:\n"
    "  [T N] = Θ⁺ + S (I - Θ Θ⁺), so that T E + N C = I\n"
    "  ρ_i = min {σ : C (TA)^(σ-1) T f_i ≠ 0}, Ψ = [(TA)^(ρ_i - 1) T f_i]_i, Υ = C Ψ, rank Υ = "
    "n_f\n"
    "  M = Υ⁺, Φ = TA Ψ, Ω Υ = 0 with rank Ω = n_y - n_f; G_k = Φ M + Ḡ_k Ω\n"
    "  x̂⁺ = TA x̂ + T (B u + Bw w̄) + G_k (ỹ - C x̂) + N ỹ⁺, r = M (ỹ - C x̂)\n"
    "  Ḡ_k minimises ‖R⁺‖_F, R⁺ = [(TA - G_k C) R̄, T Dw, -G_k Dv, -N Dv], R̄ = R reduced,\n"
    "  where Dw, Dv are the generators of Bw W and Dv V.\n"
    "Fault i at the time k - ρ_i lies in r_i ± h_i, for any faults before and after. h is the "
    "vector\n"
    "of row sums of |[M C R̄, M Dv]| with \"noise_coupling\": \"independent\", as published. With "
    "\"shared\"\n"
    "the noise v(k), which is in the error and in the output, is one value: e = a - N Dv v, and h "
    "are\n"
    "the row sums of |[M C Ā, M (I - C N) Dv]|, a of its own recursion with the same gains. On "
    "the\n"
    "published example that halves the bounds. Neither depends on the data. With \"max_columns\": "
    "0 the\n"
    "gain of step 400 stays, which gives the bounds a limit that is told in advance.\n"
    "\n"
    "Bounds that exclude 0 exclude the nominal mode, and speak of the time k - ρ_i. In a bank of "
    "several\n"
    "modes the decision is then \"isolating\", since another mode may be the reason, and "
    "\"ambiguous\" later; of one,\n"
    "\"unknown_fault\", and \"monitoring\" again where no bound excludes 0.\n"
    "The filter's sets are its own: of the pipeline's backend it uses nothing.\n"
    "\n"
    "Samples that lack outputs: a fault that acts in the gap may put the state anywhere, so that "
    "no\n"
    "bounds are told until the next complete sample, where the filter begins anew from the\n"
    "admissible_set. Give one that is not much wider than the states are: it is all that is "
    "known.\n"
    "\n"
    "As printed, the paper omits a row of its T (row 3 is (0 0 .5 0)) and the square root of "
    "‖·‖_F, and\n"
    "shifts the fault in (29) by a step: n(k-1) enters as C T F n(k-1). The condition is rank CΨ = "
    "n_f.";

}  // namespace

CORDON_COMPONENT(diagnoser, fault_estimation_filter) {
  registrar.add(DiagnoserEntry{
      {"fault_estimation_filter",
       "bounds of additive faults in systems with and without E, a few steps later", "Wang2017",
       filter_parameters(), filter_details},
      check_filter,
      [](const DiagnoserContext& context, const Params& params) -> std::unique_ptr<Diagnoser> {
        if (auto problems = check_filter(context, params); !problems.empty()) {
          throw InputError("diagnoser \"fault_estimation_filter\"", std::move(problems));
        }
        return std::make_unique<FaultEstimationFilter>(context, params);
      },
      false,
      false});
}

}  // namespace cordon::estimators
