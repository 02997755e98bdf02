// SPDX-License-Identifier: GPL-3.0-or-later
// What the gain of an observer acts on: its prediction of the next state, or its estimate of this
// one. With C̄ = mid(g) C, and zonotopes with the shapes G_W and G_V around W and V:
//   predictor   x̂⁺ = A x̂ + … + L (y - C̄ x̂),               e⁺ = (A - L C̄) e + …
//   filter      x̂⁺ = x̄ + L (y⁺ - C̄ x̄),  x̄ = A x̂ + …,      e⁺ = (A - L C̄ A) e + …
// Either is given by four matrices and one disturbance d in a unit box,
//   e⁺ = (A - L 𝒞) e + (ℰ - L 𝒩) d,
//   predictor   𝒞 = C̄,     ℰ = [Eθ  Bw G_W  0],   𝒩 = [0      0          Dv G_V]
//   filter      𝒞 = C̄ A,   ℰ = [Eθ  Bw G_W  0],   𝒩 = [C̄ Eθ   C̄ Bw G_W   Dv G_V]
// and a designer needs to know no more. (A, C̄ A) is detectable if and only if (A, C̄) is:
// eigenvalues 0 do not count.
#pragma once

#include "cordon/interfaces/gain_designer.hpp"

namespace cordon::estimators {

enum class GainForm { predictor, filter };

/// A matrix as computed, and by how much its entries may be off.
struct Rounded {
  Matrix value, error;
};

/// 𝒞.
Rounded shown_errors(const LinearModel& model, GainForm form);

/// ℰ and 𝒩; `theta` is Eθ (n rows, or 0×0 for none). Errors of W and V that no zonotope encloses.
struct ErrorDisturbances {
  Rounded E, N;
};
ErrorDisturbances error_disturbances(const Model& model, const Matrix& theta, GainForm form);

/// A - L 𝒞, or in words: "A - L C", "(I - L C) A".
const char* name_of_loop(GainForm form);

/// A designer that knows both forms; to whoever asks through the public interface, the predictor's.
class FormedDesigner : public GainDesigner {
 public:
  using GainDesigner::design;
  GainDesign design(const Model& model, GainForm form) const { return do_design(model, form); }

 private:
  GainDesign do_design(const Model& model) const final {
    return do_design(model, GainForm::predictor);
  }
  virtual GainDesign do_design(const Model& model, GainForm form) const = 0;
};

}  // namespace cordon::estimators
