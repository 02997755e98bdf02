// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/gain_designer.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon {

/// A set that contains every state of time k that is consistent with model, bounds and the data up
/// to the sample that gave it.
struct Estimate {
  Index k = 0;  ///< lags behind the sample by Observer::lag
  Enclosure set;
  Answer consistent =
      Answer::unknown;  ///< `no`: the set is proven empty, so the data contradict model or bounds
  Certificate why;      ///< proof of `consistent` (of the emptiness of `set`)
};

/// A sample that contradicts what was known before it. The prediction is the observer's estimate of
/// the same time without the sample's outputs; y_i misses it by the distance of y_i from the
/// interval of C x + D u + Dv v over the prediction, the matrices and V, of g(x, v, u, k) where the
/// model is one of formulas.
struct Contradiction {
  Index k = 0;
  /// Of those that miss the prediction the one that does so by the most of its interval's size; -1:
  /// none by itself, though all together contradict what was known.
  Index output = -1;
  double distance = 0;  ///< of that output, in its unit; computed to nearest
  bool before = false;  ///< the prediction itself is empty: the outputs do not matter
};

/// Wall-clock time of the last step by phase, in microseconds; `question` is the emptiness test.
struct PhaseTimes {
  double predict = 0, correct = 0, reduce = 0, question = 0;
  double step() const { return predict + correct + reduce; }
};

/// A set-based observer. The base class keeps the previous sample, asks for emptiness after each
/// step, and holds on to ∅: once the data are proven inconsistent every later estimate is ∅, until
/// `replace`.
///
/// Where the model is proven in a region only, the base class shows by induction that every step
/// keeps to it: X̂_k within the states and u_k within the inputs for the step to k + 1, and where
/// the outputs are not linear, the prediction for time k before y_k is used.
class Observer {
 public:
  virtual ~Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  /// Begins anew; X0 overrides the model's initial set.
  void start(std::optional<Enclosure> X0 = {});
  /// Takes the sample of the next time; samples come in order. Sizes are checked. Throws
  /// Errc::unsupported for missing outputs that the observer does not take, Errc::not_enclosed
  /// where the model's region is not shown to hold the state and the input.
  Estimate step(const Sample& now);
  /// Replaces the set of states at the time of the last sample, and keeps the time; of an observer
  /// that lags, nothing is left of what it knew of earlier times.
  void replace(Enclosure X);

  /// From now on outputs that miss the prediction are left out, as if they were missing, in at most
  /// `most` samples of any `window` that follow each other (0: none; window ≥ 1). What is left out
  /// is no longer assumed to keep to V. Only for observers that take missing outputs: throws
  /// Errc::unsupported. The limit lasts when the observer begins anew while time goes on. Costs the
  /// bounds of the outputs over every prediction and, where estimates use the outputs of their
  /// time, a second step at every sample.
  void leave_out_outliers(Index most, Index window);

  /// Writes all that later steps depend on to the archive, or takes it from there. An observer that
  /// is made with the same model, backend and parameters, and reads what this one has written,
  /// takes every later sample as this one would, bit by bit; `times` are not kept. Throws
  /// Errc::unsupported if the observer or its backend do not offer it, Errc::invalid for what does
  /// not fit this observer, which has to begin anew then.
  void serialize(Archive& archive);

  const PhaseTimes& times() const { return times_; }
  /// Of the last sample: outputs that were left out, in ascending order.
  const std::vector<Index>& left_out() const { return left_out_; }
  /// Of the last sample: what it contradicts, if its estimate is the first one that is proven empty
  /// or outputs were left out, and the observer takes missing outputs.
  const std::optional<Contradiction>& contradiction() const { return contradiction_; }

  /// The set that the observer assumes to contain the state at the first sample: the model's X0, or
  /// what its parameters put there.
  virtual LineForm initial_set() const { return model_.X0; }

  /// A set that the observer assumes to contain the true state at all times (beyond the model's
  /// bounds), or none: as it was given, not as the backend represents it. Guarantees hold while it
  /// does. By default that of `admit`.
  virtual std::optional<LineForm> admissible_set() const { return admissible_form_; }

  /// The gains it works with, with what is known about them; of gains that vary in time those of
  /// the steady state.
  virtual std::vector<Gain> gains() const { return {}; }

  /// By how many samples estimates lag. The sample of time k gives the estimate of time
  /// max(k - lag, b), b being the time of the first sample since the start, or of the last one
  /// before `replace`; it uses all samples from b up to k. Before b + lag all are of time b, each
  /// one knowing a sample more, and the one of b + lag is the last of them.
  virtual Index lag() const { return 0; }

  /// What the recursion itself promises where every set operation in it is exact. `exact`: what the
  /// sample of time k gives is then the set of all states that the model, the assumptions and all
  /// samples up to k allow at the estimate's time. No recursion is that by itself: one that leaves
  /// out a measurement, an input or the previous sample only encloses this set, however exact its
  /// operations are. The claim of an estimate is the meet of this one and of its set's, so that
  /// `exact` is said only where an observer states it here, and `cordon verify` compares the sets.
  virtual Tightness claim() const { return Tightness::outer; }

  /// Does each estimate hold all successors of the one before that are consistent with the samples?
  /// Then `cordon verify` holds every estimate against the one before. An observer that knows more
  /// than its last set, as a bound of its error for all times, may keep to less, and says no.
  virtual bool follows_its_sets() const { return false; }

  /// Does it take samples with missing outputs, and enclose every state that is consistent with the
  /// outputs that are there? Otherwise `step` refuses such samples.
  virtual bool takes_missing_outputs() const { return false; }

  /// Do estimates use the outputs of their time? Those that do not are their own predictions.
  virtual bool uses_outputs_of_its_time() const { return true; }

  /// A box inside the hull of the last estimate, made of trajectories that the observer must
  /// enclose: what is left between the two is the price of the enclosure. Never an enclosure
  /// itself. Nothing: not offered, or an admissible set has cut estimates, of which the
  /// trajectories know nothing.
  std::optional<Box> inner_estimate() const {
    return is_cut_to_nothing_ ? std::nullopt : do_inner_estimate();
  }

 protected:
  Observer(Model model, std::shared_ptr<const SetBackend> backend)
      : model_(std::move(model)), backend_(std::move(backend)) {}

  const Model& model() const { return model_; }
  const SetBackend& backend() const { return *backend_; }

  /// For constructors of observers without a lag: `admissible` holds the state at all times. From
  /// now on an estimate that is not within it is cut by it, reduced to the budget, and takes the
  /// place of the observer's own set, as by `replace`. A cut by which the set's interval hull
  /// becomes no narrower is left out: representations without exact intersections may enclose it by
  /// more than there was; the estimate is claimed `outer` then. Costs the hull of every estimate,
  /// and an intersection where it is cut.
  void admit(const LineForm& admissible, Budget budget);

  /// Of an output over a set of states, and the size of known terms in it.
  struct OutputBounds {
    double lower = 0, upper = 0, terms = 0;
  };
  /// By default of a linear model.
  virtual OutputBounds output_bounds(const Set& X, Index output, const Sample& now);

  /// Observers that lag hold more than their estimates. Of what `do_start` and `do_step` return,
  /// which is what `do_replace` is given to go back to: the estimate; and the states at the time of
  /// the last sample, which outliers and the model's region are judged by. By default the same.
  virtual Enclosure estimate_of(const Enclosure& held) const { return held; }
  virtual Enclosure present_of(const Enclosure& held) const { return held; }

  enum class Phase { predict, correct, reduce };
  /// Runs `work` and books its time to the phase.
  template <class Work>
  auto timed(Phase phase, Work&& work) {
    const Stopwatch watch(phase == Phase::predict   ? times_.predict
                          : phase == Phase::correct ? times_.correct
                                                    : times_.reduce);
    return work();
  }

 private:
  /// The estimate at the first sample, or what it is made of; X0 is of the observer's backend.
  virtual Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) = 0;
  virtual Enclosure do_step(const Sample& before, const Sample& now) = 0;
  virtual void do_replace(const Enclosure& X) = 0;
  virtual std::optional<Box> do_inner_estimate() const { return std::nullopt; }
  /// The members that `do_start`, `do_step` and `do_replace` change, without those that only keep
  /// memory or what they can make again: `archive(x_, X_)`. Asked for once there has been a sample.
  /// Default: Errc::unsupported.
  virtual void do_serialize(Archive& archive);

  class Stopwatch {
   public:
    explicit Stopwatch(double& total);
    ~Stopwatch();

   private:
    double& total_;
    long long begin_;
  };

  /// Cuts the estimate by the admissible set; false: it is as it was.
  bool cut(Enclosure& X);
  Index estimated_time(Index k) const;
  /// One step, with what is asked of its estimate.
  Estimate advance(const Sample& now);
  /// Goes back to the sample before.
  void go_back();
  /// The outputs of a sample that miss the set by more than rounding; fills in `contradiction_`.
  std::vector<Index> outliers(const Set& X, const Sample& now);
  bool may_leave_out(Index k) const;
  /// One step without the outputs that miss the prediction; `used`: the sample without these, if
  /// there were any.
  Estimate advance_without_outliers(const Sample& now, std::optional<Sample>& used);
  /// Finds out what the sample contradicts, the estimate of which is empty.
  void explain(const Sample& now);
  /// Throws Errc::not_enclosed if the step to this sample is not proven to keep to the region.
  void expect_region(const Sample& now);
  /// Bounds of x_k by the model alone, without y_k; at the first sample of the initial set.
  Box predicted();

  Model model_;
  std::shared_ptr<const SetBackend> backend_;
  std::optional<LineForm> admissible_form_;
  Enclosure admissible_;  ///< the same in the backend; no set: none
  Budget admissible_budget_;
  std::optional<Enclosure> X0_;
  std::optional<Sample> before_;
  Index begin_ = 0;  ///< nothing is known of times before
  Enclosure held_;   ///< what the last `advance` has led to
  Enclosure last_;   ///< the same of `before_`
  /// What later estimates can claim at most, for the observer's own set may not tell what a cut has
  /// left out; and at `before_`.
  Tightness inherited_ = Tightness::exact, last_inherited_ = Tightness::exact;
  bool inconsistent_ = false;
  bool is_cut_to_nothing_ = false;  ///< by the admissible set, since the start
  Index most_outliers_ = 0, outlier_window_ = 1;
  std::vector<Index> outlier_times_;  ///< of the window, ascending
  std::vector<Index> left_out_;
  std::optional<Contradiction> contradiction_;
  Enclosure noise_, disturbance_;  ///< V and W, where they were asked for
  std::string left_region_;        ///< why the next step is not proven to keep to the region
  PhaseTimes times_;
};

}  // namespace cordon
