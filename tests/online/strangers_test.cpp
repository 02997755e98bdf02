// SPDX-License-Identifier: GPL-3.0-or-later
// Plants that nobody wrote for this, beside which everything happens at once: outputs are missing
// and come late, samples are doubled, times are left out while the plant holds its input, and the
// program is killed. The state stays inside, no estimate is empty, and in the end the session says
// what one says that had every sample in time.
#include <algorithm>
#include <cmath>
#include <random>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "online/study.hpp"

using namespace online_test;
using Json = nlohmann::json;

namespace {

class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}
  double real(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_()) / 4294967296.0;
  }
  Index whole(Index lower, Index upper) {
    return lower + static_cast<Index>(engine_() % static_cast<unsigned>(upper - lower + 1));
  }
  bool chance(double p) { return real(0, 1) < p; }

 private:
  std::mt19937 engine_;
};

Json rows(const Matrix& M) {
  Json all = Json::array();
  for (Index i = 0; i < M.rows(); ++i)
    all.push_back(std::vector<double>(M.row(i).begin(), M.row(i).end()));
  return all;
}

Json box(const Vector& r) {
  const Vector lower = -r;
  return {{"type", "box"},
          {"lower", std::vector<double>(lower.begin(), lower.end())},
          {"upper", std::vector<double>(r.begin(), r.end())}};
}

/// Stable, in units from 1e-6 to 1e6, with rows of C that repeat and outputs without noise.
struct Stranger {
  Stranger(Index n, Index p, bool noise_free, Draws& draws) : A(n, n), B(n, 1), C(p, n) {
    scale = Vector(n);
    for (Index i = 0; i < n; ++i)
      scale[i] = std::pow(10.0, static_cast<double>(draws.whole(-6, 6)));
    for (double& entry : A.reshaped()) entry = draws.real(-1, 1);
    A *= draws.real(0.4, 0.95) / std::max(1.0, A.cwiseAbs().rowwise().sum().maxCoeff());
    for (double& entry : B.reshaped()) entry = draws.real(-1, 1);
    for (double& entry : C.reshaped()) entry = draws.chance(0.3) ? 0 : draws.real(-1, 1);
    if (p > 1) C.row(p - 1) = C.row(0);
    A = scale.asDiagonal() * A * scale.cwiseInverse().asDiagonal();
    B = scale.asDiagonal() * B;
    C = C * scale.cwiseInverse().asDiagonal();
    w = 0.01 * scale;
    v = Vector::Constant(p, noise_free ? 0.0 : 0.02);
    x = Vector::Zero(n);
  }

  std::string study(const char* backend, const Json& observer, const Json& online) const {
    const Index n = A.rows(), p = C.rows();
    const Json system{{"type", "lti"},    {"A", rows(A)},
                      {"B", rows(B)},     {"Bw", rows(Matrix::Identity(n, n))},
                      {"C", rows(C)},     {"Dv", rows(Matrix::Identity(p, p))},
                      {"X0", box(scale)}, {"W", box(w)},
                      {"V", box(v)}};
    Json all{{"cordon", 1}, {"system", system}};
    all["pipelines"] = {{{"name", "it"}, {"backend", backend}, {"observer", observer}}};
    if (!online.is_null()) all["online"] = online;
    return all.dump();
  }

  GivenSample next(Index k, double u, Draws& draws) {
    GivenSample sample{k, Vector::Constant(1, u), C * x};
    for (Index i = 0; i < v.size(); ++i) sample.y[i] += draws.real(-0.95, 0.95) * v[i];
    x = A * x + B * sample.u;
    for (Index i = 0; i < x.size(); ++i) x[i] += draws.real(-0.95, 0.95) * w[i];
    return sample;
  }

  Matrix A, B, C;
  Vector scale, w, v, x;
};

/// What the plant has made, and when what of it is sent.
struct Course {
  std::vector<GivenSample> samples;
  std::vector<Vector> states;
  std::vector<std::vector<GivenSample>> sent;  ///< by time
};

constexpr Index lag = 6;

Course course_of(Stranger plant, Index steps, Draws& draws) {
  Course course;
  course.sent.resize(static_cast<std::size_t>(steps));
  double u = 0;
  Index down_until = -1;
  const auto at = [](Index k) { return static_cast<std::size_t>(k); };
  for (Index k = 0; k < steps; ++k) {
    const bool ends = k + lag >= steps;
    if (k > 0 && k > down_until && !ends && draws.chance(0.03)) down_until = k + draws.whole(0, 2);
    const bool is_down = k <= down_until;
    if (!is_down) u = draws.real(-1, 1);
    course.states.push_back(plant.x);
    const GivenSample sample = plant.next(k, u, draws);
    course.samples.push_back(sample);
    GivenSample first = sample;
    for (double& y : first.y) y = !ends && draws.chance(0.3) ? NAN : y;
    if (!is_down) course.sent[at(k)].push_back(first);
    if (!is_down && draws.chance(0.1)) course.sent[at(k)].push_back(first);
    // All comes in the end, within the lag: when the line is up again, and in two parts at times.
    const Index later = std::max(k + draws.whole(1, 2), is_down ? down_until + 1 : k);
    GivenSample part = sample;
    if (draws.chance(0.5)) part.y[0] = NAN;
    course.sent[at(std::min(later, steps - 1))].push_back(part);
    course.sent[at(std::min(later + 1, steps - 1))].push_back(sample);
  }
  return course;
}

bool is_inside(const Box& hull, const Vector& x, const Vector& scale) {
  const Vector room = 1e-9 * (scale + x.cwiseAbs());
  return ((hull.lower - room).array() <= x.array()).all() &&
         ((hull.upper + room).array() >= x.array()).all();
}

/// Steps through the course; the session is another one now and then, that goes on from what was
/// saved. The last hull.
Box watched(const Loaded& loaded, const Course& course, const Stranger& plant, Draws& draws) {
  OnlineSession session(loaded.study, loaded.registry);
  Box last;
  for (const std::vector<GivenSample>& sent : course.sent) {
    for (const GivenSample& sample : sent) {
      for (const SessionStep& step : session.take(sample).steps) {
        const EstimateStep& done = *step.estimate;
        REQUIRE(done.estimate.consistent != Answer::no);
        REQUIRE(is_inside(done.hull, course.states[static_cast<std::size_t>(step.k)], plant.scale));
        last = done.hull;
      }
    }
    if (!draws.chance(0.05)) continue;
    const std::string saved = session.save();
    session = OnlineSession(loaded.study, loaded.registry);
    session.restore(saved);
  }
  return last;
}

struct Way {
  const char* backend;
  Json observer;
};

std::vector<Way> all_ways() {
  return {{"zonotope", {{"type", "prediction_correction"}, {"max_generators", 40}}},
          {"constrained_zonotope",
           {{"type", "prediction_correction"}, {"max_generators", 40}, {"max_constraints", 6}}},
          {"zonotope", {{"type", "gain_correction"}, {"max_generators", 40}}},
          {"zonotope", {{"type", "luenberger"}, {"max_generators", 40}}},
          {"interval", {{"type", "error_hull"}}}};
}

void check_plants(unsigned first, unsigned last, Index most_states, Index steps,
                  const std::vector<Way>& ways = all_ways()) {
  const Json rules{{"jumps", "fill"}, {"late", "correct"}, {"lag", lag}, {"repeated", "ignore"}};
  for (unsigned seed = first; seed <= last; ++seed) {
    CAPTURE(seed);
    Draws draws(seed);
    const Index n = draws.whole(1, most_states), p = draws.whole(1, 3);
    const Stranger plant(n, p, draws.chance(0.3), draws);
    const Course course = course_of(plant, steps, draws);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      CAPTURE(i);
      const Loaded loaded(plant.study(ways[i].backend, ways[i].observer, rules), Loaded::whole);
      const Box in_the_end = watched(loaded, course, plant, draws);
      OnlineSession in_time(loaded.study, loaded.registry);
      Box hull;
      for (const GivenSample& sample : course.samples)
        hull = in_time.take(sample).steps.at(0).estimate->hull;
      CHECK(in_the_end.lower == hull.lower);
      CHECK(in_the_end.upper == hull.upper);
    }
  }
}

}  // namespace

TEST_CASE("plants of up to 6 states, beside which everything goes wrong") {
  check_plants(1, 8, 6, 120);
}

TEST_CASE("plants of up to 12 states") { check_plants(101, 103, 12, 150); }

TEST_CASE("one of them for 5,000 steps") {
  check_plants(202, 202, 4, 5000, {all_ways().front(), all_ways().back()});
}
