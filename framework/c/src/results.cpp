// SPDX-License-Identifier: GPL-3.0-or-later
// What came out of the last samples.
#include "session.hpp"
#include "study/text/json_writer.hpp"

using namespace cordon;

namespace {

/// A number of an optional part of a result.
template <class Get>
int number(const char* function, const cordon_session* session, int result, Get&& get) {
  return c::got(function, c::refused, [&] { return get(c::result_of(session, result).step); });
}

/// The hull of a result; null: there is c::none.
const Box* hull_of(c::Result& result) {
  if (result.step.estimate)
    return result.step.estimate->is_last ? &result.step.estimate->hull : nullptr;
  const std::optional<Enclosure>& estimate = result.step.diagnosis->diagnosis.estimate;
  if (!estimate || !estimate->set) return nullptr;
  if (!result.hull) result.hull = (*estimate)->interval_hull();
  return &*result.hull;
}

/// Has it bounds? Without computing them.
bool is_bounded(const SessionStep& step) {
  if (step.estimate) return step.estimate->is_last;
  return step.diagnosis->diagnosis.estimate && step.diagnosis->diagnosis.estimate->set;
}

void expect_length(int n, int wanted, const char* what) {
  if (n != wanted)
    throw Error(Errc::dimension, std::string(what) + " have " + std::to_string(n) + " entries, " +
                                     std::to_string(wanted) + " are needed");
}

const std::vector<DiagnosisEvent>& events_of(const SessionStep& step) {
  static const std::vector<DiagnosisEvent> no_events;
  return step.diagnosis ? step.diagnosis->events : no_events;
}

const DiagnosisEvent& event_of(const cordon_session* session, int result, int event) {
  return c::entry(events_of(c::result_of(session, result).step), event, "event");
}

/// A text that is made when it is asked for first.
template <class Make>
const char* made(std::string& text, Make&& make) {
  const c::DefaultArithmetic arithmetic;
  if (text.empty()) text = make();
  return text.c_str();
}

}  // namespace

extern "C" {

int cordon_result_count(const cordon_session* session) {
  return c::got(__func__, c::refused, [&] { return c::count_of(c::session_of(session).results); });
}
int64_t cordon_result_k(const cordon_session* session, int result) {
  return c::got(__func__, int64_t{c::refused},
                [&] { return int64_t{c::result_of(session, result).step.k}; });
}

int64_t cordon_result_bounds_k(cordon_session* session, int result) {
  return c::got(__func__, int64_t{c::refused}, [&] {
    const SessionStep& step = c::result_of(session, result).step;
    if (!is_bounded(step)) return int64_t{c::none};
    return int64_t{step.estimate ? step.estimate->estimate.k : step.diagnosis->diagnosis.k};
  });
}
int cordon_result_bounds(cordon_session* session, int result, double* lower, double* upper, int n) {
  return c::done(__func__, [&] {
    c::Result& of = c::result_of(session, result);
    expect_length(n, c::count_of(session->names.states), "lower and upper");
    double* const below = &c::required(lower, "lower");
    double* const above = &c::required(upper, "upper");
    const Box* const hull = hull_of(of);
    const Box box = hull ? *hull : Box::space(n);
    if (box.dim() != n) throw Error(Errc::internal, "the hull is of another dimension");
    Eigen::Map<Vector>(below, n) = box.lower;
    Eigen::Map<Vector>(above, n) = box.upper;
  });
}
int cordon_result_consistent(const cordon_session* session, int result) {
  return number(__func__, session, result, [](const SessionStep& step) {
    return step.estimate ? static_cast<int>(step.estimate->estimate.consistent) : c::none;
  });
}

int cordon_result_restarted(const cordon_session* session, int result) {
  return number(__func__, session, result, [](const SessionStep& step) {
    return step.estimate && (step.estimate->restarted || !step.estimate->not_enclosed.empty()) ? 1
                                                                                               : 0;
  });
}

int cordon_result_left_open(const cordon_session* session, int result) {
  return number(__func__, session, result,
                [](const SessionStep& step) { return step.left_open ? 1 : 0; });
}

int cordon_result_decision(const cordon_session* session, int result) {
  return number(__func__, session, result, [](const SessionStep& step) {
    return step.diagnosis ? static_cast<int>(step.diagnosis->diagnosis.decision) : c::none;
  });
}
int cordon_result_mode(const cordon_session* session, int result) {
  return number(__func__, session, result, [](const SessionStep& step) {
    return step.diagnosis ? static_cast<int>(step.diagnosis->diagnosis.mode) : c::none;
  });
}
int cordon_result_candidates(const cordon_session* session, int result, int* candidates, int n) {
  return c::done(__func__, [&] {
    const SessionStep& step = c::result_of(session, result).step;
    expect_length(n, c::count_of(session->online.session().modes()), "candidates");
    for (int j = 0; j < n; ++j) {
      const bool is = step.diagnosis->diagnosis.modes[static_cast<std::size_t>(j)].candidate;
      (&c::required(candidates, "candidates"))[j] = is;
    }
  });
}

const char* cordon_result_json(cordon_session* session, int result) {
  return c::got(__func__, "", [&] {
    c::Result& of = c::result_of(session, result);
    return made(of.json, [&] { return line_json_of(of.step, session->online.session()); });
  });
}

int cordon_event_count(const cordon_session* session, int result) {
  return number(__func__, session, result,
                [](const SessionStep& step) { return c::count_of(events_of(step)); });
}
const char* cordon_event_what(const cordon_session* session, int result, int event) {
  return c::got(__func__, "",
                [&] { return to_string(event_of(session, result, event).what).data(); });
}
int cordon_event_mode(const cordon_session* session, int result, int event) {
  return c::got(__func__, c::refused,
                [&] { return static_cast<int>(event_of(session, result, event).mode); });
}
const char* cordon_event_json(cordon_session* session, int result, int event) {
  return c::got(__func__, "", [&] {
    const DiagnosisEvent& wanted = event_of(session, result, event);
    c::Result& of = c::result_of(session, result);
    of.event_json.resize(events_of(of.step).size());
    return made(of.event_json[static_cast<std::size_t>(event)], [&] {
      const std::string list = events_json_of({wanted}, session->online.session().modes());
      return list.substr(1, list.size() - 2);
    });
  });
}

}  // extern "C"
