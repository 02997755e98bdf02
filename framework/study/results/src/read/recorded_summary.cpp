// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "read/recorded_parts.hpp"

namespace cordon::verification {

namespace {

using namespace json;
using Kind = Value::Kind;

/// What the steps say under the names of a summary.
struct Counts {
  explicit Counts(const std::vector<RecordedStep>& steps)
      : all{{"steps", static_cast<std::int64_t>(steps.size())},
            {"consistent", 0},
            {"inconsistent", 0},
            {"undecided", 0},
            {"inconsistent_from", -1}} {
    for (const RecordedStep& step : steps) {
      ++all[step.consistent == Answer::yes ? 1 : step.consistent == Answer::no ? 2 : 3].value;
      if (step.consistent == Answer::no && all[4].value < 0) all[4].value = step.k;
    }
  }
  struct Count {
    const char* name;
    std::int64_t value;  ///< negative: a time that there is not
  };
  std::vector<Count> all;
};

/// Does the member say something else? One that is absent says nothing.
bool contradicts(const Cursor& object, const Counts::Count& count) {
  const auto at = object.find(count.name);
  if (!at) return false;
  if (at->is(Kind::null)) return count.value >= 0;
  return !at->is(Kind::number) || at->value().number != static_cast<double>(count.value);
}

bool is_bound(const Cursor& box, const char* key, const Vector& bound) {
  const auto at = box.find(key);
  Problems unread;
  const auto numbers = at ? read_bounds(Cursor(at->value(), at->pointer(), unread)) : std::nullopt;
  return numbers && numbers->size() == bound.size() && *numbers == bound;
}

bool is_last(const Cursor& at, const RecordedStep& step) {
  const auto k = at.find("k"), hull = at.find("hull");
  const auto width = at.find("width");
  const bool none = step.hull.is_empty();
  if (width && none != width->is(Kind::null)) return false;
  if (width && !none && !is_bound(at, "width", step.hull.upper - step.hull.lower)) return false;
  return k && k->is(Kind::number) && k->value().number == static_cast<double>(step.k) && hull &&
         hull->is(Kind::object) && is_bound(*hull, "lower", step.hull.lower) &&
         is_bound(*hull, "upper", step.hull.upper);
}

}  // namespace

std::vector<Diagnostic> contradictions_of(const Cursor& pipeline,
                                          const std::vector<RecordedStep>& steps) {
  std::vector<Diagnostic> found;
  const Counts counts(steps);
  for (const char* part : {"summary", "numbers"}) {
    const auto at = pipeline.find(part);
    if (!at || !at->is(Kind::object)) continue;
    for (const Counts::Count& count : counts.all) {
      if (!contradicts(*at, count)) continue;
      const Cursor item = *at->find(count.name);
      found.push_back(
          {item.pointer(), "is not what the steps say", not_as_written, item.value().line});
    }
  }
  const auto last = pipeline.find("last");
  if (last && last->is(Kind::object) && (steps.empty() || !is_last(*last, steps.back())))
    found.push_back({last->pointer(), "is not the last step", not_as_written, last->value().line});
  return found;
}

}  // namespace cordon::verification
