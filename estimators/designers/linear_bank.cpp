// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/linear_bank.hpp"

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::designers {

LinearBank::LinearBank(const ModeBank& modes) : bank(modes) {
  for (const Mode& mode : modes.modes) models.emplace_back(mode.model);
}

LinearBank::LinearBank(const ModeBank& modes, const Matrix& u) : bank(modes) {
  for (const Mode& mode : modes.modes) {
    try {
      models.push_back(model_under(mode.model, u));
    } catch (const Error& error) {
      if (error.code() != Errc::not_enclosed) throw;
      const char* way_out =
          mode.model.is_linear()
              ? ""
              : "; give the system an \"admissible\" set in which formulas are defined, or smaller "
                "sets";
      throw Error(Errc::not_enclosed,
                  fmt::format("mode \"{}\" is not enclosed under the input, {}{}", mode.name,
                              error.what(), way_out));
    }
  }
}

}  // namespace cordon::designers
