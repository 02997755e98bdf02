// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_check.hpp"

#include <algorithm>
#include <set>

namespace cordon::json {

namespace {

constexpr std::size_t most_values = 64;   // of one axis that are tried
constexpr std::size_t most_problems = 3;  // of one value that are told

/// The name of a pipeline is that under the first values, whatever its backend becomes later.
Value with_names(const Value& tree, const Value& first, const Study& study,
                 const Registry& registry) {
  Value named = tree;
  const auto& pipelines = first.find("pipelines")->items();
  for (std::size_t i = 0; i < pipelines.size(); ++i) {
    if (pipelines[i].find("name")) continue;
    const auto parts = std::make_shared<Parts>();
    parts->text = study.pipelines[i].name;
    Value name;
    name.kind = Value::Kind::text;
    name.line = pipelines[i].line;
    name.parts = parts;
    const SweepPath path{"", {{"pipelines"}, {std::to_string(i)}, {"name"}}};
    named = place(named, path, name, registry).tree;
  }
  return named;
}

class SweepChecker {
 public:
  SweepChecker(StudySource& source, const Registry& registry, bool checks, Problems& problems)
      : source_(source), registry_(registry), checks_(checks), problems_(problems) {}

  TreeReading read() {
    const std::vector<std::size_t> first(source_.sweep.size(), 0);
    Problems found;
    const Value tree = substituted(source_.tree, source_.sweep, first, registry_, found);
    TreeReading result = read_tree(tree, registry_, options(first), found);
    source_.system = result.known;
    const std::vector<Diagnostic> list = found.found();
    for (const Diagnostic& d : list) told_.emplace(d.pointer, d.message);
    for (const Diagnostic& d : result.refusals) told_.emplace(d.pointer, d.message);
    const bool good = !found.any() && result.refusals.empty();
    if (good) remember(first, result.study.pipelines.size());
    if (good && !source_.sweep.empty())
      source_.tree = with_names(source_.tree, tree, result.study, registry_);
    report_first(list, found);
    for (std::size_t axis = 0; axis < source_.sweep.size(); ++axis) try_values(axis, good);
    return result;
  }

  std::vector<Diagnostic>& refusals() { return refusals_; }

 private:
  TreeOptions options(const std::vector<std::size_t>& at) const {
    TreeOptions result{source_.file, source_.folder};
    result.checks = checks_;
    result.data = source_.data;
    result.asks = [this, at](std::size_t pipeline) {
      return !source_.is_known(registry_, pipeline, at);
    };
    result.known = source_.system;
    return result;
  }

  void remember(const std::vector<std::size_t>& at, std::size_t pipelines) const {
    for (std::size_t i = 0; i < pipelines; ++i) source_.remember(registry_, i, at);
  }

  /// The axis that leads to the place of a problem, if there is one.
  const WrittenAxis* axis_of(const Diagnostic& d) const {
    const auto leads = [&](const WrittenAxis& axis) { return axis.leads_to(d.pointer); };
    const auto found = std::find_if(source_.sweep.begin(), source_.sweep.end(), leads);
    return found == source_.sweep.end() ? nullptr : &*found;
  }

  /// Problems under the first values: of a path, of a value, of the first values together, or of
  /// the study itself.
  void report_first(const std::vector<Diagnostic>& list, const Problems& found) {
    std::set<std::string> as_written;
    const bool elsewhere =
        std::any_of(list.begin(), list.end(), [&](const Diagnostic& d) { return !axis_of(d); });
    if (elsewhere && !source_.sweep.empty()) {
      Problems own;
      TreeOptions plain = options({});
      plain.asks = nullptr;
      read_tree(source_.tree, registry_, plain, own);
      for (const Diagnostic& d : own.found()) as_written.insert(d.pointer + d.message);
    }
    for (const Diagnostic& d : list) {
      const WrittenAxis* axis = axis_of(d);
      if (!axis) {
        const bool of_values = !source_.sweep.empty() && !d.pointer.starts_with("/sweep/") &&
                               !as_written.count(d.pointer + d.message);
        problems_.add(
            of_values ? "/sweep" : d.pointer, of_values ? source_.tree.find("sweep")->line : d.line,
            of_values ? "with the first values, " + d.pointer + " " + d.message : d.message,
            d.suggestion);
      } else if (axis->ends_at(d.pointer) && found.is_unknown(d.pointer)) {
        tell(axis->pointer + "/path", axis->path_line, "leads to " + d.pointer + ": " + d.message,
             d.message, d.suggestion);
      } else {
        tell_value(*axis, 0, d);
      }
    }
  }

  /// False if a problem of this kind was told of the place before.
  bool tell(const std::string& pointer, int line, std::string message, const std::string& kind,
            const std::string& suggestion) {
    const bool fresh = of_values_.emplace(pointer, kind).second;
    if (fresh) problems_.add(pointer, line, std::move(message), suggestion);
    return fresh;
  }

  std::string value_pointer(const WrittenAxis& axis, std::size_t value) const {
    return axis.range ? axis.pointer + "/range" : child(axis.pointer + "/values", value);
  }

  /// Once, if "*" leads to the same problem in several places.
  bool tell_value(const WrittenAxis& axis, std::size_t value, const Diagnostic& d) {
    const std::string which =
        axis.range ? "the value " + canonical_text(axis.values[value]) + " " : "";
    const std::string text = axis.ends_at(d.pointer)
                                 ? d.message + " (at " + d.pointer + ")"
                                 : "makes " + d.pointer + " wrong: " + d.message;
    const std::string place = d.pointer.substr(
        d.pointer.rfind('/') + 1);  // "*" leads to the same one in several components
    return tell(value_pointer(axis, value), axis.values[value].line, which + text,
                place + which + d.message, d.suggestion);
  }

  void try_values(std::size_t index, bool good) {
    const WrittenAxis& axis = source_.sweep[index];
    const std::size_t size = axis.values.size(), tries = std::min(size, most_values);
    for (std::size_t i = 1; i < tries; ++i) {
      const std::size_t value = size <= most_values ? i : i * (size - 1) / (most_values - 1);
      std::vector<std::size_t> at(source_.sweep.size(), 0);
      at[index] = value;
      Problems found;
      TreeOptions how = options(at);
      how.checks = how.checks && good;
      const TreeReading reading = read_tree(
          substituted(source_.tree, source_.sweep, at, registry_, found), registry_, how, found);
      const bool refused = !reading.refusals.empty();
      if (!found.any() && !refused) remember(at, reading.study.pipelines.size());
      const auto known = [&](const Diagnostic& d) {
        const bool own_place = axis.leads_to(d.pointer) && !found.is_unknown(d.pointer);
        return !own_place && told_.count({d.pointer, d.message}) > 0;
      };
      std::size_t told = 0;
      for (const Diagnostic& d : found.found()) {
        if (told < most_problems && !known(d) && tell_value(axis, value, d)) ++told;
      }
      for (const Diagnostic& d : reading.refusals) {
        if (told_.emplace(d.pointer, d.message).second) refusals_.push_back(d);
      }
    }
  }

  StudySource& source_;
  const Registry& registry_;
  bool checks_;
  Problems& problems_;
  std::set<std::pair<std::string, std::string>>
      told_;  ///< under the first values: place and message
  std::set<std::pair<std::string, std::string>> of_values_;  ///< the same for values
  std::vector<Diagnostic> refusals_;
};

}  // namespace

TreeReading read_first_values(StudySource& source, const Registry& registry, bool checks,
                              Problems& problems) {
  SweepChecker checker(source, registry, checks, problems);
  TreeReading result = checker.read();
  result.refusals.insert(result.refusals.end(), checker.refusals().begin(),
                         checker.refusals().end());
  return result;
}

std::string overlapping_seeds(const Study& study, const std::vector<WrittenAxis>& axes) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  const bool all_seeds = std::any_of(study.pipelines.begin(), study.pipelines.end(),
                                     [](const PipelineSpec& spec) { return !spec.estimation(); });
  if (!simulate || simulate->seeds < 2 || !all_seeds) return "";
  for (const WrittenAxis& axis : axes) {
    if (!axis.repeat || axis.path_text() != "/data/simulate/seed") continue;
    std::vector<double> seeds;
    for (const Value& value : axis.values) seeds.push_back(value.number);
    std::sort(seeds.begin(), seeds.end());
    const auto next = std::adjacent_find(seeds.begin(), seeds.end(), [&](double a, double b) {
      return b - a < static_cast<double>(simulate->seeds);
    });
    if (next == seeds.end()) continue;
    const std::string count = std::to_string(simulate->seeds);
    return axis.pointer + ": with \"seeds\": " + count +
           " the repetitions share seeds, and statistics count these several times; " +
           "choose values that lie " + count + " apart: \"range\": [first, last, " + count + "]";
  }
  return "";
}

}  // namespace cordon::json
