// SPDX-License-Identifier: GPL-3.0-or-later
// The known inputs u_k of a simulation, channel by channel (definitions: cordon/study/study.hpp,
// Signal).
#pragma once

#include <string>
#include <vector>

#include "cordon/study/study.hpp"
#include "study/data/random.hpp"

namespace cordon::detail {

/// sin(omega k + phase), evaluated in extended precision and rounded once: the double-precision
/// routine of the C library has variants that differ in the last bit from processor to processor.
double sine(double omega, std::int64_t k, double phase);
double cosine(double omega, std::int64_t k, double phase);

/// Problems of a signal: an empty table, a period below 1, a NaN or infinite number. Pointers start
/// with `pointer`.
std::vector<Diagnostic> problems_of(const Signal& signal, const std::string& pointer);

/// One channel over time. `prbs` draws from the signal's own seed, the purpose and the channel's
/// index, so that equal signals on two channels are unrelated, and nothing else of a study changes
/// them.
class SignalSource {
 public:
  SignalSource(Signal signal, std::size_t channel, Purpose purpose = Purpose::prbs);
  /// The value at k ≥ 0; k must not decrease from call to call. O(1).
  double at(std::int64_t k);

 private:
  double pseudo_random(std::int64_t k);

  Signal signal_;
  RandomStream stream_;
  std::int64_t drawn_ = -1;  ///< index of the interval that `sign_` belongs to
  double sign_ = 0;
};

}  // namespace cordon::detail
