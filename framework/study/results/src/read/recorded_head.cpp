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

bool expect_all_sets(const Cursor& root) {
  const auto kept = root.find("sets");
  const auto text = kept ? read_text(*kept, 10) : std::nullopt;
  if (!kept || !text) return !kept;
  if (*text == "last" || *text == "none") {
    kept->error(*text == "last" ? "only the last sets were kept (--sets last)"
                                : "no sets were kept (--sets none)",
                "run the study again without --sets");
  } else {
    kept->error("must be \"last\" or \"none\"",
                "the file is not as \"cordon run\" wrote it; run the study again");
  }
  return false;
}

}  // namespace cordon::json
