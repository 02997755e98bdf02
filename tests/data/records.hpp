// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of data ask of a stream of records.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "cordon/study/data.hpp"

namespace data_test {

inline std::vector<cordon::Record> all(cordon::DataSource& data) {
  std::vector<cordon::Record> records;
  while (std::optional<cordon::Record> record = data.next()) records.push_back(std::move(*record));
  return records;
}
inline std::vector<cordon::Record> all(const cordon::Study& study) {
  return all(*cordon::open_data(study));
}

/// FNV-1a over the bit patterns of inputs, outputs, states and faults.
inline std::uint64_t digest(const std::vector<cordon::Record>& records) {
  std::uint64_t hash = 14695981039346656037u;
  const auto take = [&](double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int i = 0; i < 8; ++i) hash = (hash ^ ((bits >> (8 * i)) & 255)) * 1099511628211u;
  };
  for (const cordon::Record& r : records) {
    for (const cordon::Vector* part : {&r.sample.u, &r.sample.y, &*r.truth})
      std::for_each(part->begin(), part->end(), take);
    if (r.fault) std::for_each(r.fault->begin(), r.fault->end(), take);
  }
  return hash;
}

/// What is wrong with the data, up to their end; empty: nothing.
inline std::string message_of(const cordon::Study& study) {
  try {
    all(study);
  } catch (const cordon::InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace data_test
