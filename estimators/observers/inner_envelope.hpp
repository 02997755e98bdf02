// SPDX-License-Identifier: GPL-3.0-or-later
// What an observer's enclosure costs: the reach of its own recursion for matrices that are constant
// in time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cordon/interfaces/archive.hpp"
#include "cordon/registry/plugin.hpp"

namespace cordon::estimators {

/// An observer of x⁺ = (A + ΔA) x + (B + ΔB) u + Bw w, y = (C + ΔC) x + D u + Dv v with the gain L
/// has to enclose every
///   x̂⁺ = A* x̂ + (B + ΔB - L D) u + L y + Bw w - L Dv v,   A* = A + ΔA - L (C + ΔC),
/// for the y that were measured. For one constant θ = (ΔA, ΔB, ΔC) these x̂_k fill a zonotope, whose
/// hull is
///   c_k ± (|A*ᵏ G0| 1 + Σ_{j<k} |A*ʲ [Bw G_W, -L Dv G_V]| 1);
/// the envelope is the hull of those for the centre, both ends and random θ. Effectiveness that is
/// known by ranges stays at its middle. Nominal rounding. O(n³) per θ and step. [Pourasghar2021,
/// (37)-(38)]
class InnerEnvelope {
 public:
  /// inner_samples and inner_seed.
  static void add_parameters(ParamSchema& schema);
  /// A problem if X0, W or V, of which it needs the generators, has constraints or lines.
  static void check(const ObserverContext& context, const Params& params,
                    std::vector<Diagnostic>& problems);

  /// Off if inner_samples is 0. Models without E.
  InnerEnvelope(const Model& model, const Matrix& L, const Params& params);

  bool is_on() const { return !copies_.empty(); }
  /// Begins with this set; ends if it has lines or constraints.
  void start(const LineForm& X0);
  void end() { running_ = false; }
  /// Moves on by the sample of the time that it stands at; ends if that lacks an output.
  void step(const Sample& before);
  /// The hull of all x̂_k, which exceeds that of the estimate by rounding only; nothing if it has
  /// ended.
  std::optional<Box> hull() const;
  void serialize(Archive& archive);

 private:
  struct Copy {
    Matrix A, B;   ///< A* and (B + ΔB - L D̄) f̄
    Matrix power;  ///< A*ᵏ
    Vector center;
    Vector noise;  ///< Σ |A*ʲ …| 1
  };
  void add(const Model& model, const Matrix& L, const Matrix& dA, const Matrix& dB,
           const Matrix& dC);

  Matrix L_, G0_, noises_;
  Vector drift_;
  std::vector<Copy> copies_;
  bool running_ = false;
};

}  // namespace cordon::estimators
