// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/recorded_head.hpp"

namespace cordon::json {

bool expect_results(const Cursor& root) {
  if (!root.expect(Value::Kind::object, "a results file of \"cordon run\" is an object"))
    return false;
  const auto version = root.need("cordon_results", "this is not a results file of \"cordon run\"");
  const auto number = version ? read_number(*version) : std::nullopt;
  if (number && *number != 1)
    version->error("this version of the format is not known", "this program reads 1");
  return number && *number == 1;
}

}  // namespace cordon::json
