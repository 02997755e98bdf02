// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <sstream>

#include "cordon/experiments/interchange.hpp"
#include "json_layout.hpp"
#include "study/reading/read_sets.hpp"
#include "study/text/json_cursor.hpp"
#include "write_files.hpp"

namespace cordon {

namespace {

namespace fs = std::filesystem;
using json::Cursor;
using json::Json;
using Kind = json::Value::Kind;

/// Lists of ranges, lists of values, texts: whatever looks like a matrix there is none.
const std::vector<std::string> no_matrices{"actuator", "sensor", "sweep", "$comment", "$schema"};

bool is_row(const json::Value& value) {
  const auto is_number = [](const json::Value& v) { return v.kind == Kind::number; };
  return value.kind == Kind::array &&
         std::all_of(value.items().begin(), value.items().end(), is_number);
}

bool is_dense_matrix(const json::Value& value) {
  const std::vector<json::Value>& rows = value.items();
  if (value.kind != Kind::array || rows.empty()) return false;
  return std::all_of(rows.begin(), rows.end(), [&](const json::Value& row) {
    return is_row(row) && row.items().size() == rows[0].items().size();
  });
}

std::vector<std::string> steps_of(const std::string& pointer) {
  std::vector<std::string> steps;
  std::istringstream stream(pointer);
  for (std::string step; std::getline(stream, step, '/');) steps.push_back(step);
  return steps;
}

class Rewriter {
 public:
  Rewriter(const Cursor& root, MatrixForm form) : form_(form) {
    const auto sweep = root.find("sweep");
    for (std::size_t i = 0; sweep && i < sweep->size(); ++i) {
      const auto path = sweep->item(i).find("path");
      const bool list = path && path->is(Kind::array);
      for (std::size_t j = 0; path && j < (list ? path->size() : 1); ++j) {
        const Cursor one = list ? path->item(j) : *path;
        if (one.is(Kind::text)) axes_.push_back(steps_of(one.value().text()));
      }
    }
  }

  Json rewrite(const Cursor& at) const {
    const bool matrix_here = json::is_sparse_matrix(at.value()) || is_dense_matrix(at.value());
    if (matrix_here && !is_swept(at.pointer())) {
      const auto A = json::read_matrix(at);
      return A ? matrix(*A) : Json();
    }
    return copy(at, true);
  }

 private:
  /// Does the path of an axis lead into the value at this place?
  bool is_swept(const std::string& pointer) const {
    const std::vector<std::string> place = steps_of(pointer);
    return std::any_of(axes_.begin(), axes_.end(), [&](const std::vector<std::string>& axis) {
      if (axis.size() <= place.size()) return false;
      return std::equal(place.begin(), place.end(), axis.begin(),
                        [](const std::string& step, const std::string& own) {
                          return own == "*" || own == step;
                        });
    });
  }

  Json matrix(const Matrix& A) const {
    Json dense = json::to_json(A);
    if (form_ == MatrixForm::dense && !(A.rows() == 0 && A.cols() > 0)) return dense;
    Json sparse = json::to_sparse(A);
    const bool shorter = sparse.dump().size() < dense.dump().size();
    return shorter || (A.rows() == 0 && A.cols() > 0) ? sparse : dense;
  }

  Json copy(const Cursor& at, bool matrices) const {
    const json::Value& value = at.value();
    Json out;
    switch (value.kind) {
      case Kind::boolean:
        return value.flag;
      case Kind::number:
        return json::to_json(value.number);
      case Kind::text:
        return value.text();
      case Kind::array:
        out = Json::array();
        for (std::size_t i = 0; i < at.size(); ++i)
          out.push_back(matrices ? rewrite(at.item(i)) : copy(at.item(i), false));
        return out;
      case Kind::object:
        out = Json::object();
        for (std::size_t i = 0; i < at.size(); ++i) {
          const std::string& key = value.keys()[i];
          const bool inside = matrices && std::find(no_matrices.begin(), no_matrices.end(), key) ==
                                              no_matrices.end();
          const Cursor member(value.items()[i], json::child(at.pointer(), key), at.problems());
          out[key] = inside ? rewrite(member) : copy(member, false);
        }
        return out;
      default:
        return out;
    }
  }

  MatrixForm form_;
  std::vector<std::vector<std::string>> axes_;
};

bool is_set(const json::Value& value) {
  const json::Value* type = value.find("type");
  const std::vector<std::string>& types = json::set_types();
  return type && type->kind == Kind::text &&
         std::find(types.begin(), types.end(), type->text()) != types.end();
}

JsonFile kind_of(const json::Value& root) {
  if (root.find("cordon_results") || root.find("cordon_run")) return JsonFile::results;
  if (root.find("cordon") || root.find("system")) return JsonFile::study;
  const bool list = root.kind == Kind::array && !root.items().empty() &&
                    std::all_of(root.items().begin(), root.items().end(), is_set);
  return list || is_set(root) ? JsonFile::sets : JsonFile::other;
}

}  // namespace

JsonFile json_file(const fs::path& file) {
  json::Problems problems;
  const json::Value tree = json::parse(json::read_file(file.string()), problems);
  if (problems.any()) throw InputError(file.string(), problems.sorted());
  return kind_of(tree);
}

void rewrite_matrices(const fs::path& file, const Target& target, MatrixForm form) {
  json::Problems problems;
  const json::Value tree = json::parse(json::read_file(file.string()), problems);
  const Cursor root(tree, "", problems);
  Json out;
  if (!problems.any()) {
    const JsonFile kind = kind_of(tree);
    if (kind != JsonFile::study && kind != JsonFile::sets)
      root.error("is neither a study nor a set nor a list of sets",
                 "a set is {\"type\": \"zonotope\", \"center\": [...], ...}");
    out = Rewriter(root, form).rewrite(root);
  }
  if (problems.any()) throw InputError(file.string(), problems.sorted());
  detail::write_files({{target.file, json::pretty(out)}}, target.replace);
}

}  // namespace cordon
