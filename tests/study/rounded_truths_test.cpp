// SPDX-License-Identifier: GPL-3.0-or-later
// Studies whose truth was lost by rounding alone: large terms that cancel in an observer's gain, in
// its inputs and outputs, or in the inverse of [E; C]; coordinates that are known exactly; a failed
// assumption that came later.
#include <string>

#include <doctest/doctest.h>

#include "run/program.hpp"

using test::Outcome;

namespace {

struct Case {
  const char *name, *study, *data;
};

const Case cases[] = {
    {"a box around a coordinate that is known exactly", R"({"cordon": 1, "system": {"type": "lti",
      "A": [[0.5, 0, 0], [0, 0.688, 0.58], [0, -0.58, 0.688]], "B": [[0.1, 0.7], [0, 0], [0, 0]],
      "C": [[1, 0, 0], [0, 1, 0]], "Bw": [[0, 0], [1, 0], [0, 1]],
      "X0": {"type": "box", "lower": [0, -1, -1], "upper": [0, 1, 1]},
      "W": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
      "V": {"type": "box", "lower": [0, -1], "upper": [0, 1]}},
     "data": {"simulate": {"steps": 6, "noise": "uniform", "input": [
      {"type": "table", "values": [-0.9, 0.9, 0.0, -0.3, 0.4, 0.0, 0.4]},
      {"type": "table", "values": [0.0, -0.06428571428571428, 0.7, -0.30714285714285716, 0.4,
        -0.22857142857142856, 0.5]}]}},
     "pipelines": [{"backend": "interval", "observer": {"type": "luenberger", "max_generators": 3,
      "gain": [[0.3, 0], [0, 0], [0, 0]]}}], "metrics": ["contains_truth"]})",
     ""},
    {"inputs and outputs of 1e9 that cancel in one step show in the next",
     R"({"cordon": 1, "system": {"type": "lti", "A": [[0.5, 0], [0.3, 0.5]],
      "B": [[0, 1], [0.3, 0]], "C": [[1, 0], [0, 1]],
      "X0": {"type": "box", "lower": [1000000000.865, 1], "upper": [1000000000.865, 1]},
      "W": {"type": "box", "lower": [0, 0], "upper": [0, 0]},
      "V": {"type": "box", "lower": [0, -1e-12], "upper": [0, 1e-12]},
      "U": {"type": "box", "lower": [-2e9, -2e9], "upper": [2e9, 2e9]},
      "modes": [{"name": "weak", "actuator": [0.5, 1]}]},
     "data": {"csv": {"file": "d.csv", "inputs": ["u0", "u1"], "outputs": ["y0", "y1"]}},
     "pipelines": [{"backend": {"type": "zonotope", "rounding": "nominal"}, "diagnoser":
      {"type": "observer_bank", "waiting_time": 3, "gain": [[0, 0], [0.3, 0]]}}]})",
     "u0,u1,y0,y1\n"
     "-1000000001.076,-500000000.0,1000000000.865,1.0\n"
     "0.4,0.0,0.4325000047683716,0.43670001029968264\n"
     "-0.8,0.0,0.2162500023841858,0.4681000065803528\n"
     "-0.1,0.0,0.1081250011920929,0.05892500400543212\n"
     "0.7,0.0,0.05406250059604645,0.031900002360343925\n"},
    {"an output that weighs one state by 1e-9",
     R"({"cordon": 1, "system": {"type": "descriptor", "E": [[1, 0, 0], [0, 1, 0], [0, 0, 0]],
      "A": [[-0.3, -0.5, 0], [0.3000000006, 0.5000000005, 0], [0.1, 0.2, 1.0]],
      "C": [[1, 1, 1e-09]], "Bw": [[], [], []],
      "X0": {"type": "box", "lower": [0.484, -0.484, -9e9], "upper": [0.484, -0.484, 9e9]},
      "V": {"type": "box", "lower": [-1e-20], "upper": [1e-20]}},
     "data": {"csv": {"file": "d.csv", "outputs": ["y"]}},
     "pipelines": [{"backend": {"type": "zonotope", "rounding": "nominal"},
      "observer": {"type": "descriptor"}}]})",
     "y\n4.84e-11\n5.8079977127556764e-11\n1.1615995447291345e-11\n2.3231990865542716e-12\n"},
    {"a gain of 4e8 for outputs that hardly differ",
     R"({"cordon": 1, "system": {"type": "lti", "A": [[0.5, 0.25], [0.25, 0.5]],
      "C": [[1, 1], [1, 1.0000000009313226]], "Bw": [[], []],
      "X0": {"type": "box", "lower": [0.046875, 0.265625], "upper": [0.046875, 0.265625]},
      "V": {"type": "box", "lower": [0, 0], "upper": [0, 0]}},
     "data": {"csv": {"file": "d.csv", "outputs": ["y0", "y1"]}},
     "pipelines": [{"name": "a", "backend": {"type": "zonotope", "rounding": "nominal"},
      "observer": {"type": "luenberger", "widening_limit": 2,
       "gain": [[-429496729.6, 429496729.6], [-429496729.6, 429496729.6]]}},
      {"name": "b", "backend": {"type": "zonotope", "rounding": "outward"},
      "observer": {"type": "luenberger",
       "gain": [[-429496729.6, 429496729.6], [-429496729.6, 429496729.6]]}}]})",
     "y0,y1\n0.3125,0.31250000024738256\n0.234375,0.23437500013460522\n"
     "0.17578125,0.17578125008822099\n0.1318359375,0.1318359375629825\n"},
    {"a fault that comes after the plant has left W by its rounding",
     R"({"cordon": 1, "system": {"type": "lti", "A": [[-0.3]], "B": [[1.2]], "C": [[-1.0], [0.6]],
      "D": [[0], [0]], "X0": {"type": "box", "lower": [-1.0], "upper": [1.0]},
      "W": {"type": "box", "lower": [-0.3], "upper": [0.3]},
      "V": {"type": "box", "lower": [0, -0.01], "upper": [0, 0.01]},
      "U": {"type": "box", "lower": [-3.0], "upper": [3.0]},
      "modes": [{"name": "m0", "sensor": [0, 0.5]}], "F": [[-1.2]]},
     "data": {"simulate": {"steps": 4, "seed": 40, "seeds": 1, "noise": "vertex",
      "input": [{"type": "square", "amplitude": 1.0, "period": 9}], "additive_faults":
       [{"fault": 1, "from": 4, "signal": {"type": "constant", "offset": 1}}]}},
     "pipelines": [{"backend": {"type": "constrained_zonotope", "rounding": "outward",
      "reduction": "combastel"}, "diagnoser": {"type": "consistency_bank", "waiting_time": 1,
       "observer": {"type": "prediction_correction", "max_generators": 8,
        "max_constraints": 30}}}], "metrics": ["contains_truth"]})",
     ""},
    {"a sensor in other units determines its state all the same",
     R"({"cordon": 1, "system": {"type": "descriptor", "E": [[1, 0], [0, 0]],
      "A": [[0.5, 0], [0, 1]], "C": [[0, 1e-13]], "Bw": [[1], [0]],
      "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
      "W": {"type": "box", "lower": [-0.1], "upper": [0.1]},
      "V": {"type": "box", "lower": [-1e-14], "upper": [1e-14]}},
     "data": {"simulate": {"steps": 5}},
     "pipelines": [{"backend": "zonotope", "observer": {"type": "descriptor"}}]})",
     ""},
    {"an optimal input without a margin leaves tubes that touch",
     R"({"cordon": 1, "system": {"type": "lti", "A": [[1]], "B": [[1]], "C": [[1]],
      "X0": {"type": "box", "lower": [0], "upper": [0]},
      "W": {"type": "box", "lower": [-0.125], "upper": [0.125]},
      "V": {"type": "box", "lower": [-0.125], "upper": [0.125]},
      "U": {"type": "box", "lower": [-1], "upper": [1]},
      "modes": [{"name": "weak", "actuator": [0.5]}]},
     "data": {"simulate": {"seed": 1, "noise": "uniform"}},
     "pipelines": [{"backend": "zonotope",
      "designer": {"type": "facets", "horizon": 1, "epsilon": 0}}]})",
     ""}};

}  // namespace

TEST_CASE("no truth is lost by rounding alone") {
  for (const Case& one : cases) {
    CAPTURE(one.name);
    const Scratch scratch;
    scratch.write("d.csv", one.data);
    const std::string study = scratch.write("s.json", one.study).string(),
                      out = (scratch.path() / "out").string();
    const Outcome ran =
        test::cordon_with("run --quiet --no-report --out " + out + " " + study + " 2>&1");
    CAPTURE(ran.out);
    CHECK(ran.code == 0);
    const Outcome verified = test::cordon_with("verify " + out + " 2>&1");
    CAPTURE(verified.out);
    CHECK((verified.code == 0 || verified.code == 5));
  }
}
