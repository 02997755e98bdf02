// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/reading/read_sweep.hpp"

#include <algorithm>
#include <functional>

#include <nlohmann/json.hpp>

#include "experiments/sweep/sweep_files.hpp"
#include "study/results/measures.hpp"
#include "study/results/table_builder.hpp"
#include "study/text/input_file.hpp"
#include "study/text/json_writer.hpp"
#include "study/text/manifest.hpp"

namespace cordon::detail {

namespace {

namespace fs = std::filesystem;
using json::Cursor;
using Kind = json::Value::Kind;

[[noreturn]] void refuse_results(const fs::path& file, const std::string& reason,
                                 const std::string& what_to_do) {
  throw InputError(file.string(), {{"", reason, what_to_do}});
}

/// A file around its points.
struct Frame {
  std::string head;   ///< up to the end of the last member before shard and points
  std::string shard;  ///< the line with the shard, if there is one
  std::string tail;   ///< what follows the points
};

/// A last line without its comma.
void end_member(std::string& text) {
  if (text.ends_with('\n')) text.pop_back();
  if (text.ends_with(',')) text.pop_back();
}

/// Calls `begin` when the head is there, then hands each point to `point`, which tells whether it
/// is right.
Frame read_points(const fs::path& file, const std::function<void(const Frame&)>& begin,
                  const std::function<bool(const Cursor&)>& point) {
  InputFile input(file, "\"cordon run\" writes it at the end of a sweep");
  enum class Place { head, points, tail } place = Place::head;
  Frame frame;
  for (std::string line; input.line(line, json::max_bytes);) {
    if (place == Place::points && line.starts_with("    ")) {
      if (line.ends_with(',')) line.pop_back();
      json::Problems problems;
      const json::Value tree = json::parse(line, problems);
      const Cursor at(tree, "", problems);
      if (!point(at) || problems.any())
        throw InputError(
            file.string(),
            {{"", "this line is no point of a sweep", not_as_written,
              static_cast<int>(std::min<std::int64_t>(input.lines(), 1'000'000'000))}});
      continue;
    }
    if (place == Place::head && line == "  \"points\": [") {
      end_member(frame.head);
      end_member(frame.shard);
      begin(frame);
      place = Place::points;
    } else if (place == Place::head) {
      (line.starts_with("  \"shard\": ") ? frame.shard : frame.head) += line + '\n';
    } else {
      if (place == Place::tail) frame.tail += line + '\n';
      place = Place::tail;  // this line closes the points
    }
    if (frame.head.size() + frame.tail.size() > json::max_bytes)
      refuse_results(file, "is too large", not_as_written);
  }
  if (place == Place::head)
    refuse_results(file, "has no points: it is not of a sweep",
                   "name a directory that a sweep was written to");
  if (place == Place::points) refuse_results(file, "ends in the middle", not_as_written);
  return frame;
}

std::string text(const Cursor& root, const char* key) {
  const auto at = root.need(key, not_as_written);
  return at && at->expect(Kind::text, not_as_written) ? at->value().text() : "";
}

std::int64_t whole(const Cursor& object, const char* key, std::int64_t lowest) {
  const auto at = object.need(key, not_as_written);
  return at ? json::read_integer(*at, static_cast<double>(lowest), json::max_integer)
                  .value_or(lowest)
            : lowest;
}

void read_axis(const Cursor& at, Study& study) {
  if (!at.expect(Kind::object, not_as_written)) return;
  SweepAxis& axis = study.sweep.emplace_back();
  axis.name = text(at, "name");
  if (const auto path = at.need("path", not_as_written))
    axis.path = json::resolved_path_text(*path);
  const auto repeat = at.need("repeat", not_as_written), values = at.need("values", not_as_written);
  axis.repeat = repeat && json::read_flag(*repeat).value_or(false);
  if (values && values->expect(Kind::array, not_as_written) && values->size() == 0)
    values->error("is empty", not_as_written);
  const auto labels = at.find("labels");
  if (!labels || !labels->expect(Kind::array, not_as_written)) return;
  for (std::size_t i = 0; i < labels->size(); ++i)
    axis.labels.push_back(json::read_text(labels->item(i), 1000).value_or(""));
  if (values && labels->size() != values->size())
    labels->error("does not name every value", not_as_written);
}

void read_names(const Cursor& root, SweepFiles& sweep) {
  whole(root, "cordon_results", 1);
  sweep.study.title = text(root, "title");
  sweep.study_hash = text(root, "study_hash");
  if (const auto cordon = root.need("cordon", not_as_written);
      cordon && cordon->expect(Kind::object, not_as_written)) {
    sweep.version = text(*cordon, "version");
    sweep.abi_tag = text(*cordon, "abi_tag");
  }
  const auto pipelines = root.need("pipelines", not_as_written);
  for (std::size_t i = 0;
       pipelines && pipelines->expect(Kind::array, not_as_written) && i < pipelines->size(); ++i) {
    const Cursor pipeline = pipelines->item(i);
    sweep.study.pipelines.emplace_back().name =
        pipeline.expect(Kind::object, not_as_written) ? text(pipeline, "name") : "";
  }
  if (pipelines && pipelines->size() == 0) pipelines->error("is empty", not_as_written);
  const auto limit = root.need("point_limit_s", not_as_written);
  if (limit && !limit->is(Kind::null))
    sweep.limit_s = json::read_number(*limit).value_or(sweep.limit_s);
  const auto study = root.need("study", not_as_written);
  if (!study || study->is(Kind::null)) return;
  sweep.study.labels.sampling_time = sampling_time_of(root);
  const auto axes =
      study->expect(Kind::object, not_as_written) ? study->find("sweep") : std::nullopt;
  for (std::size_t i = 0; axes && axes->expect(Kind::array, not_as_written) && i < axes->size();
       ++i)
    read_axis(axes->item(i), sweep.study);
}

/// The numbers of a line of results.json or run.json.
bool read_point(const Cursor& at, bool measured, PointResult& result) {
  if (!at.expect(Kind::object, not_as_written)) return false;
  result.index = whole(at, "point", 0);
  const auto numbers = at.need("numbers", not_as_written);
  return numbers && read_numbers(*numbers, measured, result.numbers);
}

/// The place in the grid that a line claims.
bool is_at(const Cursor& at, const SweepPoint& point) {
  const auto place = at.need("at", not_as_written);
  if (!place || !place->expect(Kind::array, not_as_written) || place->size() != point.at.size())
    return false;
  bool same = whole(at, "pipeline", 0) == static_cast<std::int64_t>(point.pipeline);
  for (std::size_t i = 0; i < point.at.size(); ++i) {
    same = same && json::read_integer(place->item(i), 0, json::max_integer) ==
                       static_cast<std::int64_t>(point.at[i]);
  }
  return same;
}

Shard shard_of(const std::string& line, const fs::path& file) {
  json::Problems problems;
  const json::Value tree = json::parse('{' + line + '}', problems);
  const Cursor root(tree, "", problems);
  Shard shard;
  const auto at =
      root.expect(Kind::object, not_as_written) ? root.need("shard", not_as_written) : std::nullopt;
  if (at && at->expect(Kind::object, not_as_written))
    shard = {whole(*at, "part", 1), whole(*at, "of", 1)};
  if (problems.any() || shard.part > shard.of || shard.of > most_parts)
    refuse_results(file, "has a shard that is none", not_as_written);
  return shard;
}

/// Of run.json what is not about single points.
void read_times(SweepFiles& sweep, const Frame& frame, const fs::path& file) {
  json::Problems problems;
  const std::string text_around = frame.head + ",\n" + frame.tail;
  const json::Value tree = json::parse(text_around, problems);
  const Cursor root(tree, "", problems);
  if (root.expect(Kind::object, not_as_written)) {
    whole(root, "cordon_run", 1);
    const auto wall = root.need("wall_s", not_as_written);
    if (wall) sweep.wall_s = json::read_number(*wall).value_or(0);
    sweep.finished = text(root, "finished");
  }
  if (problems.any()) throw InputError(file.string(), problems.sorted());
}

void check_complete(const SweepFiles& sweep, const SweepGrid& grid, const fs::path& file) {
  const Shard shard = sweep.shard.value_or(Shard{});
  std::int64_t count = 0;
  for (std::int64_t i = 0; i < grid.size(); ++i) {
    const bool mine = shard.has(grid[i], sweep.study.pipelines.size());
    if (mine != sweep.rows.has(i))
      refuse_results(
          file, "point " + std::to_string(i) + (mine ? " is missing" : " does not belong here"),
          not_as_written);
    count += mine;
  }
  if (count != sweep.rows.size())
    refuse_results(file, "has points that are not in its sweep", not_as_written);
}

}  // namespace

void read_head(SweepFiles& sweep, const fs::path& file) {
  const std::string head = sweep.heads.results + "\n}";
  json::Problems problems;
  const json::Value tree = json::parse(head, problems);
  const Cursor root(tree, "", problems);
  if (root.expect(Kind::object, not_as_written)) {
    read_names(root, sweep);
    sweep.measures = read_measures(root);
  }
  if (problems.any()) throw InputError(file.string(), problems.sorted());
  // What was checked is read again, by a parser that can also write: values are texts, the same
  // whoever reads this head.
  const auto whole_head = nlohmann::ordered_json::parse(head);
  for (std::size_t i = 0; i < sweep.study.sweep.size(); ++i) {
    for (const auto& value : whole_head["study"]["sweep"][i]["values"])
      sweep.study.sweep[i].values.push_back(value.dump());
  }
}

SweepFiles read_sweep(const fs::path& directory) {
  const RecordedFiles files(directory);
  const fs::path file = files.file("results.json"), times = files.file("run.json");
  SweepFiles sweep;
  std::optional<SweepGrid> grid;
  read_points(
      file,
      [&](const Frame& frame) {
        sweep.heads.results = frame.head;
        read_head(sweep, file);
        if (!frame.shard.empty()) sweep.shard = shard_of(frame.shard, file);
        grid.emplace(sweep.study);
      },
      [&](const Cursor& at) {
        PointResult result;
        if (!read_point(at, false, result) || result.index >= grid->size() ||
            sweep.rows.has(result.index))
          return false;
        const auto error = at.need("error", not_as_written);
        if (error && !error->is(Kind::null))
          result.error = json::read_text(*error, json::max_bytes).value_or("");
        if (const auto code = at.find("error_code")) {
          result.code = code->is(Kind::text) ? error_code(code->value().text()) : std::nullopt;
          if (!result.code) return false;
        }
        if (result.error.empty() == result.code.has_value()) return false;
        if (!is_at(at, (*grid)[result.index])) return false;
        sweep.rows.add(result);
        return true;
      });
  check_complete(sweep, *grid, file);
  const Frame frame = read_points(
      times, [&](const Frame& around) { sweep.heads.run = around.head; },
      [&](const Cursor& at) {
        PointResult result;
        return read_point(at, true, result) && sweep.rows.extend(result);
      });
  read_times(sweep, frame, times);
  files.check_unchanged();
  return sweep;
}

}  // namespace cordon::detail
