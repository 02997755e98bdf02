// SPDX-License-Identifier: GPL-3.0-or-later
// A sampled DC motor with a weak supply and with friction as faults: designs with many inputs.
#pragma once

#include "input_design/systems.hpp"

namespace cordon::examples {

/// Current and speed; the speed is measured.
inline ModeBank motor_models() {
  Model model;
  model.linear = {{},
                  Matrix{{0.12068803200777645, -0.042281095904099994},
                         {0.4228109590410001, 0.9620818404993664}},
                  Matrix{{0.42561846320018526}, {0.28075041591852995}},
                  Matrix{{0.28075041591852995}, {-9.843117908780599}},
                  Matrix{{0, 1}},
                  Matrix{{0}},
                  Matrix{{1}}};
  model.X0 = make_box({numbers({-.2, -.5}), numbers({.2, .5})});
  model.W = cube(1, .01);
  model.V = cube(1, .3);
  model.U = cube(1, 24);
  ModeBank bank{{{"healthy", model}, {"supply", model}, {"friction", model}}, 0};
  bank.modes[1].model.linear.B *= .7;
  LinearModel& friction = bank.modes[2].model.linear;
  friction.A = Matrix{{0.12114472828865985, -0.040388201188592335},
                      {0.40388201188592343, 0.8965981911096327}};
  friction.B = Matrix{{0.4257562420211521}, {0.2734278766903595}};
  friction.Bw = Matrix{{0.2734278766903594}, {-9.507377652666422}};
  return bank;
}

/// With an elastic shaft and a load; current and speed are measured.
inline ModeBank motor_with_shaft_models() {
  Model model;
  model.linear = {
      {},
      Matrix{
          {0.12245694733775059, -0.03332222790977608, 1.0137131947754838, -0.008974338846932483},
          {0.3332222790977607, 0.5828266437871978, -27.961039003465228, 0.38043454812435973},
          {0.004054852779101933, 0.011184415601386081, -0.1521759807653198, -0.01128781546869986},
          {0.1794867769386496, 0.7608690962487203, 56.43907734349939, 0.21697075189033987}},
      Matrix{{0.4260334655071318},
             {0.2547612164798594},
             {0.0018052714848914462},
             {0.052018577524762716}},
      Matrix{
          {0.05201857752476272}, {-2.83523931988175}, {0.1537812386642155}, {-14.123054788581621}},
      Matrix{{1, 0, 0, 0}, {0, 1, 0, 0}},
      Matrix::Zero(2, 1),
      Matrix::Identity(2, 2)};
  const Vector x0 = numbers({.2, .5, .01, .5}), v = numbers({.1, .3});
  model.X0 = make_box({-x0, x0});
  model.W = cube(1, .01);
  model.V = make_box({-v, v});
  model.U = cube(1, 24);
  ModeBank bank{{{"healthy", model}, {"supply", model}, {"friction", model}}, 0};
  bank.modes[1].model.linear.B *= .7;
  LinearModel& friction = bank.modes[2].model.linear;
  friction.A = Matrix{
      {0.12350667608268517, -0.02931693558954445, 0.937736087051096, -0.008519414218810343},
      {0.2931693558954446, 0.46366429928426645, -24.893775316983813, 0.356231618942664},
      {0.003750944348204383, 0.009957510126793528, -0.13046911559210383, -0.011410332239363323},
      {0.17038828437620657, 0.7124632378853275, 57.051661196816596, 0.21435217111119664}};
  friction.B = Matrix{{0.42637000117996277},
                      {0.23753321557389043},
                      {0.0017138800433948009},
                      {0.049985998163671164}};
  friction.Bw = Matrix{
      {0.04998599816367125}, {-2.7036028070354923}, {0.15430677876848092}, {-14.113935046398812}};
  return bank;
}

}  // namespace cordon::examples
