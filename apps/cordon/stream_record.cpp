// SPDX-License-Identifier: GPL-3.0-or-later
#include "stream_record.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cordon/core/error.hpp"
#include "study/text/numbers.hpp"
#include "study/text/publish.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

Json names_of(const char* symbol, Index count) {
  Json names = Json::array();
  for (Index i = 1; i <= count; ++i) names.push_back(fmt::format("{}_{}", symbol, i));
  return names;
}

/// The study of one pipeline with recorded data. Plugins are named by their whole paths.
Json recorded_study(const Study& study, const std::string& pipeline) {
  Json recorded = Json::parse(study.resolved);
  const std::filesystem::path folder = std::filesystem::absolute(study.file).parent_path();
  if (recorded.contains("plugins")) {
    for (Json& directory : recorded["plugins"])
      directory = (folder / directory.get<std::string>()).lexically_normal().string();
  }
  Json csv{{"file", "recorded.csv"}};
  if (study.model.inputs() > 0) csv["inputs"] = names_of("u", study.model.inputs());
  csv["outputs"] = names_of("y", study.model.outputs());
  csv["missing"] = "skip";
  recorded["data"] = {{"csv", csv}};
  Json pipelines = Json::array();
  for (const Json& one : recorded["pipelines"]) {
    if (one["name"] == pipeline) pipelines.push_back(one);
  }
  recorded["pipelines"] = pipelines;
  recorded.erase("sweep");
  return recorded;
}

}  // namespace

StreamRecord::StreamRecord(std::filesystem::path directory, const Study& study,
                           const std::string& pipeline)
    : directory_(std::move(directory)),
      study_(directory_ / "recorded.json"),
      most_waiting_(static_cast<std::size_t>(study.online.lag) + 1) {
  if (detail::is_there(study_) || detail::is_there(directory_ / "recorded.csv"))
    throw InputError(directory_.string(), {{"", "holds a record already",
                                            "name another directory, or remove this one"}});
  std::error_code failure;
  std::filesystem::create_directories(directory_, failure);
  if (failure) throw Error(Errc::io, directory_.string() + ": " + failure.message());
  detail::OutputFile out(study_);
  out.write(recorded_study(study, pipeline).dump(1) + "\n");
  out.close();
  file_ = std::make_unique<detail::OutputFile>(directory_ / "recorded.csv");
  std::string header;
  for (const char* symbol : {"u", "y"}) {
    const Index count = *symbol == 'u' ? study.model.inputs() : study.model.outputs();
    for (Index i = 1; i <= count; ++i)
      header += fmt::format("{}{}_{}", header.empty() ? "" : ",", symbol, i);
  }
  file_->write(header + "\n");
}

void StreamRecord::take(const Sample& sample) {
  const bool is_first = taken_++ == 0;
  if (is_first && sample.k != 0)
    throw Error(Errc::invalid,
                "what is recorded begins with k = 0, and the first sample is of k = " +
                    std::to_string(sample.k));
  if (!is_first && sample.k <= waiting_.back().k) {  // with outputs that came late
    waiting_[waiting_.size() - 1 - static_cast<std::size_t>(waiting_.back().k - sample.k)] = sample;
    return;
  }
  waiting_.push_back(sample);
  if (waiting_.size() <= most_waiting_) return;
  write_row(waiting_.front());
  file_->flush();  // what was written outlives a kill
  waiting_.pop_front();
}

void StreamRecord::write_row(const Sample& sample) {
  std::string row;
  for (const Vector* part : {&sample.u, &sample.y}) {
    for (const double value : *part) {
      row += (std::isnan(value) ? "" : detail::to_text(value)) + ",";
    }
  }
  if (row == ",") row = "nan,";  // of an output alone, which is missing: no blank line
  row.back() = '\n';
  file_->write(row);
}

void StreamRecord::finish() {
  for (const Sample& sample : waiting_) write_row(sample);
  waiting_.clear();
  file_->close();
}

}  // namespace cordon::apps
