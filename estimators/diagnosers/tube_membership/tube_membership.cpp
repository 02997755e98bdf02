// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnosis of an experiment by the output tubes of its modes: with Y_j^k(u_0 … u_k) the outputs
// y_0 … y_k that mode j can show,
//   mode j is excluded at k  ⇔  (y_0 … y_k) ∉ Y_j^k(u_0 … u_k) is proven.
// All samples enter at once, nothing is reduced and nothing is propagated: within rounding no
// method excludes a mode earlier. If the inputs were designed so that the tubes of all modes are
// disjoint at the horizon N, at most one mode is left at k = N, whatever the disturbances are
// [Rego2025, sec. 5] [Scott2014]; most often one is left before.
//
// Formulas are enclosed by linear models along their trajectories under the inputs so far, so that
// exclusions hold for them; a mode that cannot be enclosed, or is not shown to keep to the region
// that its linear model is proven in, stays possible.
//
// Every mode is a candidate at the first sample, and the experiment has one mode throughout: an
// excluded mode stays excluded, and there is no reset. After N the decision stands.
//
// `ModeEvidence::why` proves the answer about the rows of `output_tube` for the horizon k, above
// those of its outputs, as `contains` does: multipliers of rows where the mode is excluded, (δ, ξ)
// where it is not.
#include "components.hpp"
#include "cordon/core/error.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "designers/designer_parameters.hpp"
#include "diagnosers/tube_membership/membership.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

namespace {

class TubeMembership final : public Diagnoser {
 public:
  TubeMembership(const DiagnoserContext& context, const Params& params)
      : Diagnoser(context.bank, context.backend), horizon_(params.integer("horizon")) {
    if (params.has("admissible_set")) admissible_ = params.set_form("admissible_set");
  }

  std::optional<DiagnosisAssumptions> assumptions() const override {
    DiagnosisAssumptions assumed;
    for (const Mode& mode : bank().modes)
      assumed.modes.push_back({mode.model.X0, {}, admissible_of(mode.model)});
    return assumed;
  }

 private:
  std::optional<LineForm> admissible_of(const Model& model) const {
    if (model.linear.is_descriptor()) return admissible_;
    return model.nonlinear ? model.nonlinear->admissible : std::nullopt;
  }

  void do_start() override {
    candidate_.assign(static_cast<std::size_t>(bank().size()), true);
    u_ = y_ = Vector(0);
    taken_ = 0;
    lost_.assign(candidate_.size(), "");
    along_.clear();
  }

  Diagnosis do_step(const Sample* before, const Sample& now) override {
    if (!before) begin(now.k);
    Diagnosis result;
    result.k = now.k;
    result.since = since_;
    result.modes.resize(candidate_.size());
    if (now.k - since_ <= horizon_) examine(now, result.modes);
    Index left = 0;
    for (std::size_t j = 0; j < candidate_.size(); ++j) {
      result.modes[j].candidate = candidate_[j];
      if (candidate_[j]) result.modes[j].left_open = lost_[j];
      if (!candidate_[j]) continue;
      ++left;
      result.mode = static_cast<Index>(j);
    }
    if (left != 1) result.mode = -1;
    result.decision = left == 0                   ? Decision::unknown_fault
                      : left == 1                 ? Decision::monitoring
                      : now.k - since_ < horizon_ ? Decision::isolating
                                                  : Decision::ambiguous;
    return result;
  }

  std::optional<Index> do_last_used_sample() const override { return horizon_; }
  bool do_takes_missing_outputs() const override { return true; }

  /// Asks for every candidate whether all samples so far can be its own.
  void examine(const Sample& now, std::vector<ModeEvidence>& modes) {
    const Vector u = joined(u_, now.u), y = joined(y_, now.y);
    std::vector<bool> candidate = candidate_;
    for (std::size_t j = 0; j < candidate.size(); ++j) {
      if (!candidate[j]) continue;
      const std::optional<TimedModel> model = model_of(j, now, u);
      if (!model) continue;
      const OutputTube tube = output_tube(*model, backend(), {now.k - since_, false, admissible_});
      Certificate why;
      const Answer answer = diagnosers::membership(tube, u, y, &why);
      candidate[j] = answer != Answer::no;
      const bool enclosed = admissible_ || !bank().modes[j].model.is_linear();
      if (answer == Answer::unknown || (answer == Answer::yes && enclosed)) continue;
      modes[j].consistent = answer;
      modes[j].why = std::move(why);
    }
    u_ = u;
    y_ = y;
    ++taken_;
    candidate_ = std::move(candidate);
  }

  void do_serialize(Archive& archive) override {
    const std::size_t modes = candidate_.size();
    serialize_flags(archive, candidate_);
    archive(lost_, u_, y_);
    serialize_time(archive, since_);
    serialize_within(archive, taken_, 0, horizon_ + 1);
    if (lost_.size() != modes) archive.refuse("another number of modes");
    const Model& model = bank()[bank().nominal].model;
    if (u_.size() != taken_ * model.inputs() || y_.size() != taken_ * model.outputs())
      archive.refuse("samples of other sizes");
    if (!u_.allFinite() || y_.array().isInf().any()) archive.refuse("a sample that is not finite");
    if (archive.is_reading()) follow_again(archive);
  }

  /// All inputs so far, for modes by formulas that are still asked about.
  void follow_again(const Archive& archive) {
    along_.clear();
    begin(since_);
    for (std::size_t j = 0; j < along_.size(); ++j) {
      if (!along_[j] || !candidate_[j] || !lost_[j].empty()) continue;
      const Index size = bank().modes[j].model.inputs();
      try {
        for (Index k = 0; k < taken_; ++k) along_[j]->append(u_.segment(k * size, size));
      } catch (const Error& error) {
        archive.refuse(error.what());
      }
    }
  }

  void begin(Index k) {
    since_ = k;
    for (const Mode& mode : bank().modes)
      along_.push_back(mode.model.is_linear()
                           ? std::nullopt
                           : std::optional(AlongTrajectories(mode.model, since_)));
  }

  /// The mode's model under the inputs up to now; nothing, with the reason, where it is not shown
  /// to hold.
  std::optional<TimedModel> model_of(std::size_t j, const Sample& now, const Vector& u) {
    if (!lost_[j].empty()) return {};
    try {
      if (!along_[j])
        return model_under(bank().modes[j].model, designers::by_time(u, now.u.size()));
      along_[j]->append(now.u);
      return TimedModel(along_[j]->models());
    } catch (const Error& error) {
      if (error.code() != Errc::not_enclosed) throw;
      lost_[j] = error.what();
      return {};
    }
  }

  static Vector joined(const Vector& all, const Vector& next) {
    Vector both(all.size() + next.size());
    both << all, next;
    return both;
  }

  Index horizon_;
  std::optional<LineForm> admissible_;
  std::vector<bool> candidate_;
  std::vector<std::optional<AlongTrajectories>> along_;  ///< by mode, of those by formulas
  std::vector<std::string> lost_;  ///< why a mode cannot be excluded any more; "": it can
  Vector u_, y_;                   ///< since the first sample
  Index taken_ = 0;                ///< samples in them
  Index since_ = 0;
};

std::vector<Diagnostic> check_tube_membership(const DiagnoserContext& context,
                                              const Params& params) {
  std::vector<Diagnostic> problems =
      designers::check_tube_data({context.bank, context.backend}, params);
  for (const Mode& mode : context.bank.modes) {
    if (!mode.model.linear.has_ranges()) continue;
    problems.push_back({"",
                        "the effectiveness of mode \"" + mode.name +
                            "\" is known by ranges only: its outputs are no tube",
                        "give numbers, or use \"observer_bank\" or \"consistency_bank\""});
  }
  return problems;
}

}  // namespace

CORDON_COMPONENT(diagnoser, tube_membership) {
  ParamSchema schema;
  schema.integer("horizon", "N: the samples of k = 0 … N decide; the work for each grows with k",
                 20, 0, designers::most_horizon);
  schema.set(
      "admissible_set",
      "a set that holds the state of descriptor systems at all times, as far as E does not "
      "determine it; exclusions rest "
      "on it. Needed with \"constrained_zonotope\"; the one that the input was designed with");
  registrar.add(DiagnoserEntry{
      {"tube_membership",
       "all samples of an experiment against the output tube of every mode; a mode is excluded "
       "when they are "
       "proven to lie outside",
       "Rego2025; Scott2014", schema},
      check_tube_membership,
      [](const DiagnoserContext& context, const Params& params) -> std::unique_ptr<Diagnoser> {
        return std::make_unique<TubeMembership>(context, params);
      },
      false,
      true,
      true,
      true});
}

}  // namespace cordon::estimators
