// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/reading/sweep_path.hpp"

#include <algorithm>
#include <memory>

#include "study/reading/read_parts.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;

bool same_step(const PathStep& a, const PathStep& b) {
  if (a.every || b.every) return (a.every || step_index(a.key)) && (b.every || step_index(b.key));
  return a.key == b.key;
}

bool begins_with(const std::vector<PathStep>& all, const std::vector<PathStep>& first) {
  return first.size() <= all.size() &&
         std::equal(first.begin(), first.end(), all.begin(), same_step);
}

Value text_value(const std::string& text, int line) {
  const auto parts = std::make_shared<Parts>();
  parts->text = text;
  Value value;
  value.kind = Kind::text;
  value.line = line;
  value.parts = parts;
  return value;
}

Value empty_object(int line) {
  Value value;
  value.kind = Kind::object;
  value.line = line;
  value.parts = std::make_shared<Parts>();
  return value;
}

/// A value whose parts are copied when the first of them is exchanged.
class Draft {
 public:
  explicit Draft(const Value& value) : value_(value) {}

  void set(std::size_t i, Value item) { own().items[i] = std::move(item); }
  void append(const std::string& key, Value item) {
    own().keys.push_back(key);
    own().items.push_back(std::move(item));
  }
  /// Nothing if nothing was exchanged.
  std::optional<Value> changed() const {
    return parts_ ? std::optional<Value>(value_) : std::nullopt;
  }

 private:
  Parts& own() {
    if (!parts_) {
      parts_ = std::make_shared<Parts>(*value_.parts);
      value_.parts = parts_;
    }
    return *parts_;
  }

  Value value_;
  std::shared_ptr<Parts> parts_;
};

/// What the schema of a component says about a place: a component of a kind, perhaps one that may
/// be written as a matrix.
struct Role {
  std::string kind;         ///< empty: not a component
  std::string matrix_type;  ///< of a component that may be written as a matrix
};

class Placer {
 public:
  Placer(const SweepPath& path, const Value& value, const Registry& registry)
      : path_(path), value_(value), registry_(registry) {}

  Placement placed(const Value& tree) {
    Placement result;
    const std::optional<Value> changed = put(tree, 0, {}, false);
    result.tree = changed.value_or(tree);
    result.places = places_;
    result.reported = reported_;
    result.problem = problem_;
    result.suggestion = suggestion_;
    if (result.problem.empty() && places_ == 0 && !reported_) {
      const std::string& last = path_.steps.back().key;
      result.problem = lacking_.empty()
                           ? "matches nothing"
                           : "no component that it matches has the parameter " + in_quotes(last);
      result.suggestion = lacking_.empty() ? "" : suggest(last, lacking_);
    }
    return result;
  }

 private:
  const PathStep& step(std::size_t depth) const { return path_.steps[depth]; }
  bool is_last(std::size_t depth) const { return depth + 1 == path_.steps.size(); }

  std::string pointer(std::size_t depth) const {
    std::string text;
    for (std::size_t i = 0; i < depth; ++i) text = child(text, step(i).key);
    return text.empty() ? "the study" : text;
  }

  std::nullopt_t fail(std::string problem, std::string suggestion = "") {
    if (problem_.empty()) {
      problem_ = std::move(problem);
      suggestion_ = std::move(suggestion);
    }
    return std::nullopt;
  }

  /// A plant that is no component but formulas.
  static bool is_written_out(const Role& role, const Value& node) {
    const Value* type = role.kind == "plant" ? node.find("type") : nullptr;
    return type && type->kind == Kind::text && type->text() == "nonlinear";
  }

  /// What stands behind the step at `depth`, by the place alone: components of a study.
  Role role_by_place(std::size_t depth) const {
    const auto is = [&](std::size_t i, const char* key) { return step(i).key == key; };
    static const std::vector<std::string> parts{"backend", "observer", "diagnoser", "designer"};
    if (depth == 2 && is(0, "pipelines") &&
        std::find(parts.begin(), parts.end(), step(2).key) != parts.end())
      return {step(2).key, ""};
    if (depth == 1 && is(0, "metrics")) return {"metric", ""};
    if (depth == 1 && is(0, "system") && is(1, "plant")) return {"plant", ""};
    if (depth == 2 && is(0, "data") && is(1, "simulate") && is(2, "plant")) return {"plant", ""};
    return {};
  }

  /// The tree at `node` with the value in place; nothing if nothing was written below.
  std::optional<Value> put(const Value& node, std::size_t depth, const Role& role, bool starred) {
    if (depth == path_.steps.size()) {
      ++places_;
      return value_;
    }
    if (node.kind == Kind::broken) {
      reported_ = true;
      return std::nullopt;
    }
    if (!role.kind.empty() && !is_written_out(role, node) &&
        !(node.kind == Kind::array && (step(depth).every || step_index(step(depth).key))))
      return put_into_component(node, depth, role, starred);
    if (step(depth).every) return put_into_all(node, depth);
    if (node.kind == Kind::array) return put_into_array(node, depth, starred);
    if (node.kind == Kind::object)
      return put_into_object(node, depth, role_by_place(depth), starred);
    return fail(pointer(depth) + " is " + std::string(kind_name(node.kind)) + ", it has no " +
                in_quotes(step(depth).key));
  }

  std::optional<Value> put_into_all(const Value& node, std::size_t depth) {
    if (node.kind != Kind::array) {
      return fail(pointer(depth) + " is " + std::string(kind_name(node.kind)) +
                      ", \"*\" stands for the elements of a list",
                  node.kind == Kind::object ? suggest("", node.keys()) : "");
    }
    Draft draft(node);
    const Role role = role_by_place(depth);
    for (std::size_t i = 0; i < node.items().size(); ++i) {
      if (auto item = put(node.items()[i], depth + 1, role, true)) draft.set(i, std::move(*item));
    }
    return draft.changed();
  }

  std::optional<Value> put_into_array(const Value& node, std::size_t depth, bool starred) {
    const auto index = step_index(step(depth).key);
    if (!index || *index >= node.items().size()) {
      const std::string size = counted(static_cast<Index>(node.items().size()), "element");
      return fail(
          pointer(depth) + " is a list of " + size + ", it has no " + in_quotes(step(depth).key),
          "elements are counted from 0; \"*\" stands for all of them");
    }
    Draft draft(node);
    if (auto item = put(node.items()[*index], depth + 1, role_by_place(depth), starred))
      draft.set(*index, std::move(*item));
    return draft.changed();
  }

  std::optional<Value> put_into_object(const Value& node, std::size_t depth, const Role& role,
                                       bool starred) {
    const std::string& key = step(depth).key;
    if (is_sparse_matrix(node) && step_index(key)) {
      return fail(pointer(depth) + " is a sparse matrix, its entries have no places",
                  "write it as a list of rows, or sweep the whole matrix");
    }
    const auto found = std::find(node.keys().begin(), node.keys().end(), key);
    Draft draft(node);
    if (found != node.keys().end()) {
      const auto i = static_cast<std::size_t>(found - node.keys().begin());
      if (auto item = put(node.items()[i], depth + 1, role, starred))
        draft.set(i, std::move(*item));
    } else if (is_last(depth)) {
      ++places_;
      draft.append(key, value_);
    } else if (!starred) {
      fail(pointer(depth) + " has no " + in_quotes(key),
           nearest(key, node.keys()).empty() ? "" : suggest(key, node.keys()));
    }
    return draft.changed();
  }

  /// A component is an object with its type and parameters, its name alone, or a matrix.
  std::optional<Value> put_into_component(const Value& node, std::size_t depth, const Role& role,
                                          bool starred) {
    Draft object(empty_object(node.line));
    if (node.kind == Kind::text) object.append("type", node);
    if (node.kind == Kind::array && !role.matrix_type.empty()) {
      object.append("type", text_value(role.matrix_type, node.line));
      object.append("matrix", node);
    }
    const Value component = object.changed().value_or(node);
    if (component.kind != Kind::object || step(depth).every) {
      return fail(pointer(depth) + " is " +
                  std::string(step(depth).every ? "a component" : kind_name(component.kind)) +
                  ", it has no " + in_quotes(step(depth).key));
    }
    const std::string& key = step(depth).key;
    Role inner;
    if (key != "type") {
      const Value* type = component.find("type");
      const ComponentInfo* info =
          type && type->kind == Kind::text ? registry_.info(role.kind, type->text()) : nullptr;
      const ParamSpec* spec = info ? info->schema.find(key) : nullptr;
      if (!info) reported_ = true;
      if (info && !spec && starred) {
        for (const std::string& name : info->schema.names()) lacking_.push_back(name);
        return std::nullopt;
      }
      if (spec && is_kind(spec->component_kind)) inner = {spec->component_kind, spec->matrix_type};
    }
    return put_into_object(component, depth, inner, starred);
  }

  const SweepPath& path_;
  const Value& value_;
  const Registry& registry_;
  std::size_t places_ = 0;
  bool reported_ = false;
  std::string problem_, suggestion_;
  std::vector<std::string> lacking_;  ///< parameters of the components that were passed over
};

}  // namespace

std::optional<std::size_t> step_index(const std::string& key) {
  const bool digits =
      !key.empty() && key.size() < 10 && key.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || (key.size() > 1 && key[0] == '0')) return std::nullopt;
  return std::stoul(key);
}

std::optional<std::vector<PathStep>> path_steps(std::string_view text) {
  std::vector<PathStep> steps;
  if (text.empty() || text[0] != '/') return std::nullopt;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '/') {
      steps.emplace_back();
    } else if (text[i] != '~') {
      steps.back().key += text[i];
    } else if (i + 1 < text.size() && (text[i + 1] == '0' || text[i + 1] == '1')) {
      steps.back().key += text[++i] == '0' ? '~' : '/';
    } else {
      return std::nullopt;
    }
  }
  for (PathStep& step : steps) step.every = step.key == "*";
  return steps;
}

bool SweepPath::leads_to(std::string_view pointer) const {
  const auto other = path_steps(pointer);
  return other && begins_with(*other, steps);
}

bool SweepPath::ends_at(std::string_view pointer) const {
  const auto other = path_steps(pointer);
  return other && other->size() == steps.size() && begins_with(*other, steps);
}

bool SweepPath::meets(const SweepPath& other) const {
  return begins_with(steps, other.steps) || begins_with(other.steps, steps);
}

Placement place(const Value& tree, const SweepPath& path, const Value& value,
                const Registry& registry) {
  return Placer(path, value, registry).placed(tree);
}

}  // namespace cordon::json
