// SPDX-License-Identifier: GPL-3.0-or-later
#include "read_nonlinear.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "cordon/formulas/parse.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "formula_parameters.hpp"
#include "formula_sections.hpp"
#include "nonlinear_keys.hpp"
#include "study/reading/read_sets.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
using NameList = std::vector<std::string>;
constexpr std::size_t longest_name = 60;  // bytes
constexpr const char* box_form =
    "the set of all values it can take, for example {\"type\": \"box\", \"lower\": [...], "
    "\"upper\": [...]}";

class NonlinearReader {
 public:
  NonlinearReader(const Cursor& system, std::vector<std::string>& warnings)
      : system_(system), warnings_(warnings), before_(system.problems().met()) {}

  SystemPart read(const PlantReader& read_plant);

 private:
  void take(PlantSystem plant);
  void read_written();
  void read_variables(Symbol role);
  void take_name(const Cursor& at, const std::string& name, Symbol role);
  void take_ranges();
  void read_formulas(const char* key, std::size_t least, NameList& out);
  void compile();
  std::shared_ptr<const formulas::Function> function(std::vector<const Section*> sections,
                                                     Symbol noise);
  void parse(const Section& section, formulas::Graph& graph, std::vector<int>& nodes);
  formulas::Vocabulary vocabulary(const Section& section, formulas::Graph& graph) const;
  NameList variables_of(const Section& section) const;
  void report(const Cursor& at, const std::vector<formulas::FormulaError>& errors) const;
  void warn_of_unused(const formulas::Function& function, Symbol role);
  void read_sets();
  void read_set_of(const char* key, Symbol role, LineForm& out);
  void extend(const char* key, Symbol role, LineForm& set);
  void read_admissible();
  void name_labels();
  NameList& names(Symbol role) { return written_.names[static_cast<std::size_t>(role)]; }
  const NameList& names(Symbol role) const {
    return written_.names[static_cast<std::size_t>(role)];
  }
  using Ranges = std::vector<ParameterRange>;
  Ranges& ranges(Symbol role) { return ranges_[static_cast<std::size_t>(role)]; }
  const Ranges& ranges(Symbol role) const { return ranges_[static_cast<std::size_t>(role)]; }
  Index written(Symbol role) const { return static_cast<Index>(names(role).size()); }
  Index count(Symbol role) const { return written(role) + static_cast<Index>(ranges(role).size()); }

  const Cursor& system_;
  std::vector<std::string>& warnings_;
  std::size_t before_;
  SystemPart part_;
  WrittenFormulas written_;
  std::map<std::string, Symbol> known_;
  std::array<Ranges, 4> ranges_;  ///< of parameters that stand after the names of a list
  NonlinearModel model_;
};

/// Sizes and functions of a plant, whose variables are called x1, w1, u1, … in messages.
void NonlinearReader::take(PlantSystem plant) {
  written_.plant = std::move(plant.spec);
  if (!plant.f) return;
  names(Symbol::state).resize(as_size(plant.states()));
  names(Symbol::input).resize(as_size(plant.inputs));
  names(Symbol::disturbance).resize(as_size(plant.states()));
  names(Symbol::noise).resize(as_size(plant.outputs()));
  part_.sizes = {plant.states(), plant.inputs, plant.outputs(), 0};
  model_.inputs = plant.inputs;
  model_.f = std::move(plant.f);
  model_.g = std::move(plant.g);
}

void NonlinearReader::take_name(const Cursor& at, const std::string& name, Symbol role) {
  if (const std::string why = formulas::why_no_name(name); !why.empty()) {
    at.error(in_quotes(name) + " is no name for " +
                 symbol_words[static_cast<std::size_t>(role)].noun + ": " + why,
             "names are a letter, then letters, digits and _");
    return;
  }
  const auto [first, fresh] = known_.emplace(name, role);
  if (!fresh) {
    at.error("repeats the name " + in_quotes(name) + " of " +
                 symbol_words[static_cast<std::size_t>(first->second)].noun,
             "names are unique over all lists");
  }
}

void NonlinearReader::read_variables(Symbol role) {
  const SymbolWords& word = symbol_words[static_cast<std::size_t>(role)];
  const auto at = role == Symbol::state
                      ? system_.need("states", "the names of the states: [\"x1\", \"x2\"]")
                      : system_.find(word.key);
  if (!at || !at->expect(Kind::array, "a list of names: [\"x1\", \"x2\"]")) return;
  if (at->size() > static_cast<std::size_t>(max_dimension) ||
      (role == Symbol::state && at->size() == 0)) {
    at->error("has " + counted(static_cast<Index>(at->size()), "name") + ", must have " +
              (role == Symbol::state ? "1" : "0") + " to " + std::to_string(max_dimension));
    return;
  }
  for (std::size_t i = 0; i < at->size(); ++i) {
    const auto name = read_line(at->item(i), longest_name);
    if (name) take_name(at->item(i), *name, role);
    names(role).push_back(name.value_or(""));
  }
}

/// Parameters of which bounds are known: one that keeps its value is a state that does, one that
/// varies a disturbance of f, and a noise of g.
void NonlinearReader::take_ranges() {
  std::vector<std::string> shown = written_.g;
  shown.insert(shown.end(), written_.invariants.begin(), written_.invariants.end());
  ranges(Symbol::state) = constant_ranges(written_);
  ranges(Symbol::disturbance) = varying_ranges(written_, written_.f);
  ranges(Symbol::noise) = varying_ranges(written_, shown);
}

void NonlinearReader::read_formulas(const char* key, std::size_t least, NameList& out) {
  const auto at =
      least > 0 ? system_.need(key, key == std::string("f") ? section_f().form : section_g().form)
                : system_.find(key);
  if (!at || !at->expect(Kind::array, "a list of formulas, each a text")) return;
  if (at->size() < least || at->size() > static_cast<std::size_t>(max_dimension)) {
    at->error("has " + counted(static_cast<Index>(at->size()), "formula") + ", must have " +
              std::to_string(least) + " to " + std::to_string(max_dimension));
  }
  for (std::size_t i = 0; i < at->size(); ++i)
    out.push_back(read_text(at->item(i), formulas::longest_formula).value_or(""));
}

NameList NonlinearReader::variables_of(const Section& section) const {
  NameList all;
  for (const Symbol role : section.variables) {
    all.insert(all.end(), names(role).begin(), names(role).end());
    for (const ParameterRange& range : ranges(role)) all.push_back(range.name);
  }
  all.push_back("k");
  return all;
}

formulas::Vocabulary NonlinearReader::vocabulary(const Section& section,
                                                 formulas::Graph& graph) const {
  formulas::Vocabulary made;
  const NameList all = variables_of(section_f().key == section.key ? section_f() : section_g());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (known_.contains(all[i]) || all[i] == "k")
      made.known.emplace(all[i], graph.variable(static_cast<Index>(i)));
  }
  for (const auto& [name, value] : written_.parameters)
    made.known.emplace(name, graph.constant(value));
  for (const auto& [name, role] : known_) {
    const bool allowed = role == Symbol::parameter ||
                         std::ranges::find(section.variables, role) != section.variables.end();
    if (allowed) continue;
    made.known.erase(name);
    made.refused.emplace(name, std::string(symbol_words[static_cast<std::size_t>(role)].noun) +
                                   " cannot stand in " + section.key);
  }
  if (!section.uses_time) {
    made.known.erase("k");
    made.refused.emplace("k", std::string("the time cannot stand in ") + section.key);
  }
  return made;
}

void NonlinearReader::report(const Cursor& at,
                             const std::vector<formulas::FormulaError>& errors) const {
  for (const formulas::FormulaError& error : errors) {
    const std::string place =
        error.column > 0 ? "column " + std::to_string(error.column) + ": " : "";
    at.error(place + error.message, error.suggestion);
  }
}

void NonlinearReader::parse(const Section& section, formulas::Graph& graph,
                            std::vector<int>& nodes) {
  const auto at = system_.find(section.key);
  if (!at || !at->is(Kind::array)) return;
  const formulas::Vocabulary names = vocabulary(section, graph);
  for (std::size_t i = 0; i < at->size(); ++i) {
    const Cursor item = at->item(i);
    if (!item.is(Kind::text)) continue;
    const std::size_t length = item.value().text().size();
    if (length == 0 || length > formulas::longest_formula) continue;  // was reported
    std::vector<formulas::FormulaError> errors;
    try {
      const auto made = formulas::parse(item.value().text(), graph, names, errors);
      if (made) nodes.push_back(made->node());
    } catch (const Error& error) {
      errors.push_back({0, error.what(), ""});
    }
    report(item, errors);
  }
  if (section.key != section_f().key) return;
  for (Index i = written(Symbol::state); i < count(Symbol::state); ++i)
    nodes.push_back(graph.variable(i).node());
}

std::shared_ptr<const formulas::Function> NonlinearReader::function(
    std::vector<const Section*> sections, Symbol noise) {
  const auto graph = std::make_shared<formulas::Graph>(variables_of(*sections.front()));
  std::vector<int> nodes;
  for (const Section* section : sections) parse(*section, *graph, nodes);
  if (system_.problems().met() != before_) return nullptr;
  try {
    return std::make_shared<const formulas::Function>(graph, nodes,
                                                      count(Symbol::state) + count(noise), 2);
  } catch (const Error& error) {
    system_.find(sections.front()->key)->error(error.what(), "use simpler formulas");
    return nullptr;
  }
}

void NonlinearReader::warn_of_unused(const formulas::Function& function, Symbol role) {
  for (Index i = 0; i < written(role); ++i) {
    const Index variable = count(Symbol::state) + i;
    bool used = false;
    for (Index row = 0; row < function.rows(); ++row)
      used = used || function.depends_on(row, variable);
    if (used) continue;
    const SymbolWords& word = symbol_words[static_cast<std::size_t>(role)];
    warnings_.push_back(child(child(system_.pointer(), word.key), static_cast<std::size_t>(i)) +
                        ": " + in_quotes(names(role)[static_cast<std::size_t>(i)]) +
                        " stands in no formula");
  }
}

void NonlinearReader::compile() {
  const auto f = system_.find("f");
  if (f && f->is(Kind::array) && system_.find("states") &&
      f->size() != names(Symbol::state).size()) {
    f->error("has " + counted(static_cast<Index>(f->size()), "formula") + ", must have " +
                 std::to_string(written(Symbol::state)) + ", one per state",
             "");
  }
  model_.f = function({&section_f()}, Symbol::disturbance);
  model_.g = function({&section_g(), &section_h()}, Symbol::noise);
  if (!model_.f || !model_.g) return;
  model_.invariants = static_cast<Index>(written_.invariants.size());
  model_.inputs = count(Symbol::input);
  warn_of_unused(*model_.f, Symbol::disturbance);
  warn_of_unused(*model_.g, Symbol::noise);
}

/// By the parameters that stand after the names of this list.
void NonlinearReader::extend(const char* key, Symbol role, LineForm& set) {
  if (ranges(role).empty()) return;
  LineForm all = cartesian_product(set, box_of(ranges(role)));
  written_.sets.emplace(key, std::exchange(set, std::move(all)));
}

void NonlinearReader::read_set_of(const char* key, Symbol role, LineForm& out) {
  const SymbolWords& word = symbol_words[static_cast<std::size_t>(role)];
  if (!system_.find(key) && written(role) == 0 && !written_.plant) {
    out = make_point(Vector(0));
    extend(key, role, out);
    return;
  }
  const auto at = system_.need(key, box_form);
  auto X = at ? read_set(*at, warnings_) : std::nullopt;
  if (!X || (written_.plant && !model_.f)) return;
  if (X->dim() != written(role)) {
    at->error("has dimension " + std::to_string(X->dim()) + ", must have " +
              std::to_string(written(role)) + " like " +
              (written_.plant ? "the " + std::string(word.key) + " of " : "") +
              child(system_.pointer(), written_.plant ? "plant" : word.key));
    return;
  }
  out = std::move(*X);
  extend(key, role, out);
}

void NonlinearReader::read_sets() {
  read_set_of("X0", Symbol::state, part_.model.X0);
  read_set_of("W", Symbol::disturbance, part_.model.W);
  read_set_of("V", Symbol::noise, part_.model.V);
  part_.model.U = make_space(count(Symbol::input));
  if (system_.find("U")) read_set_of("U", Symbol::input, part_.model.U);
}

void NonlinearReader::read_admissible() {
  if (system_.find("admissible")) {
    LineForm set;
    read_set_of("admissible", Symbol::state, set);
    model_.admissible = std::move(set);
  }
  if (const auto at = system_.find("domain")) {
    const auto choice = read_choice(*at, {"refused", "assumed"});
    if (choice && *choice == "assumed") model_.undefined = formulas::Undefined::assumed;
  }
}

/// Names of the formulas, where the study does not call them otherwise.
void NonlinearReader::name_labels() {
  const auto name = [this](Labels::Names& labels, Symbol role) {
    if (!labels.empty()) return;
    labels.assign(names(role).begin(), names(role).end());
    for (const ParameterRange& range : ranges(role)) labels.push_back(range.name);
  };
  name(part_.labels.states, Symbol::state);
  name(part_.labels.inputs, Symbol::input);
  name(part_.labels.disturbances, Symbol::disturbance);
  name(part_.labels.noises, Symbol::noise);
}

/// What is written as formulas.
void NonlinearReader::read_written() {
  for (const Symbol role : {Symbol::state, Symbol::input, Symbol::disturbance, Symbol::noise})
    read_variables(role);
  read_parameters(
      system_,
      [this](const Cursor& at, const std::string& name) { take_name(at, name, Symbol::parameter); },
      written_);
  read_formulas("f", 1, written_.f);
  read_formulas("g", 1, written_.g);
  read_formulas("invariants", 0, written_.invariants);
  take_ranges();
  compile();
  Sizes& sizes = part_.sizes;
  if (system_.find("states")) sizes.states = count(Symbol::state);
  sizes.inputs = count(Symbol::input);
  if (!written_.g.empty()) sizes.outputs = static_cast<Index>(written_.g.size());
  sizes.faults = 0;
}

SystemPart NonlinearReader::read(const PlantReader& read_plant) {
  expect_nonlinear_keys(system_);
  const auto plant = system_.find("plant");
  plant ? take(read_plant(*plant).value_or(PlantSystem{})) : read_written();
  read_sets();
  read_admissible();
  const Sizes& sizes = part_.sizes;
  const bool known = !plant || model_.f;
  const auto of = [&](Symbol role) { return known ? std::optional(count(role)) : std::nullopt; };
  part_.labels = read_labels(system_, {sizes.states, sizes.inputs, sizes.outputs,
                                       of(Symbol::disturbance), of(Symbol::noise), 0});
  if (!plant) name_labels();
  part_.good = system_.problems().met() == before_ && model_.f && model_.g;
  model_.parameters = std::ssize(ranges(Symbol::state));
  if (part_.good) part_.model.nonlinear = std::make_shared<const NonlinearModel>(std::move(model_));
  part_.formulas = std::move(written_);
  read_modes(system_, part_, warnings_);
  return std::move(part_);
}

}  // namespace

SystemPart read_nonlinear(const Cursor& system, std::vector<std::string>& warnings,
                          const PlantReader& read_plant) {
  return NonlinearReader(system, warnings).read(read_plant);
}

}  // namespace cordon::json
