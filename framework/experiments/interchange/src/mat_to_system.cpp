// SPDX-License-Identifier: GPL-3.0-or-later
#include "mat_to_system.hpp"

#include <algorithm>
#include <cmath>

#include "mat_labels.hpp"
#include "study/reading/read_sets.hpp"
#include "study/text/json_cursor.hpp"

namespace cordon::mat {

namespace {

using json::child;
using json::Json;
using json::Problems;

/// A key of a set: what it is called in a struct, and in a study.
struct SetKey {
  const char* field;
  const char* key;
  enum class Shape { vector, bounds, matrix, number } shape;
};
using Shape = SetKey::Shape;

constexpr SetKey set_keys[] = {
    {"c", "center", Shape::vector},     {"center", "center", Shape::vector},
    {"M", "lines", Shape::matrix},      {"lines", "lines", Shape::matrix},
    {"G", "generators", Shape::matrix}, {"generators", "generators", Shape::matrix},
    {"S", "S", Shape::matrix},          {"A", "A", Shape::matrix},
    {"b", "b", Shape::vector},          {"lower", "lower", Shape::bounds},
    {"upper", "upper", Shape::bounds},  {"rho", "rho", Shape::vector},
    {"d", "d", Shape::number},          {"sigma", "sigma", Shape::number},
    {"dim", "dim", Shape::number},      {"H", "H", Shape::matrix},
    {"h", "h", Shape::vector},          {"vertices", "vertices", Shape::matrix}};

struct SetKeys {
  const char* type;
  std::vector<std::string> keys;
};

const std::vector<std::string>& keys_of(const std::string& type) {
  static const std::vector<SetKeys> all{
      {"box", {"lower", "upper"}},
      {"zonotope", {"center", "generators"}},
      {"constrained_zonotope", {"center", "generators", "A", "b"}},
      {"line_zonotope", {"center", "lines", "generators", "S", "A", "b"}},
      {"strip", {"rho", "d", "sigma"}},
      {"space", {"dim"}},
      {"point", {"center"}},
      {"polytope", {"lower", "upper", "H", "h", "vertices"}}};
  static const std::vector<std::string> none;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const SetKeys& one) { return one.type == type; });
  return found == all.end() ? none : found->keys;
}

bool holds(const std::vector<std::string>& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool is_given(const Value* value) {
  return value && !(value->is(Value::Kind::numbers) &&
                    (value->numbers.rows() == 0 || value->numbers.cols() == 0));
}

/// Reports the first entry that is not finite, or NaN where infinite ones are allowed.
bool expect_numbers(const Value& value, bool infinite, const std::string& pointer,
                    Problems& problems) {
  if (!value.is(Value::Kind::numbers)) {
    problems.add(pointer, 0, kind_of(value) + ", must be a matrix of real numbers");
    return false;
  }
  const Matrix& A = value.numbers;
  if (A.rows() * std::max<Index>(A.cols(), 1) > json::max_entries || A.cols() > json::max_entries) {
    problems.add(pointer, 0, "has more than " + std::to_string(json::max_entries) + " entries");
    return false;
  }
  for (Index j = 0; j < A.cols(); ++j) {
    for (Index i = 0; i < A.rows(); ++i) {
      if (std::isnan(A(i, j)) || (!infinite && std::isinf(A(i, j)))) {
        const std::string what = std::isnan(A(i, j)) ? "NaN" : "Inf";
        problems.add(pointer, 0,
                     "holds " + what + " in row " + std::to_string(i + 1) + ", column " +
                         std::to_string(j + 1),
                     "a study holds finite numbers; only bounds of a box may be infinite");
        return false;
      }
    }
  }
  return true;
}

/// A row or a column.
Json vector_of(const Value& value, bool infinite, const std::string& pointer, Problems& problems) {
  Json list = Json::array();
  if (!expect_numbers(value, infinite, pointer, problems)) return list;
  const Matrix& x = value.numbers;
  if (x.rows() > 1 && x.cols() > 1) {
    problems.add(pointer, 0, "is " + json::shape(x.rows(), x.cols()) + ", must be a vector");
    return list;
  }
  for (Index i = 0; i < x.size(); ++i) list.push_back(json::to_json(x.data()[i]));
  return list;
}

Json matrix_of(const Value& value, const std::string& pointer, Problems& problems) {
  return expect_numbers(value, false, pointer, problems) ? json::to_json(value.numbers)
                                                         : Json::array();
}

Json key_of(const SetKey& key, const Value& value, const std::string& pointer, Problems& problems) {
  switch (key.shape) {
    case Shape::matrix:
      return matrix_of(value, pointer, problems);
    case Shape::vector:
    case Shape::bounds:
      return vector_of(value, key.shape == Shape::bounds, pointer, problems);
    case Shape::number:
      break;
  }
  if (!expect_numbers(value, false, pointer, problems)) return nullptr;
  if (value.numbers.size() == 1) return json::to_json(value.numbers(0, 0));
  problems.add(
      pointer, 0,
      "is " + json::shape(value.numbers.rows(), value.numbers.cols()) + ", must be a number");
  return nullptr;
}

/// The type that the fields of a set speak of, where it does not say so itself.
std::string type_by_fields(const Value& set, Index element) {
  const auto has = [&](const char* name) { return is_given(set.field(name, element)); };
  if (has("H") || has("vertices")) return "polytope";
  if (has("rho")) return "strip";
  if (has("c") || has("center")) {
    if (has("M") || has("lines")) return "line_zonotope";
    if (has("A")) return "constrained_zonotope";
    return has("G") || has("generators") ? "zonotope" : "point";
  }
  return "box";
}

class SystemReader {
 public:
  SystemReader(const Value& system, Index element, std::string pointer, Problems& problems)
      : system_(system), element_(element), pointer_(std::move(pointer)), problems_(problems) {}

  Json read();
  const std::vector<std::string>& known() const { return known_; }
  const Value* find(const char* name);
  std::string text_of(const char* name, const std::string& fallback);
  std::string place(const char* name) const { return child(pointer_, name); }

 private:
  void matrix(Json& out, const char* name);
  void interval(Json& out, const char* name, const std::string& radius);
  void set(Json& out, const char* name);
  bool is_all_zero(const std::string& name) const;

  const Value& system_;
  Index element_;
  std::string pointer_;
  Problems& problems_;
  std::vector<std::string> known_;
};

const Value* SystemReader::find(const char* name) {
  known_.emplace_back(name);
  return system_.field(name, element_);
}

std::string SystemReader::text_of(const char* name, const std::string& fallback) {
  const Value* value = find(name);
  if (!value || (value->is(Value::Kind::numbers) && value->numbers.size() == 0)) return fallback;
  if (value->is(Value::Kind::text)) return value->text;
  problems_.add(place(name), 0, kind_of(*value) + ", must be a text");
  return fallback;
}

/// [] is as good as absent; a matrix without columns is not: it says that there are none.
void SystemReader::matrix(Json& out, const char* name) {
  const Value* value = find(name);
  if (!value || (value->is(Value::Kind::numbers) && value->numbers.rows() == 0)) return;
  out[name] = matrix_of(*value, place(name), problems_);
}

void SystemReader::interval(Json& out, const char* name, const std::string& radius_name) {
  matrix(out, name);
  const Value* radius = find(radius_name.c_str());
  if (!is_given(radius) || !out.contains(name)) return;
  Json both{{"center", out[name]},
            {"radius", matrix_of(*radius, place(radius_name.c_str()), problems_)}};
  out[name] = std::move(both);
}

void SystemReader::set(Json& out, const char* name) {
  const Value* value = find(name);
  if (!value || (value->is(Value::Kind::numbers) && value->numbers.size() == 0)) return;
  out[name] = set_of(*value, 0, place(name), problems_);
}

Json SystemReader::read() {
  Json system;
  system["type"] = "";
  const Value* E = find("E");
  const bool intervals =
      is_given(find("A_radius")) || is_given(find("B_radius")) || is_given(find("C_radius"));
  system["type"] = text_of("type", is_given(E) ? "descriptor" : intervals ? "interval_lti" : "lti");
  matrix(system, "E");
  interval(system, "A", "A_radius");
  interval(system, "B", "B_radius");
  matrix(system, "Bw");
  interval(system, "C", "C_radius");
  matrix(system, "D");
  matrix(system, "Dv");
  for (const char* name : {"X0", "W", "V"}) set(system, name);
  for (const char* name : {"Ts", "dt"}) {
    const Value* time = find(name);
    if (!time || !time->is(Value::Kind::numbers) || time->numbers.size() != 1) continue;
    const double seconds = time->numbers(0, 0);
    if (seconds == 0)
      problems_.add(place(name), 0, "is 0: the system is one of continuous time",
                    "discretise it first, with c2d for example");
  }
  return system;
}

Index size_of(const Json& system, const char* key, bool columns) {
  if (!system.contains(key)) return 0;
  const Json& entry = system[key];
  const Json& rows = entry.is_object() ? entry["center"] : entry;
  if (!columns || rows.empty()) return static_cast<Index>(rows.size());
  return static_cast<Index>(rows[0].size());
}

/// Effectiveness: `size` numbers, or `size` rows [low high].
Json effectiveness_of(const Value& value, Index size, const std::string& pointer,
                      Problems& problems) {
  Json list = Json::array();
  if (!expect_numbers(value, false, pointer, problems)) return list;
  const Matrix& A = value.numbers;
  if (A.rows() == size && A.cols() == 2) {
    for (Index i = 0; i < size; ++i) {
      const Json low = json::to_json(A(i, 0)), high = json::to_json(A(i, 1));
      list.push_back(A(i, 0) == A(i, 1) ? low : Json{low, high});
    }
  } else if (A.size() == size && (A.rows() == 1 || A.cols() == 1)) {
    for (Index i = 0; i < size; ++i) list.push_back(json::to_json(A.data()[i]));
  } else {
    problems.add(pointer, 0, "is " + json::shape(A.rows(), A.cols()),
                 "give " + std::to_string(size) + " numbers, or as many rows [low high]");
  }
  return list;
}

Json mode_of(const Value& modes, Index j, const Json& nominal, const std::string& pointer,
             Problems& problems) {
  SystemReader reader(modes, j, pointer, problems);
  Json mode;
  mode["name"] = reader.text_of("name", "mode " + std::to_string(j + 1));
  const std::pair<const char*, Index> parts[] = {{"actuator", size_of(nominal, "B", true)},
                                                 {"sensor", size_of(nominal, "C", false)}};
  for (const auto& [name, size] : parts) {
    const Value* value = reader.find(name);
    if (is_given(value)) mode[name] = effectiveness_of(*value, size, reader.place(name), problems);
  }
  if (is_given(modes.field("A", j))) {
    mode["system"] = reader.read();
  } else {
    for (const char* name : {"W", "V"}) {
      const Value* value = reader.find(name);
      if (is_given(value)) mode[name] = set_of(*value, 0, reader.place(name), problems);
    }
  }
  return mode;
}

}  // namespace

std::string kind_of(const Value& value) {
  switch (value.kind) {
    case Value::Kind::numbers:
      return "is a matrix";
    case Value::Kind::text:
      return "is a text";
    case Value::Kind::cell:
      return "is a cell array";
    case Value::Kind::structs:
      return "is a struct";
    case Value::Kind::refused:
      break;
  }
  return "cannot be used: " + value.text;
}

bool is_system(const Value& value) {
  return value.rows * value.cols == 1 && value.field("A") && value.field("C");
}

bool is_set(const Value& value) {
  if (!value.is(Value::Kind::structs) || is_system(value)) return false;
  const auto has = [&](const char* name) { return holds(value.names, name); };
  return has("c") || has("center") || (has("lower") && has("upper")) || has("rho") ||
         has("vertices") || has("H") || (has("type") && has("dim"));
}

Json set_of(const Value& set, Index element, const std::string& pointer, Problems& problems) {
  Json out;
  if (!set.is(Value::Kind::structs)) {
    problems.add(pointer, 0, kind_of(set) + ", must be a struct with the fields of a set",
                 "struct('lower', [-1; -1], 'upper', [1; 1])");
    return out;
  }
  if (element >= set.rows * set.cols) {
    problems.add(pointer, 0, "is an empty struct array");
    return out;
  }
  const Value* type = set.field("type", element);
  if (type && !type->is(Value::Kind::text)) {
    problems.add(child(pointer, "type"), 0, kind_of(*type) + ", must be a text");
    return out;
  }
  const std::string name = type ? type->text : type_by_fields(set, element);
  const std::vector<std::string>& keys = keys_of(name);
  out["type"] = name;
  if (keys.empty()) {
    problems.add(child(pointer, "type"), 0, "no set " + json::in_quotes(name),
                 suggest(name, json::set_types()));
    return out;
  }
  // what a box or a space is besides, as a zonotope, follows from its bounds
  const bool has_more = name == "box" || name == "space";
  for (const SetKey& key : set_keys) {
    const Value* value = set.field(key.field, element);
    if (!is_given(value)) continue;
    if (holds(keys, key.key)) {
      out[key.key] = key_of(key, *value, child(pointer, key.field), problems);
    } else if (!has_more) {
      problems.add(child(pointer, key.field), 0,
                   "does not belong to a set of type " + json::in_quotes(name),
                   "change the type, or remove it");
    }
  }
  const Value* center = set.field("c", element);
  if (name == "space" && !out.contains("dim") && center) out["dim"] = center->numbers.size();
  if (holds(keys, "center") && !out.contains("center"))
    out["center"] = Json::array();  // of dimension 0
  return out;
}

Json system_of(const Value& value, std::vector<std::string>& ignored, Problems& problems) {
  SystemReader reader(value, 0, "", problems);
  Json system = reader.read();
  std::vector<std::string> known = reader.known();
  if (const Value* F = value.field("F"); F && is_given(F))
    system["F"] = matrix_of(*F, "/F", problems);
  if (const Value* U = value.field("U"); is_given(U)) system["U"] = set_of(*U, 0, "/U", problems);
  read_labels(value, system, problems);
  const std::string nominal = reader.text_of("nominal", "");
  if (!nominal.empty()) system["nominal"] = nominal;
  if (const Value* modes = value.field("modes"); is_given(modes)) {
    if (modes->is(Value::Kind::structs)) {
      system["modes"] = Json::array();
      for (Index j = 0; j < modes->rows * modes->cols; ++j) {
        system["modes"].push_back(
            mode_of(*modes, j, system, child("/modes", static_cast<std::size_t>(j)), problems));
      }
    } else {
      problems.add("/modes", 0, kind_of(*modes) + ", must be a struct array");
    }
  }
  known.insert(known.end(),
               {"F", "U", "nominal", "modes", "name", "title", "names", "sampling_time"});
  for (const std::string& name : value.names) {
    if (!holds(known, name)) ignored.push_back(name);
  }
  return system;
}

}  // namespace cordon::mat
