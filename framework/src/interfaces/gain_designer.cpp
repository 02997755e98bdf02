// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/gain_designer.hpp"

#include "cordon/core/error.hpp"

namespace cordon {

Matrix GainDesigner::update(const Model&, MatrixIn) const {
  throw Error(Errc::internal, "this gain designer has no gain that varies in time");
}

}  // namespace cordon
