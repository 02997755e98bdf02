// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/observer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/interfaces/archive.hpp"
#include "interfaces/sample_check.hpp"
#include "region.hpp"

namespace cordon {

namespace {

long long now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Is the mean width smaller, in units of the widths of `than`? Widths of 0 stay, and one that has
/// become finite counts more than others.
bool is_narrower(const Box& box, const Box& than) {
  double share = 0, all = 0;
  for (Index i = 0; i < box.dim(); ++i) {
    const double width = box.upper[i] - box.lower[i], before = than.upper[i] - than.lower[i];
    if (std::isinf(before) && std::isfinite(width)) return true;
    if (!(before > 0) || std::isinf(before)) continue;
    share += width / before;
    all += 1;
  }
  return share < all;
}

/// The largest finite bound.
double finite_size(const Box& box) {
  double size = 0;
  for (const Vector* bound : {&box.lower, &box.upper}) {
    for (const double x : *bound) size = std::isfinite(x) ? std::max(size, std::abs(x)) : size;
  }
  return size;
}

/// By how much sets of these hulls may miss each other where they meet: infinite sides do not
/// count.
Vector rounding_between(const Box& X, const Box& Y) {
  Vector sizes = Vector::Zero(X.dim());
  for (const Vector* bound : {&X.lower, &X.upper, &Y.lower, &Y.upper})
    sizes = sizes.cwiseMax(bound->array().isFinite().select(bound->cwiseAbs(), 0.0));
  const double largest = sizes.size() > 0 ? sizes.maxCoeff() : 0.0;
  return tolerances::reported * sizes.array() + tolerances::product_noise * largest;
}

/// The largest dᵀx for x ∈ X and d within `radius` (empty: 0) of c. |x_j| is x_j or -x_j where the
/// hull has one sign; of few others both are tried, and more are bounded by the hull.
double row_support(const Set& X, Vector c, const Vector& radius, const Box& hull) {
  constexpr std::size_t most_tried = 6;
  std::vector<Index> both;
  double spread = 0;
  for (Index j = 0; j < radius.size(); ++j) {
    if (!(radius[j] > 0)) continue;
    if (hull.lower[j] >= 0) {
      c[j] += radius[j];
    } else if (hull.upper[j] <= 0) {
      c[j] -= radius[j];
    } else if (both.size() < most_tried) {
      both.push_back(j);
    } else {
      spread += radius[j] * std::max(-hull.lower[j], hull.upper[j]);
    }
  }
  double most = -infinity;
  for (std::size_t signs = 0; signs < std::size_t{1} << both.size(); ++signs) {
    Vector d = c;
    for (std::size_t b = 0; b < both.size(); ++b)
      d[both[b]] += (signs >> b & 1) != 0 ? radius[both[b]] : -radius[both[b]];
    most = std::max(most, X.support(d));
  }
  return most + spread;
}

/// Σ |c_j| max |x_j| over x in the hull, without coordinates that have no bounds.
double finite_terms(const Box& hull, const Vector& c) {
  double sum = 0;
  for (Index j = 0; j < c.size(); ++j) {
    const double most = std::max(std::abs(hull.lower[j]), std::abs(hull.upper[j]));
    if (c[j] != 0 && std::isfinite(most)) sum += std::abs(c[j]) * most;
  }
  return sum;
}

}  // namespace

Observer::Stopwatch::Stopwatch(double& total) : total_(total), begin_(now_ns()) {}
Observer::Stopwatch::~Stopwatch() { total_ += static_cast<double>(now_ns() - begin_) * 1e-3; }

void Observer::start(std::optional<Enclosure> X0) {
  if (X0) {
    *X0 = backend_->import(*X0);
    if ((*X0)->dim() != model_.states())
      throw Error(Errc::dimension, "the initial set has another dimension than the state");
  }
  X0_ = std::move(X0);
  before_.reset();
  inconsistent_ = is_cut_to_nothing_ = false;
  inherited_ = last_inherited_ = Tightness::exact;
  left_out_.clear();
  left_region_.clear();
  contradiction_.reset();
  times_ = {};
}

void Observer::admit(const LineForm& admissible, Budget budget) {
  admissible_form_ = admissible;
  admissible_ = backend_->import(admissible);
  if (admissible_->dim() != model_.states())
    throw Error(Errc::dimension, "the admissible set has another dimension than the state");
  admissible_budget_ = budget;
}

bool Observer::cut(Enclosure& X) {
  const Box hull = X->interval_hull();
  if (hull.is_empty()) return false;
  if (hull.is_bounded() && backend_->box(hull)->is_subset_of(*admissible_) == Answer::yes) {
    X.tightness = meet(X.tightness, admissible_.tightness);  // it may reach beyond what was given
    return false;
  }
  const Matrix unit = Matrix::Identity(hull.dim(), hull.dim());
  Enclosure narrowed =
      timed(Phase::correct, [&] { return backend_->intersection(X, unit, admissible_); });
  if (narrowed->is_empty() == Answer::yes) {  // by more than rounding, if it is to say anything
    const Vector room = rounding_between(hull, admissible_->interval_hull());
    const Enclosure wider = backend_->sum(admissible_, backend_->box({-room, room}));
    narrowed = timed(Phase::correct, [&] { return backend_->intersection(X, unit, wider); });
    narrowed.tightness = Tightness::outer;
  }
  Enclosure reduced =
      timed(Phase::reduce, [&] { return backend_->reduce(narrowed, admissible_budget_); });
  const Box now = reduced->interval_hull();
  if (!now.is_empty() && !is_narrower(now, hull)) {
    X.tightness = Tightness::outer;  // what is known of the state is not all used
    return false;
  }
  X = std::move(reduced);
  // beside a set of such size the estimate is rounding, though operations call it exact
  const double size = finite_size(admissible_->interval_hull());
  if (tolerances::product_noise * size > tolerances::reported * finite_size(now))
    X.tightness = Tightness::outer;
  return true;
}

void Observer::leave_out_outliers(Index most, Index window) {
  if (most < 0 || window < 1)
    throw Error(Errc::invalid, "outliers: a number of samples in a window of 1 at least");
  if (most > 0 && !takes_missing_outputs()) {
    throw Error(Errc::unsupported,
                "outliers are left out like missing outputs, which this observer does not take");
  }
  most_outliers_ = most;
  outlier_window_ = window;
}

Index Observer::estimated_time(Index k) const { return std::max(k - lag(), begin_); }

Estimate Observer::advance(const Sample& now) {
  Estimate estimate{estimated_time(now.k), {}, Answer::unknown, {}};
  held_ = before_ ? do_step(*before_, now) : do_start(X0_, now);
  estimate.set = estimate_of(held_);
  const Tightness claimed = meet(meet(estimate.set.tightness, claim()), inherited_);
  estimate.set.tightness = claimed;
  const bool is_cut = admissible_.set && cut(estimate.set);
  if (estimate.set.tightness != claimed) inherited_ = meet(inherited_, estimate.set.tightness);
  {
    const Stopwatch watch(times_.question);
    estimate.consistent = negate(estimate.set->is_empty(&estimate.why));
  }
  is_cut_to_nothing_ = is_cut_to_nothing_ || (is_cut && estimate.consistent == Answer::no);
  if (is_cut && estimate.consistent != Answer::no) do_replace(estimate.set);
  if (lag() == 0) held_ = estimate.set;
  return estimate;
}

void Observer::go_back() {
  if (before_) do_replace(last_);
  inherited_ = last_inherited_;
}

Observer::OutputBounds Observer::output_bounds(const Set& X, Index output, const Sample& now) {
  const LinearModel& m = model_.linear;
  if (!noise_.set) noise_ = backend_->import(model_.V);
  const Box hull = m.C_radius.size() > 0 ? X.interval_hull() : Box{};
  const Vector c = m.C.row(output).transpose(), v = m.Dv.row(output).transpose();
  const Vector radius = m.C_radius.size() > 0 ? Vector(m.C_radius.row(output)) : Vector();
  const double direct = m.D.row(output).dot(now.u);
  return {direct - row_support(X, -c, radius, hull) - noise_->support(-v),
          direct + row_support(X, c, radius, hull) + noise_->support(v),
          m.D.row(output).cwiseAbs().dot(now.u.cwiseAbs())};
}

std::vector<Index> Observer::outliers(const Set& X, const Sample& now) {
  std::vector<Index> found;
  double worst = 0;
  for (const Index i : present_outputs(now)) {
    const auto [lower, upper, terms] = output_bounds(X, i, now);
    const double y = now.y[i];
    const double distance = std::max(y - upper, lower - y);  // NaN: open on both sides
    double size = std::max(
        {std::abs(y), terms, std::isfinite(upper) ? upper : 0, std::isfinite(lower) ? -lower : 0});
    if (!(distance > tolerances::reported * size)) continue;
    if (model_.is_linear())  // what cancels in C x
      size += finite_terms(X.interval_hull(), model_.linear.C.row(i).transpose());
    if (!(distance > tolerances::reported * size)) continue;
    found.push_back(i);
    const double share = distance / std::max(upper - lower, tolerances::reported * size);
    if (contradiction_ && !(share > worst)) continue;
    worst = share;
    contradiction_ = {now.k, i, distance};
  }
  return found;
}

bool Observer::may_leave_out(Index k) const {
  const auto recent = std::count_if(outlier_times_.begin(), outlier_times_.end(),
                                    [&](Index t) { return t > k - outlier_window_; });
  return recent < most_outliers_;
}

Estimate Observer::advance_without_outliers(const Sample& now, std::optional<Sample>& used) {
  const std::vector<Index> present = present_outputs(now);
  const Sample none = missing_outputs(now, present);
  const bool two_steps = uses_outputs_of_its_time();
  Estimate estimate;
  try {
    estimate = advance(two_steps ? none : now);
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported || !two_steps) throw;
    throw Error(Errc::unsupported,
                std::string("to look for outliers, each state is predicted without the outputs of "
                            "its time: ") +
                    error.what());
  }
  std::vector<Index> missed;
  const bool empty_before = estimate.consistent == Answer::no;
  if (!empty_before) missed = outliers(*present_of(held_), now);
  if (two_steps) {
    go_back();
    estimate = advance(missed.empty() ? now : missing_outputs(now, missed));
    if (estimate.consistent == Answer::no && !empty_before) {  // the others together
      if (missed.empty()) contradiction_ = {now.k, present.size() == 1 ? present[0] : -1};
      missed = present;
      go_back();
      estimate = advance(none);
    }
  }
  if (empty_before && estimate.consistent == Answer::no)
    contradiction_ = Contradiction{now.k, -1, 0, true};
  if (missed.empty()) return estimate;
  used = missing_outputs(now, missed);
  left_out_ = std::move(missed);
  std::erase_if(outlier_times_, [&](Index t) { return t <= now.k - outlier_window_; });
  outlier_times_.push_back(now.k);
  return estimate;
}

void Observer::explain(const Sample& now) {
  const PhaseTimes times = times_;
  try {
    const std::vector<Index> present = present_outputs(now);
    bool before = present.empty() || !uses_outputs_of_its_time();
    if (!before) {
      go_back();
      before = advance(missing_outputs(now, present)).consistent == Answer::no;
      if (!before && outliers(*present_of(held_), now).empty()) {
        contradiction_ = Contradiction{now.k};
        for (const Index output : present) {  // by itself, with next to nothing beyond its bounds?
          std::vector<Index> others = present;
          std::erase(others, output);
          if (!others.empty()) go_back();
          if (!others.empty() && advance(missing_outputs(now, others)).consistent != Answer::no)
            continue;
          contradiction_->output = output;
          break;
        }
      }
    }
    if (before) contradiction_ = Contradiction{now.k, -1, 0, true};
  } catch (const Error& error) {  // why an estimate is empty was not asked for
    if (error.code() != Errc::unsupported) throw;
    contradiction_.reset();
  }
  times_ = times;
}

Estimate Observer::step(const Sample& now) {
  detail::check_sample(now, before_ ? std::optional(before_->k) : std::nullopt, model_);
  if (!now.is_complete() && !takes_missing_outputs()) detail::refuse_missing(now, "observer");
  times_ = {};
  left_out_.clear();
  contradiction_.reset();
  if (inconsistent_) {
    Estimate estimate{estimated_time(now.k), backend_->empty(model_.states()), Answer::no, {}};
    estimate.set->is_empty(&estimate.why);
    before_ = now;
    return estimate;
  }
  if (model_.region) expect_region(now);
  if (!before_) {
    begin_ = now.k;
    std::erase_if(outlier_times_, [&](Index t) { return t >= now.k; });  // of other data
  }
  std::optional<Sample> used;
  const bool watches = may_leave_out(now.k) && !present_outputs(now).empty();
  Estimate estimate = watches ? advance_without_outliers(now, used) : advance(now);
  inconsistent_ = estimate.consistent == Answer::no;
  const Enclosure held = held_;
  if (inconsistent_ && !watches && takes_missing_outputs()) explain(now);
  last_ = held;
  last_inherited_ = inherited_;
  if (used) {
    before_ = std::move(*used);
  } else {
    before_ = now;  // in place, without memory of its own
  }
  if (model_.region)
    left_region_ = detail::why_outside(*model_.region, present_of(last_)->interval_hull(), now);
  return estimate;
}

Box Observer::predicted() {
  if (!before_) return backend_->import(X0_ ? (*X0_)->line_form() : initial_set())->interval_hull();
  if (!disturbance_.set) disturbance_ = backend_->import(model_.W);
  return detail::predicted_hull(model_.linear, *present_of(last_), before_->u, *disturbance_);
}

void Observer::expect_region(const Sample& now) {
  std::string why = before_ ? left_region_ : "";
  if (why.empty() && model_.region->nonlinear_outputs && !present_outputs(now).empty())
    why = detail::why_outside(*model_.region, predicted(), now);
  if (!why.empty()) throw Error(Errc::not_enclosed, why);
}

void Observer::replace(Enclosure X) {
  if (!before_)
    throw Error(Errc::invalid,
                "replace: no sample has been taken; give the set to start() instead");
  X = backend_->import(X);
  if (X->dim() != model_.states())
    throw Error(Errc::dimension, "the replacing set has another dimension than the state");
  inconsistent_ = false;
  inherited_ = last_inherited_ = Tightness::exact;
  begin_ = before_->k;
  last_ = X;
  if (model_.region)
    left_region_ = detail::why_outside(*model_.region, X->interval_hull(), *before_);
  do_replace(X);
}

void Observer::serialize(Archive& archive) {
  archive.section("observer");
  const Index n = model_.states();
  archive(X0_, before_, begin_, held_, last_, inherited_, last_inherited_, inconsistent_,
          is_cut_to_nothing_, outlier_times_, left_out_, contradiction_, left_region_);
  times_ = {};
  if (X0_ && (!X0_->set || (*X0_)->dim() != n)) archive.refuse("no initial set of the states");
  if (!before_) return;
  const auto fits = [n, lags = lag() > 0](const Enclosure& held) {
    if (!held.set || !lags) return held.set && held->dim() == n;
    return held->dim() >= n && held->dim() % std::max<Index>(n, 1) == 0;  // of several times
  };
  if (archive.is_reading()) detail::check_saved(*before_, model_, archive);
  if (!fits(held_) || !fits(last_)) archive.refuse("a sample without an estimate of the states");
  if (begin_ > before_->k) archive.refuse("a sample of before the first one");
  if (!before_->is_complete() && !takes_missing_outputs()) archive.refuse("a sample with a gap");
  do_serialize(archive);
}

void Observer::do_serialize(Archive&) {
  throw Error(Errc::unsupported, "the state of this observer cannot be saved");
}

}  // namespace cordon
