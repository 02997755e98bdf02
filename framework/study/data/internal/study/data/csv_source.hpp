// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded data from a CSV file.
#pragma once

#include <string>
#include <vector>

#include "cordon/study/data.hpp"
#include "study/data/step_clock.hpp"
#include "study/text/csv_reader.hpp"

namespace cordon::detail {

/// Samples in the order of rows, k = row index from 0, or by their times. The constructor reads the
/// whole file once and throws InputError (file: the CSV file) with up to 20 problems and their
/// lines: missing or repeated columns, ragged rows, text or non-finite values in a number of a
/// column that is used (but for outputs without a value, where the study skips them), a mode that
/// there is not, times that are not those of the steps, no header, no rows. Afterwards rows are
/// read again one by one; memory is constant.
class CsvSource final : public DataSource {
 public:
  /// `modes`: the names that the column of modes may hold, in the order of the bank;
  /// `sampling_time`: for a column of times.
  CsvSource(const CsvSpec& spec, const Model& model, std::vector<std::string> modes = {},
            double sampling_time = 0);

  std::optional<Record> next() override;
  std::optional<std::int64_t> size() const override { return steps_; }

 private:
  /// A group of columns: where they are, and where the study names them.
  struct Columns {
    std::vector<std::string> names;
    std::vector<std::size_t> at;
    std::string pointer;
  };

  void check_sizes(const CsvSpec& spec, const Model& model) const;
  void validate();
  bool locate(const CsvRow& header);
  void find_columns(Columns& columns, const std::vector<std::string>& header);
  std::optional<Vector> numbers(const CsvRow& row, const Columns& columns);
  std::optional<Index> mode(const CsvRow& row);
  std::optional<std::int64_t> step(const CsvRow& row, StepClock& clock);
  std::optional<Record> next_row();
  void check_row(const CsvRow& row);
  void report(std::string pointer, std::int64_t line, std::string message,
              std::string suggestion = "");
  bool too_many() const { return problems_.size() >= 20; }

  std::filesystem::path file_;
  Columns inputs_, outputs_, truth_, mode_, time_;
  bool skips_missing_;  ///< outputs without a value are missing, no problem
  std::vector<std::string> modes_;
  std::size_t width_ = 0;
  std::int64_t rows_ = 0, steps_ = 0;
  std::vector<Diagnostic> problems_;
  std::optional<CsvReader> reader_;
  double sampling_time_;
  bool fills_;
  StepClock clock_;                ///< of the second reading
  std::optional<Record> waiting_;  ///< the row after steps that are left out
  Vector last_input_;
  std::optional<Index> last_mode_;  ///< of the row before; between rows of one mode it lasts
  std::int64_t k_ = 0;
};

}  // namespace cordon::detail
