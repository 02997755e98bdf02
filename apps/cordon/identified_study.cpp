// SPDX-License-Identifier: GPL-3.0-or-later
#include "identified_study.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "cordon/core/error.hpp"
#include "json_text.hpp"
#include "model_json.hpp"
#include "new_file.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

constexpr double wider = 1 + 1e-6;  ///< than the factors found, which the solver rounds

bool has_varying_parameters(const Study& study) {
  const Json json = Json::parse(*study.source, nullptr, true, true);
  const Json& system = json["system"];
  if (!system.contains("parameters")) return false;
  return std::ranges::any_of(system["parameters"], [](const Json& parameter) {
    return parameter.is_object() && parameter.value("varying", false);
  });
}

}  // namespace

void require_writable(const Study& study) {
  if (study.continuous) {
    throw Error(Errc::invalid,
                "--write: the study is in continuous time, and the bounds found are those of the "
                "sampled model; scale its W and V by the factors yourself");
  }
  if (!study.source) throw Error(Errc::invalid, "--write: the study's text is not known");
  if (study.model.nonlinear && has_varying_parameters(study)) {
    throw Error(Errc::invalid,
                "--write: parameters that vary are coordinates of W or V, and their bounds stand "
                "elsewhere; scale W and V by the factors yourself");
  }
}

void write_identified(const Study& study, const BoundFactors& factors, const std::string& remark,
                      const std::filesystem::path& file) {
  Json json = Json::parse(*study.source, nullptr, true, true);
  Json& system = json["system"];
  if (study.model.W.dim() > 0)
    system["W"] = set_of(with_factors(study.model.W, factors.disturbances * wider));
  if (study.model.V.dim() > 0)
    system["V"] = set_of(with_factors(study.model.V, factors.noises * wider));
  system["$comment"] = remark;
  name_data_from(file, study, json);
  write_new_file(file, json_text(json));
}

}  // namespace cordon::apps
