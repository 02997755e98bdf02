// SPDX-License-Identifier: GPL-3.0-or-later
// An input designer as a plugin: tries a few inputs and takes the cheapest one under which a solver
// finds no common output of two modes. Start from here and replace the search by your own. The host
// proves the answer again; nothing here has to be trusted.
#include <cordon/registry/plugin.hpp>
#include <cordon/solvers/set_questions.hpp>

namespace {

using namespace cordon;

class MyDesigner final : public InputDesigner {
 public:
  MyDesigner(const DesignerContext& context, const Params& params)
      : InputDesigner(context.bank, context.backend), horizon_(params.integer("horizon")) {}

 private:
  DesignOutcome do_design(DesignControl& control) const override {
    DesignOutcome outcome;
    outcome.horizon = horizon_;
    const Box allowed = interval_hull(bank()[bank().nominal].model.U);
    for (const double part : {0.125, 0.25, 0.5, 1.0}) {
      if (control.stop()) {
        outcome.stopped = true;
        break;
      }
      const Vector u = allowed.center() + part * allowed.radius();
      InputDesign design = judged(u.transpose().replicate(horizon_ + 1, 1));
      if (design.separates() != Answer::yes) continue;
      outcome.status = DesignStatus::feasible;  // another input may be cheaper
      outcome.best = std::move(design);
      return outcome;
    }
    outcome.reason = "none of the inputs that were tried separates the modes";
    outcome.suggestion = "allow a longer horizon";
    return outcome;  // unknown: that is no proof that there is none
  }

  InputDesign judged(const Matrix& u) const {
    InputDesign design;
    design.u = u;
    design.cost = u.cwiseAbs().sum();
    std::vector<LineForm> tubes;
    for (const Mode& mode : bank().modes) {
      tubes.push_back(outputs(mode.model, u));
      design.outputs.push_back(interval_hull(tubes.back()));
      design.empty.push_back(is_empty(tubes.back()));
    }
    for (Index i = 0; i < bank().size(); ++i) {
      for (Index j = i + 1; j < bank().size(); ++j) {
        PairSeparation pair;
        pair.i = i;
        pair.j = j;
        pair.disjoint = is_disjoint(tubes[as_size(i)], tubes[as_size(j)], &pair.why);
        design.pairs.push_back(std::move(pair));
      }
    }
    return design;
  }

  /// All (y_0, …, y_N) that the mode can show.
  static LineForm outputs(const Model& model, const Matrix& u) {
    const LinearModel& m = model.linear;
    const Index n = m.states(), p = m.outputs();
    LineForm Z = model.X0;  // (y_0, …, y_{k-1}, x_k)
    for (Index k = 0; k < u.rows(); ++k) {
      const Index known = Z.dim() - n, noises = m.noises(), disturbances = m.disturbances();
      const Vector now = u.row(k).transpose();
      const LineForm with_noise =
          cartesian_product(cartesian_product(Z, model.V), model.W);  // (y, x, v, w)
      Matrix T = Matrix::Zero(known + p + n, known + n + noises + disturbances);
      T.topLeftCorner(known, known).setIdentity();
      T.block(known, known, p, n) = m.C;
      T.block(known, known + n, p, noises) = m.Dv;
      T.block(known + p, known, n, n) = m.A;
      T.block(known + p, known + n + noises, n, disturbances) = m.Bw;
      Vector t = Vector::Zero(known + p + n);
      t.segment(known, p) = m.D * now;
      t.tail(n) = m.B * now;
      Z = affine_map(with_noise, T, t);
    }
    const Index rows = Z.dim() - n;
    return affine_map(Z, Matrix::Identity(rows, Z.dim()), Vector::Zero(rows));
  }

  Index horizon_;
};

std::vector<Diagnostic> problems_of(const DesignerContext& context, const Params&) {
  std::vector<Diagnostic> problems;
  for (const Mode& mode : context.bank.modes) {
    if (mode.model.linear.is_descriptor())
      problems.push_back({"", "takes systems without E", "use the designer \"facets\""});
  }
  const Box allowed = interval_hull(context.bank[context.bank.nominal].model.U);
  if (!allowed.is_bounded())
    problems.push_back({"", "the inputs are not bounded", "give /system/U"});
  return problems;
}

void register_components(Registrar& registrar) {
  ParamSchema schema;
  schema.integer("horizon", "N: inputs u_0 … u_N, outputs y_0 … y_N", 4, 1, 100);
  registrar.add(DesignerEntry{
      {"my_designer", "tries a few inputs", "", schema},
      problems_of,
      [](const DesignerContext& context, const Params& params) -> std::unique_ptr<InputDesigner> {
        return std::make_unique<MyDesigner>(context, params);
      }});
}

}  // namespace

CORDON_PLUGIN("my_designer", "0.1.0", "GPL-3.0-or-later", "A. Uthor", "an input designer of my own",
              register_components)
