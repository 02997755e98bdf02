// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/separation_problem.hpp"

namespace cordon::designers {

double Cost::at(VectorIn u) const {
  const Vector apart = (u - reference).cwiseAbs();
  if (u.size() == 0) return 0;
  switch (kind) {
    case Kind::norm_1:
      return weights.dot(apart);
    case Kind::norm_inf:
      return weights.cwiseProduct(apart).maxCoeff();
    case Kind::quadratic:
      return weights.dot(apart.cwiseAbs2());
  }
  return 0;
}

}  // namespace cordon::designers
