// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes around all errors of an observer with one gain, which is never reduced. With E = Bw G_W, F
// = Dv G_V and zonotopes around X0, W and V:
//   previous   x⁺ = A x + B u + L (y - D u - C x),            M = A - L C,       D = [E, -L F]
//   current    x⁺ = x̄ + Λ (y⁺ - D u⁺ - C x̄),  x̄ = A x + B u,  M = (I - Λ C) A,   D = [(I - Λ C) E,
//   -Λ F]
// and the estimate is x ± h with the half widths h of error_widths.hpp, which depend on which
// outputs are there, and not on what they are. Where some are missing M and D are those of the
// others, and what x is off by by then joins the errors.
#include <cmath>
#include <optional>
#include <utility>

#include "components.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/rounded_products.hpp"
#include "observer_parameters.hpp"
#include "observers/at_rest.hpp"
#include "observers/error_widths.hpp"
#include "observers/observer_gain.hpp"
#include "observers/present_outputs.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

namespace {

/// x⁺ = rows z + w for what is known, z = (x, u_before, y, u_now), and the sizes of these numbers
/// before they were multiplied with each other.
struct PointStep {
  PointStep() = default;
  PointStep(const Matrix& X, const Matrix& U, const Matrix& Y, const Matrix& V, Vector constant)
      : rows(X.rows(), X.cols() + U.cols() + Y.cols() + V.cols()), w(std::move(constant)) {
    rows << X, U, Y, V;
  }

  Matrix rows;
  Vector w;
};

/// One step of the centre and of the errors, for the outputs of a model.
struct ErrorStep {
  ErrorStep(const Model& model, const Matrix& L, GainForm form);

  PointStep point, sizes;
  Rounded M, D;
};

ErrorStep::ErrorStep(const Model& model, const Matrix& L, GainForm form) {
  const LinearModel& m = model.linear;
  const auto size = [](const auto& A) { return Matrix(A.cwiseAbs()); };
  const Vector w = m.Bw * invariant::enclosing_zonotope(model.W).c,
               v = m.Dv * invariant::enclosing_zonotope(model.V).c;
  const Vector w_size = size(m.Bw) * invariant::enclosing_zonotope(model.W).c.cwiseAbs(),
               v_size = size(m.Dv) * invariant::enclosing_zonotope(model.V).c.cwiseAbs();
  const invariant::ClosedLoop loop = loop_of_errors(m, L, form);
  M = {loop.value, loop.error};
  const ErrorDisturbances d = error_disturbances(model, Matrix(0, 0), form);
  D = less(d.E, times(L, d.N));
  const Matrix LD = linalg::product(L, m.D), LD_size = size(L) * size(m.D);
  if (form == GainForm::predictor) {
    const Matrix none = Matrix::Zero(m.states(), m.inputs());
    point = {loop.value, m.B - LD, L, none, w - L * v};
    sizes = {size(m.A) + size(L) * size(m.C), size(m.B) + LD_size, size(L), none,
             w_size + size(L) * v_size};
    return;
  }
  const Matrix unit = Matrix::Identity(m.states(), m.states()),
               rest = unit - linalg::product(L, m.C), rest_size = unit + size(L) * size(m.C);
  point = {loop.value, linalg::product(rest, m.B), L, -LD, rest * w - L * v};
  sizes = {rest_size * size(m.A), rest_size * size(m.B), size(L), LD_size,
           rest_size * w_size + size(L) * v_size};
}

class ErrorHullObserver final : public Observer {
 public:
  ErrorHullObserver(const ObserverContext& context, const Params& params, ObserverGain gain,
                    GainForm form)
      : Observer(context.model, context.backend),
        X0_(initial_set_from(model(), params)),
        gain_(std::move(gain.gain)),
        form_(form),
        complete_(model(), gain_.L, form),
        share_(rounding::gamma(8 * (model().states() + model().inputs() + model().outputs() +
                                    model().disturbances() + model().noises()) +
                               32)),
        widths_(complete_.M, complete_.D),
        off_(widths_.memory()),
        before_{{}, 0, {}, off_, {}} {}

  LineForm initial_set() const override { return X0_; }
  std::vector<Gain> gains() const override { return {gain_}; }
  bool takes_missing_outputs() const override { return true; }
  bool uses_outputs_of_its_time() const override { return form_ == GainForm::filter; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    replaced_.reset();
    before_.estimate = {};
    return told(first.k, begun(X0, first));
  }

  Enclosure begun(const std::optional<Enclosure>& X0, const Sample& first) {
    const sets::Zonotope start =
        invariant::enclosing_zonotope(X0 ? (*X0)->line_form() : X0_, "the initial set");
    off_.start();
    x_ = start.c;
    if (form_ == GainForm::predictor) {
      widths_.start(exactly(start.G));
      return estimate();
    }
    const std::vector<Index> present = present_outputs(first);
    const ErrorStep step(with_outputs(at_rest(model()), present), gain_.L(Eigen::all, present),
                         form_);
    off_.step(moved(step, Vector::Zero(first.u.size()), first));
    const Rounded rest = estimators::times(step.M.value, exactly(start.G));
    const Matrix lost = linalg::product(step.M.error, start.G.cwiseAbs());
    Rounded R = exactly(Matrix(x_.size(), rest.value.cols() + step.D.value.cols()));
    R.value << rest.value, step.D.value;
    R.error << rest.error + 2 * lost, step.D.error;
    widths_.start(R);
    return estimate();
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    if (replaced_) {
      go_on_from(*replaced_, before.k);
      replaced_.reset();
    }
    before_.estimate = last_;
    before_.k = k_;
    before_.x = x_;
    before_.off = off_;
    widths_.keep(before_.widths);
    return told(now.k, stepped(before, now));
  }

  Enclosure stepped(const Sample& before, const Sample& now) {
    return timed(Phase::predict, [&] {
      const Sample& used = form_ == GainForm::filter ? now : before;
      if (used.is_complete()) {
        off_.step(moved(complete_, before.u, used));
        widths_.step();
        return estimate();
      }
      const auto others = others_.at(used, [&](const std::vector<Index>& present) {
        return std::make_shared<ErrorStep>(with_outputs(model(), present),
                                           gain_.L(Eigen::all, present), form_);
      });
      widths_.step_by(others->M, others->D, off_.bound());
      off_.start();
      off_.step(moved(*others, before.u, used));
      return estimate();
    });
  }

  const Enclosure& told(Index k, Enclosure estimate) {
    last_ = std::move(estimate);
    k_ = k;
    return last_;
  }

  void do_replace(const Enclosure& X) override {
    const Box hull = X->interval_hull();
    if (hull.is_empty()) return;  // of nothing every box is an enclosure
    if (!hull.is_bounded())
      throw Error(Errc::unsupported, "\"error_hull\" goes on from bounded sets only");
    replaced_ = X;
  }

  void do_serialize(Archive& archive) override {
    const Index n = model().states();
    archive.set(last_, n);
    serialize_time(archive, k_);
    archive(x_, off_, widths_);
    serialize_set(archive, replaced_, n);
    bool has_before = before_.estimate.set != nullptr;
    archive(has_before);
    if (archive.is_reading()) before_ = {{}, 0, {}, widths_.memory(), {}};
    if (has_before) {
      archive.set(before_.estimate, n);
      serialize_time(archive, before_.k);
      archive(before_.x, before_.off);
      widths_.serialize(before_.widths, archive);
    }
    if (x_.size() != n || (has_before && before_.x.size() != n))
      archive.refuse("a centre of another size");
  }

  /// An estimate of its own at time k is gone back to with all that was known then, by which errors
  /// keep the directions in which they decay. Of any other set the box is all that is known.
  void go_on_from(const Enclosure& X, Index k) {
    if (X.set == last_.set && k_ == k) return;
    if (X.set == before_.estimate.set && before_.k == k) {
      x_ = before_.x;
      off_ = before_.off;
      widths_.go_back(before_.widths);
    } else {
      const Box hull = X->interval_hull();
      x_ = hull.center();
      const Matrix half = Vector((hull.upper - x_).cwiseMax(x_ - hull.lower)).asDiagonal();
      off_.start();
      widths_.start({half, 4 * rounding::unit * half});
    }
    told(k, X);
  }

  /// Moves x to the next time; by how much rounding can have moved it.
  const Vector& moved(const ErrorStep& step, VectorIn u_before, const Sample& used) {
    known_.resize(step.point.rows.cols());
    if (used.is_complete()) {
      known_ << x_, u_before, used.y, used.u;
    } else {
      known_ << x_, u_before, without_missing(used).y, used.u;
    }
    x_ = step.point.w;
    moved_ = step.sizes.w;
    for (Index j = 0; j < known_.size(); ++j) {
      const double z = known_[j], size = std::abs(z);
      for (Index i = 0; i < x_.size(); ++i) {
        x_[i] += step.point.rows(i, j) * z;
        moved_[i] += step.sizes.rows(i, j) * size;
      }
    }
    moved_ *= 2 * share_;
    return moved_;
  }

  Enclosure estimate() {
    widths_.take_half_widths(half_);
    off_.add_bound(half_);
    if (!half_.allFinite())
      throw Error(
          Errc::not_finite,
          "the errors of \"error_hull\" have grown beyond all numbers: outputs were missing "
          "for too long without which they do not decay; start it anew from a bounded set");
    half_ += 4 * rounding::unit * (half_ + x_.cwiseAbs());
    box_.lower = x_ - half_;
    box_.upper = x_ + half_;
    Enclosure box = backend().box(box_);
    box.tightness = Tightness::outer;
    return box;
  }

  LineForm X0_;
  Gain gain_;
  GainForm form_;
  ErrorStep complete_;
  PerOutputs<ErrorStep> others_;
  double share_;
  Vector x_;
  Vector known_, moved_, half_;  ///< of the last step; their memory is used again
  Box box_;
  ErrorWidths widths_;
  ErrorMemory off_;  ///< what the numbers of x are off by

  /// An estimate, and what the observer knew beside its box.
  struct Kept {
    Enclosure estimate;
    Index k = 0;
    Vector x;
    ErrorMemory off;
    ErrorWidths::State widths;
  };
  Enclosure last_;  ///< the estimate of now
  Index k_ = 0;
  Kept before_;                        ///< of the estimate that the last step began from
  std::optional<Enclosure> replaced_;  ///< what the next step begins from instead
};

GainForm form_from(const Params& params) {
  return params.text("measurement") == "current" ? GainForm::filter : GainForm::predictor;
}

std::vector<Diagnostic> check_error_hull(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  if (context.model.linear.is_descriptor()) {
    return {{"/type", "\"error_hull\" takes systems of type \"lti\"",
             "use the observer \"descriptor\""}};
  }
  check_bounded_start(context, params, problems);
  if (check_noises(context, problems, Beyond::told))  // gains are designed for these sets
    check_observer_gain(context, params, "gain", steady_kalman(), problems, form_from(params));
  return problems;
}

constexpr const char* error_hull_details =
    "The observer of one point, x⁺ = x̄ + Λ (y⁺ - D u⁺ - C x̄) with x̄ = A x + B u (measurement "
    "current), or\n"
    "x⁺ = A x + B u + L (y - D u - C x) (previous), with the box around all errors that X0, W and "
    "V "
    "allow:\n"
    "    h = |Mᵏ R| 1 + Σ |Mʲ D| 1,   M = (I - Λ C) A or A - L C.\n"
    "h does not depend on the data, is bounded for ever, and nothing is reduced: the boxes are the "
    "hulls that \"gain_correction\"\n"
    "(current) or \"luenberger\" (previous) would have with the same gain and an unlimited budget. "
    "Rounding errors are added, on\n"
    "any backend. Where outputs are missing the errors go through A - L C of the others with their "
    "directions, as up to some\n"
    "thousand columns, of which the smallest are boxed now and then. Estimates are never empty.";

}  // namespace

CORDON_COMPONENT(observer, error_hull) {
  ParamSchema schema;
  add_gain_parameter(schema, "gain",
                     "one gain for all times: a matrix with a row per state and a column per "
                     "output, or a designer of one; absent: \"kalman\" with \"steady\"");
  schema.choice("measurement",
                "are estimates corrected by the outputs of their time (current), or made of those "
                "before (previous)?",
                {"current", "previous"}, "current");
  schema.set("initial_set", "set of initial states in place of the system's X0, bounded");
  registrar.add(ObserverEntry{
      {"error_hull",
       "boxes around all errors of one gain, their half widths known in advance; standard linear "
       "systems, any backend",
       "Tang2019", std::move(schema), error_hull_details},
      check_error_hull,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        const GainForm form = form_from(params);
        return std::make_unique<ErrorHullObserver>(
            context, params, observer_gain(context, params, "gain", steady_kalman(), form), form);
      }});
}

}  // namespace cordon::estimators
