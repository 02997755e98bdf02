// SPDX-License-Identifier: GPL-3.0-or-later
// Alarms that stand, and what has become of them.
#include "session.hpp"

using namespace cordon;

namespace {

template <class Result, class Get>
Result of_change(const char* function, const cordon_session* session, int i, Result otherwise,
                 Get&& get) {
  return c::got(function, otherwise,
                [&] { return get(c::entry(c::session_of(session).changes, i, "change").change); });
}

template <class Result, class Get>
Result of_alarm(const char* function, const cordon_session* session, int i, Result otherwise,
                Get&& get) {
  return c::got(function, otherwise,
                [&] { return get(c::entry(c::session_of(session).online.alarms(), i, "alarm")); });
}

}  // namespace

std::vector<c::Change> c::changes_of(std::vector<AlarmChange> changes) {
  std::vector<Change> all;
  for (AlarmChange& change : changes) all.push_back({std::move(change)});
  return all;
}

extern "C" {

int cordon_change_count(const cordon_session* session) {
  return c::got(__func__, c::refused, [&] { return c::count_of(c::session_of(session).changes); });
}
int cordon_change_what(const cordon_session* session, int change) {
  return of_change(__func__, session, change, c::refused,
                   [](const AlarmChange& of) { return static_cast<int>(of.what); });
}
int cordon_change_cause(const cordon_session* session, int change) {
  return of_change(__func__, session, change, c::refused,
                   [](const AlarmChange& of) { return static_cast<int>(of.alarm.cause); });
}
int64_t cordon_change_k(const cordon_session* session, int change) {
  return of_change(__func__, session, change, int64_t{c::refused},
                   [](const AlarmChange& of) { return int64_t{of.k}; });
}
const char* cordon_change_text(const cordon_session* session, int change) {
  return of_change(__func__, session, change, "",
                   [](const AlarmChange& of) { return of.alarm.text.c_str(); });
}
const char* cordon_change_json(cordon_session* session, int change) {
  return c::got(__func__, "", [&] {
    c::Change& of = c::entry(c::session_of(session).changes, change, "change");
    if (of.json.empty()) of.json = json_of(of.change);
    return of.json.c_str();
  });
}

int cordon_alarm_count(const cordon_session* session) {
  return c::got(__func__, c::refused,
                [&] { return c::count_of(c::session_of(session).online.alarms()); });
}
int cordon_alarm_cause(const cordon_session* session, int alarm) {
  return of_alarm(__func__, session, alarm, c::refused,
                  [](const Alarm& of) { return static_cast<int>(of.cause); });
}
int64_t cordon_alarm_raised_at(const cordon_session* session, int alarm) {
  return of_alarm(__func__, session, alarm, int64_t{c::refused},
                  [](const Alarm& of) { return int64_t{of.raised_at}; });
}
int cordon_alarm_is_active(const cordon_session* session, int alarm) {
  return of_alarm(__func__, session, alarm, c::refused,
                  [](const Alarm& of) { return int{of.is_active}; });
}
int cordon_alarm_is_acknowledged(const cordon_session* session, int alarm) {
  return of_alarm(__func__, session, alarm, c::refused,
                  [](const Alarm& of) { return int{of.acknowledged}; });
}
const char* cordon_alarm_text(const cordon_session* session, int alarm) {
  return of_alarm(__func__, session, alarm, "", [](const Alarm& of) { return of.text.c_str(); });
}

int cordon_acknowledge(cordon_session* session) {
  return c::done(__func__, [&] {
    cordon_session& s = c::session_of(session);
    s.changes.clear();
    s.changes = c::changes_of(s.online.acknowledge());
  });
}

}  // extern "C"
