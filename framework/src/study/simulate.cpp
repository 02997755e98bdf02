// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/simulate.hpp"

#include <algorithm>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "study/numbers.hpp"

namespace cordon::detail {

namespace {

constexpr double consistency_tolerance = 1e-9;  // relative to the largest summand of the static rows

double largest(const Matrix& A) { return A.size() == 0 ? 0.0 : A.cwiseAbs().maxCoeff(); }

}  // namespace

SimulatedSource::SimulatedSource(const Model& model, const SimulateSpec& spec, std::string file)
    : spec_(spec),
      file_(std::move(file)),
      plant_((check_sizes(model), model.linear), file_),
      disturbance_(model.W, spec.noise, RandomStream(spec.seed, Purpose::disturbance), 0, file_, "/system/W"),
      noise_(model.V, spec.noise, RandomStream(spec.seed, Purpose::noise), disturbance_.factors(), file_, "/system/V") {
  for (std::size_t i = 0; i < spec_.input.size(); ++i) signals_.emplace_back(spec_.input[i], i);
  start(model);
}

void SimulatedSource::fail(const std::string& pointer, const std::string& message, const std::string& mend) const {
  throw InputError(file_, {{pointer, message, mend}});
}

void SimulatedSource::check_sizes(const Model& model) const {
  std::vector<Diagnostic> problems;
  const auto require = [&](Index size, Index wanted, const char* pointer, const char* of) {
    if (size == wanted) return;
    problems.push_back({pointer, "has size " + std::to_string(size) + ", must be " + std::to_string(wanted) + ", " + of, ""});
  };
  require(static_cast<Index>(spec_.input.size()), model.linear.inputs(), "/data/simulate/input",
          "one signal per column of /system/B");
  require(model.W.dim(), model.linear.disturbances(), "/system/W", "the columns of /system/Bw");
  require(model.V.dim(), model.linear.noises(), "/system/V", "the columns of /system/Dv");
  if (spec_.x0) require(spec_.x0->size(), model.linear.states(), "/data/simulate/x0", "the rows of /system/A");
  if (spec_.x0 && !spec_.x0->allFinite()) problems.push_back({"/data/simulate/x0", "has a NaN or infinite number", ""});
  if (spec_.steps < 0) problems.push_back({"/data/simulate/steps", "is negative", ""});
  for (std::size_t i = 0; i < spec_.input.size(); ++i) {
    for (Diagnostic& d : problems_of(spec_.input[i], "/data/simulate/input/" + std::to_string(i)))
      problems.push_back(std::move(d));
  }
  if (!problems.empty()) throw InputError(file_, std::move(problems));
}

Vector SimulatedSource::input(std::int64_t k) {
  Vector u(static_cast<Index>(signals_.size()));
  for (Index i = 0; i < u.size(); ++i) u[i] = signals_[static_cast<std::size_t>(i)].at(k);
  return u;
}

void SimulatedSource::start(const Model& model) {
  w0_ = disturbance_.at(0);
  const Vector u0 = input(0);
  if (!spec_.x0) {
    start_from_center(model, u0);
    return;
  }
  plant_.start(*spec_.x0);
  if (plant_.static_A().rows() == 0 || start_near_given(model, *spec_.x0, u0)) return;
  if (start_from_joint_set(make_point(*spec_.x0), model.W, u0)) return;
  const Vector rest = linalg::product(plant_.static_A(), *spec_.x0) + linalg::product(plant_.static_B(), u0);
  const Vector open = rest + linalg::product(plant_.static_Bw(), w0_);
  fail("/data/simulate/x0",
       "is not consistent with the static rows of the descriptor system for any w_0 in W found: the nearest correction of w_0 "
       "leaves a "
       "residual of " +
           to_text(largest(open)),
       "choose x0 with 0 = A x0 + B u_0 + Bw w_0 in the static rows, or leave x0 out");
}

/// Least-squares correction of the drawn w_0 on the static rows; true if the result lies in W as far as can be told.
bool SimulatedSource::start_near_given(const Model& model, const Vector& x0, const Vector& u0) {
  const Matrix& Bw = plant_.static_Bw();
  const Vector ax = linalg::product(plant_.static_A(), x0), bu = linalg::product(plant_.static_B(), u0);
  const Vector rest = ax + bu;
  const Matrix inverse = linalg::pseudo_inverse(Bw);
  w0_ -= linalg::product(inverse, rest + linalg::product(Bw, w0_));
  const Vector bw = linalg::product(Bw, w0_);
  const double scale = std::max({1.0, largest(ax), largest(bu), largest(bw)});
  if (largest(rest + bw) > consistency_tolerance * scale) return false;
  return contains(model.W, w0_) != Answer::no;
}

void SimulatedSource::start_from_center(const Model& model, const Vector& u0) {
  const std::optional<Vector> center = central_point(model.X0);
  if (!center)
    fail("/system/X0", "no point of the set was found to start from", "check its constraints, or give /data/simulate/x0");
  plant_.start(*center);
  if (plant_.static_A().rows() == 0 || contains(model.X0, plant_.state(u0, w0_)) != Answer::no) return;
  if (start_from_joint_set(model.X0, model.W, u0)) return;
  fail("/system/X0", "no state of X0 was found that meets the static rows of the descriptor system for some w_0 in W",
       "check X0, or give /data/simulate/x0");
}

/// A central point of {(x,w) ∈ X0 × W : 0 = Ǎ x + B̌ u_0 + B̌w w}.
bool SimulatedSource::start_from_joint_set(const LineForm& X0, const LineForm& W, const Vector& u0) {
  const Index n = X0.dim(), rows = plant_.static_A().rows();
  Matrix R(rows, n + W.dim());
  R << plant_.static_A(), plant_.static_Bw();
  const Vector target = -linalg::product(plant_.static_B(), u0);
  const std::optional<Vector> pair = central_point(intersection(cartesian_product(X0, W), R, make_point(target)));
  if (!pair) return false;
  const double scale = std::max({1.0, largest(target), largest(R) * largest(*pair)});
  if (largest(linalg::product(R, *pair) - target) > consistency_tolerance * scale) return false;
  plant_.start(pair->head(n));
  w0_ = pair->tail(W.dim());
  return true;
}

std::optional<Record> SimulatedSource::next() {
  if (k_ > spec_.steps) return std::nullopt;
  const std::int64_t k = k_++;
  Record record;
  record.sample.k = static_cast<Index>(k);
  record.sample.u = input(k);
  const Vector w = k == 0 ? w0_ : disturbance_.at(k);
  LinearPlant::Output now = plant_.step(record.sample.u, w, noise_.at(k));
  if (!now.x.allFinite() || !now.y.allFinite()) {
    fail("/data/simulate/steps", "the simulated state overflows at k = " + std::to_string(k),
         "simulate fewer steps, or stabilise the system");
  }
  record.sample.y = std::move(now.y);
  record.truth = std::move(now.x);
  return record;
}

}  // namespace cordon::detail
