// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/answer.hpp"

namespace cordon {

std::string_view to_string(Answer answer) noexcept {
  return answer == Answer::yes ? "yes" : answer == Answer::no ? "no" : "unknown";
}
std::string_view to_string(Tightness tightness) noexcept {
  return tightness == Tightness::exact ? "exact" : "outer";
}
std::string_view to_string(Rounding rounding) noexcept {
  return rounding == Rounding::nominal   ? "nominal"
         : rounding == Rounding::outward ? "outward"
                                         : "rational";
}
std::string_view to_string(Certificate::Kind kind) noexcept {
  switch (kind) {
    case Certificate::Kind::none:
      return "none";
    case Certificate::Kind::farkas:
      return "farkas";
    case Certificate::Kind::point:
      return "point";
    case Certificate::Kind::dual:
      return "dual";
    case Certificate::Kind::direction:
      return "direction";
    case Certificate::Kind::structure:
      return "structure";
    case Certificate::Kind::rows:
      return "rows";
  }
  return "none";
}

}  // namespace cordon
