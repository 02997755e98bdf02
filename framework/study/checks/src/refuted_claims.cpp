// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/study/design.hpp"
#include "study/checks/design_check.hpp"
#include "study/checks/outside.hpp"

namespace cordon {

namespace {

bool is_other(VectorIn asked, VectorIn given) {
  if (asked.size() != given.size()) return true;
  if (asked.size() == 0) return false;
  const double size = std::max({1.0, asked.cwiseAbs().maxCoeff(), given.cwiseAbs().maxCoeff()});
  return (asked - given).cwiseAbs().maxCoeff() > tolerances::reported * size;
}

bool equal(const Matrix& A, const Matrix& B) {
  return A.rows() == B.rows() && A.cols() == B.cols() && A == B;
}
bool equal(const LineForm& X, const LineForm& Y) {
  return equal(X.M, Y.M) && equal(X.G, Y.G) && equal(X.c, Y.c) && equal(X.S, Y.S) &&
         equal(X.A, Y.A) && equal(X.b, Y.b);
}

/// The answer of one designer beside what the study asks of it and what is proven.
class Refutation {
 public:
  Refutation(const ModeBank& bank, const ComponentSpec& designer, const DesignOutcome& outcome)
      : bank_(bank), params_(designer.params), outcome_(outcome) {}

  std::vector<std::string> of(const ExactSeparation* exact) {
    compare_horizon();
    compare_question();
    compare_bound();
    if (outcome_.best) {
      compare_given();
      compare_certificates();
      if (is_designed()) compare_inputs();
      if (exact) compare_separation(*exact);
    }
    return std::move(found_);
  }

 private:
  template <class T>
  const T* asked(const char* name) const {
    const auto at = params_.values().find(name);
    return at == params_.values().end() ? nullptr : std::get_if<T>(&at->second);
  }
  template <class... Parts>
  void refute(fmt::format_string<Parts...> text, Parts&&... parts) {
    found_.push_back(fmt::format(text, std::forward<Parts>(parts)...));
  }

  /// Is the input the designer's own choice? Also where it says that it was given and the study
  /// gives none.
  bool is_designed() const {
    return outcome_.status != DesignStatus::given || !asked<Matrix>("input");
  }
  bool was_found() const {
    return outcome_.status == DesignStatus::optimal || outcome_.status == DesignStatus::feasible;
  }

  void compare_horizon() {
    const auto* horizon = asked<std::int64_t>("horizon");
    const auto* any = asked<std::int64_t>("horizon_at_most");
    const auto* most = any ? any : asked<std::int64_t>("max_horizon");
    if (horizon && outcome_.horizon != *horizon) {
      refute("it answers for the horizon {}, and \"horizon\" is {}", outcome_.horizon, *horizon);
    } else if (!horizon && most && outcome_.horizon > *most) {
      refute("it answers for the horizon {}, and \"{}\" is {}", outcome_.horizon,
             any ? "horizon_at_most" : "max_horizon", *most);
    }
  }

  /// Is it the question of the study that is answered?
  void compare_question() {
    const auto* outputs = asked<std::string>("outputs");
    if (outputs && (*outputs == "last") != outcome_.last_output_only) {
      refute("it compares {}, and \"outputs\" is \"{}\"",
             outcome_.last_output_only ? "the last output only" : "all outputs", *outputs);
    }
    const auto* admissible = asked<LineForm>("admissible_set");
    if (outcome_.admissible_set && !admissible) {
      refute("it assumes an admissible set, and the study gives none");
    } else if (outcome_.admissible_set && !equal(*outcome_.admissible_set, *admissible)) {
      refute("it assumes another admissible set than that of the study");
    }
    const auto* epsilon = asked<double>("epsilon");
    if (epsilon && outcome_.epsilon != *epsilon)
      refute("it asks for κ ≥ {}, and \"epsilon\" is {}", outcome_.epsilon, *epsilon);
  }

  void compare_bound() {
    if (!outcome_.best || !was_found()) return;
    const double cost = outcome_.best->cost;
    if (outcome_.lower_bound > cost + tolerances::reported * std::max(1.0, std::abs(cost))) {
      refute(
          "its input costs {}, less than its lower bound {} of every input that separates the "
          "modes",
          cost, outcome_.lower_bound);
    }
  }

  void compare_given() {
    const auto* input = asked<Matrix>("input");
    if (input && !equal(*input, outcome_.best->u))
      refute("its input is another than the study's \"input\"");
  }

  void compare_inputs() {
    const Matrix& u = outcome_.best->u;
    const auto* own = asked<LineForm>("input_set");
    const auto* first = asked<Vector>("first_input");
    const LineForm& U = own ? *own : bank_[bank_.nominal].model.U;
    if (first && is_other(*first, u.row(0).transpose()))
      refute("u_0 is another than the study's \"first_input\"");
    if (U.dim() != u.cols()) return;  // nothing is said of the inputs
    std::vector<Index> outside;
    for (Index k = first ? 1 : 0; k < u.rows(); ++k) {
      if (detail::clearly_outside(U, u.row(k).transpose())) outside.push_back(k);
    }
    if (outside.empty()) return;
    refute("u_k is proven to lie outside {} at k = {}",
           own ? "\"input_set\"" : "the input set U of the study", fmt::join(outside, ", "));
  }

  /// A certificate is about rows of the designer's own making; what it says of itself is all that
  /// can be compared.
  void compare_certificates() {
    using Kind = Certificate::Kind;
    for (const PairSeparation& pair : outcome_.best->pairs) {
      const Certificate& why = pair.why;
      const bool proves_nothing =
          why.kind == Kind::farkas && (!why.data.allFinite() || !(why.margin > 0));
      const bool proves_other = why.kind == Kind::point;
      if (pair.disjoint != Answer::yes || (!proves_nothing && !proves_other)) continue;
      refute("it calls the output tubes of {} and {} disjoint by a certificate that proves {}",
             bank_[pair.i].name, bank_[pair.j].name,
             proves_other ? "that they meet"
                          : "nothing: its margin is not positive, or its numbers are none");
    }
  }

  void compare_separation(const ExactSeparation& exact) {
    for (const auto& claim : verification::compare_design(bank_, outcome_, exact).refuted)
      found_.push_back(claim.what);
    if (!was_found() || outcome_.epsilon <= 0) return;
    for (std::size_t q = 0; q < exact.pairs.size();
         ++q) {  // such an input separates all pairs, whatever it says of each
      const ExactPair& pair = exact.pairs[q];
      if (pair.disjoint != Answer::no || outcome_.best->pairs[q].disjoint == Answer::yes) continue;
      refute(
          "it calls its input {}, and the outputs of {} and {} can be the same "
          "under it",
          to_string(outcome_.status), bank_[pair.i].name, bank_[pair.j].name);
    }
  }

  const ModeBank& bank_;
  const Params& params_;
  const DesignOutcome& outcome_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> refuted_claims(const ModeBank& bank, const ComponentSpec& designer,
                                        const DesignOutcome& outcome,
                                        const ExactSeparation* exact) {
  return Refutation(bank, designer, outcome).of(exact);
}

}  // namespace cordon
