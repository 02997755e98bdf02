// SPDX-License-Identifier: GPL-3.0-or-later
#include "formula_study.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "campaigns/draw.hpp"

namespace cordon::campaigns {

namespace {

using Json = nlohmann::ordered_json;
using Strings = std::vector<std::string>;

std::string text(double x) {
  const std::string digits = std::to_string(std::round(1000 * x) / 1000);
  return x < 0 ? "(" + digits + ")" : digits;
}

class FormulaStudy {
 public:
  explicit FormulaStudy(std::uint64_t number)
      : draw_(0x9e3779b97f4a7c15 * (number + 1)), number_(number) {}

  Json make() {
    const auto count = [this](std::size_t most) { return 1 + draw_.place(most); };
    name("x", count(3), states_);
    name("w", draw_.one_in(5) ? 0 : count(2), disturbances_);
    name("v", draw_.one_in(8) ? 0 : count(2), noises_);
    name("u", draw_.one_in(2) ? 0 : 1, inputs_);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      units_.push_back(draw_.one_in(6) ? std::pow(10.0, static_cast<double>(draw_.place(9)) - 4)
                                       : 1.0);
    }
    Json study{{"cordon", 1}, {"title", "random formulas " + std::to_string(number_)}};
    study["system"] = system();
    study["data"]["simulate"] = data();
    study["pipelines"] = pipelines();
    study["metrics"] = {"contains_truth"};
    return study;
  }

 private:
  static void name(const char* letter, std::size_t count, Strings& names) {
    for (std::size_t i = 1; i <= count; ++i) names.push_back(letter + std::to_string(i));
  }

  /// A state in units of its own.
  std::string state() {
    const std::size_t i = draw_.place(states_.size());
    return units_[i] == 1 ? states_[i] : "(" + states_[i] + "/" + units_text(i) + ")";
  }
  std::string units_text(std::size_t i) const {
    return "1e" + std::to_string(static_cast<int>(std::lround(std::log10(units_[i]))));
  }

  /// A formula of the states and of these, of size about 1.
  std::string formula(int depth, const Strings& others) {
    if (depth == 0 || draw_.one_in(6)) {
      if (draw_.one_in(7)) return text(2 * draw_.uniform());
      if (!others.empty() && draw_.one_in(5)) return draw_.among(others);
      return draw_.one_in(12) ? "0.1*k" : state();
    }
    const std::string a = formula(depth - 1, others);
    switch (draw_.place(18)) {
      case 0:
      case 1:
        return "(" + a + " + " + formula(depth - 1, others) + ")";
      case 2:
        return "(" + a + " - " + formula(depth - 1, others) + ")";
      case 3:
      case 4:
        return a + "*" + formula(depth - 1, others);
      case 5:
        return a + "/(" + formula(depth - 1, others) + " + 3)";
      case 6:
        return a + "/(1 + (" + formula(depth - 1, others) + ")^2)";
      case 7:
        return "sqrt(abs(" + a + ") + " + text(std::abs(draw_.uniform())) + ")";
      case 8:
        return "sqrt(" + a + " + 1.5)";
      case 9:
        return "(" + a + ")^" + std::to_string(2 + draw_.place(2));
      case 10:
        return "max(" + a + ", " + formula(depth - 1, others) + ")";
      case 11:
        return "min(" + a + ", " + formula(depth - 1, others) + ")";
      case 12:
        return "log(2 + " + a + ")";
      case 13:
        return "exp(-abs(" + a + "))";
      case 14:
        return "tan(0.4*" + a + ")";
      default:
        return draw_.among({"sin", "cos", "atan", "abs"}) + "(" + a + ")";
    }
  }

  Strings with(const Strings& more) const {
    Strings all = inputs_;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  Json box(std::size_t dim, const std::vector<double>& radii, double center) const {
    Json lower = Json::array(), upper = Json::array();
    for (std::size_t i = 0; i < dim; ++i) {
      lower.push_back(center - radii[i]);
      upper.push_back(center + radii[i]);
    }
    return {{"type", "box"}, {"lower", lower}, {"upper", upper}};
  }

  std::vector<double> radii(std::size_t count) {
    static const double sizes[] = {0, 1e-9, 1e-3, 1e-2, 0.1};
    const double usual = sizes[draw_.place(5)];
    std::vector<double> all(count, usual);
    if (count > 1 && draw_.one_in(4)) all[draw_.place(count)] = 0;
    return all;
  }

  Json system() {
    Json system{{"type", "nonlinear"}, {"states", states_}};
    if (!inputs_.empty()) system["inputs"] = inputs_;
    if (!disturbances_.empty()) system["disturbances"] = disturbances_;
    if (!noises_.empty()) system["noises"] = noises_;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      std::string next = text(0.6 * draw_.uniform()) + "*" + state() + " + " +
                         text(0.3 * draw_.uniform()) + "*" + formula(3, with(disturbances_));
      if (!disturbances_.empty() && draw_.one_in(2)) next += " + " + draw_.among(disturbances_);
      system["f"].push_back(units_[i] == 1 ? next : units_text(i) + "*(" + next + ")");
    }
    for (std::size_t i = 0; i < 1 + draw_.place(2); ++i) {
      std::string output = draw_.one_in(3) ? state() : formula(2, with(noises_));
      if (!noises_.empty() && !draw_.one_in(4)) output += " + " + draw_.among(noises_);
      system["g"].push_back(output);
    }
    if (draw_.one_in(3)) system["domain"] = "assumed";
    system["X0"] = start();
    if (!disturbances_.empty()) {
      system["W"] = box(disturbances_.size(), radii(disturbances_.size()), 0);
    }
    if (!noises_.empty()) system["V"] = box(noises_.size(), radii(noises_.size()), 0);
    return system;
  }

  Json start() {
    Json center = Json::array(), radius = Json::array();
    const bool point = draw_.one_in(4);
    for (const double unit : units_) {
      center.push_back(unit * draw_.uniform());
      radius.push_back(point || draw_.one_in(8) ? 0 : unit * std::abs(draw_.uniform()) / 2);
    }
    Json set{{"type", "box"}};
    for (std::size_t i = 0; i < units_.size(); ++i) {
      set["lower"].push_back(center[i].get<double>() - radius[i].get<double>());
      set["upper"].push_back(center[i].get<double>() + radius[i].get<double>());
    }
    return set;
  }

  Json data() {
    Json spec{{"steps", 15},
              {"seed", number_ + 1},
              {"noise", draw_.among({"uniform", "vertex", "sine", "zero"})}};
    if (!inputs_.empty()) {
      spec["input"].push_back({{"type", "sine"}, {"amplitude", 1.0}, {"omega", 0.4}});
    }
    if (draw_.one_in(4)) spec["dropouts"] = {{{"probability", 0.3}}};
    return spec;
  }

  Json pipelines() {
    static const std::vector<std::pair<std::string, Strings>> backends{
        {"interval", {"natural", "interval", "mean_value", "first_order"}},
        {"zonotope", {"interval", "mean_value", "first_order", "dc", "lifted"}},
        {"constrained_zonotope", {"mean_value", "first_order", "dc", "lifted", "relaxation"}},
        {"line_zonotope", {"mean_value", "first_order", "relaxation"}}};
    Json list = Json::array();
    for (const auto& [type, methods] : backends) {
      for (const std::string& method : methods) {
        Json observer{{"type", "nonlinear"},
                      {"method", method},
                      {"max_generators", states_.size() + 4 + draw_.place(20)}};
        if (type == "constrained_zonotope" || type == "line_zonotope") {
          observer["max_constraints"] = 1 + draw_.place(8);
        }
        if (draw_.one_in(3)) observer["contraction"] = false;
        if (draw_.one_in(3) && method != "interval" && method != "natural")
          observer["box"] = false;
        else if (draw_.one_in(3) && method != "relaxation")
          observer["parts"] = 2 + draw_.place(6);
        add(list, type, draw_.one_in(2) ? "outward" : "nominal", observer);
      }
    }
    for (const char* variant : {"frad_a", "frad_b", "frad_c", "vol_min_a", "vol_min_b"}) {
      add(list, "zonotope", "nominal",
          {{"type", "nonlinear_strips"},
           {"variant", variant},
           {"max_generators", states_.size() + 4 + draw_.place(20)}});
    }
    return list;
  }

  void add(Json& list, const std::string& backend, const std::string& rounding,
           const Json& observer) {
    Json pipeline{{"name", std::to_string(list.size())}};
    pipeline["backend"] = {{"type", backend}, {"rounding", rounding}};
    if (backend != "interval" && draw_.one_in(3))
      pipeline["backend"]["reduction"] =
          draw_.among({"girard", "combastel", "pca", "qr", "yang_scott"});
    pipeline["observer"] = observer;
    list.push_back(pipeline);
  }

  Draw draw_;
  std::uint64_t number_;
  Strings states_, disturbances_, noises_, inputs_;
  std::vector<double> units_;
};

}  // namespace

Json formula_study(std::uint64_t number) { return FormulaStudy(number).make(); }

}  // namespace cordon::campaigns
