// SPDX-License-Identifier: GPL-3.0-or-later
// Points of the plane, and polygons cut by half-planes.
#pragma once

#include <cmath>
#include <vector>

#include "experiments/report/plane_set.hpp"

namespace cordon::report {

inline PlanePoint operator+(PlanePoint a, PlanePoint b) { return {a.x + b.x, a.y + b.y}; }
inline PlanePoint operator-(PlanePoint a, PlanePoint b) { return {a.x - b.x, a.y - b.y}; }
inline PlanePoint operator*(double s, PlanePoint a) { return {s * a.x, s * a.y}; }
inline double dot(PlanePoint a, PlanePoint b) { return a.x * b.x + a.y * b.y; }
inline double cross(PlanePoint a, PlanePoint b) { return a.x * b.y - a.y * b.x; }
inline double length(PlanePoint a) { return std::hypot(a.x, a.y); }

/// {dᵀx ≤ h} of a polygon with flags per edge; the new edge has the flag `open`.
void cut_with(std::vector<PlanePoint>& points, std::vector<bool>& flags, PlanePoint d, double h,
              bool open);

}  // namespace cordon::report
