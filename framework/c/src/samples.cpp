// SPDX-License-Identifier: GPL-3.0-or-later
// Samples in, and the state between them.
#include <cstring>

#include "session.hpp"

using namespace cordon;

namespace {

/// An array of the caller.
Vector given(const double* values, int n, int wanted, const char* what) {
  if (n != wanted)
    throw Error(Errc::dimension, std::string(what) + " has " + std::to_string(n) +
                                     " entries, the model has " + std::to_string(wanted));
  if (n == 0) return Vector(0);
  return Eigen::Map<const Vector>(&c::required(values, what), n);
}

/// `sample` is empty but for its time.
int take(const char* function, cordon_session* session, GivenSample sample, const double* u,
         int n_u, const double* y, int n_y) {
  return c::done(function, [&] {
    cordon_session& s = c::session_of(session);
    s.forget();
    sample.u = given(u, n_u, c::count_of(s.names.inputs), "u");
    sample.y = given(y, n_y, c::count_of(s.names.outputs), "y");
    s.take(sample);
  });
}

}  // namespace

void cordon_session::forget() {
  how.reset();
  said.clear();
  results.clear();
  changes.clear();
}

void cordon_session::take(const GivenSample& sample) {
  if (lost)
    throw Error(Errc::plugin,
                "there was no memory for what an earlier sample has told; begin anew, or "
                "go on from a state that was saved");
  Taken taken = online.take(sample);
  lost = true;  // unless all is kept
  for (TakenStep& step : taken.steps) {
    for (c::Change& change : c::changes_of(std::move(step.alarms)))
      changes.push_back(std::move(change));
    results.push_back({std::move(step)});
  }
  said = std::move(taken.said);
  how = taken.how;
  lost = false;
}

extern "C" {

int cordon_step(cordon_session* session, const double* u, int n_u, const double* y, int n_y) {
  return take(__func__, session, GivenSample{}, u, n_u, y, n_y);
}
int cordon_take(cordon_session* session, int64_t k, const double* u, int n_u, const double* y,
                int n_y) {
  GivenSample sample;
  sample.k = k;
  return take(__func__, session, std::move(sample), u, n_u, y, n_y);
}
int cordon_take_at(cordon_session* session, int64_t k, double t, const double* u, int n_u,
                   const double* y, int n_y) {
  GivenSample sample;
  if (k != CORDON_NONE) sample.k = k;
  sample.t = t;
  return take(__func__, session, std::move(sample), u, n_u, y, n_y);
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
    s.changes = c::changes_of(s.online.start());
    s.lost = false;
  });
}

int cordon_save(cordon_session* session, void* buffer, size_t capacity, size_t* size) {
  return c::done(__func__, [&] {
    cordon_session& s = c::session_of(session);
    if (s.lost)
      throw Error(Errc::invalid, "what the last sample has told is lost: there is no state");
    const std::string bytes = s.online.save();
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
    const std::string saved(&c::required(static_cast<const char*>(buffer), "buffer"), size);
    s.forget();
    s.online.restore(saved);
    s.lost = false;
  });
}

}  // extern "C"
