// SPDX-License-Identifier: GPL-3.0-or-later
// Gains are what their certificates say.
#include <cmath>
#include <complex>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/exact_modes.hpp"
#include "making.hpp"

namespace cordon::conformance {

namespace {

struct GainTrial {
  Model model;
  Params params;
  std::shared_ptr<const GainDesigner> designer;
  GainDesign design;

  Verdict fails(const std::string& message) const {
    Verdict verdict = Verdict::fails(message);
    if (design.feasible == Answer::yes) verdict.derived.emplace_back("L", describe(design.gain.L));
    verdict.derived.emplace_back("params", describe(params));
    return verdict;
  }
};

TestCase gain_case(const Setting& s) {
  SystemShape shape;
  shape.samples = 2;
  return system_case(s, shape);
}

GainTrial gain_trial(const Context& context, const TestCase& test) {
  GainTrial trial{model_of(test), {}, nullptr, {}};
  const Registry& registry = context.registry();
  const std::string& name = context.subject.component;
  ParameterDraw draw(context, test, registry.info("gain", name)->schema);
  trial.params = draw.find([&](const Params& params) {
    return registry.check<GainEntry>(name, GainContext{trial.model}, params);
  });
  trial.designer = registry.make<GainEntry>(name, trial.params);
  trial.design = trial.designer->design(trial.model);
  return trial;
}

Verdict check_design(const Context& context, const TestCase& test) {
  const GainTrial trial = gain_trial(context, test);
  const LinearModel& m = trial.model.linear;
  if (trial.design.feasible != Answer::yes) {
    if (trial.design.reason.empty()) return trial.fails("there is no gain, and no reason is told");
    return Verdict::inapplicable();
  }
  const Matrix& L = trial.design.gain.L;
  if (L.rows() != m.states() || L.cols() != m.outputs())
    return trial.fails("the gain is " + std::to_string(L.rows()) + "×" + std::to_string(L.cols()));
  if (!L.allFinite()) return trial.fails("the gain is not finite");
  if (!exact::is_schur(m.A, L, m.C))
    return trial.fails("A - L C is not stable, in exact arithmetic");
  return {};
}

double largest_eigenvalue(const Matrix& A) {
  double most = 0;
  for (const std::complex<double>& value : linalg::eigenvalues(A))
    most = std::max(most, std::abs(value));
  return most;
}

Verdict check_certificate(const Context& context, const TestCase& test) {
  const GainTrial trial = gain_trial(context, test);
  if (trial.design.feasible != Answer::yes) return Verdict::inapplicable();
  const LinearModel& m = trial.model.linear;
  const Matrix& L = trial.design.gain.L;
  const GainCertificate& c = trial.design.gain.certificate;
  const Matrix closed = m.A - L * m.C;
  if (!std::isnan(c.spectral_radius)) {
    const double radius = largest_eigenvalue(closed);
    // of a defective matrix eigenvalues are known to a root of roundoff only
    if (!(c.spectral_radius >= radius - 1e-5 * (1 + radius)))
      return trial.fails("the spectral radius is " + describe(radius) + ", told to be at most " +
                         describe(c.spectral_radius));
  }
  const bool monotone = exact::is_nonnegative(m.A, L, m.C);
  if (c.monotone != Answer::unknown && (c.monotone == Answer::yes) != monotone)
    return trial.fails(std::string("A - L C ≥ 0 is told to be ") +
                       std::string(to_string(c.monotone)) + ", which is wrong");
  if (c.norm_lower > c.norm_upper) return trial.fails("the norm's bounds are in the wrong order");
  if (std::isnan(c.norm_upper)) return {};
  const Matrix inputs = [&] {
    const Matrix BG = m.Bw * trial.model.W.G, DG = L * m.Dv * trial.model.V.G;
    Matrix all(m.states(), BG.cols() + DG.cols());
    all << BG, -DG;
    return all;
  }();
  double reached = 0;  // the largest singular value of G on a grid of the circle
  for (int k = 0; k <= 400; ++k) {
    const double angle = 3.14159265358979323846 * k / 400;
    const Index n = m.states();
    // (zI - F)⁻¹ B as the real matrix of twice the size
    Matrix Z(2 * n, 2 * n), B = Matrix::Zero(2 * n, 2 * inputs.cols());
    const Matrix I = Matrix::Identity(n, n);
    Z << std::cos(angle) * I - closed, -std::sin(angle) * I, std::sin(angle) * I,
        std::cos(angle) * I - closed;
    B.topLeftCorner(n, inputs.cols()) = inputs;
    B.bottomRightCorner(n, inputs.cols()) = inputs;
    if (B.cols() == 0) break;
    reached = std::max(reached, linalg::svd(linalg::pseudo_inverse(Z, 1e-15) * B).sigma[0]);
  }
  if (reached > c.norm_upper * (1 + 1e-6) + 1e-12)
    return trial.fails("the norm is " + describe(reached) + " at least, told to be at most " +
                       describe(c.norm_upper));
  return {};
}

Verdict check_gain_units(const Context& context, const TestCase& test) {
  const GainTrial trial = gain_trial(context, test);
  Random random(seed_of(test.seed, "gain units", 0));
  Model other = trial.model;
  LinearModel& m = other.linear;
  for (Index i = 0; i < m.states(); ++i) {
    const double s = std::exp2(random.between(-4, 4));
    m.A.row(i) *= s;
    m.A.col(i) /= s;
    m.B.row(i) *= s;
    m.Bw.row(i) *= s;
    m.C.col(i) /= s;
    other.X0.c[i] *= s;
    other.X0.G.row(i) *= s;
  }
  for (Index i = 0; i < m.outputs(); ++i) {
    const double s = std::exp2(random.between(-4, 4));
    m.C.row(i) *= s;
    m.D.row(i) *= s;
    m.Dv.row(i) *= s;
  }
  const auto problems = context.registry().check<GainEntry>(context.subject.component,
                                                            GainContext{other}, trial.params);
  if (!problems.empty()) return Verdict::inapplicable();
  const GainDesign design = trial.designer->design(other);
  const Answer one = trial.design.feasible, two = design.feasible;
  if (one != Answer::unknown && two != Answer::unknown && one != two)
    return trial.fails("there is a gain in one unit, and proven to be none in another: " +
                       trial.design.reason + design.reason);
  if (two == Answer::yes && !exact::is_schur(m.A, design.gain.L, m.C))
    return trial.fails("in other units A - L C is not stable, in exact arithmetic");
  return {};
}

Verdict check_gain_repeats(const Context& context, const TestCase& test) {
  const GainTrial trial = gain_trial(context, test);
  const GainDesign again = trial.designer->design(trial.model);
  if (again.feasible != trial.design.feasible)
    return trial.fails(
        "the same design is feasible: " + std::string(to_string(trial.design.feasible)) +
        ", then " + std::string(to_string(again.feasible)));
  if (again.feasible == Answer::yes && again.gain.L != trial.design.gain.L)
    return trial.fails("the same design gives another gain: " + describe(again.gain.L));
  return {};
}

Verdict check_gain_update(const Context& context, const TestCase& test) {
  const GainTrial trial = gain_trial(context, test);
  if (!trial.designer->is_time_varying() || trial.design.feasible != Answer::yes)
    return Verdict::inapplicable();
  const Matrix R = trial.model.X0.G, P = R * R.transpose();
  const Matrix L = trial.designer->update(trial.model, P);
  if (L != trial.designer->update(trial.model, P))
    return trial.fails("the gain for one covariation is not the same twice");
  return {};
}

}  // namespace

void add_gains(LawList& list) {
  const std::string kind = "gain";
  list.push_back(law_of(kind, "gain.stable",
                        "a gain makes A - L C stable, in exact arithmetic; if there is none, the "
                        "reason is told",
                        gain_case, check_design, 0.2));
  list.push_back(law_of(kind, "gain.certificate",
                        "spectral radius, norm and signs of A - L C are what the certificate says",
                        gain_case, check_certificate, 0.15));
  list.push_back(law_of(kind, "gain.units",
                        "in other units a gain is stable, and answers do not contradict each other",
                        gain_case, check_gain_units, 0.15));
  list.push_back(law_of(kind, "gain.repeats", "the same design gives the same bits", gain_case,
                        check_gain_repeats, 0.05));
  list.push_back(law_of(kind, "gain.update",
                        "a gain that varies in time has one value for each covariation", gain_case,
                        check_gain_update, 0.05));
}

}  // namespace cordon::conformance
