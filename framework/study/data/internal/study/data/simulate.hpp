// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated data: x_{k+1}, y_k from the model, with seeded disturbances and faults.
#pragma once

#include <optional>
#include <string>

#include "cordon/study/data.hpp"
#include "study/data/draws.hpp"
#include "study/data/linear_plant.hpp"

namespace cordon::detail {

/// Samples k = 0 … steps with the true state, mode and additive faults. Memory is constant.
///
/// At every k one model makes y_k and x_{k+1}: that of the fault that acts at k, else the nominal
/// one. The draws of the nominal model go on unseen during a fault, so that faults do not change
/// what comes after them. Additive faults act on all models.
///
/// Start of a system with static rows: x0 must satisfy them, F n_0 included, for some w_0 ∈ W. The
/// drawn w_0 is corrected by least squares on the static rows; where that leaves W, a central point
/// of {w ∈ W : static rows} replaces it. Without x0, the dynamic part of the centre of X0 is taken
/// and the static part follows from w_0; where that state leaves X0, a central pair (x_0, w_0) is
/// taken. With x0_set, the same is tried with draws of x0 and, after the first, of w_0 from
/// sequences of their own; where none of a hundred states lies in the set, a pair is drawn from
/// {(x,w) ∈ x0_set × W : static rows}. Throws InputError: sizes, unbounded W or V, index above 1,
/// models of different E one after another, an x0 that no w_0 ∈ W explains (with the residual).
class SimulatedSource final : public DataSource {
 public:
  /// `modes`: the records name the true mode.
  SimulatedSource(const Model& model, const SimulateSpec& spec, std::string file,
                  bool modes = true);

  std::optional<Record> next() override;
  std::optional<std::int64_t> size() const override { return spec_.steps + 1; }

 private:
  /// What makes the data for a while.
  struct Regime {
    LinearPlant plant;
    DrawSource draws;
  };
  Regime regime_of_fault(std::size_t index) const;
  void check_faults(const LinearModel& nominal) const;
  void enter(std::int64_t k);
  Draw draw(std::int64_t k);
  Vector pushed(const Draw& draw, const Vector& u, const Vector& n) const;
  LinearPlant& plant() { return fault_ ? fault_->plant : nominal_.plant; }

  void start(const Model& model);
  bool start_near_given(const Model& model, const Vector& x0, const Vector& u0);
  void start_from_center(const Model& model, const Vector& u0);
  void start_from_draws(const Model& model, const Vector& u0);
  LineForm joint_set(const LineForm& X0, const LineForm& W, const Vector& u0);
  bool start_from_pair(const Vector& pair, const Vector& u0);
  bool start_from_joint_set(const LineForm& X0, const LineForm& W, const Vector& u0);
  [[noreturn]] void fail(const std::string& pointer, const std::string& message,
                         const std::string& suggestion) const;

  SimulateSpec spec_;
  std::string file_;
  bool modes_;
  FaultTimeline timeline_;
  Regime nominal_;
  Index acting_ = -1;            ///< the fault that acts, -1: none
  std::optional<Regime> fault_;  ///< of that fault
  InputSource inputs_;
  AdditiveFaultSource additive_;
  Draw first_;  ///< of k = 0
  std::int64_t k_ = 0;
};

}  // namespace cordon::detail
