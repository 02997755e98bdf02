// SPDX-License-Identifier: GPL-3.0-or-later
// Scalar, vector and matrix types of every public signature.
#pragma once

#include <cstddef>
#include <limits>

#include <Eigen/Core>

namespace cordon {

using Index = Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Read-only views: bind to a matrix, a block or a map without a copy. Never store one beyond the
/// call.
using MatrixIn = Eigen::Ref<const Matrix>;
using VectorIn = Eigen::Ref<const Vector>;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
/// A number that there is none of.
inline constexpr double not_available = std::numeric_limits<double>::quiet_NaN();

/// A coordinate as a place in a std::vector.
constexpr std::size_t as_size(Index i) { return static_cast<std::size_t>(i); }

}  // namespace cordon
