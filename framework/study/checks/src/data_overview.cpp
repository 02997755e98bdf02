// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>

#include "cordon/study/data.hpp"
#include "study/checks/outside.hpp"
#include "study/text/csv_reader.hpp"

namespace cordon {

namespace {

std::string unused_time(const Study& study) {
  const auto* csv = std::get_if<CsvSpec>(&study.data);
  if (!csv || !csv->time.empty()) return "";
  std::set<std::string> used{csv->mode};
  for (const auto* names : {&csv->inputs, &csv->outputs, &csv->truth})
    used.insert(names->begin(), names->end());
  detail::CsvRow header;
  if (!detail::CsvReader(csv->file).next(header)) return "";
  for (const std::string& name : header.fields) {
    std::string word;
    for (const char c : name) word += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    static const std::set<std::string> times{"t",       "time",     "t_s", "time_s",   "t [s]",
                                             "seconds", "time [s]", "t/s", "timestamp"};
    if (times.contains(word) && !used.contains(name)) return name;
  }
  return "";
}

}  // namespace

DataOverview overview_of_data(const Study& study, std::int64_t most) {
  const Index outputs = study.model.outputs();
  const LineForm& U = study.model.U;
  const bool is_bounded = U.dim() > 0 && U.lines() < U.dim();
  DataOverview found;
  found.missing.assign(static_cast<std::size_t>(outputs), 0);
  const std::unique_ptr<DataSource> data = open_data(study);
  found.unused_time = unused_time(study);
  std::optional<Vector> before;
  bool outside = false;
  while (const std::optional<Record> record = data->next()) {
    if (found.samples == most) {
      found.is_whole = false;
      break;
    }
    const Sample& sample = record->sample;
    ++found.samples;
    found.last = sample.k;
    for (const Index output : sample.missing) ++found.missing[static_cast<std::size_t>(output)];
    found.empty += outputs > 0 && static_cast<Index>(sample.missing.size()) == outputs ? 1 : 0;
    if (!is_bounded || sample.u.size() != U.dim()) continue;
    if (!before || *before != sample.u) outside = detail::clearly_outside(U, sample.u);
    before = sample.u;
    if (!outside) continue;
    ++found.outside_U;
    if (found.first_outside_U < 0) found.first_outside_U = sample.k;
  }
  return found;
}

}  // namespace cordon
