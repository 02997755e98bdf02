// SPDX-License-Identifier: GPL-3.0-or-later
#include "cddlib_listener.hpp"

#include <fmt/format.h>

namespace cordon {

namespace verification {

namespace {

SecondOpinionFindings::Count as_count(const cdd::SecondOpinion::Count& count) {
  return {count.agree, count.disagree, count.too_large, count.unanswered};
}

}  // namespace

void CddlibListener::asked_by(const std::string& pipeline) {
  opinion_.asked_by(fmt::format("pipeline \"{}\"", pipeline));
}

void CddlibListener::asked_by(const std::string& pipeline, Index k) {
  opinion_.asked_by(fmt::format("pipeline \"{}\", k = {}", pipeline, k));
}

SecondOpinionFindings CddlibListener::findings() const {
  return {"cddlib " + cdd::version(), as_count(opinion_.conversions()),
          as_count(opinion_.programs()), opinion_.first_disagreement(),
          opinion_.first_unanswered()};
}

}  // namespace verification

std::string cddlib_version() { return cdd::version(); }

}  // namespace cordon
