// SPDX-License-Identifier: GPL-3.0-or-later
// Five observers by zonotopes, linearisation at the centre and strips, as they are compared in
// [Holzinger2026]: without boxes, contraction or certified hulls.
//   Lin(<c,G>):  f(c + G ξ) ∈ f(c) + A G ξ + <c_e, G_e>, A = ∂f/∂x (c); with G_r ⊇ G of n columns,
//     r = |G|1, [H_q] ⊇ ∂²f_q over c ± r and M_q = G_rᵀ mid(H_q) G_r:
//     c_e = (¼ tr M_q)_q, G_e = [(¼ M_q,jj)_q, (½ (M_q,jl + M_q,lj))_q (j < l), diag(½ rᵀ rad(H_q)
//     r)]
//   frad_a, vol_min_a, vol_min_b:  R⁺ = strips(PCA(<f(c) + c_e, [A G, G_e]>) ⊕ W, y⁺), row by row
//     c ← c + λ (y_i - C_i c), G ← [(I - λ C_i) G, σ_i λ]
//     frad_a:     λ = G Gᵀ C_iᵀ / (C_i G Gᵀ C_iᵀ + σ_i²), least F-radius            [Alamo2005]
//     vol_min_a:  λ of least volume, by a linear program over subsets of columns     [Alamo2005]
//     vol_min_b:  one column is replaced by the strip's, of least det G Gᵀ           [Bravo2006]
//   frad_b:  one gain for all outputs, Λ = R Cᵀ (C R Cᵀ + G_V G_Vᵀ)⁻¹, R = A G Gᵀ Aᵀ + G_W G_Wᵀ
//   frad_c:  R⁺ = PCA(<f(c) + L (y - C c) + c_e, [(A - L C) G, -L G_V, G_e, G_W]>),
//     L = A G Gᵀ Cᵀ (C G Gᵀ Cᵀ + G_V G_Vᵀ)⁻¹: predictions, X0 first                 [Combastel2015]
// Unlike there disturbances may enter in any way (they are columns of z = (x, w), and of H),
// outputs too (C and σ are of an affine form over the hull), V need not be centred, and what f(c),
// A and roundings leave out is enclosed. In double arithmetic, up to its rounding errors
// ("nominal").
#pragma once

#include "cordon/formulas/evaluator.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/model.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "observers/nonlinear/affine_rows.hpp"

namespace cordon::estimators {

enum class StripVariant { frad_a, frad_b, frad_c, vol_min_a, vol_min_b };

class StripRecursion {
 public:
  /// `generators`: of estimates and of the set of errors, at most.
  StripRecursion(const Model& model, StripVariant variant, Index generators);

  void start(const LineForm& X0);  ///< a zonotope
  /// From the sample `before` to the next time. Throws Errc::not_enclosed.
  void predict(const Sample& before);
  /// False: a strip is proven to miss the set.
  bool correct(const Sample& now);

  void serialize(Archive& archive);

  const Vector& center() const { return c_; }
  const Matrix& generators() const { return G_; }

 private:
  struct Linearised {
    Vector value;   ///< f(c) + c_e
    Matrix A, Bw;   ///< slopes by x and by w
    Matrix errors;  ///< G_e
  };
  void evaluate(const std::vector<Interval>& variables, Index k);
  Linearised linearised(VectorIn u, Index k);
  Matrix error_columns(Vector& center) const;
  AffineRows outputs(const Sample& now);
  bool strip(double y, const Eigen::RowVectorXd& C, double sigma);
  Vector gain(const Eigen::RowVectorXd& C, double sigma) const;
  void replace_column(double y, const Eigen::RowVectorXd& C, double sigma);
  bool all_strips(const Sample& now, const AffineRows& form);
  void correct_prediction(const Sample& before, const Linearised& f, Vector& value, Matrix& A,
                          Matrix& noise);
  Vector radius() const { return G_.cwiseAbs().rowwise().sum(); }

  std::shared_ptr<const NonlinearModel> model_;
  StripVariant variant_;
  Index most_;
  formulas::Evaluator f_;
  formulas::BoxEnclosure g_;
  LineForm W_, V_;
  Vector c_;
  Matrix G_;
};

/// Principal components: of more than `most` columns those that are smallest, by ‖g‖₁ - ‖g‖∞, are
/// replaced by U diag(|Uᵀ G|1), U their left singular vectors; zero columns are left out. most ≥ n.
Matrix reduced_by_components(const Matrix& G, Index most);

}  // namespace cordon::estimators
