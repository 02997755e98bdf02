// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated data from a plant that is not the study's model.
#pragma once

#include <string>

#include "cordon/study/data.hpp"
#include "study/data/draws.hpp"

namespace cordon::detail {

/// Samples k = 0 … steps of x⁺ = next(k, x, diag(f) u), y = diag(g) output(k, x, diag(f) u) + Dv v,
/// with the true state and mode. f, g, Dv and V are those of the fault that acts at k; without one
/// f = g = 1. It starts in x0, in a point of x0_set, or in the centre of X0. Throws InputError:
/// sizes, unbounded V, a state that is not finite; Errc::plugin where the plant throws or returns
/// another size.
class PlantSource final : public DataSource {
 public:
  /// `modes`: the records name the true mode.
  PlantSource(const Model& model, const SimulateSpec& spec, std::string file, bool modes = true);

  std::optional<Record> next() override;
  std::optional<std::int64_t> size() const override { return spec_.steps + 1; }

 private:
  Vector ask(const char* what, Vector (Plant::*function)(Index, VectorIn, VectorIn) const,
             std::int64_t k, const Vector& u) const;
  [[noreturn]] void fail(const std::string& pointer, const std::string& message,
                         const std::string& suggestion) const;

  SimulateSpec spec_;
  std::string file_;
  bool modes_;
  Matrix Dv_;  ///< of the nominal model
  FaultTimeline timeline_;
  DrawSource nominal_;
  Index acting_ = -1;  ///< the fault that acts, -1: none
  std::optional<DrawSource> fault_;
  InputSource inputs_;
  Vector x_;
  std::int64_t k_ = 0;
};

}  // namespace cordon::detail
