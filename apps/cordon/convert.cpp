// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "cordon/experiments/interchange.hpp"

namespace cordon::apps {

namespace {

namespace fs = std::filesystem;

struct ConvertRequest {
  fs::path in, out;
  std::string variable;
  bool force = false, sets = false, no_data = false, sparse = false, dense = false;
};

/// Where it comes from decides what an option means, if anything.
void refuse_option(bool given, const char* option, const char* where) {
  if (given) throw Error(Errc::invalid, fmt::format("{} goes with {} only", option, where));
}

std::string ending(const fs::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

void require_mat(const ConvertRequest& wanted, const char* what) {
  if (ending(wanted.out) == ".mat") return;
  const bool table = ending(wanted.out) == ".csv";
  throw Error(Errc::invalid,
              fmt::format("{} become a MAT-file: give a name that ends in .mat{}", what,
                          table ? "; tables of results are there already: steps.csv, data.csv and "
                                  "summary.csv in their directory"
                                : ""));
}

void convert_results(const ConvertRequest& wanted, const Target& target) {
  require_mat(wanted, "results");
  results_to_mat(wanted.in, target, wanted.sets);
  note(fmt::format("Wrote {}", wanted.out.string()));
}

void convert_mat(const ConvertRequest& wanted, const Target& target) {
  if (ending(wanted.out) != ".json")
    throw Error(Errc::invalid,
                "a MAT-file becomes a study or a file of sets: give a name that ends in .json");
  const ImportedStudy imported = mat_to_json(wanted.in, target, wanted.variable);
  for (const std::string& name : imported.ignored)
    warn(fmt::format("left out, as no part of the system: {}", name));
  for (const fs::path& file : imported.files) note(fmt::format("Wrote {}", file.string()));
  if (imported.sets_only) return;
  if (!imported.missing.empty()) {
    warn(fmt::format("{} says nothing of {}: add {} to the system before the study can run",
                     wanted.in.string(), fmt::join(imported.missing, " and "),
                     imported.missing.size() == 1 ? "it" : "them"));
  }
  note(fmt::format("Next: cordon validate {}", quoted(as_operand(imported.files.back()))));
}

void convert_json(const Program& program, const ConvertRequest& wanted, const Target& target) {
  const JsonFile kind = json_file(wanted.in);
  if (kind == JsonFile::results) {
    throw Error(Errc::invalid,
                fmt::format("{} belongs to results: give their directory, {}", wanted.in.string(),
                            wanted.in.has_parent_path() ? wanted.in.parent_path().string() : "."));
  }
  if (kind == JsonFile::other) {
    throw Error(Errc::invalid, fmt::format("{} is neither a study nor a set nor a list of sets",
                                           wanted.in.string()));
  }
  if (wanted.sparse || wanted.dense) {
    if (ending(wanted.out) != ".json")
      throw Error(Errc::invalid, "--sparse and --dense write JSON: give a name that ends in .json");
    refuse_option(wanted.no_data, "--no-data", "a MAT-file of a study");
    rewrite_matrices(wanted.in, target, wanted.sparse ? MatrixForm::sparse : MatrixForm::dense);
  } else if (ending(wanted.out) == ".json") {
    throw Error(Errc::invalid, "say --sparse or --dense: how matrices are to be written");
  } else if (kind == JsonFile::sets) {
    refuse_option(wanted.no_data, "--no-data", "a MAT-file of a study");
    require_mat(wanted, "sets");
    sets_to_mat(wanted.in, target);
  } else {
    require_mat(wanted, "studies");
    Registry registry;
    const Study study = read_study(wanted.in, registry, default_search_path(program.plugins),
                                   program.study_plugins());
    study_to_mat(study, target, !wanted.no_data);
  }
  note(fmt::format("Wrote {}", wanted.out.string()));
}

Exit convert(const Program& program, const ConvertRequest& wanted) {
  const Target target{wanted.out, wanted.force};
  const bool results = fs::is_directory(wanted.in), mat = ending(wanted.in) == ".mat";
  refuse_option(wanted.sets && !results, "--sets", "the directory of a run");
  refuse_option(!wanted.variable.empty() && !mat, "--variable", "a MAT-file that is read");
  if (results || mat) {
    refuse_option(wanted.sparse || wanted.dense, "--sparse or --dense", "JSON files");
    refuse_option(wanted.no_data, "--no-data", "a MAT-file of a study");
    results ? convert_results(wanted, target) : convert_mat(wanted, target);
  } else {
    convert_json(program, wanted, target);
  }
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(convert) {
  CLI::App* command = app.add_subcommand(
      "convert", "Write studies, results and sets for MATLAB, and read them from there");
  command->footer(
      "cordon convert STUDY.json OUT.mat         the system and the data\n"
      "cordon convert RESULTS OUT.mat            what `cordon run` has left in the directory "
      "RESULTS\n"
      "cordon convert SETS.json OUT.mat          a set or a list of sets\n"
      "cordon convert IN.mat OUT.json            the beginning of a study, with recorded data as "
      "OUT.csv; or sets\n"
      "cordon convert IN.json OUT.json --sparse  a study or sets with matrices in another form (or "
      "--dense)");
  const auto wanted = std::make_shared<ConvertRequest>();
  command
      ->add_option("IN", wanted->in,
                   "A study, a directory of results, a file of sets, or a MAT-file")
      ->required()
      ->check(CLI::ExistingPath);
  command->add_option("OUT", wanted->out, "The file to write")->required();
  command->add_flag("--force", wanted->force, "Replace OUT if it is there");
  command->add_flag("--sets", wanted->sets, "Of results: the set of every step as well");
  command->add_flag("--no-data", wanted->no_data, "Of a study: the system alone");
  command->add_option("--variable", wanted->variable, "Of a MAT-file: the variable to take")
      ->option_text("NAME");
  CLI::Option* sparse =
      command->add_flag("--sparse", wanted->sparse,
                        "Matrices by their entries that are not 0, where that is shorter");
  command->add_flag("--dense", wanted->dense, "Matrices as lists of rows")->excludes(sparse);
  command->callback([&program, wanted] { program.exit = convert(program, *wanted); });
}

}  // namespace cordon::apps
