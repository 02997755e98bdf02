// SPDX-License-Identifier: GPL-3.0-or-later
// Models in continuous time as models from sample to sample.
#pragma once

#include <memory>

#include "cordon/interfaces/model.hpp"

namespace cordon::sampling {

/// How a disturbance moves between two samples.
enum class DisturbanceSignal {
  any,  ///< as it likes, with values in its set
  held  ///< constant from sample to sample, as inputs are
};

inline constexpr Index max_states = 100;  ///< of a model that is sampled

/// What becomes of matrices.
enum class Matrices {
  doubles,  ///< those next to the exact values are the model
  enclosed  ///< centre and radius hold all that is meant, the rounding of the centre included
};

/// Of ẋ = A x + B u + Bw w, known by intervals or exactly, over a time h > 0, with u held. What is
/// told by centre and radius encloses what is meant; the parameters may change within their
/// intervals at any time.
///
/// Throws Errc::invalid where e^{A h} is not finite in doubles, or where its numbers differ in size
/// by so much that 50 digits do not carry the last one.
class Sampling {
 public:
  /// `matrices`: of an uncertain model they are enclosed in any case.
  Sampling(const LinearModel& continuous, double h, DisturbanceSignal disturbance,
           Matrices matrices = Matrices::doubles);
  ~Sampling();

  DisturbanceSignal disturbance() const { return disturbance_; }
  bool encloses_matrices() const { return uncertain_; }
  /// Can disturbances keep their matrix? Else they become a set in the state's coordinates, and
  /// their matrix the identity.
  bool keeps_matrices() const { return disturbance_ == DisturbanceSignal::held && !uncertain_; }

  IntervalMatrix transition() const;  ///< e^{A h}
  /// ∫₀ʰ e^{A s} ds B, |B - center| ≤ radius (0×0: exact).
  IntervalMatrix integral(const Matrix& B, const Matrix& radius = {}) const;
  /// The same of an exact model and matrix in doubles: next to the exact values or one beside them,
  /// or within 1e-30 of the largest.
  Matrix nearest_integral(const Matrix& B) const;
  /// Encloses {∫₀ʰ e^{A (h-s)} B w(s) ds}, w(s) ∈ W for all s; of held w all are one. W has no
  /// lines, and may have constraints.
  ///
  /// Of any signal, it is the sum of the pieces of a division of [0, h], on each of which e^{A s} B
  /// is linear up to its curvature. The support function of a linear one's integral is not above
  /// the trapezoid of those at its ends, so that half a piece's length times either end's image of
  /// W enclose it; a box holds what curvature and rounding add. Pieces are divided until either
  /// excess is 2 % of the whole, 64 at most.
  LineForm disturbances(const Matrix& B, const LineForm& W) const;
  /// Is it divided so far that neither excess is above 2 %? It is not where the state turns many
  /// times within h. Of held w there is nothing to divide.
  bool is_fine(const Matrix& B, const LineForm& W) const;

 private:
  struct Enclosures;
  DisturbanceSignal disturbance_;
  bool uncertain_;
  std::unique_ptr<const Enclosures> enclosures_;
};

/// The model from sample to sample: A, B, F, the radii, and Bw and W. C, D, Dv, V, X0, U stay.
/// Matrices are doubles as by `nearest_integral`, or enclosed; then there is no F.
Model sampled(const Model& continuous, const Sampling& sampling);

}  // namespace cordon::sampling
