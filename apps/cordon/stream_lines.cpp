// SPDX-License-Identifier: GPL-3.0-or-later
#include "stream_lines.hpp"

#include <fmt/format.h>

#include "study/text/json_writer.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::apps {

namespace {

/// An open object that ends with its line.
class Line {
 public:
  Line() { json_.begin_object(); }
  detail::JsonWriter& json() { return json_; }
  std::string text() {
    json_.end_object();
    return std::move(sink_.text) + "\n";
  }

 private:
  detail::StringSink sink_;
  detail::JsonWriter json_{sink_};
};

std::string_view name_of(Request request) {
  return request == Request::acknowledge ? "acknowledge" : "start";
}

}  // namespace

std::string line_of(const Taken& taken, std::int64_t number) {
  Line line;
  line.json().member("how", to_string(taken.how)).member("said", taken.said);
  line.json().member("line", number);
  return line.text();
}

std::string line_of(Request request, const std::vector<AlarmChange>& alarms) {
  Line line;
  line.json().member("did", name_of(request)).key("alarms").raw(json_of(alarms));
  return line.text();
}

std::string error_text(const Error& error) {
  const auto* const input = dynamic_cast<const InputError*>(&error);
  if (!input) return error.what();
  std::string text;
  for (const Diagnostic& problem : input->diagnostics()) {
    if (!text.empty()) text += "; ";
    text += (problem.pointer.empty() ? "" : problem.pointer + ": ") + problem.message;
    if (!problem.suggestion.empty()) text += " (" + problem.suggestion + ")";
  }
  return text;
}

std::string counts_text(const TakenCounts& counts, std::int64_t refused) {
  std::string text;
  const auto add = [&](std::int64_t number, const char* what) {
    if (number > 0) text += fmt::format(", {} {}", number, what);
  };
  add(refused, "refused");
  if (counts.filled_steps > 0)
    text +=
        fmt::format(", {} time{} filled", counts.filled_steps, counts.filled_steps == 1 ? "" : "s");
  add(counts.corrected, "corrected");
  add(counts.late, "late");
  add(counts.repeated, "repeated");
  return text;
}

std::string error_line(const Error& error, std::int64_t number) {
  Line line;
  line.json().member("error", error_text(error));
  if (number > 0) line.json().member("line", number);
  return line.text();
}

std::string log_line(const GivenLine& given) {
  Line line;
  if (given.request) line.json().member("do", name_of(*given.request));
  if (given.sample) {
    if (given.sample->k) line.json().member("k", *given.sample->k);
    if (given.sample->t) line.json().member("t", *given.sample->t);
    line.json().member("u", given.sample->u).member("y", given.sample->y);
  }
  return line.text();
}

std::string log_line(const AlarmChange& change) {
  Line line;
  line.json().key("alarm").raw(json_of(change));
  return line.text();
}

}  // namespace cordon::apps
