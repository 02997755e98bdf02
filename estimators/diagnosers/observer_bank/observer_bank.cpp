// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/observer_bank/observer_bank.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "diagnosers/mode_gain.hpp"
#include "gains/gain_certificate.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

namespace {

/// What is nearer to 0 than this may be rounding: a share of the numbers that a residual was made
/// of, and of its own bounds.
Vector rounding_slack(const Box& hull, const Vector& size) {
  return tolerances::proof_margin * (size + hull.lower.cwiseAbs().cwiseMax(hull.upper.cwiseAbs()));
}

/// How far 0 lies outside the hull of R: the coordinate and its direction, if any is beyond
/// rounding.
std::optional<Certificate> separated_axis(const Box& hull, const Vector& size) {
  const Vector slack = rounding_slack(hull, size);
  std::optional<Certificate> best;
  for (Index i = 0; i < hull.dim(); ++i) {
    for (const double sign : {1.0, -1.0}) {
      const double distance = sign > 0
                                  ? hull.lower[i]
                                  : -hull.upper[i];  // 0 below the lower bound, above the upper one
      if (!(distance > slack[i]) || (best && best->margin >= distance)) continue;
      Vector d = Vector::Zero(hull.dim());
      d[i] = -sign;
      best = Certificate{Certificate::Kind::direction, std::move(d), distance};
    }
  }
  return best;
}

/// Is 0 ∉ R proven? In one dimension the hull is the set, and needs no program. What the sets
/// answer bounds no rounding errors of the numbers behind R, so that `no` has to hold for a
/// neighbourhood of 0. That 0 lies in R shows nothing: R encloses, and is about one sample.
void ask(const SetBackend& backend, const Enclosure& R, const Box& hull, const Vector& size,
         ModeEvidence& evidence) {
  if (hull.is_empty()) {  // no error in X̃ explains the sample of the reset
    if (R->is_empty(&evidence.why) == Answer::yes) {
      evidence.consistent = Answer::no;
      return;
    }
  } else if (auto proof = separated_axis(hull, size)) {
    evidence.consistent = Answer::no;
    evidence.why = std::move(*proof);
    return;
  } else if (hull.dim() > 1) {
    const Vector zero = Vector::Zero(hull.dim()), slack = rounding_slack(hull, size);
    if (R->contains(zero, &evidence.why) == Answer::no &&
        backend.sum(R, backend.box({-slack, slack}))->contains(zero) == Answer::no) {
      evidence.consistent = Answer::no;
      return;
    }
  }
  evidence.consistent = Answer::unknown;
  evidence.why = {};
}

/// Entries of the outputs that are there among those of all; others are 0, or free.
Vector among_all(const Vector& values, const Sample& sample) {
  if (sample.is_complete()) return values;
  Vector all = Vector::Zero(sample.y.size());
  all(present_outputs(sample)) = values;
  return all;
}
Box among_all(const Box& box, const Sample& sample) {
  if (sample.is_complete()) return box;
  const std::vector<Index> present = present_outputs(sample);
  Box all = Box::space(sample.y.size());
  all.lower(present) = box.lower;
  all.upper(present) = box.upper;
  return all;
}

}  // namespace

ObserverBank::ObserverBank(ModeBank bank, std::shared_ptr<const SetBackend> backend,
                           ObserverBankOptions options)
    : Diagnoser(std::move(bank), std::move(backend)),
      options_(std::move(options)),
      elimination_(Diagnoser::bank().size(), options_.waiting_time, Diagnoser::bank().nominal),
      workers_(options_.threads) {
  const ModeBank& all = Diagnoser::bank();
  for (Index j = 0; j < all.size(); ++j) {
    members_.emplace_back(all[j].model, options_.gains[static_cast<std::size_t>(j)],
                          shared_backend(), options_.budget, options_.widening_limit);
  }
  inputs_ = input_bounds(all);
  error_set_ = this->backend().import(check_error_set(all, options_.gains, options_.offline).set);
}

void ObserverBank::do_start() {
  was_reset_ = unfinished_ = false;
  suggested_ = suggesting_since_ = -1;
  for (Member& m : members_) {
    m.copy.reset();
    m.bound.reset();
    m.drift.start();
    m.rounding.start();
    m.evidence = {};
  }
}

/// What was promised in advance rests on U.
void ObserverBank::expect_input(const Sample& now) const {
  if (inputs_.contains(now.u)) return;
  throw Error(Errc::invalid, "u at k = " + std::to_string(now.k) +
                                 " lies outside the interval hull of the input set U, on which the "
                                 "bank's error set rests; widen /system/U");
}

void ObserverBank::expect_residuals(const Sample* before, const Sample& now) {
  if (!residuals_.empty()) return;
  const bool has_gap = !now.is_complete() || (before && !before->is_complete());
  const auto drifts = [](const Member& m) { return !m.drift.is_none(); };
  if (has_gap || std::any_of(members_.begin(), members_.end(), drifts))
    residuals_ = residual_bounds(bank(), options_.gains, options_.offline);
}

void ObserverBank::see(Index j, const Sample& sample, Seen& seen) {
  Member& m = member(j);
  seen.recursion = &m.recursion;
  seen.sample = &sample;
  if (sample.is_complete()) return;
  seen.others = m.others.at(sample, [&](const std::vector<Index>& present) {
    const Matrix L = options_.gains[static_cast<std::size_t>(j)](Eigen::all, present);
    return std::make_shared<LuenbergerRecursion>(with_outputs(bank()[j].model, present), L,
                                                 shared_backend(), options_.budget);
  });
  seen.without = without_missing(sample);
  seen.recursion = seen.others.get();
  seen.sample = &seen.without;
}

void ObserverBank::advance(Index j, const Sample& before) {
  Member& m = member(j);
  Seen seen;
  see(j, before, seen);
  const LuenbergerRecursion& recursion = *seen.recursion;
  const Sample& sample = *seen.sample;
  if (m.bound) m.bound = m.recursion.reduced(recursion.next_bound(*m.bound, m.X, sample));
  const auto advanced = [&](const Enclosure& X, Box& hull, WideningLimit& limit) {
    Vector open;
    const Enclosure next = recursion.next(X, sample, &open, hull.dim() > 0 ? &hull : nullptr);
    if (before.is_complete()) {
      limit.step(m.recursion, before, open);
    } else {
      limit.step_with_gap(m.recursion, recursion, sample, open);
    }
    return limit.apply(backend(), m.recursion.reduced(next), &hull);
  };
  if (m.copy) m.copy = advanced(*m.copy, m.copy_hull, m.copy_limit);
  m.X = advanced(m.X, m.X_hull, m.X_limit);
  m.size = recursion.next_size(m.center, sample);
  m.center = recursion.next(m.center, sample);
  if (m.drift.is_none() && before.is_complete()) {
    m.rounding.step(m.size);
  } else {
    const auto at = static_cast<std::size_t>(j);
    m.drift.step(before, recursion.error_map(), options_.gains[at], residuals_[at],
                 tolerances::product_noise * m.size,
                 tolerances::product_noise * m.rounding.bound());
  }
}

/// Residual sets at k, and what those of candidates prove.
void ObserverBank::judge(Index j, const Sample& now) {
  Member& m = member(j);
  m.evidence = {};
  m.bound_violated = false;
  Seen seen;
  see(j, now, seen);
  const LuenbergerRecursion& recursion = *seen.recursion;
  const Sample& sample = *seen.sample;
  if (sample.y.size() == 0) {
    m.hull = Box::space(0);
    m.residual_size = Vector(0);
    m.evidence.residual = Box::space(now.y.size());
    return;
  }
  m.residual = recursion.residual(m.X, sample);
  m.residual_size = recursion.residual_size(m.size, sample);
  m.hull = m.residual->interval_hull();
  m.evidence.residual = among_all(m.hull, now);
  if (m.copy) {
    const Enclosure copy = recursion.residual(*m.copy, sample);
    const Box hull = copy->interval_hull();
    ask(backend(), copy, hull, m.residual_size, m.evidence);
    if (!hull.is_empty()) m.evidence.reset_residual = among_all(hull, now);
  } else if (!was_reset_ && elimination_.is_candidate(j)) {
    ask(backend(), m.residual, m.hull, m.residual_size, m.evidence);
  }
  if (m.evidence.why.kind == Certificate::Kind::direction && !now.is_complete())
    m.evidence.why.data = among_all(m.evidence.why.data, now);
  if (m.bound) {
    const Enclosure allowed = recursion.residual_bound(*m.bound, m.X, sample);
    const Box all = allowed->interval_hull();
    const double size =
        sample.y.cwiseAbs().maxCoeff() +
        std::max(m.hull.lower.cwiseAbs().maxCoeff(), m.hull.upper.cwiseAbs().maxCoeff());
    const double slack = tolerances::proof_margin * size;
    m.bound_violated = (m.hull.lower.array() < all.lower.array() - slack).any() ||
                       (m.hull.upper.array() > all.upper.array() + slack).any();
    if (!m.bound_violated && m.hull.dim() > 1)
      m.bound_violated = m.residual->is_subset_of(*allowed) == Answer::no;
  }
}

void ObserverBank::reset(Index j, const Sample& now) {
  Member& m = member(j);
  Seen seen;
  see(j, now, seen);
  const LuenbergerRecursion& recursion = *seen.recursion;
  const Sample& sample = *seen.sample;
  const Index n = m.center.size();
  const Matrix unit = Matrix::Identity(n, n);
  Enclosure E = error_set_;
  if (m.drift.is_none()) {
    const Vector off = tolerances::product_noise * m.rounding.bound();
    E = backend().sum(E, backend().box({-off, off}));
  } else {
    const sets::Zonotope& drift = m.drift.set();
    const LineForm moved = make_zonotope(-drift.c, drift.G);
    E = backend().sum(E, backend().import(moved));
  }
  E = m.recursion.reduced(E);
  Enclosure errors = E, start = E;
  if (sample.y.size() > 0) {
    std::optional<Matrix> gain;
    if (options_.strip_gain) gain = (*options_.strip_gain)(Eigen::all, present_outputs(now));
    const Matrix* const by = gain ? &*gain : nullptr;
    errors = recursion.errors_within(E, recursion.explained_outputs(E, m.center, sample), by);
    start = recursion.errors_within(E, backend().box(m.hull), by);
  }
  m.copy = m.recursion.reduced(backend().affine_map(errors, unit, m.center));
  m.copy_limit.start(m.recursion, *m.copy);
  m.copy_hull = {};
  m.bound = m.recursion.reduced(start);
}

Diagnosis ObserverBank::do_step(const Sample* before, const Sample& now) {
  if (unfinished_)
    throw Error(Errc::invalid,
                "the last step ended with an error, and left sets of different times; start anew");
  expect_input(now);
  expect_residuals(before, now);
  unfinished_ = true;
  const Index modes = bank().size();
  if (!before) {
    elimination_.start(now.k);
    for (Index j = 0; j < modes; ++j) {
      const LineForm& start = options_.initial_sets[static_cast<std::size_t>(j)];
      member(j).X = member(j).recursion.reduced(backend().import(start));
      member(j).X_limit.start(member(j).recursion, member(j).X);
      member(j).X_hull = {};
      member(j).center = invariant::enclosing_zonotope(start).c;
      member(j).size = member(j).center.cwiseAbs();
    }
  }
  workers_.for_each(modes, [&](Index j) {
    if (before) advance(j, *before);
    judge(j, now);
  });
  std::vector<bool> excluded;
  for (Member& m : members_) excluded.push_back(m.evidence.consistent == Answer::no);
  const Index known = elimination_.mode(), since = elimination_.since();
  const bool is_reset = elimination_.update(now.k, excluded);
  if (is_reset) {
    was_reset_ = true;
    workers_.for_each(modes, [&](Index j) { reset(j, now); });
    begin_suggestion(known);
  } else {
    suggest(now);
  }
  for (Index j = 0; was_reset_ && j < modes; ++j) {
    if (!elimination_.is_candidate(j)) member(j).copy.reset();
  }
  Diagnosis diagnosis = report(now);
  diagnosis.since = since;
  diagnosis.reset = is_reset;
  unfinished_ = false;
  return diagnosis;
}

/// The published algorithm considers all modes but the one that has just been given up.
void ObserverBank::begin_suggestion(Index from) {
  suggested_ = -1;
  suggesting_since_ = elimination_.since();
  if (from >= 0) member(from).bound.reset();
}

void ObserverBank::suggest(const Sample& now) {
  if (suggesting_since_ < 0) return;
  const bool waited = now.k - suggesting_since_ >= options_.waiting_time;
  Index left = 0, last = -1;
  for (Index j = 0; j < bank().size(); ++j) {
    Member& m = member(j);
    if (!m.bound) continue;
    if (m.bound_violated || (waited && separated_axis(m.hull, m.residual_size))) {
      m.bound.reset();
    } else {
      ++left;
      last = j;
    }
  }
  if (left > 1 && !waited) return;
  suggested_ = left == 1 ? last : -1;
  suggesting_since_ = -1;
  for (Member& m : members_) m.bound.reset();
}

Diagnosis ObserverBank::report(const Sample& now) const {
  Diagnosis diagnosis;
  diagnosis.k = now.k;
  diagnosis.decision = elimination_.decision();
  diagnosis.mode = elimination_.mode();
  diagnosis.suggested = suggested_;
  for (Index j = 0; j < bank().size(); ++j) {
    diagnosis.modes.push_back(member(j).evidence);
    diagnosis.modes.back().candidate = elimination_.is_candidate(j);
  }
  if (diagnosis.mode >= 0) {
    const Member& m = member(diagnosis.mode);
    diagnosis.estimate = m.copy ? *m.copy : m.X;
  }
  return diagnosis;
}

/// Residuals, evidence and sizes are made anew by every sample.
void ObserverBank::serialize_member(Member& m, Archive& archive) {
  const Index n = bank()[bank().nominal].model.states();
  archive.set(m.X, n);
  serialize_set(archive, m.copy, n);
  serialize_set(archive, m.bound, n);
  m.X_limit.serialize(archive, m.recursion);
  m.copy_limit.serialize(archive, m.recursion);
  m.drift.serialize(archive, n);
  archive(m.rounding, m.X_hull, m.copy_hull, m.center);
  for (const Box* hull : {&m.X_hull, &m.copy_hull})
    if (hull->dim() != 0 && hull->dim() != n) archive.refuse("a hull of another dimension");
  if (m.center.size() != n) archive.refuse("a centre of another size");
}

void ObserverBank::do_serialize(Archive& archive) {
  for (Member& m : members_) serialize_member(m, archive);
  archive(elimination_, was_reset_, unfinished_);
  serialize_within(archive, suggested_, -1, bank().size() - 1);
  serialize_time(archive, suggesting_since_);
}

std::vector<Gain> ObserverBank::gains() const {
  std::vector<Gain> all;
  for (const Gain& gain : options_.described) {
    const Mode& mode = bank()[static_cast<Index>(all.size())];
    all.push_back(of_mode(gain, mode));
    if (std::isnan(gain.certificate.spectral_radius))
      all.back().certificate = certify(mode.model, gain.L, Matrix(0, 0));
  }
  return all;
}

std::optional<Guarantees> ObserverBank::do_guarantees() const {
  return fdi_guarantees(bank(), options_.gains, options_.offline);
}

}  // namespace cordon::estimators
