// SPDX-License-Identifier: GPL-3.0-or-later
#include "identified_study.hpp"

#include <nlohmann/json.hpp>

#include "cordon/core/error.hpp"
#include "json_text.hpp"
#include "new_file.hpp"

namespace cordon::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double wider = 1 + 1e-6;  ///< than the factors found, which the solver rounds

Json list_of(VectorIn x) {
  Json list = Json::array();
  for (Index i = 0; i < x.size(); ++i) list.push_back(x[i]);
  return list;
}

bool is_box(const LineForm& set) {
  return set.generators() == set.dim() && Matrix(set.G.diagonal().asDiagonal()) == set.G;
}

Json set_of(const LineForm& set) {
  if (is_box(set)) {
    const Vector radius = set.G.diagonal().cwiseAbs();
    return {
        {"type", "box"}, {"lower", list_of(set.c - radius)}, {"upper", list_of(set.c + radius)}};
  }
  Json rows = Json::array();
  for (Index i = 0; i < set.dim(); ++i) rows.push_back(list_of(set.G.row(i).transpose()));
  return {{"type", "zonotope"}, {"center", list_of(set.c)}, {"generators", rows}};
}

}  // namespace

void require_writable(const Study& study) {
  if (study.continuous) {
    throw Error(Errc::invalid,
                "--write: the study is in continuous time, and the bounds found are those of the "
                "sampled model; scale its W and V by the factors yourself");
  }
  if (!study.source) throw Error(Errc::invalid, "--write: the study's text is not known");
}

void write_identified(const Study& study, const BoundFactors& factors, const std::string& remark,
                      const fs::path& file) {
  Json json = Json::parse(*study.source, nullptr, true, true);
  Json& system = json["system"];
  if (study.model.W.dim() > 0)
    system["W"] = set_of(with_factors(study.model.W, factors.disturbances * wider));
  if (study.model.V.dim() > 0)
    system["V"] = set_of(with_factors(study.model.V, factors.noises * wider));
  system["$comment"] = remark;
  if (const auto* csv = std::get_if<CsvSpec>(&study.data)) {
    const fs::path folder = fs::absolute(file).parent_path();
    json["data"]["csv"]["file"] = fs::proximate(fs::absolute(csv->file), folder).string();
  }
  write_new_file(file, json_text(json));
}

}  // namespace cordon::apps
