// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/simulate.hpp"

#include <algorithm>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "study/text/numbers.hpp"

namespace cordon::detail {

namespace {

constexpr double consistency_tolerance =
    1e-9;                                 // relative to the largest summand of the static rows
constexpr std::int64_t most_draws = 100;  // of x0

/// Infinite along lines; constraints are left out.
Box bounds_without_constraints(const LineForm& X) {
  Vector radius = X.G.cwiseAbs().rowwise().sum();
  for (Index i = 0; i < radius.size(); ++i) {
    if (!X.M.row(i).isZero(0)) radius[i] = infinity;
  }
  return {X.c - radius, X.c + radius};
}

double largest(const Matrix& A) { return A.size() == 0 ? 0.0 : A.cwiseAbs().maxCoeff(); }

}  // namespace

SimulatedSource::SimulatedSource(const Model& model, const SimulateSpec& spec, std::string file,
                                 bool modes)
    : spec_(spec),
      file_(std::move(file)),
      modes_(modes),
      timeline_((check_simulation(model, spec, file_), spec_.faults), file_),
      nominal_{LinearPlant(model.linear, file_), DrawSource(model, spec_, file_)},
      inputs_(spec_.input),
      additive_(spec_.additive_faults, model.linear.faults()) {
  check_faults(model.linear);
  enter(0);
  first_ = draw(0);
  start(acting_ < 0 ? model : spec_.faults[static_cast<std::size_t>(acting_)].model);
}

void SimulatedSource::fail(const std::string& pointer, const std::string& message,
                           const std::string& suggestion) const {
  throw InputError(file_, {{pointer, message, suggestion}});
}

SimulatedSource::Regime SimulatedSource::regime_of_fault(std::size_t index) const {
  return {LinearPlant(spec_.faults[index].model.linear, file_, place_of_fault(index)),
          DrawSource(spec_, index, file_)};
}

/// Every fault can be simulated, and between models that follow each other the state can be carried
/// over.
void SimulatedSource::check_faults(const LinearModel& nominal) const {
  std::int64_t next = 0;              // first time after the faults before
  const LinearModel* last = nullptr;  // the model that acts before
  const auto follow = [&](const LinearModel& model, std::size_t i) {
    if (last && !same_descriptor(*last, model)) {
      fail(place_of_fault(i),
           "cannot be simulated: two models of different E follow each other, the state cannot be "
           "carried over",
           "simulate this fault from k = 0 to the end, in a study of its own");
    }
    last = &model;
  };
  for (std::size_t i = 0; i < spec_.faults.size(); ++i) {
    const FaultSpec& fault = spec_.faults[i];
    if (fault.from > spec_.steps) return;
    regime_of_fault(i);
    if (fault.from > next) follow(nominal, i);
    follow(fault.model.linear, i);
    if (fault.to >= spec_.steps) return;
    next = fault.to + 1;
  }
  if (!spec_.faults.empty()) follow(nominal, spec_.faults.size() - 1);
}

/// Makes the model of time k the acting one, and hands it the state.
void SimulatedSource::enter(std::int64_t k) {
  const Index acting = timeline_.at(k);
  if (acting == acting_) return;
  std::optional<Regime> fault;
  if (acting >= 0) fault = regime_of_fault(static_cast<std::size_t>(acting));
  if (k > 0) (fault ? fault->plant : nominal_.plant).resume(plant());
  fault_ = std::move(fault);
  acting_ = acting;
}

Draw SimulatedSource::draw(std::int64_t k) {
  const auto draw_for = [k](Regime& regime) {
    Draw draw = regime.draws.at(k);
    if (draw.matrices) regime.plant.exchange(draw.matrices->A, draw.matrices->B, draw.matrices->C);
    return draw;
  };
  Draw draw = draw_for(nominal_);
  if (fault_) draw = draw_for(*fault_);
  return draw;
}

/// What acts on the plant: the inputs as the actuators pass them on, and the additive faults.
Vector SimulatedSource::pushed(const Draw& draw, const Vector& u, const Vector& n) const {
  Vector both(u.size() + n.size());
  both << draw.effectiveness.actuator.cwiseProduct(u), n;
  return both;
}

void SimulatedSource::start(const Model& model) {
  const Vector u0 = pushed(first_, inputs_.at(0), additive_.at(0));
  plant().keep_first_in(bounds_without_constraints(model.X0));
  if (spec_.x0_set) return start_from_draws(model, u0);
  if (!spec_.x0) return start_from_center(model, u0);
  plant().start(*spec_.x0);
  if (plant().static_A().rows() == 0 || start_near_given(model, *spec_.x0, u0)) return;
  if (start_from_joint_set(make_point(*spec_.x0), model.W, u0)) return;
  const Vector rest =
      linalg::product(plant().static_A(), *spec_.x0) + linalg::product(plant().static_B(), u0);
  const Vector open = rest + linalg::product(plant().static_Bw(), first_.w);
  fail("/data/simulate/x0",
       "is not consistent with the static rows of the descriptor system for any w_0 in W found: "
       "the nearest correction of w_0 "
       "leaves a "
       "residual of " +
           to_text(largest(open)),
       "choose x0 with 0 = A x0 + B u_0 + Bw w_0 + F n_0 in the static rows, or leave x0 out");
}

/// Least-squares correction of the drawn w_0 on the static rows; true if the result lies in W as
/// far as can be told.
bool SimulatedSource::start_near_given(const Model& model, const Vector& x0, const Vector& u0) {
  const Matrix& Bw = plant().static_Bw();
  const Vector ax = linalg::product(plant().static_A(), x0),
               bu = linalg::product(plant().static_B(), u0);
  const Vector rest = ax + bu;
  const Matrix inverse = linalg::pseudo_inverse(Bw);
  first_.w -= linalg::product(inverse, rest + linalg::product(Bw, first_.w));
  const Vector bw = linalg::product(Bw, first_.w);
  const double scale = std::max({1.0, largest(ax), largest(bu), largest(bw)});
  if (largest(rest + bw) > consistency_tolerance * scale) return false;
  return contains(model.W, first_.w) != Answer::no;
}

void SimulatedSource::start_from_center(const Model& model, const Vector& u0) {
  const std::optional<Vector> center = central_point(model.X0);
  if (!center)
    fail("/system/X0", "no point of the set was found to start from",
         "check its constraints, or give /data/simulate/x0");
  plant().start(*center);
  if (plant().static_A().rows() == 0 ||
      contains(model.X0, plant().state(u0, first_.w)) != Answer::no)
    return;
  if (start_from_joint_set(model.X0, model.W, u0)) return;
  fail("/system/X0",
       "no state of X0 was found that meets the static rows of the descriptor system for some w_0 "
       "in W",
       "check X0, or give /data/simulate/x0");
}

void SimulatedSource::start_from_draws(const Model& model, const Vector& u0) {
  const LineForm& X0 = *spec_.x0_set;
  Disturbance states = start_draws(spec_, file_);
  if (plant().static_A().rows() == 0) return plant().start(states.at(0));
  Disturbance disturbances(model.W, spec_.noise, RandomStream(spec_.seed, Purpose::start, 1),
                           states.factors(), file_, "/system/W");
  for (std::int64_t k = 0; k < most_draws; ++k) {
    if (k > 0) first_.w = disturbances.at(k);
    plant().start(states.at(k));
    if (contains(X0, plant().state(u0, first_.w)) != Answer::no) return;
  }
  const LineForm joint = joint_set(X0, model.W, u0);
  if (central_point(joint)) {
    Disturbance pairs(joint, spec_.noise, RandomStream(spec_.seed, Purpose::start, 2), 0, file_,
                      "/data/simulate/x0");
    if (start_from_pair(pairs.at(0), u0)) return;
  }
  fail("/data/simulate/x0",
       "no state of the set was found that meets the static rows of the descriptor system for some "
       "w_0 in W",
       "widen the set, or leave x0 out");
}

/// {(x,w) ∈ X0 × W : 0 = Ǎ x + B̌ u_0 + B̌w w}.
LineForm SimulatedSource::joint_set(const LineForm& X0, const LineForm& W, const Vector& u0) {
  Matrix R(plant().static_A().rows(), X0.dim() + W.dim());
  R << plant().static_A(), plant().static_Bw();
  return intersection(cartesian_product(X0, W), R,
                      make_point(-linalg::product(plant().static_B(), u0)));
}

/// Takes (x_0, w_0) if it meets the static rows.
bool SimulatedSource::start_from_pair(const Vector& pair, const Vector& u0) {
  const Vector x = pair.head(plant().static_A().cols()), w = pair.tail(plant().static_Bw().cols());
  const Matrix &A = plant().static_A(), &Bw = plant().static_Bw();
  const Vector bu = linalg::product(plant().static_B(), u0);
  const double scale =
      std::max({1.0, largest(bu), std::max(largest(A), largest(Bw)) * largest(pair)});
  if (largest(linalg::product(A, x) + bu + linalg::product(Bw, w)) > consistency_tolerance * scale)
    return false;
  plant().start(x);
  first_.w = w;
  return true;
}

/// Starts from a central point of the joint set.
bool SimulatedSource::start_from_joint_set(const LineForm& X0, const LineForm& W,
                                           const Vector& u0) {
  const std::optional<Vector> pair = central_point(joint_set(X0, W, u0));
  return pair && start_from_pair(*pair, u0);
}

std::optional<Record> SimulatedSource::next() {
  if (k_ > spec_.steps) return std::nullopt;
  const std::int64_t k = k_++;
  enter(k);
  const Draw draw = k == 0 ? first_ : this->draw(k);
  Record record;
  record.sample.k = static_cast<Index>(k);
  record.sample.u = inputs_.at(k);
  const Vector n = additive_.at(k);
  if (!n.allFinite())
    fail("/data/simulate/additive_faults", "overflow at k = " + std::to_string(k),
         "give smaller signals");
  const Vector u = pushed(draw, record.sample.u, n);
  LinearPlant::Output now = plant().step(u, draw.w, draw.v, draw.effectiveness.sensor);
  if (!now.x.allFinite() || !now.y.allFinite()) {
    fail("/data/simulate/steps", "the simulated state overflows at k = " + std::to_string(k),
         "simulate fewer steps, or stabilise the system");
  }
  record.sample.y = std::move(now.y);
  record.truth = std::move(now.x);
  if (modes_) record.mode = acting_ < 0 ? 0 : spec_.faults[static_cast<std::size_t>(acting_)].mode;
  if (modes_ && !n.isZero(0)) {
    record.mode_without_fault = record.mode;
    record.mode = -1;
  }
  if (n.size() > 0) record.fault = n;
  return record;
}

}  // namespace cordon::detail
