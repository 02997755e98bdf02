// SPDX-License-Identifier: GPL-3.0-or-later
// Scalar, vector and matrix types of every public signature.
#pragma once

#include <Eigen/Core>

namespace cordon {

using Index = Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Read-only views: bind to a matrix, a block or a map without a copy. Never store one beyond the
/// call.
using MatrixIn = Eigen::Ref<const Matrix>;
using VectorIn = Eigen::Ref<const Vector>;

}  // namespace cordon
