// SPDX-License-Identifier: GPL-3.0-or-later
// The gains printed in [Pourasghar2021], and what is wrong with some of them
// (docs/interval_observers.md).
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "gains/interval_plants.hpp"

using namespace cordon;
using namespace interval_plants;

namespace {

struct Printed {
  const char* of;
  Model model;
  Matrix theta;
  Vector L;
  double radius;  ///< of A - L C
  bool monotone;
  double norm;   ///< ‖G_ed‖∞
  double least;  ///< over all stable gains
};

std::vector<Printed> printed() {
  const Matrix I3 = Matrix::Identity(3, 3), I2 = Matrix::Identity(2, 2);
  return {{"(68) set-based", three_states(), I3, Vector{{.2781, .2855, .7982}}, .8002710107923026,
           false, 6.4320429082656965, 6.431932094852626},
          {"(68) monotone", three_states(), I3, Vector{{.3, .2, .8}}, .8, true, 6.439588006455294,
           6.431932094852626},
          {"(70) trajectories", three_states(-.1), I3, Vector{{.2754, 1.0571, .7724}},
           .8327795356378738, false, 8.292974176314026, 6.416349619424086},
          {"(70) integrated", three_states(-.1), I3, Vector{{.2892, .295, .8001}},
           .8108899498029091, false, 6.4736606272874315, 6.416349619424086},
          {"(72) set-based", two_tanks(), I2, Vector{{.6647, .6542}}, .9767724586444169, false,
           62.02840354726771, 62.02839187351686},
          {"(72) trajectories", two_tanks(), I2, Vector{{.6542, .6493}}, .9768714020861251, false,
           62.02880380535153, 62.02839187351686},
          {"(72) monotone", two_tanks(), I2, Vector{{.001, .9803}}, .9885883505664119, false,
           87.63820337103347, 62.02839187351686},
          {"(72) W-radius", two_tanks(), I2, Vector{{.01, .9903}}, .9884846719597846, false,
           86.86222778871678, 62.02839187351686}};
}

TEST_CASE("the printed gains: how stable and how good they are, and which are monotone") {
  const Plugins plugins;
  for (const Printed& gain : printed()) {
    CAPTURE(std::string(gain.of));
    Model model =
        gain.model;  // Eθ as a disturbance: the certificate of a given gain knows of no other
    const Index n = model.linear.states();
    Matrix Bw(n, model.linear.Bw.cols() + gain.theta.cols());
    Bw << model.linear.Bw, gain.theta;
    model.linear.Bw = Bw;
    model.W = make_box(cube(Bw.cols(), 1));
    const auto designer =
        plugins.registry.make<GainEntry>("given", Params().set("matrix", Matrix(gain.L)));
    const GainDesign design = designer->design(model);
    REQUIRE(design.feasible == Answer::yes);
    const GainCertificate& certificate = design.gain.certificate;
    CHECK(certificate.spectral_radius == doctest::Approx(gain.radius).epsilon(1e-9));
    CHECK((certificate.monotone == Answer::yes) == gain.monotone);
    CHECK(certificate.norm_lower <= certificate.norm_upper);
    CHECK(certificate.norm_lower == doctest::Approx(gain.norm).epsilon(1e-6));
    CHECK(certificate.norm_upper == doctest::Approx(gain.norm).epsilon(1e-6));
    CHECK(certificate.norm_upper >= gain.least * (1 - 1e-6));
  }
}

TEST_CASE(
    "the gain printed for the set-based observer of the non-monotone system is unstable, its "
    "negative is not") {
  const Plugins plugins;
  const Matrix L{{-1.1376}, {-1.9167}, {-1.2604}};
  const GainDesign design = plugins.registry.make<GainEntry>("given", Params().set("matrix", L))
                                ->design(three_states(-.1));
  CHECK(design.feasible == Answer::no);
  CHECK(design.reason.find("2.07") != std::string::npos);
  CHECK(plugins.registry.make<GainEntry>("given", Params().set("matrix", Matrix(-L)))
            ->design(three_states(-.1))
            .feasible == Answer::yes);
}

}  // namespace
