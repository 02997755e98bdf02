// SPDX-License-Identifier: GPL-3.0-or-later
// The descriptor system of [Rego2025, section 6.1] and one run of it with w_k = (sin k, cos 2k,
// sin(3k+1)) (w_0 = (0,1,0)), v_k = (cos k, sin(2k+.5)), x_0 = (.5,.5,.25), u_k = (1 + .5 sin(π k /
// 10), -2 cos(π k / 10)).
#pragma once

#include "cordon/study/study.hpp"

namespace published {

inline constexpr double states[13][3] = {
    {0.5, 0.5, 0.25},
    {1.375, 0.375, 1.641581497184757},
    {2.7469463442606417, -1.0700832874110209, 2.8877960287348787},
    {4.202193555326565, -1.4175214676772694, 5.237366955698821},
    {6.138400753506153, 2.2797943753584486, 4.746403343730944},
    {6.842250057235333, 6.240241219932634, 3.894871437268055},
    {6.77266831978538, 10.14342191110959, 1.6110310384328137},
    {5.63943638743678, 16.938200398231047, -2.8243530261045007},
    {2.8777488377254925, 21.983515820165614, -8.03459802229865},
    {-1.185596141478004, 23.368083867602543, -13.032181548263997},
    {-5.913168499159351, 24.14379085599644, -17.74264133996373},
    {-10.882307030650477, 20.818189606589222, -21.608851445617102},
    {-15.500086755976334, 11.473606294737731, -20.850767023331002},
};

inline constexpr double outputs[13][2] = {
    {1.25, 0.7191383079063044},
    {3.2867326501188265, 1.8977082161559347},
    {5.426668954721949, 2.350734455174017},
    {8.944564262725162, 5.942395005135557},
    {10.557982286805291, 5.05633704708294},
    {10.878952587235, -0.7175348026548061},
    {8.863784501543376, -3.470236437351011},
    {3.192034488503932, -9.89642142750724},
    {-5.229599201477464, -20.17344499599381},
    {-14.67334282068434, -25.067400936784967},
    {-24.075345603661304, -28.56171466373759},
    {-32.48894562727355, -32.431258405930464},
    {-35.92892679994109, -27.86072934551175},
};

inline cordon::Model descriptor_model() {
  cordon::Model model;
  cordon::LinearModel& m = model.linear;
  m.E = cordon::Matrix::Zero(3, 3);
  m.E(0, 0) = m.E(1, 1) = 1;
  m.A.resize(3, 3);
  m.A << .5, 0, .5, .8, .95, 0, -1, .5, 1;
  m.B = cordon::Matrix::Zero(3, 2);
  m.B(0, 0) = m.B(1, 1) = 1;
  m.Bw = cordon::Vector{{.1, 1.5, .6}}.asDiagonal();
  m.C.resize(2, 3);
  m.C << 1, 0, 1, 1, -1, 0;
  m.D = cordon::Matrix::Zero(2, 2);
  m.Dv = cordon::Vector{{.5, 1.5}}.asDiagonal();
  model.X0 = cordon::make_zonotope(cordon::Vector{{.5, .5, .25}},
                                   cordon::Matrix(cordon::Vector{{.1, 1.5, .6}}.asDiagonal()));
  model.W = cordon::make_box({-cordon::Vector::Ones(3), cordon::Vector::Ones(3)});
  model.V = cordon::make_box({-cordon::Vector::Ones(2), cordon::Vector::Ones(2)});
  return model;
}

inline std::vector<cordon::Signal> descriptor_input() {
  cordon::Signal sine, cosine;
  sine.type = cordon::Signal::Type::sine;
  sine.amplitude = .5;
  sine.omega = .1 * 3.14159265358979323846;
  sine.offset = 1;
  cosine.type = cordon::Signal::Type::cosine;
  cosine.amplitude = -2;
  cosine.omega = .1 * 3.14159265358979323846;
  return {sine, cosine};
}

}  // namespace published
