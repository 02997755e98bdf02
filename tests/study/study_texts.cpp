// SPDX-License-Identifier: GPL-3.0-or-later
// The studies, one member per line.
#include "study/study_texts.hpp"

namespace study_test {

const char* const valid_study = R"({
"cordon": 1,
"title": "a study",
"system": {
"type": "descriptor",
"E": [[1, 0], [0, 0]],
"A": [[0.5, 1], [0, 2]],
"B": [[1], [0]],
"Bw": [[1, 0, 0], [0, 1, 1]],
"C": [[1, 0]],
"D": [[0.25]],
"Dv": [[1]],
"X0": {"type": "zonotope", "center": [0, 1], "generators": [[1, 0.5], [0, 1]]},
"W": {"type": "box", "lower": [-1, -1, -1], "upper": [1, 1, 1]},
"V": {"type": "box", "lower": [-0.1], "upper": [0.1]}
},
"data": {
"simulate": {
"steps": 20,
"seed": 7,
"noise": "vertex",
"x0": [0.5, 0.25],
"input": [{"type": "sine", "amplitude": 1, "omega": 0.5}]
}
},
"pipelines": [
{
"name": "first",
"backend": {"type": "zonotope", "strip": "volume"},
"observer": {"type": "descriptor", "max_generators": 30}
},
{
"backend": "line_zonotope",
"observer": {"type": "descriptor", "initial_set": {"type": "space", "dim": 2}}
}
],
"metrics": ["radius", {"type": "quantile", "level": 0.5}]
}
)";

const char* const diagnosis_study = R"({
"cordon": 1,
"title": "a diagnosis",
"system": {
"type": "lti",
"A": [[0.5, 0.1], [0, 0.8]],
"B": [[1, 0], [0.5, 2]],
"C": [[1, 0]],
"D": [[0.25, 0]],
"X0": {"type": "box", "lower": [-2, -2], "upper": [2, 2]},
"U": {"type": "box", "lower": [-1, 0], "upper": [1, 3]},
"W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
"V": {"type": "box", "lower": [-0.3], "upper": [0.3]},
"nominal": "well",
"modes": [
{"name": "weak", "actuator": [0.3, [0.1, 0.7]]},
{"name": "deaf", "sensor": [0.5], "W": {"type": "point", "center": [0, 0.125]}, "V": {"type": "box", "lower": [-0.2], "upper": [0.2]}},
{"name": "leak", "additive": {"F": [[1], [0.5]], "Fy": [[0.1]], "f": {"type": "box", "lower": [0.2], "upper": [0.4]}}},
{"name": "other", "actuator": [[0.25, 0.5], 1], "system": {"type": "lti", "A": [[0.7, 0], [0, 0.8]], "B": [[1, 0], [0, 1]], "Bw": [[1], [1]], "C": [[0, 1]], "W": {"type": "point", "center": [0.5]}, "V": {"type": "point", "center": [0]}}}
]
},
"data": {
"simulate": {
"steps": 20,
"seeds": 3,
"x0": [0.5, 0.25],
"input": [{"type": "constant", "offset": 1}, {"type": "constant", "offset": 2}],
"faults": [
{"mode": "weak", "from": 3, "to": 5, "actuator": [0.3, [0.2, 0.5]]},
{"mode": "deaf", "from": 6, "to": 9},
{"name": "both", "from": 12, "actuator": [1, 0.9], "sensor": [[0.7, 0.8]]}
]
}
},
"pipelines": [
{
"backend": "zonotope",
"diagnoser": {"type": "observer_bank", "observer": {"type": "prediction_correction", "max_generators": 25}, "waiting_time": 12}
},
{
"backend": "line_zonotope",
"observer": "prediction_correction"
}
]
}
)";

const char* const uncertain_study = R"({
"cordon": 1,
"title": "an uncertain plant",
"system": {
"type": "interval_lti",
"A": {"center": [[0.5, 0.25], [0, 0.75]], "radius": [[0.125, 0], [0, 0.0625]]},
"B": {"lower": [[0.9], [1]], "upper": [[1.1], [1]]},
"C": [[1, 0], [0, 1]],
"F": [[1, 0.5], [0, 2]],
"X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
"W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
"V": {"type": "box", "lower": [-0.3, -0.3], "upper": [0.3, 0.3]}
},
"data": {
"simulate": {
"steps": 20,
"parameters": "varying",
"input": [{"type": "constant", "offset": 1}],
"additive_faults": [
{"fault": 2, "from": 3, "to": 9, "signal": {"type": "sine", "amplitude": 1, "omega": 0.5}},
{"fault": 1, "signal": {"type": "table", "values": [0, 0.5, 0]}}
]
}
},
"pipelines": [
{
"backend": "zonotope",
"observer": {"type": "luenberger", "gain": [[0.5, 0], [0, 0.25]]}
},
{
"backend": "interval",
"diagnoser": "fault_filter"
}
]
}
)";

const char* const design_study = R"({
"cordon": 1,
"title": "a design",
"system": {
"type": "descriptor",
"E": [[1, 0], [0, 0]],
"A": [[0.5, 1], [0, 2]],
"B": [[1], [0]],
"Bw": [[1, 0, 0], [0, 1, 1]],
"C": [[1, 0]],
"X0": {"type": "zonotope", "center": [0, 1], "generators": [[1, 0.5], [0, 1]]},
"U": {"type": "box", "lower": [-5], "upper": [5]},
"W": {"type": "box", "lower": [-1, -1, -1], "upper": [1, 1, 1]},
"V": {"type": "box", "lower": [-0.1], "upper": [0.1]},
"modes": [
{"name": "weak", "actuator": [0.5]},
{"name": "other", "system": {"type": "lti", "A": [[0.7, 0], [0, 0.8]], "B": [[1], [0]], "Bw": [[1], [1]], "C": [[0, 1]], "X0": {"type": "box", "lower": [-1, 0], "upper": [1, 2]}, "W": {"type": "point", "center": [0.5]}, "V": {"type": "point", "center": [0]}}}
]
},
"data": {
"simulate": {
"seed": 7,
"seeds": 20,
"noise": "vertex",
"x0": {"type": "box", "lower": [-0.5, 0.75], "upper": [0.5, 1.25]}
}
},
"pipelines": [
{
"name": "designed",
"backend": "line_zonotope",
"designer": {"type": "search", "horizon": 4, "input_set": {"type": "box", "lower": [-1], "upper": [1]}, "weights": [[1], [2]]},
"diagnoser": "committee"
},
{
"name": "by hand",
"backend": "line_zonotope",
"designer": {"type": "given", "u": [[1], [2], [-1]]}
}
]
}
)";

const char* const sweep_study = R"({
"cordon": 1,
"title": "a sweep",
"system": {
"type": "lti",
"A": [[0.5, 1], [0, 0.5]],
"B": [[1], [0]],
"C": [[1, 0]],
"X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
"W": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
"V": {"type": "box", "lower": [-0.1], "upper": [0.1]}
},
"data": {
"simulate": {
"steps": 20,
"x0": [0.5, 0.25],
"input": [{"type": "sine", "amplitude": 1, "omega": 0.5}]
}
},
"pipelines": [
{
"name": "first",
"backend": {"type": "zonotope", "strip": "volume"},
"observer": {"type": "prediction_correction", "max_generators": 30}
},
{
"backend": "interval",
"observer": "prediction_correction"
},
{
"backend": "line_zonotope",
"observer": {"type": "luenberger", "gain": [[0.5], [0.25]]}
}
],
"metrics": ["radius", {"type": "quantile", "level": 0.5}],
"sweep": [
{"name": "generators", "path": "/pipelines/*/observer/max_generators", "values": [10, 20, 40]},
{"name": "bound", "path": "/system/W/upper/0", "values": [1, 2.5]},
{"name": "seed", "path": "/data/simulate/seed", "range": [1, 9, 4]}
]
}
)";

}  // namespace study_test
