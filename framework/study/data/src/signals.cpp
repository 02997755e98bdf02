// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/signals.hpp"

#include <algorithm>
#include <cmath>

namespace cordon::detail {

namespace {

long double angle(double omega, std::int64_t k, double phase) {
  return static_cast<long double>(omega) * static_cast<long double>(k) +
         static_cast<long double>(phase);
}

}  // namespace

double sine(double omega, std::int64_t k, double phase) {
  return static_cast<double>(std::sin(angle(omega, k, phase)));
}
double cosine(double omega, std::int64_t k, double phase) {
  return static_cast<double>(std::cos(angle(omega, k, phase)));
}

std::vector<Diagnostic> problems_of(const Signal& signal, const std::string& pointer) {
  std::vector<Diagnostic> problems;
  if (signal.type == Signal::Type::table && signal.values.size() == 0) {
    problems.push_back({pointer + "/values", "a table needs at least one value", ""});
  }
  const bool periodic = signal.type == Signal::Type::square || signal.type == Signal::Type::prbs;
  if (periodic && signal.period < 1)
    problems.push_back({pointer + "/period", "must be at least 1", ""});
  const auto finite = [&](const char* name, double value) {
    if (!std::isfinite(value))
      problems.push_back({pointer + "/" + name, "is not a finite number", ""});
  };
  finite("offset", signal.offset);
  finite("amplitude", signal.amplitude);
  finite("omega", signal.omega);
  finite("phase", signal.phase);
  if (!signal.values.allFinite())
    problems.push_back({pointer + "/values", "has a NaN or infinite number", ""});
  return problems;
}

SignalSource::SignalSource(Signal signal, std::size_t channel, Purpose purpose)
    : signal_(std::move(signal)),
      stream_(static_cast<std::uint64_t>(signal_.seed), purpose, channel) {}

double SignalSource::at(std::int64_t k) {
  const Signal& s = signal_;
  switch (s.type) {
    case Signal::Type::constant:
      return s.offset;
    case Signal::Type::sine:
      return s.offset + s.amplitude * sine(s.omega, k, s.phase);
    case Signal::Type::cosine:
      return s.offset + s.amplitude * cosine(s.omega, k, s.phase);
    case Signal::Type::step:
      return k >= s.from ? s.offset + s.amplitude : s.offset;
    case Signal::Type::square: {
      const std::int64_t place = k % s.period;
      return place < s.period - place ? s.offset + s.amplitude : s.offset - s.amplitude;
    }
    case Signal::Type::prbs:
      return pseudo_random(k);
    case Signal::Type::table:
      return s.values[static_cast<Index>(std::min<std::int64_t>(k, s.values.size() - 1))];
  }
  throw Error(Errc::internal, "a signal of unknown type");
}

double SignalSource::pseudo_random(std::int64_t k) {
  for (const std::int64_t interval = k / signal_.period; drawn_ < interval; ++drawn_)
    sign_ = stream_.sign();
  return signal_.offset + sign_ * signal_.amplitude;
}

}  // namespace cordon::detail
