// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a saved state, with what reading them refuses besides other types.
#pragma once

#include <optional>
#include <vector>

#include "cordon/interfaces/archive.hpp"

namespace cordon::estimators {

/// An index or a count between these.
inline void serialize_within(Archive& archive, Index& value, Index least, Index most) {
  archive(value);
  if (value < least || value > most) archive.refuse("a number that is out of range");
}

/// A time that differences can be taken of.
inline void serialize_time(Archive& archive, Index& value) {
  constexpr Index latest = Index{1} << 60;
  serialize_within(archive, value, -latest, latest);
}

/// No set, or one of this dimension.
inline void serialize_set(Archive& archive, std::optional<Enclosure>& X, Index dimension) {
  archive(X);
  if (X && (!X->set || (*X)->dim() != dimension)) archive.refuse("a set of another dimension");
}

/// As many as there are.
inline void serialize_flags(Archive& archive, std::vector<bool>& flags) {
  std::vector<int> values(flags.begin(), flags.end());
  archive(values);
  if (values.size() != flags.size()) archive.refuse("a list of another length");
  for (std::size_t i = 0; i < flags.size(); ++i) flags[i] = values[i] != 0;
}

}  // namespace cordon::estimators
