// SPDX-License-Identifier: GPL-3.0-or-later
// Three plants with gains, optima and hulls of observers that were found independently, with
// cvxopt, and hulls of exact sets. Gains under "given" are those of the CORA toolbox.
#pragma once

#include <fstream>

#include <nlohmann/json.hpp>

#include "published/comparison_models.hpp"

namespace gain_plants {

using namespace cordon;
using nlohmann::json;

struct Example {
  std::string name;
  Model model;
  std::vector<Sample> samples;
  json reference;
};

inline Matrix matrix(const json& rows) {
  Matrix M(static_cast<Index>(rows.size()), static_cast<Index>(rows.at(0).size()));
  for (Index i = 0; i < M.rows(); ++i) {
    for (Index j = 0; j < M.cols(); ++j)
      M(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }
  return M;
}

inline std::vector<Sample> samples_of(const json& plant) {
  const Matrix y = matrix(plant["y"]), u = matrix(plant["u"]);
  std::vector<Sample> all;
  for (Index k = 0; k < std::min(y.cols(), u.cols()); ++k) all.push_back({k, u.col(k), y.col(k)});
  return all;
}

inline const std::vector<Example>& plants() {
  static const std::vector<Example> all = [] {
    std::ifstream file(CORDON_SOURCE_DIR "/tests/published/data/gain_observers.json");
    const json read = json::parse(file);
    return std::vector<Example>{{"two_states", comparison::two_states(),
                                 comparison::samples("observer_2dim", 2), read["two_states"]},
                                {"vehicle", comparison::vehicle(),
                                 comparison::samples("observer_vehicle", 1), read["vehicle"]},
                                {"three_states", comparison::three_states(),
                                 samples_of(read["three_states"]), read["three_states"]}};
  }();
  return all;
}

inline const Plugins& plugins() {
  static const Plugins loaded;
  return loaded;
}

/// A gain as a component.
inline Params gain(const std::string& type, Params params = {}) {
  return Params().set(
      "gain", std::make_shared<const ComponentSpec>(ComponentSpec{type, std::move(params)}));
}
inline Params given(const Matrix& L) { return gain("given", Params().set("matrix", L)); }

inline Params unreduced(Params params) {
  return params.set("max_generators", std::int64_t{100'000});
}

inline std::vector<Box> hulls(const Example& plant, const std::string& observer, Params params,
                              const std::string& backend = "zonotope", Params sets = {}) {
  const auto made = plugins().observer(
      observer, plant.model, plugins().backend(backend, std::move(sets)), std::move(params));
  made->start();
  std::vector<Box> found;
  for (const Sample& sample : plant.samples)
    found.push_back(made->step(sample).set->interval_hull());
  return found;
}

/// The largest distance of the bounds of a hull from those expected, over the steps that are told.
inline double distance(const std::vector<Box>& found, const json& expected) {
  double most = 0;
  for (const auto& [k, bounds] : expected.items()) {
    const Box& hull = found.at(static_cast<std::size_t>(std::stoi(k)));
    const Matrix told = matrix(bounds);
    most = std::max(most, (hull.lower - told.row(0).transpose()).cwiseAbs().maxCoeff());
    most = std::max(most, (hull.upper - told.row(1).transpose()).cwiseAbs().maxCoeff());
  }
  return most;
}

inline double distance(const std::vector<Box>& X, const std::vector<Box>& Y) {
  double most = X.size() == Y.size() ? 0 : 1e300;
  for (std::size_t k = 0; k < std::min(X.size(), Y.size()); ++k) {
    most = std::max(most, (X[k].lower - Y[k].lower).cwiseAbs().maxCoeff());
    most = std::max(most, (X[k].upper - Y[k].upper).cwiseAbs().maxCoeff());
  }
  return most;
}

}  // namespace gain_plants
