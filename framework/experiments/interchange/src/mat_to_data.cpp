// SPDX-License-Identifier: GPL-3.0-or-later
#include "mat_to_data.hpp"

#include <cmath>

#include "mat_to_system.hpp"
#include "study/results/results_parts.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/numbers.hpp"

namespace cordon::mat {

namespace {

using json::Problems;

class DataReader {
 public:
  DataReader(const Value& data, const std::string& pointer, Problems& problems)
      : data_(data), pointer_(pointer), problems_(problems) {}

  /// Reports a signal that is wrong, or absent although `required`; NaN where values may be
  /// `missing`.
  std::optional<Matrix> signal(const char* name, Index channels, const char* of, bool required,
                               bool missing = false);
  Index samples() const { return samples_; }
  std::string place(const char* name) const { return json::child(pointer_, name); }

 private:
  const Value& data_;
  const std::string& pointer_;
  Problems& problems_;
  Index samples_ = -1;  ///< not known yet
};

std::optional<Matrix> DataReader::signal(const char* name, Index channels, const char* of,
                                         bool required, bool missing) {
  const Value* value = data_.field(name);
  const auto report = [&](const std::string& message, const std::string& suggestion = "") {
    problems_.add(place(name), 0, message, suggestion);
    return std::nullopt;
  };
  if (!value || (value->is(Value::Kind::numbers) && value->numbers.size() == 0)) {
    if (!required) return std::nullopt;
    return report("is missing", "a matrix with " + json::counted(channels, "row") + ", " + of +
                                    ", and a column per sample");
  }
  if (!value->is(Value::Kind::numbers))
    return report(kind_of(*value) + ", must be a matrix of real numbers");
  Matrix rows = value->numbers;
  if (rows.rows() != channels && rows.cols() == channels) rows.transposeInPlace();
  if (rows.rows() != channels) {
    return report("is " + json::shape(rows.rows(), rows.cols()) + ", must have " +
                      json::counted(channels, "row") + ", " + of,
                  "a column per sample, or a row per sample");
  }
  if (samples_ >= 0 && rows.cols() != samples_)
    return report("has " + json::counted(rows.cols(), "sample") + ", the others have " +
                  std::to_string(samples_));
  samples_ = rows.cols();
  for (Index k = 0; k < rows.cols(); ++k) {
    for (const double x : rows.col(k)) {
      if (std::isfinite(x) || (missing && std::isnan(x))) continue;
      return report(
          (missing ? "holds Inf in sample " : "holds NaN or Inf in sample ") +
              std::to_string(k + 1),
          "only outputs may be missing, which NaN says: cut the samples, or repair them first");
    }
  }
  return rows;
}

/// Names of the modes: 0 is the nominal one, j the j-th of the others, -1 none of them.
std::vector<std::string> mode_names(const Matrix& modes, const json::SystemPart& system,
                                    const std::string& place, Problems& problems) {
  std::vector<std::string> names;
  const auto count = static_cast<double>(system.modes.size());
  for (Index k = 0; k < modes.cols(); ++k) {
    const double mode = modes(0, k);
    if (mode != std::floor(mode) || mode < -1 || mode > count) {
      problems.add(place, 0,
                   "holds " + detail::to_text(mode) + " in sample " + std::to_string(k + 1),
                   "0 is the nominal mode, j the j-th of the others, -1 none of them");
      return {};
    }
    names.push_back(mode < 0    ? ""
                    : mode == 0 ? system.nominal
                                : system.modes[static_cast<std::size_t>(mode) - 1].name);
  }
  return names;
}

}  // namespace

std::optional<CsvData> data_of(const Value& data, const json::SystemPart& system,
                               const std::string& pointer, Problems& problems) {
  if (!data.field("y")) return std::nullopt;
  const LinearModel& m = system.model.linear;
  DataReader reader(data, pointer, problems);
  const std::size_t before = problems.count();
  const auto y = reader.signal("y", m.outputs(), "one per row of C", true, true);
  std::optional<Matrix> u;
  if (m.inputs() > 0) u = reader.signal("u", m.inputs(), "one per column of B", true);
  const auto x = reader.signal("x", m.states(), "one per state", false);
  const auto mode = reader.signal("mode", 1, "the index of the mode", false);
  std::vector<std::string> modes;
  if (mode) modes = mode_names(*mode, system, reader.place("mode"), problems);
  if (problems.count() > before || !y) return std::nullopt;
  CsvData csv;
  std::vector<std::string> header{"k"};
  std::vector<const Matrix*> parts;
  const auto add = [&](const char* name, const std::optional<Matrix>& part,
                       std::vector<std::string>& names) {
    for (Index i = 1; part && i <= part->rows(); ++i) names.push_back(name + std::to_string(i));
    header.insert(header.end(), names.begin(), names.end());
    if (part) parts.push_back(&*part);
  };
  add("u_", u, csv.spec.inputs);
  add("y_", y, csv.spec.outputs);
  add("x_", x, csv.spec.truth);
  if (mode) header.push_back(csv.spec.mode = "mode");
  if (y->hasNaN()) csv.spec.missing = MissingValue::skip;
  csv.text = detail::joined(header);
  for (Index k = 0; k < reader.samples(); ++k) {
    std::vector<std::string> row{std::to_string(k)};
    for (const Matrix* part : parts) {
      for (Index i = 0; i < part->rows(); ++i)
        row.push_back(std::isnan((*part)(i, k)) ? "" : detail::to_text((*part)(i, k)));
    }
    if (mode) row.push_back(detail::csv_field(modes[static_cast<std::size_t>(k)]));
    csv.text += detail::joined(row);
  }
  return csv;
}

}  // namespace cordon::mat
