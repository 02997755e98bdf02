// SPDX-License-Identifier: GPL-3.0-or-later
#include "catalogue.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "descriptor.hpp"

namespace cordon {

std::string described(const ComponentEntry& entry) {
  return std::visit([](const auto& e) { return fmt::format("{} \"{}\"", e.kind, e.info.name); },
                    entry);
}

const ComponentInfo& info_of(const ComponentEntry& entry) {
  return std::visit([](const auto& e) -> const ComponentInfo& { return e.info; }, entry);
}

Params complete_params(const ComponentEntry& entry, Params params) {
  std::vector<Diagnostic> problems = info_of(entry).schema.complete(params);
  if (!problems.empty()) throw InputError(described(entry), std::move(problems));
  return params;
}

}  // namespace cordon

namespace cordon::registry {

namespace {

template <std::size_t... index>
std::vector<std::string> names_of_kinds(std::index_sequence<index...>) {
  return {std::string(std::variant_alternative_t<index, ComponentEntry>::kind)...};
}

/// Of one text that a component tells of itself: longer ones are damage.
constexpr std::size_t longest_text = 1'000'000;

/// The texts of a component, by what they are.
std::vector<std::pair<std::string_view, const std::string*>> texts_of(const ComponentInfo& info) {
  std::vector<std::pair<std::string_view, const std::string*>> texts{
      {"name", &info.name},
      {"summary", &info.summary},
      {"citation", &info.citation},
      {"text of details", &info.details}};
  for (const ParamSpec& spec : info.schema.specs()) {
    texts.emplace_back("name of a parameter", &spec.name);
    texts.emplace_back("documentation of a parameter", &spec.doc);
    for (const std::string& choice : spec.choices) texts.emplace_back("choice", &choice);
    texts.emplace_back("kind of a parameter", &spec.component_kind);
    texts.emplace_back("type of a parameter", &spec.matrix_type);
    texts.emplace_back("name of a parameter", &spec.at_most);
  }
  return texts;
}

/// What is wrong with the lengths of its texts; "" if nothing is.
std::string too_long(const ComponentEntry& entry) {
  for (const auto& [what, text] : texts_of(info_of(entry))) {
    if (text->size() > longest_text)
      return fmt::format("a {} has a {} of {} bytes", Catalogue::kinds()[entry.index()], what,
                         text->size());
  }
  return "";
}

void check_schema(const std::string& component, const ParamSchema& schema,
                  std::vector<std::string>& problems) {
  for (const ParamSpec& spec : schema.specs()) {
    if (!is_snake_case(spec.name))
      problems.push_back(
          fmt::format("parameter \"{}\" of {} is not in snake_case", spec.name, component));
    if (spec.doc.empty())
      problems.push_back(
          fmt::format("parameter \"{}\" of {} is not documented", spec.name, component));
  }
}

}  // namespace

const std::vector<std::string>& Catalogue::kinds() {
  static const std::vector<std::string> all =
      names_of_kinds(std::make_index_sequence<std::variant_size_v<ComponentEntry>>());
  return all;
}

const Shelf* Catalogue::shelf(std::string_view kind) const {
  const auto found = std::find(kinds().begin(), kinds().end(), kind);
  return found == kinds().end() ? nullptr
                                : &shelves_[static_cast<std::size_t>(found - kinds().begin())];
}

const Provided* Catalogue::find(std::string_view kind, std::string_view name) const {
  const Shelf* all = shelf(kind);
  const auto found = all ? all->find(name) : Shelf::const_iterator();
  return all && found != all->end() ? &found->second : nullptr;
}

void Catalogue::take(Catalogue&& other) {
  for (std::size_t i = 0; i < shelves_.size(); ++i) shelves_[i].merge(other.shelves_[i]);
}

void Catalogue::remove(std::string_view plugin) {
  for (Shelf& all : shelves_)
    std::erase_if(all, [&](const auto& item) { return item.second.plugin == plugin; });
}

void Batch::read_all() const noexcept {
  for (const Shelf& shelf : mine_.shelves()) {
    for (const auto& item : shelf) {
      const ComponentInfo copy = info_of(item.second.entry);
      for (const auto& [what, text] : texts_of(copy)) {
        if (text->size() > longest_text) std::abort();
      }
    }
  }
}

void Batch::add(ComponentEntry entry) {
  if (std::string problem = too_long(entry); !problem.empty()) {
    problems_.push_back(std::move(problem));
    return;
  }
  const std::string component = described(entry);
  const ComponentInfo& info = info_of(entry);
  const bool can_be_made =
      std::visit([](const auto& e) { return static_cast<bool>(e.create); }, entry);
  if (!is_snake_case(info.name)) problems_.push_back(component + " is not in snake_case");
  if (info.summary.empty()) problems_.push_back(component + " has no summary");
  check_schema(component, info.schema, problems_);
  if (!can_be_made) problems_.push_back(component + " has no function that makes it");
  Shelf& mine = mine_.shelf(entry);
  if (mine.count(info.name)) problems_.push_back(component + " is registered twice");
  const Shelf& known = known_.shelf(entry);
  if (const auto other = known.find(info.name); other != known.end()) {
    left_out_.push_back(component + " is there already, from " +
                        (other->second.plugin.empty() ? "this program itself"
                                                      : "plugin \"" + other->second.plugin + "\""));
    return;
  }
  components_.push_back(Catalogue::kinds()[entry.index()] + " " + info.name);
  std::string name = info.name;
  mine.emplace(std::move(name), Provided{std::move(entry), plugin_});
}

}  // namespace cordon::registry
