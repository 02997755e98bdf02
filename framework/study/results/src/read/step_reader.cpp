// SPDX-License-Identifier: GPL-3.0-or-later
#include "read/step_reader.hpp"

#include <algorithm>

namespace cordon::verification {

namespace {

using namespace json;
using Kind = Value::Kind;

constexpr std::size_t max_pipelines = 1000, most_wrong = 1000;

/// Outputs from 1 on, ascending.
std::vector<Index> read_left_out(const Cursor& step) {
  std::vector<Index> outputs;
  const auto list = step.find("left_out");
  if (!list || !list->expect(Kind::array, not_as_written)) return outputs;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const auto output = read_integer(list->item(i), 1, max_dimension);
    if (!output) continue;
    const auto index = static_cast<Index>(*output) - 1;
    if (!outputs.empty() && index <= outputs.back())
      list->item(i).error("does not ascend", not_as_written);
    outputs.push_back(index);
  }
  return outputs;
}

/// A step whose hull may still be of another size than the state.
std::optional<RecordedStep> read_step(const Cursor& at) {
  if (!at.expect(Kind::object, not_as_written)) return std::nullopt;
  const auto k_at = at.need("k", not_as_written), hull = at.need("hull", not_as_written);
  const auto k = k_at ? read_integer(*k_at, 0, max_integer) : std::nullopt;
  const auto consistent = read_word(at, "consistent", {Answer::yes, Answer::no, Answer::unknown});
  const auto tightness = read_word(at, "tightness", {Tightness::exact, Tightness::outer});
  if (!hull || !hull->expect(Kind::object, not_as_written)) return std::nullopt;
  const auto lower_at = hull->need("lower", not_as_written),
             upper_at = hull->need("upper", not_as_written);
  auto lower = lower_at ? read_bounds(*lower_at) : std::nullopt,
       upper = upper_at ? read_bounds(*upper_at) : std::nullopt;
  if (!k || !consistent || !tightness || !lower || !upper) return std::nullopt;
  return RecordedStep{*k,
                      {std::move(*lower), std::move(*upper)},
                      *consistent,
                      *tightness,
                      at.value().line,
                      read_left_out(at)};
}

}  // namespace

void StepReader::take(const Cursor& at, std::size_t pipeline) {
  if (pipeline >= max_pipelines) return;
  steps_.resize(std::max(steps_.size(), pipeline + 1));
  Steps& own = steps_[pipeline];
  if (own.wrong.size() >= most_wrong) return;
  Problems problems;
  const Cursor step(at.value(), at.pointer(), problems);
  if (step.is(Kind::object) && step.find("decision")) {
    if (auto diagnosed = read_diagnosed_step(step)) own.diagnosed.push_back(std::move(*diagnosed));
  } else if (auto estimated = read_step(step)) {
    own.read.push_back(std::move(*estimated));
  }
  own.wrong.insert(own.wrong.end(), problems.found().begin(), problems.found().end());
}

std::vector<RecordedStep> StepReader::of(const Cursor& pipeline, std::size_t index, Index n,
                                         Index p) {
  if (index >= steps_.size()) return {};
  Steps& own = steps_[index];
  Problems& problems = pipeline.problems();
  for (const Diagnostic& one : own.wrong)
    problems.add(one.pointer, one.line, one.message, one.suggestion);
  for (std::size_t i = 0; i < own.read.size(); ++i) {
    const Box& hull = own.read[i].hull;
    const std::vector<Index>& left_out = own.read[i].left_out;
    if (!left_out.empty() && left_out.back() >= p) {
      problems.add(child(child(pipeline.pointer(), "steps"), i) + "/left_out", own.read[i].line,
                   "names an output that there is not", not_as_written);
    }
    if (hull.lower.size() == n && hull.upper.size() == n) continue;
    problems.add(child(child(pipeline.pointer(), "steps"), i) + "/hull", own.read[i].line,
                 "is no box of the state, which has dimension " + std::to_string(n),
                 not_as_written);
  }
  return std::move(own.read);
}

std::vector<RecordedDiagnosis::Step> StepReader::of_diagnosis(const Cursor& pipeline,
                                                              std::size_t index) {
  if (index >= steps_.size()) return {};
  for (const Diagnostic& one : steps_[index].wrong)
    pipeline.problems().add(one.pointer, one.line, one.message, one.suggestion);
  return std::move(steps_[index].diagnosed);
}

}  // namespace cordon::verification
