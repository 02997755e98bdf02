// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_json.hpp"

#include <cmath>

#include "cordon/core/interval.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

bool is_box(const LineForm& set) {
  return set.constraints() == 0 && set.lines() == 0 && set.generators() == set.dim() &&
         Matrix(set.G.diagonal().asDiagonal()) == set.G;
}

}  // namespace

Json list_of(VectorIn x) {
  Json list = Json::array();
  for (Index i = 0; i < x.size(); ++i) list.push_back(x[i]);
  return list;
}

Json rows_of(MatrixIn A) {
  Json rows = Json::array();
  for (Index i = 0; i < A.rows(); ++i) rows.push_back(list_of(A.row(i).transpose()));
  return rows;
}

Json set_of(const LineForm& set) {
  if (is_box(set)) {
    Vector lower(set.dim()), upper(set.dim());
    for (Index i = 0; i < set.dim(); ++i) {
      const double radius = std::abs(set.G(i, i));
      lower[i] = directed::plus(set.c[i], -radius).lower;
      upper[i] = directed::plus(set.c[i], radius).upper;
    }
    return {{"type", "box"}, {"lower", list_of(lower)}, {"upper", list_of(upper)}};
  }
  Json json{{"type", "zonotope"}, {"center", list_of(set.c)}, {"generators", rows_of(set.G)}};
  if (set.constraints() > 0 || set.lines() > 0) {
    json["type"] = set.lines() > 0 ? "line_zonotope" : "constrained_zonotope";
    if (set.lines() > 0) json["lines"] = rows_of(set.M);
    if (set.lines() > 0 && set.constraints() > 0) json["S"] = rows_of(set.S);
    json["A"] = rows_of(set.A);
    json["b"] = list_of(set.b);
  }
  return json;
}

Json bounds_of(const Box& box) {
  const auto list = [](const Vector& bounds) {
    Json all = Json::array();
    for (const double x : bounds)
      all.push_back(std::isinf(x) ? Json(x > 0 ? "inf" : "-inf") : Json(x));
    return all;
  };
  return {{"lower", list(box.lower)}, {"upper", list(box.upper)}};
}

void name_data_from(const std::filesystem::path& file, const Study& study, Json& json) {
  const auto* csv = std::get_if<CsvSpec>(&study.data);
  if (!csv) return;
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  json["data"]["csv"]["file"] =
      std::filesystem::proximate(std::filesystem::absolute(csv->file), folder).string();
}

}  // namespace cordon::apps
