// SPDX-License-Identifier: GPL-3.0-or-later
// Observers that lose the state, or claim to know more than they do.
#include "filter.hpp"

namespace component_mutants {

namespace {

/// Encloses what it knows by a box, and says so.
class Boxed : public Filter {
  using Filter::Filter;
  Enclosure corrected(const Enclosure& X, const Sample& now) override {
    const Enclosure narrowed = Filter::corrected(X, now);
    const Box hull = narrowed->interval_hull();
    if (hull.is_empty() || !hull.is_bounded()) return {narrowed.set, Tightness::outer};
    return {backend().box(hull).set, Tightness::outer};
  }
};

/// Never looks at an output.
class OpenLoop final : public Filter {
  using Filter::Filter;
  Tightness claim() const override { return Tightness::outer; }
  bool follows_its_sets() const override { return false; }
  bool uses_outputs_of_its_time() const override { return false; }
  Enclosure corrected(const Enclosure& X, const Sample&) override { return X; }
};

class ForgetsDisturbance final : public Filter {
  using Filter::Filter;
  Enclosure predicted(const Enclosure& X, const Sample& before, const Sample&) override {
    const LinearModel& m = model().linear;
    return predicted_with(X, m.B * before.u, Matrix::Zero(m.states(), m.disturbances()), W_);
  }
};

class LateInput final : public Filter {
  using Filter::Filter;
  Enclosure predicted(const Enclosure& X, const Sample&, const Sample& now) override {
    const LinearModel& m = model().linear;
    return predicted_with(X, m.B * now.u, m.Bw, W_);
  }
};

class ForgetsDirectInput final : public Filter {
  using Filter::Filter;
  Enclosure corrected(const Enclosure& X, const Sample& now) override {
    Sample blind = now;
    blind.u.setZero();
    return Filter::corrected(X, blind);
  }
};

class HalvesNoise final : public Filter {
  using Filter::Filter;
  Enclosure corrected(const Enclosure& X, const Sample& now) override {
    if (!now.is_complete()) return X;
    LinearModel m = model().linear;
    m.Dv *= 0.5;
    return corrected_with(X, m, now, V_);
  }
};

/// The centre of the noise is taken away on the wrong side.
class WrongCentre final : public Filter {
 public:
  explicit WrongCentre(const ObserverContext& context) : Filter(context) {
    const LineForm& V = context.model.V;
    V_ =
        backend().import(affine_map(V, -Matrix::Identity(V.dim(), V.dim()), Vector::Zero(V.dim())));
  }
};

/// The set is moved by a small part of its size.
class Drifts final : public Filter {
  using Filter::Filter;
  Enclosure told(const Enclosure& X) override {
    const Box hull = X->interval_hull();
    if (hull.is_empty() || !hull.is_bounded()) return X;
    const Index n = hull.dim();
    return backend().affine_map(X, Matrix::Identity(n, n), 1e-3 * hull.radius());
  }
};

class OneStepLate final : public Filter {
  using Filter::Filter;
  Enclosure told(const Enclosure& X) override {
    Enclosure before = late_.set ? late_ : X;
    late_ = X;
    return before;
  }
  Enclosure late_;
};

class MissingAsZero final : public Filter {
  using Filter::Filter;
  Enclosure corrected(const Enclosure& X, const Sample& now) override {
    Sample filled = now;
    for (const Index i : now.missing) filled.y[i] = 0;
    filled.missing.clear();
    return Filter::corrected(X, filled);
  }
};

class ReplacesByCentre final : public Filter {
  using Filter::Filter;
  void do_replace(const Enclosure& X) override {
    const Box hull = X->interval_hull();
    X_ = hull.is_bounded() && !hull.is_empty()
             ? backend().point(hull.lower + 0.25 * (hull.upper - hull.lower))
             : X;
  }
};

class ClaimsBoxes final : public Filter {
  using Filter::Filter;
  Enclosure told(const Enclosure& X) override {
    const Box hull = X->interval_hull();
    if (hull.is_empty() || !hull.is_bounded()) return X;
    return {backend().box(hull).set, Tightness::exact};
  }
};

class ClaimsWithOneOutput final : public Filter {
  using Filter::Filter;
  Enclosure corrected(const Enclosure& X, const Sample& now) override {
    if (!now.is_complete() || now.y.size() < 2) return Filter::corrected(X, now);
    return corrected_with(X, with_outputs(model().linear, {0}),
                          without_missing(missing_outputs(now, {1})), V_);
  }
};

/// Takes a correction that leaves little for a contradiction.
class AlarmsEarly final : public Filter {
  using Filter::Filter;
  Enclosure corrected(const Enclosure& X, const Sample& now) override {
    const Enclosure narrowed = Filter::corrected(X, now);
    const Box before = X->interval_hull(), after = narrowed->interval_hull();
    if (before.is_empty() || after.is_empty() || !before.is_bounded()) return narrowed;
    const bool is_small =
        ((after.upper - after.lower).array() < 0.2 * (before.upper - before.lower).array()).any();
    return is_small ? backend().empty(model().states()) : narrowed;
  }
};

/// Tells a box, but goes on with what it holds.
class KnowsMore final : public Filter {
  using Filter::Filter;
  Enclosure told(const Enclosure& X) override {
    const Box hull = X->interval_hull();
    if (hull.is_empty() || !hull.is_bounded()) return X;
    const Vector room = (hull.upper - hull.lower).array() + 1;
    odd_ = !odd_;
    if (odd_) return X;
    return {backend().box({hull.lower - room, hull.upper + room}).set, Tightness::outer};
  }
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    odd_ = true;
    return Filter::do_start(X0, first);
  }
  bool odd_ = false;
};

}  // namespace

void add_observers(Registrar& r) {
  const char* truth = "breaks observer.contains_truth";
  add_observer<Filter>(r, "filter", "keeps all laws", "prediction and correction, not reduced");
  add_observer<Boxed>(r, "boxed", "keeps all laws", "the same in boxes, called outer");
  add_observer<OpenLoop>(r, "open_loop", "keeps all laws", "prediction alone");
  add_observer<ForgetsDisturbance>(r, "forgets_disturbance", truth, "predicts without W");
  add_observer<LateInput>(r, "late_input", truth, "predicts by the input of the time after");
  add_observer<ForgetsDirectInput>(r, "forgets_direct_input", truth, "corrects without D u");
  add_observer<HalvesNoise>(r, "halves_noise", truth, "takes half of V");
  add_observer<WrongCentre>(r, "wrong_centre", truth, "takes the centre of V with the other sign");
  add_observer<Drifts>(r, "drifts", truth, "moves each estimate by 1e-3 of its radius");
  add_observer<OneStepLate>(r, "one_step_late", truth, "tells the estimate of the time before");
  add_observer<MissingAsZero>(r, "missing_as_zero", "breaks observer.missing_outputs",
                              "takes a missing output for 0");
  add_observer<ReplacesByCentre>(r, "replaces_by_centre", "breaks observer.replace",
                                 "keeps one point of the set that replaces its own");
  add_observer<ClaimsBoxes>(r, "claims_boxes", "breaks observer.exact_claims", "calls hulls exact");
  add_observer<ClaimsWithOneOutput>(r, "claims_with_one_output", "breaks observer.exact_claims",
                                    "leaves out an output and is called exact");
  add_observer<AlarmsEarly>(r, "alarms_early", "breaks observer.inconsistent",
                            "takes a small correction for a contradiction");
  add_observer<KnowsMore>(r, "knows_more", "breaks observer.follows_its_sets",
                          "keeps less than the successors of what it tells");
}

}  // namespace component_mutants
