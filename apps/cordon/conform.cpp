// SPDX-License-Identifier: GPL-3.0-or-later
// cordon conform: the laws of the conformance kit, checked on a plugin's components.
#include <algorithm>
#include <charconv>
#include <memory>
#include <set>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "conform_discovery.hpp"
#include "conform_worker.hpp"
#include "json_text.hpp"
#include "progress_bar.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;
using State = LawReport::State;
namespace fs = std::filesystem;

struct ConformArguments {
  std::string plugin, laws = "*";
  Wanted wanted;
  std::uint64_t seed = 1;
  Index cases = conformance::Options{}.cases;
  double timeout_s = 20;
  bool json = false, list = false, in_process = false;
};

/// The outcome for one component with one set of parameters.
struct Conformed {
  Candidate candidate;
  std::vector<LawReport> laws;
  double seconds = 0;
  std::string problem = {};  ///< no law can be checked

  Index count(State state) const {
    return std::count_if(laws.begin(), laws.end(),
                         [&](const LawReport& r) { return r.state == state; });
  }
};

/// The file that is meant: a path, or the name of a plugin on the search path.
fs::path find_plugin(const Program& program, const std::string& plugin) {
  std::error_code error;
  if (plugin.find('/') != std::string::npos || plugin.ends_with(".so")) {
    if (!fs::is_regular_file(plugin, error))
      throw Error(Errc::io, fmt::format("no file {}", plugin));
    return fs::absolute(plugin);
  }
  std::vector<std::string> names;
  for (const fs::path& directory : default_search_path(program.plugins).directories) {
    for (const auto& entry : fs::directory_iterator(directory, error)) {
      if (entry.path().extension() != ".so") continue;
      if (entry.path().stem() == plugin) return entry.path();
      names.push_back(entry.path().stem().string());
    }
  }
  throw Error(Errc::invalid,
              fmt::format("no plugin \"{}\" on the search path; {}", plugin,
                          names.empty() ? "give the path of its file" : suggest(plugin, names)));
}

std::string replay_command(const Program& program, const ConformArguments& arguments,
                           const Candidate& candidate) {
  std::string text = "cordon";
  for (const fs::path& directory : program.plugins)
    text += " --plugins " + quoted(directory.string());
  text += " conform " + quoted(arguments.plugin) + " --kind " + candidate.kind + " --component " +
          candidate.component;
  if (candidate.params != "{}") text += " --params " + quoted(candidate.params);
  return text;
}

std::string title_of(const Candidate& candidate) {
  const std::string name = candidate.kind + " " + candidate.component;
  return candidate.params == "{}" ? name : name + " " + candidate.params;
}

std::string note_of(const LawReport& report) {
  const conformance::Result& r = report.result;
  if (report.state == State::skipped) return r.reason;
  std::vector<std::string> notes;
  if (r.unsupported > 0) notes.push_back(fmt::format("{} refused", r.unsupported));
  if (r.inapplicable > 0) notes.push_back(fmt::format("{} do not bear on it", r.inapplicable));
  if (r.questions > 0 && r.unknown > 0) {
    notes.push_back(fmt::format("{:.0f} % unknown", 100.0 * static_cast<double>(r.unknown) /
                                                        static_cast<double>(r.questions)));
  }
  return fmt::format("{}", fmt::join(notes, ", "));
}

std::string shown(State state, const Paint& paint) {
  const std::string text = state == State::timed_out ? "timed out" : std::string(to_string(state));
  if (state == State::passed) return paint.green(text);
  return state == State::skipped ? paint.yellow(text) : paint.red(text);
}

std::string statement_of(const std::string& law) {
  for (const conformance::Law& known : conformance::laws()) {
    if (known.name == law) return known.statement;
  }
  return "";
}

bool is_violation(const LawReport& report) {
  return report.state != State::passed && report.state != State::skipped;
}

std::string as_text(const Conformed& c, const std::string& plugin) {
  const Paint paint(stdout);
  std::string text = paint.bold(title_of(c.candidate)) + " (plugin " + plugin + ")\n";
  if (!c.problem.empty()) return text + "no law was checked: " + c.problem + "\n";
  std::vector<std::vector<std::string>> rows{{"LAW", "CASES", "RESULT", "NOTE"}};
  for (const LawReport& report : c.laws) {
    // colours would count as width: the result stands in the last column but one, padded by hand
    std::string result =
        report.state == State::timed_out ? "timed out" : std::string(to_string(report.state));
    const std::string padding(9 - std::min<std::size_t>(9, result.size()), ' ');
    rows.push_back({report.result.law, std::to_string(report.result.cases), result + padding,
                    note_of(report)});
  }
  text += table(rows, paint);
  for (const LawReport& report : c.laws) {
    if (!is_violation(report)) continue;
    text += fmt::format("\n{}: {}\n  {}\n  {}\n", shown(report.state, paint),
                        paint.bold(report.result.law), statement_of(report.result.law),
                        report.result.reason);
    std::string line;
    for (const char letter : report.result.witness) {
      if (letter != '\n') {
        line += letter;
        continue;
      }
      text += "    " + line + "\n";
      line.clear();
    }
    text += "  replay: " + report.result.replay + "\n";
  }
  const Index violated = c.count(State::failed),
              died = c.count(State::crashed) + c.count(State::timed_out);
  text +=
      fmt::format("\n{} laws hold, {} violated, {} crashed or hung, {} do not apply; {:.1f} s\n",
                  c.count(State::passed), violated, died, c.count(State::skipped), c.seconds);
  return text;
}

Json as_json(const Conformed& c) {
  if (!c.problem.empty())
    return {{"kind", c.candidate.kind},
            {"component", c.candidate.component},
            {"params", Json::parse(c.candidate.params)},
            {"problem", c.problem}};
  Json laws = Json::array();
  for (const LawReport& report : c.laws) {
    const conformance::Result& r = report.result;
    Json entry{{"law", r.law},
               {"statement", statement_of(r.law)},
               {"status", to_string(report.state)},
               {"cases", r.cases},
               {"unsupported", r.unsupported},
               {"inapplicable", r.inapplicable},
               {"questions", r.questions},
               {"unknown", r.unknown},
               {"seconds", report.seconds}};
    if (!r.reason.empty()) entry["reason"] = r.reason;
    if (is_violation(report)) entry.update({{"witness", r.witness}, {"replay", r.replay}});
    laws.push_back(std::move(entry));
  }
  return {{"kind", c.candidate.kind},
          {"component", c.candidate.component},
          {"params", Json::parse(c.candidate.params)},
          {"seconds", c.seconds},
          {"laws", laws}};
}

Exit list_laws(const ConformArguments& arguments) {
  std::vector<std::vector<std::string>> rows{{"LAW", "OF", "STATEMENT"}};
  Json entries = Json::array();
  for (const conformance::Law& law : conformance::laws()) {
    if (!conformance::matches(arguments.laws, law.name)) continue;
    if (!arguments.wanted.kind.empty() && law.kind != arguments.wanted.kind) continue;
    rows.push_back({law.name, law.kind, law.statement});
    entries.push_back({{"law", law.name}, {"kind", law.kind}, {"statement", law.statement}});
  }
  print(arguments.json ? json_text(Json{{"laws", entries}}) : table(rows, Paint(stdout)));
  return Exit::done;
}

void require_laws(const std::string& pattern) {
  std::vector<std::string> names;
  for (const conformance::Law& law : conformance::laws()) {
    if (conformance::matches(pattern, law.name)) return;
    names.push_back(law.name);
  }
  const std::string near = nearest(pattern, names);
  throw Error(Errc::invalid,
              fmt::format("no law matches \"{}\"; {}\"cordon conform --list\" shows all", pattern,
                          near.empty() ? std::string() : "did you mean \"" + near + "\"? "));
}

/// Those of a kind that the pattern has laws of.
std::vector<Candidate> with_laws(std::vector<Candidate> candidates, const std::string& pattern) {
  std::set<std::string> kinds;
  for (const conformance::Law& law : conformance::laws()) {
    if (conformance::matches(pattern, law.name)) kinds.insert(law.kind);
  }
  const std::string first = candidates.front().kind;
  std::erase_if(candidates, [&](const Candidate& c) { return !kinds.contains(c.kind); });
  if (candidates.empty())
    throw Error(
        Errc::invalid,
        fmt::format("no law of kind \"{}\" matches \"{}\"; \"cordon conform --list\" shows all",
                    first, pattern));
  return candidates;
}

/// All components together.
struct Total {
  Index components = 0, hold = 0, violated = 0, died = 0;
  double seconds = 0;

  void add(const Conformed& c) {
    ++components;
    hold += c.count(State::passed);
    violated += c.count(State::failed);
    died += c.count(State::crashed) + c.count(State::timed_out) + (c.problem.empty() ? 0 : 1);
    seconds += c.seconds;
  }
  std::string text() const {
    return fmt::format("\n{} components: {} laws hold, {} violated, {} crashed or hung; {:.1f} s\n",
                       components, hold, violated, died, seconds);
  }
};

Exit conform(const Program& program, const ConformArguments& arguments) {
  if (arguments.list) return list_laws(arguments);
  if (arguments.plugin.empty())
    throw Error(Errc::invalid, "conform: PLUGIN is required; `cordon conform --help` tells more");
  require_laws(arguments.laws);
  const fs::path library = find_plugin(program, arguments.plugin);
  const Discovery found = discover(library, arguments.wanted);
  if (!found.problem.empty()) {
    complain(found.problem);
    return found.invalid ? Exit::invalid : Exit::plugin;
  }
  const std::vector<Candidate> candidates = with_laws(found.candidates, arguments.laws);
  std::vector<std::string> titles;
  for (const Candidate& candidate : candidates) titles.push_back(title_of(candidate));
  ProgressBar bar(titles, isatty(STDERR_FILENO) == 1);
  std::string text;
  Json components = Json::array();
  Exit exit = Exit::done;
  Total total;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    Conformed c{candidates[k], {}, 0};
    c.problem = problem_of_making(library, c.candidate);
    const ConformRequest request{library,
                                 c.candidate,
                                 {arguments.laws, arguments.seed, arguments.cases},
                                 arguments.timeout_s,
                                 replay_command(program, arguments, c.candidate),
                                 default_search_path(program.plugins)};
    const LawProgress progress = [&](std::size_t law, std::size_t laws) {
      bar.show(k, static_cast<std::int64_t>(law), static_cast<std::int64_t>(laws));
    };
    if (c.problem.empty())
      c.laws = arguments.in_process ? check_in_process(request, progress)
                                    : check_in_child(request, progress);
    for (const LawReport& report : c.laws) c.seconds += report.seconds;
    if (c.count(State::failed) > 0) exit = Exit::violated;
    const bool broken =
        !c.problem.empty() || c.count(State::crashed) + c.count(State::timed_out) > 0;
    if (broken && exit == Exit::done) exit = Exit::plugin;
    text += (text.empty() ? "" : "\n") + as_text(c, found.plugin);
    components.push_back(as_json(c));
    total.add(c);
  }
  bar.clear();
  const bool nothing_checked = exit == Exit::done && total.hold == 0;
  if (nothing_checked) exit = Exit::unanswered;
  if (total.components > 1) text += total.text();
  if (arguments.json) {
    const Json report{{"plugin", found.plugin},
                      {"version", found.version},
                      {"file", library.string()},
                      {"seed", arguments.seed},
                      {"cases", arguments.cases},
                      {"conforms", exit == Exit::done},
                      {"components", std::move(components)}};
    text = json_text(report);
  }
  print(text);
  if (nothing_checked) complain("nothing was checked: no case bore on any law, as told above");
  return exit;
}

/// The library that reads options takes negative numbers and too large ones modulo 2⁶⁴.
std::string no_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc() && rest == end) return "";
  return text + " must be a whole number from 0 to 18446744073709551615";
}

}  // namespace

CORDON_COMMAND(conform) {
  CLI::App* command = app.add_subcommand(
      "conform", "Check a plugin's components against the laws that every one of their kind keeps");
  const auto arguments = std::make_shared<ConformArguments>();
  command
      ->add_option("PLUGIN", arguments->plugin,
                   "File of a plugin, or the name of one on the search path")
      ->option_text(" ");
  command
      ->add_option("--kind", arguments->wanted.kind,
                   "Check components of this kind only: backend, observer, ...")
      ->option_text("KIND");
  command
      ->add_option("--component", arguments->wanted.component, "Check components of this name only")
      ->option_text("NAME");
  command
      ->add_option("--law", arguments->laws,
                   "Check the laws whose names match, such as 'soundness.*' [*]")
      ->option_text("GLOB");
  command->add_option("--seed", arguments->seed, "Of the random cases [1]")
      ->check(no_seed)
      ->option_text("N");
  command
      ->add_option("--cases", arguments->cases, "Cases per law; expensive laws take a share [80]")
      ->check(CLI::Range(Index{1}, Index{1'000'000}))
      ->option_text("N");
  command
      ->add_option("--params", arguments->wanted.params,
                   "Parameters of the components, as a JSON object [{}]")
      ->option_text("JSON");
  command->add_option("--timeout", arguments->timeout_s, "Seconds that one case may take [20]")
      ->check(CLI::Range(0.1, 86400.0))
      ->option_text("S");
  command->add_flag(
      "--in-process", arguments->in_process,
      "Check in this process, for debuggers: a crash ends it, and --timeout is not kept");
  command->add_flag("--list", arguments->list, "List the laws and check nothing");
  command->add_flag("--json", arguments->json, "Print JSON for programs");
  command->footer(
      "Laws run in child processes: a crash or a hang is reported with the law that was running; "
      "`gdb --args cordon conform\n"
      "PLUGIN --law LAW --in-process` shows where. A backend with a parameter\n"
      "\"rounding\" is checked with each of its values. Exit code 0: all laws hold; 4: one is "
      "violated; 3: the plugin was "
      "refused\n"
      "or crashed; 5: no case bore on any law.");
  command->callback([&program, arguments] { program.exit = conform(program, *arguments); });
}

}  // namespace cordon::apps
