// SPDX-License-Identifier: GPL-3.0-or-later
#include "carried_zonotope.hpp"

#include "linear_rows.hpp"

namespace cordon {

namespace {

constexpr double spacing = 0x1p-52;

}  // namespace

CarriedZonotope::CarriedZonotope(const LineForm& X, const char* name) {
  const bool is_zonotope = X.lines() == 0 && X.constraints() == 0;
  const LineForm Z = is_zonotope ? X : make_box(bounded_hull(X, name));
  c_ = Z.c;
  G_ = Z.G;
}

void CarriedZonotope::advance(const LinearModel& m, VectorIn u, const CarriedZonotope& W) {
  const Index n = c_.size(), terms = n + u.size() + W.c_.size() + G_.cols() + W.G_.cols() + 8;
  const Vector size = m.A.cwiseAbs() * (c_.cwiseAbs() + G_.cwiseAbs().rowwise().sum()) +
                      m.B.cwiseAbs() * u.cwiseAbs() +
                      m.Bw.cwiseAbs() * (W.c_.cwiseAbs() + W.G_.cwiseAbs().rowwise().sum());
  const Vector rounded = 2 * spacing * static_cast<double>(terms) * size;
  Matrix next(n, G_.cols() + W.G_.cols() + n);
  next << m.A * G_, m.Bw * W.G_, Matrix(rounded.asDiagonal());
  c_ = m.A * c_ + m.B * u + m.Bw * W.c_;
  G_ = std::move(next);
}

Box CarriedZonotope::hull() const {
  const Vector radius = G_.cwiseAbs().rowwise().sum();
  const double share = 2 * spacing * static_cast<double>(G_.cols() + 4);
  const Vector room = share * (c_.cwiseAbs() + radius);
  return {c_ - radius - room, c_ + radius + room};
}

}  // namespace cordon
