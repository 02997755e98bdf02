// SPDX-License-Identifier: GPL-3.0-or-later
// The samples of a study, one after another: simulated or recorded. Nothing is kept, so that memory
// does not grow with the length of a run.
#pragma once

#include <memory>
#include <optional>

#include "cordon/study/study.hpp"

namespace cordon {

struct Record {
  Sample sample;
  std::optional<Vector> truth;
  std::optional<Index> mode =
      {};  ///< index of the true mode in the study's bank, -1: outside the bank
  std::optional<Vector> fault =
      {};  ///< n_k, one entry per column of F; while one is not 0, the mode is -1
  std::vector<Index> outliers = {};  ///< outputs that are known not to keep to the model
  std::optional<Index> mode_without_fault = {};  ///< then: the mode that it would be otherwise
};

/// A stream of records. Two streams of one study give the same records bit by bit.
class DataSource {
 public:
  virtual ~DataSource() = default;
  virtual std::optional<Record> next() = 0;
  /// Number of records, if known in advance (for progress).
  virtual std::optional<std::int64_t> size() const = 0;
};

/// Opens the data of a study, simulated data with their seed + `seed_offset`. Throws InputError
/// (CSV problems with their lines; an inconsistent x0).
std::unique_ptr<DataSource> open_data(const Study& study, std::uint64_t seed_offset = 0);

/// What the data are like, before anything runs on them.
struct DataOverview {
  std::int64_t samples = 0;
  bool is_whole = true;                    ///< false: there are more
  Index last = 0;                          ///< k of the last one
  std::int64_t empty = 0;                  ///< samples without any output
  std::vector<std::int64_t> missing = {};  ///< per output: samples that lack it
  std::int64_t outside_U = 0;              ///< samples whose input is proven to lie outside U
  Index first_outside_U = -1;              ///< k
  /// Column of a CSV file that nothing uses, and whose name is one of times; empty: none.
  std::string unused_time = {};
};

/// Reads the data up to `most` samples. Throws as `open_data` does.
DataOverview overview_of_data(const Study& study, std::int64_t most);

}  // namespace cordon
