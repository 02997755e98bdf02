// SPDX-License-Identifier: GPL-3.0-or-later
// Gains as parameters of observers and of the bank: designers, matrices, and what is said of those
// that do not serve.
#include <doctest/doctest.h>

#include "diagnosis/banks.hpp"
#include "gains/interval_plants.hpp"

using namespace cordon;

namespace {

/// Answers with what it was made for.
class Fixed final : public GainDesigner {
 public:
  explicit Fixed(GainDesign answer) : answer_(std::move(answer)) {}

 private:
  GainDesign do_design(const Model&) const override { return answer_; }

  GainDesign answer_;
};

GainDesign matrix(const Matrix& L) { return {Answer::yes, {.name = "x", .type = "y", .L = L}}; }

void register_odd(Registrar& registrar) {
  const auto add = [&](const char* name, const GainDesign& answer) {
    registrar.add(GainEntry{{name, "a test", "", {}}, {}, [=](const Params&) {
                              return std::make_unique<Fixed>(answer);
                            }});
  };
  add("fixed", matrix(Matrix{{0}, {.9}}));
  add("of_wrong_shape", matrix(Matrix{{1}}));
  add("of_no_number", matrix(Matrix{{NAN}, {0}}));
  add("unstable", matrix(Matrix{{-5}, {0}}));
  add("unsure", {Answer::unknown, matrix(Matrix{{0}, {.5}}).gain, "no idea"});
  add("impossible", {Answer::no, {}, "there is none", "try something else"});
}

const Registry& registry() {
  static const Registry& instance = []() -> const Registry& {
    static Registry made;
    made.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    made.add(register_odd);
    return made;
  }();
  return instance;
}

Params designer(const std::string& type, Params params = {}) {
  return Params().set(
      "gain", std::make_shared<const ComponentSpec>(ComponentSpec{type, std::move(params)}));
}

std::vector<Diagnostic> problems(const Params& params,
                                 const Model& model = interval_plants::two_tanks()) {
  return registry().check<ObserverEntry>(
      "luenberger", {model, registry().make<BackendEntry>("zonotope", {})}, params);
}

std::shared_ptr<Observer> observer(const Params& params,
                                   const Model& model = interval_plants::two_tanks()) {
  return registry().make<ObserverEntry>(
      "luenberger", {model, registry().make<BackendEntry>("zonotope", {})}, params);
}

}  // namespace

TEST_CASE("an observer tells its gain, by whom and under which name") {
  for (const auto& [params, type] :
       {std::pair{Params(), "kalman"},
        {Params().set("gain", Matrix{{0}, {.9}}), "given"},
        {designer("peak"), "peak"},
        {designer("poles", Params().set("poles", Vector{{.5, .6}})), "poles"}}) {
    CHECK(problems(params).empty());
    const std::vector<Gain> gains = observer(params)->gains();
    REQUIRE(gains.size() == 1);
    CHECK(gains[0].name == "gain");
    CHECK(gains[0].type == type);
    CHECK(gains[0].L.rows() == 2);
    CHECK(gains[0].certificate.spectral_radius < 1);
    CHECK(gains[0].certificate.norm_upper > 0);
  }
  const Gain renamed = observer(designer("fixed"))->gains()[0];
  CHECK(renamed.name == "gain");
  CHECK(renamed.type == "fixed");
}

TEST_CASE("a designed gain is the one that is used") {
  Params peak = designer("peak", Params().set("theta", interval_plants::tank_theta()));
  const auto designed = observer(peak),
             given = observer(Params().set("gain", observer(peak)->gains()[0].L));
  for (Index k = 0; k < 5; ++k) {
    const Sample sample{k, Vector{{1}}, Vector{{.1 * static_cast<double>(k)}}};
    CHECK(designed->step(sample).set->line_form().c == given->step(sample).set->line_form().c);
  }
}

TEST_CASE("problems of a gain are told at their place") {
  const auto only = [](const Params& params, const std::string& pointer, const std::string& words,
                       const Model& model) {
    const auto found = problems(params, model);
    REQUIRE(found.size() == 1);
    CHECK(found[0].pointer == pointer);
    CHECK(found[0].message.find(words) != std::string::npos);
    CHECK_THROWS_AS(observer(params, model), InputError);
    return found[0].suggestion;
  };
  const Model tanks = interval_plants::two_tanks();
  only(designer("poles", Params().set("poles", Vector{{.5}})), "/gain/poles", "holds 1 number",
       tanks);
  only(designer("poles", Params().set("poles", Vector{{.5, .5}})), "/gain", "asked for 2 times",
       tanks);
  only(designer("given", Params().set("matrix", Matrix{{1, 0}})), "/gain",
       "is 1 × 2, must be 2 × 1", tanks);
  only(designer("given", Params().set("matrix", Matrix{{0}, {.9}}).set("other", true)),
       "/gain/other", "unknown", tanks);
  only(Params().set("gain", Matrix{{1, 0}}), "/gain", "is 1 × 2, must be 2 × 1", tanks);
  only(designer("peak"), "/gain", "column 2 of C is zero and A(1,2) < 0",
       interval_plants::three_states(-.1));
  only(designer("of_wrong_shape"), "/gain", "\"of_wrong_shape\" designed is 1 × 1, must be 2 × 1",
       tanks);
  only(designer("of_no_number"), "/gain", "no numbers", tanks);
  only(designer("unstable"), "/gain", "eigenvalue", tanks);
  CHECK(only(designer("unsure"), "/gain", "no idea", tanks).empty());
  CHECK(only(designer("impossible"), "/gain", "there is none", tanks) == "try something else");

  Model blind = tanks;
  blind.linear.A(0, 0) = 1.1;
  blind.linear.A(1, 0) = 0;
  only({}, "", "the mode 1.1 of A, along (1, 0)", blind);
  Model open = tanks;
  open.W = make_space(2);
  const auto both = problems({}, open);  // the backend holds no such W either
  REQUIRE(both.size() == 2);
  for (const Diagnostic& problem : both) CHECK(problem.message.find("W") != std::string::npos);
  CHECK(both[1].suggestion == "give \"gain\"");
}

TEST_CASE("a bank designs its gains for each mode, by default those of the steady Kalman filter") {
  const ModeBank modes = banks::reactor();
  Params common = banks::reactor_parameters(), listed, without, designed;
  for (const auto& [name, value] : common.values()) {
    if (name == "gain" || name == "error_set" || name == "strip_gain") continue;
    for (Params* params : {&listed, &without, &designed}) params->set(name, value);
  }
  std::vector<Matrix> gains;
  for (const Mode& mode : modes.modes)
    gains.push_back(registry().make<GainEntry>("kalman", {})->design(mode.model).gain.L);
  listed.set("gains", gains);
  designed.set("gain", std::make_shared<const ComponentSpec>(
                           ComponentSpec{"kalman", Params().set("steady", true)}));
  std::vector<std::shared_ptr<Diagnoser>> all;
  for (const Params& params : {listed, without, designed}) {
    all.push_back(registry().make<DiagnoserEntry>("observer_bank",
                                                  {modes, banks::backend("zonotope")}, params));
  }
  for (Index k = 0; k < 3; ++k) {
    const Sample sample{k, Vector{{10}}, Vector{{.01}}};
    const Diagnosis first = all[0]->step(sample);
    for (const std::size_t other : {1, 2}) {
      const Diagnosis same = all[other]->step(sample);
      for (std::size_t j = 0; j < first.modes.size(); ++j) {
        CHECK(same.modes[j].residual.lower == first.modes[j].residual.lower);
        CHECK(same.modes[j].residual.upper == first.modes[j].residual.upper);
      }
    }
  }
}

TEST_CASE("a bank names the modes whose gains do not serve") {
  ModeBank modes = banks::reactor();
  modes.modes[2].model.linear.C = Matrix{{0, 0}};
  modes.modes[2].model.linear.A(0, 0) = 1.5;
  modes.modes[2].model.linear.A(0, 1) = 0;
  const auto check = [&](Params params) {
    return registry().check<DiagnoserEntry>("observer_bank", {modes, banks::backend("zonotope")},
                                            params.set("waiting_time", std::int64_t{20}));
  };
  auto found = check({});
  REQUIRE(found.size() == 1);
  CHECK(found[0].pointer == "");
  CHECK(found[0].message.find("the mode 1.5") != std::string::npos);
  CHECK(found[0].message.find(modes.modes[2].name) != std::string::npos);
  const Matrix good{{.1582}, {11.6106}};
  found = check(Params().set("gains", std::vector<Matrix>{good, good, good}));
  REQUIRE(found.size() == 1);
  CHECK(found[0].pointer == "/gains/2");
  CHECK(found[0].message.find(modes.modes[2].name) != std::string::npos);
}
