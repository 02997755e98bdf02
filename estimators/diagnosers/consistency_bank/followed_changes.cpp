// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/consistency_bank/followed_changes.hpp"

#include <utility>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

namespace {

/// Of hulls, per state: an observer that begins with them has its own budget, but only from its
/// next estimate on.
constexpr Index hull_generators = 8, hull_constraints = 2;

Sample without_outputs(const Sample& sample) {
  std::vector<Index> all;
  for (Index i = 0; i < sample.y.size(); ++i) all.push_back(i);
  return missing_outputs(sample, all);
}

/// Nothing where it is proven empty.
std::optional<Enclosure> states_of(Estimate estimate) {
  if (estimate.consistent == Answer::no) return {};
  return std::move(estimate.set);
}

}  // namespace

LineForm within_parameters(const LineForm& set, const Model& model) {
  const Index count = model.nonlinear ? model.nonlinear->parameters : 0;
  if (count == 0) return set;
  const Index others = set.dim() - count;
  const LineForm& X0 = model.X0;  // with the box of the parameters, in generators of their own
  return cartesian_product(
      affine_map(set, Matrix::Identity(others, set.dim()), Vector::Zero(others)),
      make_zonotope(X0.c.tail(count), X0.G.bottomRows(count)));
}

FollowedChanges::FollowedChanges(const ModeBank& bank, std::shared_ptr<const SetBackend> backend,
                                 const MakeObserver& make)
    : bank_(bank), backend_(std::move(backend)) {
  for (const Mode& mode : bank_.modes) {
    lasting_.push_back({make(mode.model), {}});
    changed_.push_back({make(mode.model), make(mode.model), {}, false, {}});
  }
}

void FollowedChanges::begin(const Sample& now, const Sets& throughout) {
  const Sample silent = without_outputs(now);
  for (std::size_t i = 0; i < lasting_.size(); ++i) {
    lasting_[i].states = throughout[i];
    if (throughout[i]) {
      lasting_[i].observer->start(throughout[i]);
      lasting_[i].observer->step(silent);
    }
    changed_[i].states.reset();
    changed_[i].runs = false;
    changed_[i].lost.clear();
  }
}

std::optional<Enclosure> FollowedChanges::joined(const std::optional<Enclosure>& X,
                                                 const std::optional<Enclosure>& Y) const {
  if (!X || !Y) return X ? X : Y;
  const Index n = (*X)->dim();
  return backend_->reduce(backend_->convex_hull(*X, *Y),
                          {hull_generators * n, hull_constraints * n});
}

/// f_i(X^i) of the modes that have lasted; `open`: why what follows is not known.
FollowedChanges::Sets FollowedChanges::followers(const Sample& now, ModeWorkers& workers,
                                                 std::vector<std::string>& open) {
  const Sample silent = without_outputs(now);
  Sets found(lasting_.size());
  workers.for_each(static_cast<Index>(lasting_.size()), [&](Index mode) {
    const auto i = static_cast<std::size_t>(mode);
    if (!lasting_[i].states) return;
    try {
      lasting_[i].observer->replace(*lasting_[i].states);
      found[i] = states_of(lasting_[i].observer->step(silent));
    } catch (const Error& error) {
      if (error.code() != Errc::not_enclosed) throw;
      open[i] = error.what();
    }
  });
  return found;
}

void FollowedChanges::step(const Sample& now, const Sets& throughout,
                           const std::vector<bool>& unknown, ModeWorkers& workers) {
  std::vector<std::string> open(lasting_.size());
  const Sets next = followers(now, workers, open);
  for (std::size_t i = 0; i < lasting_.size(); ++i) {
    if (unknown[i] && open[i].empty()) open[i] = "its states are not known any more";
    for (std::size_t j = 0; j < changed_.size() && !open[i].empty(); ++j) {
      if (j != i && changed_[j].lost.empty())
        changed_[j].lost =
            "what follows mode \"" + bank_.modes[i].name + "\" is not known: " + open[i];
    }
  }
  workers.for_each(static_cast<Index>(changed_.size()), [&](Index mode) {
    const auto j = static_cast<std::size_t>(mode);
    if (!changed_[j].lost.empty()) return;
    try {
      take(j, now, next);
    } catch (const Error& error) {
      if (error.code() != Errc::not_enclosed) throw;
      changed_[j].lost = error.what();
    }
  });
  for (std::size_t i = 0; i < lasting_.size(); ++i) {
    const bool lasts = lasting_[i].states && throughout[i] && open[i].empty();
    lasting_[i].states = lasts ? throughout[i] : std::nullopt;
  }
}

void FollowedChanges::take(std::size_t j, const Sample& now, const Sets& followers) {
  Changed& mode = changed_[j];
  const Model& model = bank_.modes[j].model;
  std::optional<Enclosure> before;
  for (std::size_t i = 0; i < followers.size(); ++i) {
    if (i == j || !followers[i]) continue;
    const Enclosure seed = backend_->import(within_parameters((*followers[i])->line_form(), model));
    before = joined(before, seed);
  }
  std::optional<Enclosure> gone_on, begun;
  if (mode.runs && mode.states) gone_on = states_of(mode.going_on->step(now));
  if (before) {
    mode.beginning->start(before);
    begun = states_of(mode.beginning->step(now));
  }
  mode.states = joined(gone_on, begun);
  if (!mode.states) {
    mode.runs = false;
  } else if (mode.runs) {
    mode.going_on->replace(*mode.states);
  } else {
    std::swap(mode.going_on, mode.beginning);
    mode.runs = true;
  }
}

void FollowedChanges::serialize(Archive& archive) {
  for (std::size_t i = 0; i < lasting_.size(); ++i) {
    const Index n = bank_.modes[i].model.states();
    archive(*lasting_[i].observer);
    serialize_set(archive, lasting_[i].states, n);
    archive(*changed_[i].going_on, *changed_[i].beginning);
    serialize_set(archive, changed_[i].states, n);
    archive(changed_[i].runs, changed_[i].lost);
  }
}

}  // namespace cordon::estimators
