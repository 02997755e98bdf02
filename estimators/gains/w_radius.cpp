// SPDX-License-Identifier: GPL-3.0-or-later
// The gain with the smallest invariant ellipsoid of the errors for a given rate of contraction.
#include <cmath>

#include "components.hpp"
#include "cordon/core/linalg.hpp"
#include "gains/detectability.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/lmi.hpp"
#include "gains/theta.hpp"

namespace cordon::estimators {

namespace {

constexpr const char* w_radius_details =
    R"(The W-radius of a zonotope of errors is max eᵀWe over its elements. It obeys ι⁺ ≤ ρ ι + 1 - ρ for
the errors e⁺ = (A - L C) e + Eθ θ + Bw w - L Dv v if there are W = Wᵀ, Y and diagonal Γ, Υ and Ω
with

  [ ρW        *         *          *     *  ]
  [ 0         Γ         *          *     *  ]
  [ 0         0         Υ          *     *  ]  ⪰ 0,   tr Γ + tr Υ + tr Ω ≤ 1 - ρ,   W ⪰ τI,
  [ 0         0         0          Ω     *  ]
  [ WA - YC   W Bw G_W  -Y Dv G_V  W Eθ  W  ]

and then L = W⁻¹Y. τ is maximised: the errors stay in the ellipsoid eᵀWe ≤ 1 once they are there,
whose longest half axis is 1/√τ at most, and come to it by a factor ρ per step (of eᵀWe), if the
solution satisfies the inequality (its `margin` is not negative). G_W and
G_V are the generators of zonotopes around W and V, C is taken with the middle of the sensors'
effectiveness.

Theorem 3.5 of the paper leaves ε free where 1 - ρ stands here, and asks for no least W: any
solution may then be divided by any number, and says nothing about the size. ρ is the caller's:
near 1 for slow plants, whose modes that do not show in the outputs must decay faster than √ρ.

For observers that correct a predicted set ("gain_correction") C A stands for C, and the columns of
Bw G_W, Eθ and Dv G_V become W Bw G_W - Y C Bw G_W, W Eθ - Y C Eθ and -Y Dv G_V.
)";

struct WRadiusProgram {
  MatrixVariable W, Y;
  SemidefiniteProgram program;
};

WRadiusProgram w_radius_program(const ErrorDynamics& errors, double rho) {
  const Index n = errors.A.rows(), disturbances = errors.E.cols();
  WRadiusProgram design;
  design.W = symmetric_variable(0, n);
  design.Y = full_variable(design.W.end(), n, errors.C.rows());
  const MatrixVariable for_d = diagonal_variable(design.Y.end(), disturbances);
  const MatrixVariable tau{for_d.end(), {Matrix::Identity(n, n)}};
  const Matrix I = Matrix::Identity(n, n);
  // Row and column of the last block first, which changes nothing.
  BlockInequality contraction({n, n, disturbances});
  contraction.add(0, 0, design.W, I);
  contraction.add(0, 1, design.W, errors.A);
  contraction.add(0, 1, design.Y, -errors.C);
  contraction.add(0, 2, design.W, errors.E);
  contraction.add(0, 2, design.Y, -errors.N);
  contraction.add(1, 1, design.W, rho * I);
  contraction.add(2, 2, for_d, Matrix::Identity(disturbances, disturbances));
  BlockInequality size({n});
  size.add(0, 0, design.W, I);
  size.add(0, 0, tau, -I);
  MatrixInequality trace{Matrix::Constant(1, 1, 1 - rho), {}};
  for (Index i = for_d.first; i < for_d.end(); ++i)
    trace.terms.emplace_back(i, Matrix::Constant(1, 1, -1));
  design.program.cost = -Vector::Unit(tau.end(), tau.first);
  design.program.inequalities = {std::move(contraction).finish(), std::move(size).finish(),
                                 std::move(trace)};
  return design;
}

class WRadiusGain final : public FormedDesigner {
 public:
  WRadiusGain(std::optional<Matrix> theta, double rho) : theta_(std::move(theta)), rho_(rho) {}

 private:
  GainDesign do_design(const Model& model, GainForm form) const override {
    const Matrix theta = theta_of(model, theta_);
    const ErrorDynamics errors = error_dynamics(model, theta, form);
    if (std::optional<GainDesign> none = without_gain(model, errors)) return std::move(*none);
    if (const auto slow = undetectable_mode(errors.A, shown_outputs(model.linear), rho_)) {
      const std::string none =
          slow->gain_exists == Answer::no ? "no gain contracts by rho: " : "no gain was sought: ";
      return no_gain(slow->gain_exists, none + slow->reason + " and decays slower than √rho",
                     "a larger rho");
    }
    const WRadiusProgram program = w_radius_program(errors, rho_);
    const SdpSolution s = solve(program.program, {1e-8});
    if (s.status != SdpStatus::solved) return unsolved(s);
    const std::optional<Matrix> L = linalg::solve_spd(program.W.value(s.x), program.Y.value(s.x));
    if (!L)
      return no_gain(Answer::unknown, "the matrix W of the solution is not positive definite",
                     "a larger rho");
    if (const std::string problem = gain_problem(model, *L, form); !problem.empty()) {
      return no_gain(Answer::unknown, "the gain of the matrix inequality " + problem,
                     "a larger rho");
    }
    GainDesign design;
    design.feasible = Answer::yes;
    design.gain.L = *L;
    GainCertificate& c = design.gain.certificate;
    c = certify(model, *L, theta, form);
    c.objective = "τ";
    // In the units of E and N, which were divided by `unit`, errors are smaller by it, and W larger
    // by its square.
    c.optimum = -s.value / (errors.unit * errors.unit);
    c.optimum_bound = -s.bound / (errors.unit * errors.unit);
    c.margin = s.least_eigenvalue[0];
    return design;
  }

  std::optional<Matrix> theta_;
  double rho_;
};

}  // namespace

CORDON_COMPONENT(gain, w_radius) {
  ParamSchema schema;
  add_theta_parameter(schema);
  schema.real("rho",
              "ρ, factor by which the W-radius of the errors shrinks in a step at least, but for "
              "what the disturbances add",
              .9, 1e-6, 1 - 1e-6);
  registrar.add(
      GainEntry{{"w_radius",
                 "the smallest ellipsoid that holds the errors for a given contraction, by a "
                 "linear matrix inequality",
                 "Pourasghar2021", std::move(schema), w_radius_details},
                check_design,
                [](const Params& params) {
                  return std::make_unique<WRadiusGain>(theta_from(params), params.real("rho"));
                }});
}

}  // namespace cordon::estimators
