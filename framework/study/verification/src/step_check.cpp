// SPDX-License-Identifier: GPL-3.0-or-later
// Findings about a step, and the proofs that were stored with it.
#include "step_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/solvers/view_questions.hpp"
#include "solvers/rational_questions.hpp"

namespace cordon::verification {

namespace {

/// Of a coordinate's size: what nominal operations add up to at least, and the rounding of a box to
/// centre and radius.
constexpr double nominal_tolerance = 1e-9, box_tolerance = 1e-14;
/// Of the direction of a line that an observer has found: operations enclose, its own coordinates
/// are rounded.
constexpr double outward_line_tolerance = 1e-12;
constexpr double row_tolerance = 1e-13;  ///< of a nominal constraint's terms

}  // namespace

std::string text(VectorIn x) {
  std::string out = "(";
  for (Index i = 0; i < x.size(); ++i) out += fmt::format("{}{}", i ? ", " : "", x[i] + 0.0);
  return out + ")";
}

StepCheck::StepCheck(const RecordedStep& step, const RecordedSet& row, Rounding rounding,
                     const Vector& margin)
    : step_(step),
      row_(row),
      view_{row.set, row.rows, Tightness::outer},
      nominal_(rounding == Rounding::nominal),
      line_tolerance_(rounding == Rounding::nominal ? nominal_tolerance : outward_line_tolerance),
      size_(row.set.c.cwiseAbs() + row.set.G.cwiseAbs().rowwise().sum()) {
  for (Index i = 0; i < size_.size(); ++i) {
    const double reach = std::max(std::abs(step.hull.lower[i]), std::abs(step.hull.upper[i]));
    if (std::isfinite(reach) && !reported_empty()) size_[i] = reach;
    if (!std::isfinite(size_[i])) size_[i] = 0;
  }
  margin_ = margin;
  claim_margin_ = Vector::Zero(size_.size());
  row_margin_ = Vector::Zero(row.set.constraints());
  if (nominal_) {
    margin_ = claim_margin_ = margin.cwiseMax(nominal_tolerance * size_);
    row_margin_ = row_tolerance * (row.set.b.cwiseAbs() + row.set.A.cwiseAbs().rowwise().sum());
  }
  widened_ = minkowski_sum(
      row.set, make_box({-almost_all_of_margin * margin_, almost_all_of_margin * margin_}));
}

void StepCheck::violated(std::string what, bool in_sets_file) {
  if (!violation_) violation_ = {std::move(what), in_sets_file};
}

void StepCheck::missed(std::string what, bool in_sets_file) {
  if (!few_digits_) return violated(std::move(what), in_sets_file);
  open("lines of which rounding leaves few digits: " + what);
}

void StepCheck::open(std::string what) {
  if (undecided_++ == 0) first_undecided_ = std::move(what);
}

void StepCheck::proofs() {
  emptiness_proof();
  // An outer export is larger than the set whose hull was reported: nothing follows about the
  // bounds.
  if (reported_empty() || !row_.exact_exchange) return;
  for (Index i = 0; i < step_.hull.dim() && !violation_; ++i) {
    bound_proof(i, true);
    bound_proof(i, false);
  }
}

void StepCheck::emptiness_proof() {
  if (step_.consistent == Answer::unknown) return;
  if (row_.proof.kind == Certificate::Kind::none) return emptiness_without_proof();
  if (step_.consistent == Answer::no) {
    if (!proves_empty(view_, row_.proof)) {
      return violated(
          "the estimate is called empty, but the stored proof does not hold in rational arithmetic",
          true);
    }
  } else if (!proves_not_empty(row_.set, row_.proof)) {
    // rows of flat sets contradict each other in the last digits, which is not taken for emptiness
    // with nominal rounding
    const bool may_be_rounding =
        row_.proof.kind == Certificate::Kind::point && (row_margin_.array() > 0).any();
    if (may_be_rounding) return emptiness_without_proof();
    return violated(
        "the estimate is called non-empty, but the stored proof does not hold in rational "
        "arithmetic",
        true);
  } else if (!row_.exact_exchange) {
    return;  // of the set that was recorded, which is larger than the one in question
  }
  ++proofs_;
}

/// A backend may answer exactly and give no certificate: the recorded set decides, unless it is
/// larger than the one in question.
void StepCheck::emptiness_without_proof() {
  const bool called_empty = reported_empty();
  try {
    LineForm rows = row_.set;  // of dimension 0: its constraints alone
    rows.M.resize(0, rows.lines());
    rows.G.resize(0, rows.generators());
    rows.c.resize(0);
    const bool empty = called_empty ? exact::is_empty(rows) == Answer::yes
                                    : !exact::contains(rows, {}, Vector(), row_margin_);
    if (empty == called_empty && (empty || row_.exact_exchange)) {
      ++proofs_;
      return;
    }
    if (empty != called_empty && row_.exact_exchange) {
      return violated(
          fmt::format("the estimate is called {}, without a proof, and the recorded set is not",
                      called_empty ? "empty" : "non-empty"),
          true);
    }
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
  }
  open(fmt::format("\"consistent\" is \"{}\", but no proof was stored",
                   to_string(step_.consistent)));
}

void StepCheck::bound_proof(Index i, bool upper) {
  const double bound = upper ? step_.hull.upper[i] : -step_.hull.lower[i];
  if (bound == infinity) return;
  const Vector d = Vector::Unit(size_.size(), i) * (upper ? 1.0 : -1.0);
  // Boxes are exported with centre and radius rounded; lines are eliminated nominally.
  const double slack = std::max(box_tolerance * size_[i], row_.set.lines() > 0 ? margin_[i] : 0.0);
  const std::size_t place = static_cast<std::size_t>(2 * i + (upper ? 0 : 1));
  const Certificate none, &why = place < row_.hull_proofs.size() ? row_.hull_proofs[place] : none;
  if (why.kind != Certificate::Kind::none && proves_support(view_, d, bound + slack, why)) {
    ++proofs_;
    return;
  }
  const double reached = lower_support(row_.set, d);
  const std::string name = fmt::format("the {} bound of coordinate {}, {:.17g},",
                                       upper ? "upper" : "lower", i + 1, upper ? bound : -bound);
  if (reached > bound + slack) {
    return violated(fmt::format("{} lies inside the reported set, which reaches {:.17g}", name,
                                upper ? reached : -reached),
                    false);
  }
  if (why.kind == Certificate::Kind::none) {
    try {
      if (exact::support(row_.set, d).upper <= bound + slack) {
        ++proofs_;
        return;
      }
      return violated(name + " has no proof, and lies inside the recorded set", false);
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported) throw;
    }
    return open(name + " has no proof");
  }
  violated(name + " is not what its stored proof proves in rational arithmetic", false);
}

StepCheck::Successors unknown_successors(Index n) {
  const auto none = [n] { return make_empty(n); };
  return {none, [none](double) { return none(); }, [] { return std::nullopt; }};
}

}  // namespace cordon::verification
