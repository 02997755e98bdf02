// SPDX-License-Identifier: GPL-3.0-or-later
#include <random>

#include <doctest/doctest.h>

#include "published/study_models.hpp"

using namespace cordon;

namespace {

Model model() {
  Model made;
  LinearModel& m = made.linear;
  m.A = Matrix{{1, .1}, {0, .8}};
  m.B = Matrix(2, 0);
  m.Bw = Matrix{{1}, {0}};
  m.C = Matrix{{1, 0}};
  m.D = Matrix(1, 0);
  m.Dv = Matrix{{2}};
  made.X0 = make_box(cube(2, 1));
  made.W = make_box(cube(1, .3));
  made.V = make_box(cube(1, .2));
  return made;
}

Params matrix(const Matrix& L) { return Params().set("matrix", L); }

}  // namespace

TEST_CASE("a given gain is told with what it is worth") {
  const Plugins plugins;
  Model made = model();
  const auto designer = plugins.registry.make<GainEntry>("given", matrix(Matrix{{.5}, {0}}));
  CHECK_FALSE(designer->is_time_varying());
  const GainDesign design = designer->design(made);
  REQUIRE(design.feasible == Answer::yes);
  const GainCertificate& c = design.gain.certificate;
  CHECK(c.spectral_radius == doctest::Approx(.8));
  CHECK(c.monotone == Answer::yes);
  // (zI - [.5 .1; 0 .8])⁻¹ (.3, -.2; 0 0): √(.09 + .04) / .5 at ω = 0
  CHECK(c.norm_upper == doctest::Approx(std::sqrt(.13) / .5).epsilon(1e-8));
  CHECK(c.norm_lower <= c.norm_upper);
  CHECK(c.objective.empty());

  made.linear.A_radius = Matrix{{.01, .02}, {0, 0}};  // Eθ = diag(.03, 0)
  const double wider = designer->design(made).gain.certificate.norm_upper;
  CHECK(wider == doctest::Approx(std::sqrt(.13 + .0009) / .5).epsilon(1e-8));

  made.linear.A(0, 1) = -.1;
  CHECK(designer->design(made).gain.certificate.monotone == Answer::no);

  made.W = make_space(1);
  const GainCertificate without = designer->design(made).gain.certificate;
  CHECK(std::isnan(without.norm_upper));
  CHECK(without.spectral_radius == doctest::Approx(.8));
}

TEST_CASE("effectiveness of sensors known by ranges enters by its middle") {
  const Plugins plugins;
  Model made = model();
  made.linear.sensor = Box{Vector{{.2}}, Vector{{1}}};  // mid .6: A - L C̄ has 1 - .3
  const GainCertificate c = plugins.registry.make<GainEntry>("given", matrix(Matrix{{.5}, {0}}))
                                ->design(made)
                                .gain.certificate;
  CHECK(c.spectral_radius == doctest::Approx(.8));
  made.linear.A(1, 1) = .1;
  CHECK(plugins.registry.make<GainEntry>("given", matrix(Matrix{{.5}, {0}}))
            ->design(made)
            .gain.certificate.spectral_radius == doctest::Approx(.7));
}

TEST_CASE("a gain of another shape and one that does not stabilise are refused") {
  const Plugins plugins;
  const Model made = model();
  for (const auto& [L, words] :
       {std::pair<Matrix, const char*>{Matrix{{.5, 0}}, "is 1 × 2, must be 2 × 1"},
        {Matrix{{-.1}, {0}}, "not Schur: it has the eigenvalue 1.1"}}) {
    const auto problems = plugins.registry.check<GainEntry>("given", {made}, matrix(L));
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].pointer == "/matrix");
    CHECK(problems[0].message.find(words) != std::string::npos);
    const GainDesign design = plugins.registry.make<GainEntry>("given", matrix(L))->design(made);
    CHECK(design.feasible == Answer::no);
    CHECK(design.reason.find(words) != std::string::npos);
  }
  CHECK_THROWS_AS(plugins.registry.make<GainEntry>("given", {}), InputError);
}

TEST_CASE("where A - L C cancels, the norm is that of the numbers as they are written") {
  const Plugins plugins;
  Model made = model();
  LinearModel& m = made.linear;
  m.A = Matrix{{34899.71432053099}};
  m.B = Matrix(1, 0);
  m.Bw = Matrix{{1}};
  m.C = Matrix{{2.7126114260768057}};
  m.Dv = Matrix{{1}};
  made.X0 = make_box(cube(1, 1));
  made.W = make_box(cube(1, .01));
  made.V = make_box(cube(1, .1));
  const auto certificate = [&](double L) {
    return plugins.registry.make<GainEntry>("given", matrix(Matrix{{L}}))
        ->design(made)
        .gain.certificate;
  };
  const double exact = 45352157.0321;  // √(.01² + (.1 L)²) / (1 - |A - L C|) in rational
                                       // arithmetic; of doubles .9 less
  CHECK(certificate(12865.356981619727).norm_lower <= exact);
  CHECK(certificate(12865.356981619727).norm_upper >= exact);
  CHECK(certificate(12865.356981619727).norm_upper <= exact * (1 + 1e-5));

  m.A = Matrix{{1}};
  m.C = Matrix{{1e-10}};
  CHECK(certificate(1e-10).spectral_radius == 1);  // 1 - 1e-20, above all doubles below 1
  CHECK(certificate(1e-10).norm_lower == 0);
  CHECK(std::isinf(certificate(1e-10).norm_upper));
}

TEST_CASE("a loop far from normal: what doubles call stable and is not, and the other way round") {
  // T S T⁻¹ with S¹² = last I, T a product of integer steps
  const auto loop = [](double last) {
    Matrix A = Matrix::Zero(12, 12);
    for (Index i = 0; i < 11; ++i) A(i, i + 1) = 1;
    A(11, 0) = last;
    std::mt19937_64 engine(1);
    for (int k = 0; k < 70; ++k) {
      const Index i = static_cast<Index>(engine() % 12), j = static_cast<Index>(engine() % 12);
      if (i == j) continue;
      A.row(i) += A.row(j);
      A.col(j) -= A.col(i);
    }
    return A;
  };
  const Plugins plugins;
  Model made = model();
  LinearModel& m = made.linear;
  const auto feasible = [&](double last) {
    m.A = loop(last);
    m.B = Matrix(12, 0);
    m.Bw = Matrix::Identity(12, 1);
    m.C = Matrix::Identity(1, 12);
    made.X0 = make_box(cube(12, 1));
    return plugins.registry.make<GainEntry>("given", matrix(Matrix::Zero(12, 1)))
        ->design(made)
        .feasible;
  };
  CHECK(feasible(1.25) != Answer::yes);
  CHECK(feasible(.5) == Answer::yes);
  CHECK(feasible(0) == Answer::yes);
}
