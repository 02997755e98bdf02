// SPDX-License-Identifier: GPL-3.0-or-later
// What a handle of C stands for.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boundary.hpp"
#include "cordon/study/alarms.hpp"
#include "cordon/study/online.hpp"

namespace cordon::c {

/// A step with the texts and bounds that were asked for.
struct Result {
  TakenStep step;                ///< without its alarms
  std::optional<Box> hull = {};  ///< of a diagnoser's estimate
  std::string json = {};
  std::vector<std::string> event_json = {};
};

/// A change of an alarm, likewise.
struct Change {
  AlarmChange change;
  std::string json = {};
};

struct Names {
  std::vector<std::string> states, inputs, outputs;
};

}  // namespace cordon::c

struct cordon_session {
  cordon_session(const cordon::Study& study, const cordon::Registry& registry,
                 const std::string& pipeline);

  /// Takes a sample and keeps what comes out.
  void take(const cordon::GivenSample& sample);
  /// No results and no changes.
  void forget();
  bool has_ended() const { return online.has_ended() || lost; }

  cordon::OnlineSession online;
  cordon::c::Names names;
  std::vector<std::string> warnings;

  bool lost = false;  ///< for want of memory, what a sample has told
  std::optional<cordon::Taken::How> how;
  std::string said;
  std::vector<cordon::c::Result> results;
  std::vector<cordon::c::Change> changes;
};

namespace cordon::c {

/// The session, which must not be NULL.
template <class Session>
Session& session_of(Session* session) {
  return required(session, "the session");
}

template <class Session>
auto& result_of(Session* session, int i) {
  return entry(session_of(session).results, i, "result");
}

std::vector<Change> changes_of(std::vector<AlarmChange> changes);

}  // namespace cordon::c
