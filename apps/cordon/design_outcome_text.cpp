// SPDX-License-Identifier: GPL-3.0-or-later
// Words, tables and numbers of one designed input.
#include "design_outcome_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "diagnosis_report.hpp"

namespace cordon::apps {

namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr double touching_kappa = 1e-7;  // of tubes that touch up to rounding

std::string six_digits(double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "∞" : "-∞";
  return fmt::format("{:.6g}", value);
}

std::string pair_name(const Names& modes, Index i, Index j) {
  return modes[static_cast<std::size_t>(i)] + ", " + modes[static_cast<std::size_t>(j)];
}

/// What of it is proven, else what the designer claims. Without colours: cells of a table are
/// aligned by their length.
std::string separation(Answer claimed, const ExactPair* exact) {
  const bool proven = exact && exact->disjoint != Answer::unknown;
  const Answer disjoint = proven ? exact->disjoint : claimed;
  if (disjoint == Answer::unknown) return "not decided";
  return fmt::format("{} ({})", disjoint == Answer::yes ? "disjoint" : "meet",
                     proven ? "proven" : "claimed");
}

/// " with κ ≥ 0.0001": what is searched for.
std::string margin_text(const DesignOutcome& outcome) {
  return outcome.epsilon > 0 ? fmt::format(" with κ ≥ {}", outcome.epsilon) : "";
}

/// What is said of the cost of every input that is searched for.
std::string bound_text(const DesignOutcome& outcome) {
  if (outcome.lower_bound == -infinity) return "no lower bound is known";
  return fmt::format("claimed lower bound {}{}", six_digits(outcome.lower_bound),
                     margin_text(outcome));
}

/// The separation that is proven, or else the one that is claimed: green, red or yellow.
std::string separated_text(const InputDesign& best, const ExactSeparation* exact,
                           const Paint& paint) {
  const Answer proven = exact ? exact->separates() : Answer::unknown;
  if (proven == Answer::yes) return paint.green("separated (proven)");
  if (proven == Answer::no) return paint.red("not separated (proven)");
  return paint.yellow(best.separates() == Answer::yes  ? "separated (claimed)"
                      : best.separates() == Answer::no ? "not separated (claimed)"
                                                       : "not proven to be separated");
}

std::string inputs_table(const Matrix& u, const Labels& labels, const Paint& paint) {
  const double seconds = labels.sampling_time;
  Rows rows{{"k"}};
  if (seconds > 0) rows[0].push_back("t [s]");
  for (Index i = 0; i < u.cols(); ++i) rows[0].push_back(label_of(labels.inputs, "u", i));
  for (Index k = 0; k < u.rows(); ++k) {
    rows.push_back({fmt::format("{}", k)});
    if (seconds > 0) rows.back().push_back(fmt::format("{:.6g}", static_cast<double>(k) * seconds));
    for (Index i = 0; i < u.cols(); ++i) rows.back().push_back(fmt::format("{:.8g}", u(k, i)));
  }
  return table(rows, paint);
}

/// The designer's κ, as computed, as far as it agrees with what is proven.
double shown_kappa(double kappa, const ExactPair* proven) {
  if (proven && proven->disjoint == Answer::yes)
    return std::isnan(kappa) ? proven->kappa_lower : std::max(kappa, proven->kappa_lower);
  if (proven && proven->disjoint == Answer::no) return std::min(kappa, 0.0);
  return kappa;
}

std::string pairs_table(const Names& modes, const InputDesign& design, const ExactSeparation* exact,
                        const Paint& paint) {
  Rows rows{{"PAIR", "κ", "AT LEAST", "OUTPUT TUBES"}};
  for (std::size_t q = 0; q < design.pairs.size(); ++q) {
    const PairSeparation& pair = design.pairs[q];
    const ExactPair* proven = exact ? &exact->pairs[q] : nullptr;
    const bool apart = proven && proven->disjoint == Answer::yes;
    rows.push_back({pair_name(modes, pair.i, pair.j), six_digits(shown_kappa(pair.kappa, proven)),
                    apart ? six_digits(proven->kappa_lower) : "-",
                    separation(pair.disjoint, proven)});
  }
  return table(rows, paint);
}

std::string exact_text(const Names& modes, const ExactSeparation& exact, const Paint& paint) {
  std::string text;
  for (const ExactPair& pair : exact.pairs) {
    if (!pair.reason.empty())
      text += fmt::format("Not decided exactly: {}: {}\n", pair_name(modes, pair.i, pair.j),
                          pair.reason);
  }
  for (std::size_t i = 0; i < exact.empty.size(); ++i) {
    if (exact.empty[i] == Answer::unknown)
      text += fmt::format("Not decided exactly: has {} an output at all?\n", modes[i]);
  }
  const Answer separates = exact.separates();
  const std::string verdict = separates == Answer::yes  ? paint.green("the modes are separated")
                              : separates == Answer::no ? paint.red("the modes are not separated")
                                                        : paint.yellow("separation is not proven");
  return text + fmt::format("In exact arithmetic: {} ({:.3g} s)\n", verdict, exact.wall_s);
}

}  // namespace

Names mode_names(const Study& study) {
  Names names;
  for (const Mode& mode : bank_of(study).modes) names.push_back(mode.name);
  return names;
}

std::string restriction_text(const DesignOutcome& outcome) {
  if (!outcome.restriction) return "";
  const double bound = outcome.restriction->lower_bound;
  const std::string known =
      std::isfinite(bound)
          ? fmt::format("; that one costs at least {}, the problem itself may cost less",
                        six_digits(bound))
          : "";
  return fmt::format("Searched in place of the problem: {}{}\n", outcome.restriction->name, known);
}

std::string status_text(const DesignOutcome& outcome, const std::string& designer,
                        const ExactSeparation* exact, const Paint& paint) {
  const std::string cost =
      fmt::format("cost {}", six_digits(outcome.best ? outcome.best->cost : 0));
  switch (outcome.status) {
    case DesignStatus::optimal:
      return paint.green("Optimal") +
             fmt::format(" (claimed by {}): {}, {}", designer, cost, bound_text(outcome));
    case DesignStatus::feasible: {
      const std::string gap = std::isfinite(outcome.gap())
                                  ? fmt::format(" with claimed gap {:.3g} %", 100 * outcome.gap())
                                  : "";
      return paint.yellow(fmt::format("Feasible{}", gap)) +
             fmt::format(": {}, {}", cost, bound_text(outcome));
    }
    case DesignStatus::infeasible:
      return paint.yellow("Infeasible") +
             fmt::format(" (claimed by {}): no input of the input set separates the modes{}",
                         designer, margin_text(outcome));
    case DesignStatus::unknown:
      return paint.yellow(outcome.stopped ? "No answer within the limit" : "No answer") + ": " +
             bound_text(outcome);
    case DesignStatus::given:
      break;
  }
  return fmt::format("Given: {}, the modes are {}", cost,
                     separated_text(*outcome.best, exact, paint));
}

Names empty_modes(const Names& modes, const std::vector<Answer>& empty,
                  const ExactSeparation* exact) {
  Names found;
  for (std::size_t i = 0; i < empty.size(); ++i) {
    if (empty[i] == Answer::yes || (exact && exact->empty[i] == Answer::yes))
      found.push_back(modes[i]);
  }
  return found;
}

std::string empty_text(const Names& empty) {
  return fmt::format(
      "no output of {} fits this input: the model contradicts itself, and being apart from it says "
      "nothing. Check the admissible "
      "set, X0 and the static rows",
      fmt::join(empty, ", "));
}

std::string horizon_text(const DesignOutcome& outcome) {
  std::string text =
      fmt::format("Horizon N = {}: {} of k = 0 … {}\n", outcome.horizon,
                  outcome.last_output_only ? "inputs, and the last output," : "inputs and outputs",
                  outcome.horizon);
  for (const HorizonTrial& trial : outcome.tried) {
    text += fmt::format("  tried {}: N = {}, {}{}{}\n",
                        trial.horizon < outcome.horizon ? "before" : "as well", trial.horizon,
                        to_string(trial.status), trial.reason.empty() ? "" : ": ", trial.reason);
  }
  return text;
}

namespace {

/// Has exact arithmetic decided what the designer's reason leaves open? That tubes touch is a
/// reason of its own.
bool is_decided_since(const DesignOutcome& outcome, const ExactSeparation* exact) {
  if (!outcome.best || outcome.best->separates() != Answer::unknown || !exact) return false;
  const auto& pairs = outcome.best->pairs;
  const bool touching = std::any_of(pairs.begin(), pairs.end(), [](const PairSeparation& pair) {
    return std::abs(pair.kappa) < touching_kappa;
  });
  return exact->separates() == Answer::yes || (exact->separates() == Answer::no && !touching);
}

}  // namespace

std::string reason_text(const DesignOutcome& outcome, const ExactSeparation* exact) {
  const bool is_decided = is_decided_since(outcome, exact);
  std::string text =
      outcome.reason.empty() || is_decided ? "" : fmt::format("{}\n", outcome.reason);
  if (!outcome.suggestion.empty()) text += fmt::format("To try: {}\n", outcome.suggestion);
  return text;
}

std::string search_text(const DesignOutcome& outcome, double design_s) {
  if (outcome.programs == 0) return fmt::format("Time: {:.3g} s\n", design_s);
  const std::string facets = outcome.facets > 0 ? fmt::format(", {} facets", outcome.facets) : "";
  return fmt::format("Search: {} nodes, {} linear programs{}, {:.3g} s{}\n", outcome.nodes,
                     outcome.programs, facets, design_s,
                     outcome.stopped ? ", ended by the limit" : "");
}

std::string refuted_text(const Names& refuted, const Paint& paint) {
  std::string text;
  for (const std::string& claim : refuted) text += paint.red("Proven false") + ": " + claim + "\n";
  return text;
}

std::string input_text(const Labels& labels, const Names& modes, const InputDesign& best,
                       const ExactSeparation* exact, const Paint& paint) {
  std::string text = fmt::format("\n{}\n{}\n", inputs_table(best.u, labels, paint),
                                 pairs_table(modes, best, exact, paint));
  const Names empty = empty_modes(modes, best.empty, exact);
  if (!empty.empty()) text += paint.red("Modelling error") + ": " + empty_text(empty) + "\n";
  return exact ? text + exact_text(modes, *exact, paint) : text;
}

}  // namespace cordon::apps
