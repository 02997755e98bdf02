// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>

#include "cordon/experiments/report.hpp"
#include "experiments/sweep/journal.hpp"
#include "experiments/sweep/sweep_files.hpp"

namespace cordon {

namespace {

namespace fs = std::filesystem;
using detail::SweepFiles;

[[noreturn]] void refuse_part(const fs::path& directory, const std::string& reason,
                              const std::string& suggestion) {
  throw InputError(directory.string(), {{"", reason, suggestion}});
}

/// A whole sweep is part 1 of 1.
SweepFiles read_part(const fs::path& directory, bool alone) {
  if (detail::Journal::is_in(directory)) {
    refuse_part(directory, "holds an unfinished part",
                "\"cordon run\" with \"--resume\" and the same \"--shard\" finishes it");
  }
  SweepFiles part = detail::read_sweep(directory);
  if (!part.shard && alone) part.shard = Shard{};
  if (!part.shard)
    refuse_part(directory, "holds a whole sweep, not a part of one",
                "name directories of \"cordon run --shard I/N\"");
  return part;
}

/// Throws unless `part` is another part of the same sweep.
void check_same(const SweepFiles& first, const fs::path& first_directory, const SweepFiles& part,
                const fs::path& directory) {
  const std::string like = " than " + first_directory.string();
  if (part.study_hash != first.study_hash)
    refuse_part(directory, "is of another study" + like, "merge parts of one sweep only");
  if (part.version != first.version || part.abi_tag != first.abi_tag)
    refuse_part(directory, "was made by another build of this program" + like,
                "run all parts with the same build");
  if (part.limit_s != first.limit_s)
    refuse_part(directory, "was run with another time limit per point" + like,
                "run all parts with the same \"--point-limit\"");
  if (part.heads.results != first.heads.results)
    refuse_part(directory, "was made with other plugins or libraries" + like,
                "run all parts on the same installation");
  if (part.shard->of != first.shard->of)
    refuse_part(directory,
                "is a part of " + std::to_string(part.shard->of) + ", " + first_directory.string() +
                    " is one of " + std::to_string(first.shard->of),
                "merge parts of one sweep only");
}

void check_all_there(const std::set<std::int64_t>& there, std::int64_t of, const fs::path& out) {
  std::string missing;
  for (std::int64_t part = 1; part <= of; ++part) {
    if (there.count(part) == 0) missing += (missing.empty() ? "" : ", ") + std::to_string(part);
  }
  if (missing.empty()) return;
  refuse_part(
      out, "cannot be written: of " + std::to_string(of) + " parts these are missing: " + missing,
      "name the directories of all parts");
}

}  // namespace

SweepOutcome merge_sweeps(const std::vector<fs::path>& parts, const fs::path& out) {
  if (parts.empty()) throw Error(Errc::invalid, "there are no parts to merge");
  SweepFiles all = read_part(parts.front(), parts.size() == 1);
  std::set<std::int64_t> there{all.shard->part};
  std::error_code ignored;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (fs::equivalent(parts[i], out, ignored))
      refuse_part(out, "is one of the parts", "name another directory for the whole sweep");
    if (i == 0) continue;
    SweepFiles part = read_part(parts[i], false);
    check_same(all, parts.front(), part, parts[i]);
    if (!there.insert(part.shard->part).second)
      refuse_part(parts[i], "is part " + std::to_string(part.shard->part) + ", which came before",
                  "name each part once");
    all.rows.merge(part.rows);
    all.wall_s += part.wall_s;
    all.finished = std::max(all.finished, part.finished);
  }
  check_all_there(there, all.shard->of, out);
  all.shard.reset();
  const detail::DirectoryLock lock(out);
  if (detail::Journal::is_in(out))
    refuse_part(out, "holds an unfinished sweep", "name another directory for the whole sweep");
  SweepOutcome outcome;
  outcome.table = detail::table_of(all);
  outcome.files = detail::write_sweep(lock, all, outcome.table);
  outcome.report_error = add_report(lock.directory(), outcome.files);
  outcome.violated = detail::violations(outcome.table);
  outcome.first_error = all.rows.first_error();
  outcome.progress = {all.rows.size(), all.rows.size(), all.rows.failed(), all.rows.size(), 0};
  return outcome;
}

}  // namespace cordon
