// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/recorded_run.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "read/recorded_parts.hpp"
#include "read/step_reader.hpp"
#include "study/results/recorded_head.hpp"
#include "study/text/large_json.hpp"

namespace cordon::verification {

namespace {

using namespace json;
using Kind = Value::Kind;

/// A block of rows × cols; a matrix without rows or columns is written as [] or [[], …].
std::optional<Matrix> read_block(const Cursor& set, const char* key, Index rows, Index cols) {
  const auto at = set.need(key, not_as_written);
  auto entries = at ? read_matrix(*at) : std::nullopt;
  if (!entries) return std::nullopt;
  if (entries->size() == 0 && rows * cols == 0) return Matrix(rows, cols);
  if (entries->rows() == rows && entries->cols() == cols) return entries;
  at->error("is " + shape(entries->rows(), entries->cols()) + ", must be " + shape(rows, cols),
            not_as_written);
  return std::nullopt;
}

std::optional<Vector> read_part(const Cursor& set, const char* key, Index size) {
  const auto at = set.need(key, not_as_written);
  auto entries = at ? read_vector(*at) : std::nullopt;
  if (!entries || entries->size() == size) return entries;
  at->error(
      "has " + std::to_string(entries->size()) + " numbers, must have " + std::to_string(size),
      not_as_written);
  return std::nullopt;
}

std::optional<Index> read_size(const Cursor& set, const char* key) {
  const auto at = set.need(key, not_as_written);
  const auto size = at ? read_integer(*at, 0, max_entries) : std::nullopt;
  return size ? std::optional<Index>(*size) : std::nullopt;
}

}  // namespace

std::optional<LineForm> read_form(const Cursor& at, std::optional<Index> dim) {
  if (!at.expect(Kind::object, not_as_written)) return std::nullopt;
  const auto n = read_size(at, "dim"), l = read_size(at, "lines"), g = read_size(at, "generators"),
             m = read_size(at, "constraints");
  if (!n || !l || !g || !m) return std::nullopt;
  if (dim && *n != *dim) {
    at.error("has dimension " + std::to_string(*n) + ", the state has " + std::to_string(*dim),
             not_as_written);
    return std::nullopt;
  }
  auto M = read_block(at, "M", *n, *l), G = read_block(at, "G", *n, *g),
       S = read_block(at, "S", *m, *l), A = read_block(at, "A", *m, *g);
  auto c = read_part(at, "c", *n), b = read_part(at, "b", *m);
  if (!M || !G || !S || !A || !c || !b) return std::nullopt;
  return LineForm{std::move(*M), std::move(*G), std::move(*c),
                  std::move(*S), std::move(*A), std::move(*b)};
}

namespace {

/// H and h, r×n and r: as many rows as h has entries.
std::optional<Inequalities> read_inequalities(const Cursor& at, Index dim) {
  const auto h_at = at.need("h", not_as_written);
  auto h = h_at ? read_vector(*h_at) : std::nullopt;
  if (!h) return std::nullopt;
  auto H = read_block(at, "H", h->size(), dim);
  if (!H) return std::nullopt;
  return Inequalities{std::move(*H), std::move(*h)};
}

std::optional<Certificate> read_certificate(const Cursor& at) {
  if (!at.expect(Kind::object, not_as_written)) return std::nullopt;
  using Proof = Certificate::Kind;
  const auto kind = read_word(at, "kind",
                              {Proof::none, Proof::farkas, Proof::point, Proof::dual,
                               Proof::direction, Proof::structure, Proof::rows});
  if (!kind) return std::nullopt;
  Certificate why{*kind, Vector(0), 0};
  if (const auto data = at.find("data")) {
    auto numbers = read_vector(*data);
    if (!numbers) return std::nullopt;
    why.data = std::move(*numbers);
  }
  if (const auto margin = at.find("margin")) why.margin = read_number(*margin).value_or(0);
  return why;
}

std::optional<Rounding> read_rounding(const Cursor& pipeline) {
  return read_word(pipeline, "rounding",
                   {Rounding::nominal, Rounding::outward, Rounding::rational});
}

/// What the pipeline assumes and its steps; nothing if they are not right.
std::optional<RecordedEstimation> read_estimation(const Cursor& at, Index n,
                                                  std::vector<RecordedStep> read) {
  RecordedEstimation estimation;
  estimation.steps = std::move(read);
  const auto assumed = at.need("assumptions", not_as_written),
             steps = at.need("steps", not_as_written);
  if (!assumed || !steps || !steps->expect(Kind::array, not_as_written)) return std::nullopt;
  if (assumed->is(Kind::null) && estimation.steps.empty())
    return estimation;  // stopped before its first step
  if (!read_rounding(at) || !assumed->expect(Kind::object, not_as_written)) return std::nullopt;
  if (const auto initial = assumed->need("initial_set", not_as_written)) {
    if (auto form = read_form(*initial, n)) estimation.initial_set = std::move(*form);
  }
  if (const auto admissible = assumed->need("admissible_set", not_as_written);
      admissible && !admissible->is(Kind::null)) {
    estimation.admissible_set = read_form(*admissible, n);
  }
  if (const auto restart = assumed->find("restart_set"))
    estimation.restart_set = read_form(*restart, n);
  if (const auto follows = assumed->find("follows_its_sets"))
    estimation.follows_its_sets = read_flag(*follows).value_or(false);
  if (const auto lag = assumed->find("lag"))
    estimation.lag = read_integer(*lag, 1, max_integer).value_or(0);
  const auto summary = at.find("summary");
  estimation.has_outliers = summary && summary->is(Kind::object) && summary->find("outliers");
  estimation.contradictions = contradictions_of(at, estimation.steps);
  return estimation;
}

/// What the run itself has found.
void read_summary(const Cursor& at, const SystemPart& system, RecordedPipeline& pipeline) {
  const auto summary = at.find("summary");
  if (!summary || !summary->is(Kind::object)) return;
  pipeline.failed = read_failed_assumption(*summary, system);
  const auto error = summary->find("error");
  pipeline.stopped = error && !error->is(Kind::null);
  const auto refuted = summary->find("refuted");
  if (!pipeline.design() || !refuted || !refuted->is(Kind::array)) return;
  for (std::size_t i = 0; i < refuted->size(); ++i)
    pipeline.design()->refuted.push_back(read_text(refuted->item(i), 10'000).value_or(""));
}

std::optional<RecordedPipeline> read_pipeline(const Cursor& at, const SystemPart& system,
                                              std::size_t index, StepReader& steps) {
  if (!at.expect(Kind::object, not_as_written)) return std::nullopt;
  RecordedPipeline pipeline;
  const auto name = at.need("name", not_as_written), backend = at.need("backend", not_as_written);
  if (!name || !backend) return std::nullopt;
  pipeline.name = read_text(*name, 1000).value_or("");
  pipeline.backend = read_text(*backend, 1000).value_or("");
  if (at.find("designer")) {
    pipeline.task = read_designed(at, system);
  } else if (at.find("diagnoser")) {
    const auto assumed = at.find("assumptions");  // without them nothing is made of the steps
    const bool is_read = assumed && !assumed->is(Kind::null);
    pipeline.task = read_diagnosed(
        at, system,
        is_read ? steps.of_diagnosis(at, index) : std::vector<RecordedDiagnosis::Step>{});
  } else {
    const Index n = system.model.states();
    auto estimation = read_estimation(at, n, steps.of(at, index, n, system.model.outputs()));
    if (estimation) pipeline.task = std::move(*estimation);  // else the run is refused
  }
  read_summary(at, system, pipeline);
  if (const auto rounding = at.find("rounding"); rounding && !rounding->is(Kind::null))
    pipeline.rounding = read_rounding(at).value_or(Rounding::nominal);
  return pipeline;
}

int line_number(const detail::InputFile& file) {
  return static_cast<int>(std::min<std::int64_t>(file.lines(), 1'000'000'000));
}

/// May samples of this study lack outputs?
bool may_have_gaps(const Cursor& study) {
  const auto data = study.find("data");
  const auto simulate = data ? data->find("simulate") : std::nullopt,
             csv = data ? data->find("csv") : std::nullopt;
  return (simulate && simulate->find("dropouts")) ||
         (csv && (csv->find("missing") || csv->find("irregular")));
}

CsvSpec data_of(std::filesystem::path file, const Model& model, const Labels& labels,
                MissingValue missing) {
  CsvSpec spec;
  spec.missing = missing;
  spec.file = std::move(file);
  for (Index i = 0; i < model.inputs(); ++i)
    spec.inputs.push_back(heading_of(labels.inputs, "u", i));
  for (Index i = 0; i < model.outputs(); ++i)
    spec.outputs.push_back(heading_of(labels.outputs, "y", i));
  return spec;
}

/// A line of a file whose lines all have their ends; false behind the last one.
bool next_line(detail::InputFile& file, std::string& line) {
  if (!file.line(line, max_bytes)) return false;
  if (file.ended_line()) return true;
  throw InputError(file.path().string(),
                   {{"", "ends in the middle of a line", not_as_written, line_number(file)}});
}

/// The first column of data.csv counts the rows from 0: estimates are matched with samples by it.
void check_times(const std::filesystem::path& path) {
  detail::InputFile file(path, not_as_written);
  std::string row;
  next_line(file, row);
  for (std::int64_t k = 0; next_line(file, row); ++k) {
    if (row.substr(0, row.find(',')) == std::to_string(k)) continue;
    throw InputError(path.string(),
                     {{"", "must tell of k = " + std::to_string(k) + " in its first column",
                       not_as_written, line_number(file)}});
  }
}

/// `k` of a line of sets.jsonl, if it stands there as it was written. (A quote inside of a text is
/// escaped, so that no name holds the key.)
std::optional<Index> time_of(const std::string& text) {
  static const std::string key = "\"k\": ";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return std::nullopt;
  Index k = 0;
  const char *first = text.data() + at + key.size(), *last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, k);
  return error == std::errc{} && end != last && *end == ',' ? std::optional<Index>(k)
                                                            : std::nullopt;
}

}  // namespace

RecordedRun read_run(const std::filesystem::path& directory) {
  RecordedRun run{detail::RecordedFiles(directory), {}, {}, {}, {}, {}};
  const std::filesystem::path file = run.files.file("results.json");
  Problems problems;
  StepReader steps;
  const Value tree =
      read_large(file,
                 {.kept = {"/cordon_results", "/formulas", "/study/system",
                           "/study/data/simulate/dropouts", "/study/data/csv/missing",
                           "/study/data/csv/irregular", "/sets", "/points", "/pipelines"},
                  .streamed = {"/pipelines/*/steps/*", "/points/*"},
                  .take =
                      [&](const Cursor& at, const std::vector<std::size_t>& place) {
                        if (place.size() == 2) steps.take(at, place[0]);
                      }},
                 problems)
          .tree;
  const Cursor root(tree, "", problems);
  if (expect_results(root)) {
    if (root.find("points")) {
      throw InputError(file.string(),
                       {{"/points", "is a sweep, which keeps no sets",
                         "\"cordon run STUDY --point INDEX\" runs one point with all files"}});
    }
    const auto study = root.need("study", not_as_written),
               pipelines = root.need("pipelines", not_as_written);
    const auto system = study && study->expect(Kind::object, not_as_written)
                            ? study->need("system", not_as_written)
                            : std::nullopt;
    if (study && may_have_gaps(*study)) run.data.missing = MissingValue::skip;
    std::vector<std::string> warnings;
    SystemPart part = system ? read_recorded_system(*system, warnings, &root) : SystemPart{};
    if (part.good && pipelines && pipelines->expect(Kind::array, not_as_written)) {
      for (std::size_t i = 0; i < pipelines->size(); ++i) {
        if (auto pipeline = read_pipeline(pipelines->item(i), part, i, steps)) {
          run.pipelines.push_back(std::move(*pipeline));
        }
      }
    }
    const bool observes =
        std::any_of(run.pipelines.begin(), run.pipelines.end(),
                    [](const RecordedPipeline& one) { return one.estimation() != nullptr; });
    if (observes) expect_all_sets(root);
    run.bank.modes.push_back({std::move(part.nominal), part.model});
    run.bank.modes.insert(run.bank.modes.end(), part.modes.begin(), part.modes.end());
    run.model = std::move(part.model);
    run.labels = std::move(part.labels);
  }
  if (problems.any()) throw InputError(file.string(), problems.sorted());
  run.data = data_of(run.files.file("data.csv"), run.model, run.labels, run.data.missing);
  check_times(run.data.file);
  return run;
}

SetReader::SetReader(const detail::RecordedFiles& files)
    : files_(files),
      input_(files.file("sets.jsonl"), "\"cordon run\" writes it beside results.json") {}

std::optional<RecordedSet> SetReader::next(const std::function<bool(Index)>& wanted) {
  std::string text;
  for (bool passes = true; passes;) {
    if (!next_line(input_, text)) {
      files_.check_unchanged();
      return std::nullopt;
    }
    const auto k = wanted ? time_of(text) : std::nullopt;
    passes = k && !wanted(*k);
  }
  Problems problems;
  RecordedSet row;
  row.line = input_.lines();
  const Value tree = parse(text, problems);
  const Cursor root(tree, "", problems);
  if (root.expect(Kind::object, not_as_written)) {
    const auto name = root.need("pipeline", not_as_written), k_at = root.need("k", not_as_written),
               proof = root.need("proof", not_as_written);
    const auto exchange = read_word(root, "exchange", {Tightness::exact, Tightness::outer});
    row.tightness = read_word(root, "tightness", {Tightness::exact, Tightness::outer})
                        .value_or(Tightness::outer);
    row.consistent = read_word(root, "consistent", {Answer::yes, Answer::no, Answer::unknown})
                         .value_or(Answer::unknown);
    const auto dim = read_size(root, "dim");
    if (name) row.pipeline = read_text(*name, 1000).value_or("");
    if (k_at) row.k = read_integer(*k_at, 0, max_integer).value_or(0);
    if (exchange) row.exact_exchange = *exchange == Tightness::exact;
    if (auto form = dim ? read_form(root, *dim) : std::nullopt) row.set = std::move(*form);
    if (dim && root.find("H")) {
      row.rows = read_inequalities(root, *dim).value_or(Inequalities{});
      row.exact_exchange = false;
    }
    if (proof) row.proof = read_certificate(*proof).value_or(Certificate{});
    if (const auto proofs = root.find("hull_proofs");
        proofs && proofs->expect(Kind::array, not_as_written)) {
      for (std::size_t i = 0; i < proofs->size(); ++i) {
        row.hull_proofs.push_back(read_certificate(proofs->item(i)).value_or(Certificate{}));
      }
    }
  }
  if (!problems.any()) return row;
  std::vector<Diagnostic> found = problems.sorted();
  for (Diagnostic& one : found) one.line = line_number(input_);
  throw InputError(input_.path().string(), std::move(found));
}

}  // namespace cordon::verification
