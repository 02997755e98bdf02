// SPDX-License-Identifier: GPL-3.0-or-later
// Samples in, and the state between them.
#include <cstring>

#include "cordon/interfaces/archive.hpp"
#include "session.hpp"
#include "study/text/fingerprint.hpp"

using namespace cordon;

namespace {

constexpr const char* head_of_saved = "cordon c session 1\n";
constexpr std::int64_t latest = std::int64_t{1} << 53;  // later times are no numbers in JSON

/// An array of the caller.
Vector given(const double* values, int n, int wanted, const char* what) {
  if (n != wanted)
    throw Error(Errc::dimension, std::string(what) + " has " + std::to_string(n) +
                                     " entries, the model has " + std::to_string(wanted));
  if (n == 0) return Vector(0);
  return Eigen::Map<const Vector>(&c::required(values, what), n);
}

int take(const char* function, cordon_session* session, std::optional<std::int64_t> k,
         const double* u, int n_u, const double* y, int n_y) {
  return c::done(function, [&] {
    cordon_session& s = c::session_of(session);
    s.forget();
    GivenSample sample;
    sample.k = k;
    sample.u = given(u, n_u, c::count_of(s.names.inputs), "u");
    sample.y = given(y, n_y, c::count_of(s.names.outputs), "y");
    if (k.value_or(s.online.session().last().value_or(0)) >= latest)
      throw Error(Errc::invalid, "times end at " + std::to_string(latest));
    s.take(sample);
  });
}

std::string saved(cordon_session& session) {
  if (session.ended) throw Error(Errc::invalid, "the session has ended: there is no state");
  std::string of_session = session.online.save();
  Archive of_alarms(nullptr);
  session.alarms->serialize(of_alarms);
  std::string alarms = of_alarms.bytes();
  Archive archive(nullptr);
  archive(of_session, alarms);
  return head_of_saved + detail::fingerprint(archive.bytes()) + "\n" + archive.bytes();
}

/// Throws Errc::invalid if the check sum does not fit.
std::string checked(std::string_view saved) {
  const std::string_view head = head_of_saved;
  const std::size_t end = saved.find('\n', std::min(head.size(), saved.size()));
  if (!saved.starts_with(head) || end == std::string_view::npos)
    throw Error(Errc::invalid, "this is no saved session of this version");
  const std::string_view bytes = saved.substr(end + 1);
  if (detail::fingerprint(bytes) != saved.substr(head.size(), end - head.size()))
    throw Error(Errc::invalid, "the saved session is damaged: its check sum does not fit");
  return std::string(bytes);
}

void restore(cordon_session& session, std::string_view bytes) {
  std::string of_session, of_alarms;
  Archive archive(nullptr, checked(bytes));
  archive(of_session, of_alarms);
  archive.expect_end();
  auto alarms = std::make_unique<Alarms>(*session.alarms);
  Archive reader(nullptr, of_alarms);
  alarms->serialize(reader);
  reader.expect_end();
  session.forget();
  session.ended = true;  // unless it is restored or begins anew
  try {
    session.online.restore(of_session);
  } catch (const Error&) {
    session.ended = false;
    throw;
  }
  session.alarms = std::move(alarms);
  session.ended = false;
}

}  // namespace

void cordon_session::forget() {
  how.reset();
  said.clear();
  results.clear();
  changes.clear();
}

void cordon_session::take(const GivenSample& sample) {
  if (ended)
    throw Error(Errc::plugin, "the session has ended; reset it, or restore what was saved");
  Taken taken;
  ended = true;  // a step whose alarms are lost is none
  try {
    taken = online.take(sample);
  } catch (const Error& error) {
    ended = false;  // if it is the sample's; the session knows
    throw;
  }
  std::vector<AlarmChange> all;
  for (const SessionStep& step : taken.steps) {
    for (AlarmChange& change : alarms->step(step)) all.push_back(std::move(change));
  }
  changes = c::changes_of(std::move(all));
  for (SessionStep& step : taken.steps) results.push_back({std::move(step)});
  said = std::move(taken.said);
  how = taken.how;
  ended = false;
}

extern "C" {

int cordon_step(cordon_session* session, const double* u, int n_u, const double* y, int n_y) {
  return take(__func__, session, {}, u, n_u, y, n_y);
}
int cordon_take(cordon_session* session, int64_t k, const double* u, int n_u, const double* y,
                int n_y) {
  return take(__func__, session, k, u, n_u, y, n_y);
}

int cordon_take_how(const cordon_session* session) {
  return c::got(__func__, c::refused, [&] {
    const std::optional<Taken::How> how = c::session_of(session).how;
    return how ? static_cast<int>(*how) : c::none;
  });
}
const char* cordon_take_said(const cordon_session* session) {
  return c::got(__func__, "", [&] { return c::session_of(session).said.c_str(); });
}

int64_t cordon_last_k(const cordon_session* session) {
  return c::got(__func__, int64_t{c::refused}, [&] {
    return int64_t{c::session_of(session).online.session().last().value_or(c::none)};
  });
}
int cordon_has_ended(const cordon_session* session) {
  return c::got(__func__, c::refused, [&] { return int{c::session_of(session).has_ended()}; });
}

int cordon_reset(cordon_session* session) {
  return c::done(__func__, [&] {
    cordon_session& s = c::session_of(session);
    s.forget();
    s.ended = true;
    s.online.start();
    s.ended = false;
  });
}

int cordon_save(cordon_session* session, void* buffer, size_t capacity, size_t* size) {
  return c::done(__func__, [&] {
    const std::string bytes = saved(c::session_of(session));
    c::required(size, "size") = bytes.size();
    if (!buffer) return;
    if (capacity < bytes.size())
      throw Error(Errc::dimension, "the buffer holds " + std::to_string(capacity) + " bytes, and " +
                                       std::to_string(bytes.size()) + " are needed");
    std::memcpy(buffer, bytes.data(), bytes.size());
  });
}

int cordon_restore(cordon_session* session, const void* buffer, size_t size) {
  return c::done(__func__, [&] {
    cordon_session& s = c::session_of(session);
    restore(s, {&c::required(static_cast<const char*>(buffer), "buffer"), size});
  });
}

}  // extern "C"
