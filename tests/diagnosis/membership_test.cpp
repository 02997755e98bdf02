// SPDX-License-Identifier: GPL-3.0-or-later
// Membership in output tubes against rational arithmetic, on models whose numbers are multiples of
// 1/4 and 1/16: products are exact, so that both see the same problem.
#include "diagnosers/tube_membership/membership.hpp"

#include <random>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/certificate.hpp"
#include "diagnosis/full_information.hpp"
#include "input_design/plugins.hpp"

using namespace cordon;
using namespace diagnosis_test;

namespace {

/// Random multiples.
class Quarters {
 public:
  explicit Quarters(std::uint64_t seed) : engine_(seed) {}
  Index below(Index end) { return static_cast<Index>(engine_() % static_cast<std::uint64_t>(end)); }
  double operator()(Index most, double unit = .25) {
    return unit * static_cast<double>(below(2 * most + 1) - most);
  }
  Matrix matrix(Index rows, Index cols, Index most) {
    return Matrix::NullaryExpr(rows, cols, [&] { return (*this)(most); });
  }
  Vector vector(Index size, Index most, double unit = .25) {
    return Vector::NullaryExpr(size, [&] { return (*this)(most, unit); });
  }

 private:
  std::mt19937_64 engine_;
};

LineForm box(Index n, double radius) {
  return make_box({Vector::Constant(n, -radius), Vector::Constant(n, radius)});
}

/// The first n_d states are dynamic, each other one stands in a static row with the coefficient 1.
Model random_model(Quarters& draw) {
  Model model;
  LinearModel& m = model.linear;
  const Index n = 1 + draw.below(3), dynamic = draw.below(3) == 0 ? n : draw.below(n + 1),
              p = 1 + draw.below(2);
  m.A = draw.matrix(n, n, 4);
  if (dynamic < n || draw.below(2) == 0) {
    m.E = Matrix::Identity(n, n);
    m.E.bottomRightCorner(n - dynamic, n - dynamic).setZero();
    m.A.bottomRightCorner(n - dynamic, n - dynamic) = Matrix::Identity(n - dynamic, n - dynamic);
  }
  m.B = draw.matrix(n, 1 + draw.below(2), 4);
  m.Bw = draw.matrix(n, draw.below(3), 2);
  m.C = draw.matrix(p, n, 4);
  m.D = draw.matrix(p, m.B.cols(), 4);
  m.Dv = draw.matrix(p, draw.below(3), 2);
  model.W = box(m.Bw.cols(), .25);
  model.V = box(m.Dv.cols(), .25);
  model.X0 = draw.below(3) == 0 ? make_space(n) : box(n, 2);
  return model;
}

/// Samples of the model, with outputs that are displaced by up to `noise` quarters at one time.
std::vector<Sample> random_samples(const Model& model, Quarters& draw, Index steps, Index noise) {
  const LinearModel& m = model.linear;
  const Index n = m.states(), free = m.is_descriptor() ? static_cast<Index>(m.E.sum()) : n;
  const auto inside = [&](const LineForm& X) { return Vector(draw.vector(X.dim(), 4, .0625)); };
  Vector x = draw.vector(n, 2);
  std::vector<Sample> samples;
  const Index displaced = draw.below(steps + 1);
  for (Index k = 0; k <= steps; ++k) {
    const Vector u = draw.vector(m.inputs(), 4), w = inside(model.W);
    x.tail(n - free).setZero();
    x.tail(n - free) = -(m.A * x + m.B * u + m.Bw * w).tail(n - free);
    Vector y = m.C * x + m.D * u + m.Dv * inside(model.V);
    if (k == displaced) y += draw.vector(y.size(), noise);
    samples.push_back({k, u, y});
    x = m.A * x + m.B * u + m.Bw * w;
  }
  return samples;
}

struct Stacked {
  Vector u, y;
};
Stacked stacked(const std::vector<Sample>& samples) {
  Stacked all;
  for (const Sample& now : samples) {
    for (const auto& [to, part] : {std::pair(&all.u, &now.u), std::pair(&all.y, &now.y)}) {
      to->conservativeResize(to->size() + part->size());
      to->tail(part->size()) = *part;
    }
  }
  return all;
}

}  // namespace

TEST_CASE("membership agrees with rational arithmetic, and its proofs hold there") {
  const auto backend = examples::backend("line_zonotope");
  int inside = 0, outside = 0, open = 0, missed = 0, proofs = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    CAPTURE(seed);
    Quarters draw(seed);
    const Model model = random_model(draw);
    const Index steps = draw.below(4);
    const std::vector<Sample> samples =
        random_samples(model, draw, steps, draw.below(3) == 0 ? 0 : 8);
    const Stacked all = stacked(samples);
    const OutputTube tube = output_tube(model, *backend, {steps});
    Certificate why;
    const Answer answer = diagnosers::membership(tube, all.u, all.y, &why);
    if (answer == Answer::unknown) {
      CHECK(why.kind == Certificate::Kind::none);
      ++open;
      missed += contradicts(model, samples);
      continue;
    }
    REQUIRE((answer == Answer::no) == contradicts(model, samples));
    if (answer == Answer::no) {
      ++outside;
      REQUIRE(why.kind == Certificate::Kind::farkas);
      CHECK(why.margin > 0);
      CHECK(proves_excludes(tube.at(all.u), all.y, why));
    } else {
      ++inside;
      REQUIRE(why.kind == Certificate::Kind::point);
      REQUIRE(why.data.size() == tube.S.cols() + tube.A.cols());
      proofs += proves_contains(tube.at(all.u), all.y, why);
      const Vector delta = why.data.head(tube.S.cols()), xi = why.data.tail(tube.A.cols());
      const LineForm Y = tube.at(all.u);
      CHECK((Y.S * delta + Y.A * xi - Y.b).cwiseAbs().sum() < 1e-9);
      CHECK((Y.c + Y.M * delta + Y.G * xi - all.y).cwiseAbs().sum() < 1e-9);
    }
  }
  CHECK(inside >= 400);
  CHECK(outside >= 400);
  CHECK(open <= 200);  // solutions that touch their bounds, and rows that depend on each other
  CHECK(missed == 0);
  CHECK(proofs >= inside - inside / 20);
}

TEST_CASE("a mode without outputs that could differ is never excluded") {
  Model model;
  model.linear = {{}, Matrix{{1}}, Matrix{{1}}, Matrix{{1}}, Matrix{{1}}, Matrix{{0}}, Matrix{{1}}};
  model.X0 = model.V = make_space(1);
  model.W = box(1, .1);
  const auto tube = output_tube(model, *examples::backend("line_zonotope"), {2});
  Certificate why;
  CHECK(diagnosers::membership(tube, Vector{{1, 2, 3}}, Vector{{1e6, -1e6, 5}}, &why) ==
        Answer::yes);
  CHECK(why.kind == Certificate::Kind::point);
  CHECK(proves_contains(tube.at(Vector{{1, 2, 3}}), Vector{{1e6, -1e6, 5}}, why));
}

TEST_CASE("what may stem from rounding of large numbers excludes nothing") {
  const auto answer = [](double input, double offset, double gain, double first, double output) {
    Model model;
    model.linear = {{},          Matrix{{1}}, Matrix{{gain}}, Matrix{{1}},
                    Matrix{{1}}, Matrix{{1}}, Matrix{{1}}};
    model.X0 = model.W = box(1, .1);
    model.V = make_zonotope(Vector{{offset}}, Matrix{{.1}});
    const auto tube = output_tube(model, *examples::backend("zonotope"), {1});
    return diagnosers::membership(tube, Vector{{input, 0}},
                                  Vector{{input + offset + first, output}});
  };
  CHECK(answer(0, 0, 1, 0, 0) == Answer::yes);
  CHECK(answer(0, 0, 1, .5, 0) == Answer::no);
  CHECK(answer(0, 0, 1, 0, .5) == Answer::no);
  // y_0 = x_0 + u_0 + v_0 and y_1 = x_0 + w_0 + B u_0 + v_1, with large terms in u_0 or in v
  CHECK(answer(1e10, 0, 0, .5, 0) == Answer::unknown);
  CHECK(answer(1e10, 0, 0, 50, 0) == Answer::no);
  CHECK(answer(0, 1e10, 0, 0, 1e10 + .5) == Answer::unknown);
  CHECK(answer(0, 1e10, 0, 0, 1e10 + 50) == Answer::no);
  CHECK(answer(1e10, 0, 1, 0, 1e10 + .5) == Answer::unknown);
  CHECK(answer(1e10, 0, 1, 0, 1e10 + 50) == Answer::no);
}

TEST_CASE("numbers that overflow are an error, not an answer") {
  Model model;
  model.linear = {{}, Matrix{{1}}, Matrix{{4}}, Matrix{{1}}, Matrix{{1}}, Matrix{{0}}, Matrix{{1}}};
  model.X0 = model.W = model.V = box(1, 1);
  const auto tube = output_tube(model, *examples::backend("zonotope"), {1});
  CHECK_THROWS_AS(diagnosers::membership(tube, Vector{{1e308, 0}}, Vector{{0, 0}}), Error);
}
