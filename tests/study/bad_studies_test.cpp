// SPDX-License-Identifier: GPL-3.0-or-later
// One mistake each in a study that is otherwise valid: exactly one problem is reported, at its
// place, with its reason and suggestion.
#include <algorithm>
#include <string>

#include <doctest/doctest.h>

#include "study/fakes.hpp"
#include "study/mistake.hpp"

using namespace study_test;

namespace {

const Mistake top_level[] = {
    {"\"cordon\": 1,\n", "", "/cordon", "is missing", "write \"cordon\": 1", 1},
    {"\"cordon\": 1", "\"cordon\": 2", "/cordon", "not known", "reads \"cordon\": 1"},
    {"\"cordon\": 1", "\"cordon\": \"1\"", "/cordon", "is a text, must be a number",
     "without quotes"},
    {"\"title\": \"a study\"", "\"titl\": \"a study\"", "/titl", "unknown key of a study",
     "did you mean \"title\"?"},
    {"\"title\": \"a study\"", "\"title\": \"\"", "/title", "empty text", ""},
    {"\"title\": \"a study\"", "\"title\": \"a\\u0000\"", "/title", "holds a NUL character", ""},
    {"\"title\": \"a study\"", "\"title\": \"a\\nb\"", "/title", "holds a control character",
     "in one line"},
    {"\"title\": \"a study\"", "\"title\": \"\\u001b[2J\"", "/title", "holds a control character",
     "in one line"},
    {"\"title\": \"a study\"", "\"title\": \"\\u001f\"", "/title", "holds a control character",
     "in one line"},
    {"\"title\": \"a study\"", "\"title\": \"\\u007f\"", "/title", "holds a control character",
     "in one line"},
    {"\"title\": \"a study\"", "\"title\": \"\\u0080\"", "/title", "holds a control character",
     "in one line"},
    {"\"title\": \"a study\"", "\"title\": \"\\u009f\"", "/title", "holds a control character",
     "in one line"},
    {"\"title\": \"a study\"", "\"plugins\": [\"nowhere\"]", "/plugins/0", "no such directory",
     "relative to the folder"},
    {"\"title\": \"a study\"", "\"plugins\": \"nowhere\"", "/plugins", "is a text, must be a list",
     "list of texts"},
    {"\"title\": \"a study\"", "\"figures\": []", "/figures", "unknown key of a study",
     "\"system\""},
    {"\"title\": \"a study\"", "\"a/b~c\": 0", "/a~1b~0c", "unknown key of a study", "\"system\""},
    {"\"title\": \"a study\"", "\"title\": \"x\", \"title\": \"y\"", "/title",
     "the key is repeated (first on line 3)", "remove one"},
};

const Mistake systems[] = {
    {"\"type\": \"descriptor\",\n\"E\"", "\"E\"", "/system/type", "is missing", "\"lti\"", 4},
    {"\"type\": \"descriptor\",\n", "\"type\": \"descripter\",\n", "/system/type",
     "unknown choice \"descripter\"", "did you mean \"descriptor\"?"},
    {"\"type\": \"descriptor\",\n", "\"type\": \"unlike\",\n", "/system/type", "unknown choice",
     "\"lti\", \"interval_lti\", \"descriptor\", \"nonlinear\""},
    {"\"type\": \"descriptor\",\n", "\"type\": \"interval_lti\",\n", "/system/E",
     "belongs to descriptor systems", "\"descriptor\"", 6},
    {"\"type\": \"descriptor\",\n", "\"type\": \"lti\",\n", "/system/E",
     "belongs to descriptor systems", "\"descriptor\"", 6},
    {"\"E\": [[1, 0], [0, 0]]", "\"E\": [[1, 0]]", "/system/E", "is 1 × 2, must be square", ""},
    {"\"E\": [[1, 0], [0, 0]]", "\"E\": [[1]]", "/system/E",
     "is 1 × 1, must have 2 rows like /system/A", ""},
    {"\"E\": [[1, 0], [0, 0]],\n", "", "/system/E", "is missing", "lti", 4},
    {"\"A\": [[0.5, 1], [0, 2]]", "\"A\": [[0.5, 1]]", "/system/A", "is 1 × 2, must be square", ""},
    {"\"A\": [[0.5, 1], [0, 2]]", "\"A\": [[0.5, 1], [0]]", "/system/A/1",
     "has 1 number, the first row has 2", "equal length"},
    {"\"A\": [[0.5, 1], [0, 2]]", "\"A\": [[0.5, \"1\"], [0, 2]]", "/system/A/0/1",
     "is a text, must be a number", "without quotes"},
    {"\"A\": [[0.5, 1], [0, 2]]", "\"A\": [[0.5, 1e999], [0, 2]]", "/system/A/0/1",
     "beyond the range of double", "1.8e308"},
    {"\"A\": [[0.5, 1], [0, 2]]", "\"A\": [[0.5, -Infinity], [0, 2]]", "/system/A/0/1",
     "Infinity is not a number", "finite"},
    {"\"A\": [[0.5, 1], [0, 2]]", "\"A\": [[0.5, NaN], [0, 2]]", "/system/A/0/1",
     "NaN is not a number", "finite"},
    {"\"A\": [[0.5, 1], [0, 2]]", "\"A\": [[0.5, null], [0, 2]]", "/system/A/0/1",
     "is null, must be a number", ""},
    {"\"A\": [[0.5, 1], [0, 2]]", "\"A\": []", "/system/A", "is 0 × 0, must have 1 to 1000 rows",
     ""},
    {"\"A\": [[0.5, 1], [0, 2]]", "\"A\": 3", "/system/A", "is a number, must be a list",
     "list of rows"},
    {"\"B\": [[1], [0]]", "\"B\": [[1], [0], [2]]", "/system/B",
     "is 3 × 1, must have 2 rows like /system/A", ""},
    {"\"B\": [[1], [0]]", "\"B\": [1, 0]", "/system/B/0", "is a number, must be a list",
     "list of rows"},
    {"\"Bw\": [[1, 0, 0], [0, 1, 1]],\n", "", "/system/W",
     "has dimension 3, must have 2 like the rows of /system/A (Bw is the identity", "", 13},
    {"\"C\": [[1, 0]]", "\"C\": [[1, 0, 1]]", "/system/C",
     "is 1 × 3, must have 2 columns like /system/A", ""},
    {"\"C\": [[1, 0]]", "\"C\": []", "/system/C", "is 0 × 0, must have 1 to 1000 rows",
     "at least one output"},
    {"\"C\": [[1, 0]],\n", "", "/system/C", "is missing", "y = C x", 4},
    {"\"D\": [[0.25]]", "\"D\": [[0.25, 1]]", "/system/D",
     "is 1 × 2, must have 1 column like /system/B", ""},
    {"\"Dv\": [[1]]", "\"Dv\": [[1], [1]]", "/system/Dv",
     "is 2 × 1, must have 1 row like /system/C", ""},
    {"\"Dv\": [[1]]", "\"F\": [[1]]", "/system/F", "is 1 × 1, must have 2 rows like /system/A", ""},
    {"\"Dv\": [[1]]", "\"G\": [[1]]", "/system/G", "unknown key of a system", "\"E\""},
};

const Mistake sets[] = {
    {"\"center\": [0, 1]", "\"center\": [0, 1, 2]", "/system/X0/generators",
     "is 2 × 2, must have 3 rows like /system/X0/center", "rows belong to states"},
    {"\"X0\": {\"type\": \"zonotope\"", "\"X0\": {\"type\": \"zonotop\"", "/system/X0/type",
     "unknown choice \"zonotop\"", "did you mean \"zonotope\"?"},
    {"\"X0\": {\"type\": \"zonotope\"", "\"X0\": {\"typ\": \"zonotope\"", "/system/X0/type",
     "is missing", "\"box\""},
    {"\"X0\": {\"type\": \"zonotope\"", "\"X0\": {\"lines\": [[1], [0]], \"type\": \"zonotope\"",
     "/system/X0/lines", "unknown key of a set of type \"zonotope\"", "\"generators\""},
    {"\"W\": {\"type\": \"box\", \"lower\": [-1, -1, -1], \"upper\": [1, 1, 1]},\n", "",
     "/system/W", "is missing", "box", 4},
    {"\"lower\": [-1, -1, -1], \"upper\": [1, 1, 1]", "\"lower\": [-1, -1], \"upper\": [1, 1]",
     "/system/W", "has dimension 2, must have 3 like the columns of /system/Bw", ""},
    {"\"lower\": [-1, -1, -1]", "\"lower\": [-1, -1]", "/system/W/upper",
     "has 3 numbers, must have 2 like /system/W/lower", ""},
    {"\"lower\": [-1, -1, -1]", "\"lower\": [-1, 2, -1]", "/system/W/lower/1", "the box is empty",
     "exchange"},
    {"\"lower\": [-1, -1, -1]", "\"lower\": [-1, \"-inf\", -1]", "/system/W/lower/1",
     "one side only", "free the coordinate on both sides"},
    {"\"upper\": [1, 1, 1]", "\"upper\": [1, 1, \"inf\"]", "/system/W/upper/2",
     "half-lines cannot be represented", "finite bound"},
    {"\"lower\": [-1, -1, -1]", "\"lower\": [-1, -1, \"inf\"]", "/system/W/lower/2",
     "cannot be \"inf\"", "\"-inf\""},
    {"\"upper\": [1, 1, 1]", "\"upper\": [\"-inf\", 1, 1]", "/system/W/upper/0",
     "cannot be \"-inf\"", "\"inf\""},
    {"\"upper\": [1, 1, 1]", "\"upper\": [\"one\", 1, 1]", "/system/W/upper/0",
     "is a text, must be a number", "or \"inf\""},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"strip\", \"rho\": [1], \"d\": 0, \"sigma\": -1}", "/system/V/sigma",
     "is negative", "at least 0"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"space\", \"dim\": 1}", "/data/simulate",
     "cannot be simulated: /system/V is unbounded", "csv", 18},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"space\", \"dim\": 1001}", "/system/V/dim", "is too large", "between 0 and 1000"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}", "[0.1]", "/system/V",
     "is a list, must be an object", "write a set"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"constrained_zonotope\", \"center\": [0], \"generators\": [[1]], \"A\": [[1]], "
     "\"b\": [2]}",
     "/system/V", "the set is empty", "check"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"constrained_zonotope\", \"center\": [0], \"generators\": [[1]], \"A\": [[1]]}",
     "/system/V/b", "is missing", "constraints"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"line_zonotope\", \"center\": [0], \"lines\": [[1]], \"S\": [[1, 2]], \"b\": "
     "[0]}",
     "/system/V/S", "is 1 × 2, must have 1 column like /system/V/lines", ""},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"polytope\", \"lower\": [0], \"upper\": [1], \"H\": [[-1]], \"h\": [-2]}",
     "/system/V", "the set is empty", "check"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"polytope\", \"lower\": [\"-inf\"], \"upper\": [\"inf\"], \"H\": [[-1]], \"h\": "
     "[-2]}",
     "/system/V/lower/0", "are finite", "give a box"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"polytope\", \"H\": [[1], [-1]], \"h\": [-2, 1]}", "/system/V",
     "the set is empty", "check"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"polytope\", \"H\": [[1]], \"h\": [2]}", "/system/V/H",
     "half-spaces cannot be represented", "give bounds"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"polytope\", \"H\": [[1], [-1]], \"h\": [2]}", "/system/V/H",
     "is 2 × 1, must have 1 row", "constraints"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"polytope\", \"H\": [[1], [-1]], \"h\": [2, 2], \"lower\": [0]}",
     "/system/V/upper", "is missing", "upper bounds"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"polytope\", \"vertices\": [[1], [2]], \"h\": [2]}", "/system/V/h",
     "cannot stand beside", "remove one"},
    {"{\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
     "{\"type\": \"polytope\", \"vertices\": []}", "/system/V/vertices", "has no vertices",
     "one vertex per row"},
};

const Mistake data[] = {
    {"\"simulate\": {", "\"simulated\": {", "/data/simulated", "unknown kind of data",
     "did you mean \"simulate\"?"},
    {"\"steps\": 20,\n", "", "/data/simulate/steps", "is missing", "number of steps", 18},
    {"\"steps\": 20", "\"steps\": 0", "/data/simulate/steps", "is too small", "between 1 and"},
    {"\"steps\": 20", "\"steps\": 20.5", "/data/simulate/steps", "must be an integer", "20 and 21"},
    {"\"steps\": 20", "\"steps\": 1e300", "/data/simulate/steps", "is too large", "1000000000"},
    {"\"steps\": 20", "\"steps\": true", "/data/simulate/steps",
     "is true or false, must be a number", ""},
    {"\"seed\": 7", "\"seed\": -7", "/data/simulate/seed", "is too small",
     "between 0 and 9007199254740992"},
    {"\"noise\": \"vertex\"", "\"noise\": \"vertices\"", "/data/simulate/noise", "unknown choice",
     "\"vertex\""},
    {"\"noise\": \"vertex\"", "\"fault\": []", "/data/simulate/fault",
     "unknown key of simulated data", "did you mean \"faults\"?"},
    {"\"x0\": [0.5, 0.25]", "\"x0\": [9, 0.25]", "/data/simulate/x0", "lies outside X0",
     "widen that set"},
    {"\"x0\": [0.5, 0.25]", "\"x0\": [0.5]", "/data/simulate/x0",
     "has 1 number, must have 2 like the rows of /system/A", ""},
    {",\n\"input\": [{\"type\": \"sine\", \"amplitude\": 1, \"omega\": 0.5}]", "",
     "/data/simulate/input", "is missing", "1 signal", 18},
    {"\"input\": [{\"type\": \"sine\", \"amplitude\": 1, \"omega\": 0.5}]", "\"input\": []",
     "/data/simulate/input", "has 0 signals, must have 1", ""},
    {"\"type\": \"sine\"", "\"type\": \"sines\"", "/data/simulate/input/0/type", "unknown choice",
     "did you mean \"sine\"?"},
    {", \"omega\": 0.5", "", "/data/simulate/input/0/omega", "is missing",
     "signal of type \"sine\"", 23},
    {"\"omega\": 0.5", "\"omega\": 0.5, \"period\": 2", "/data/simulate/input/0/period",
     "unknown key of a signal of type \"sine\"", "\"phase\""},
    {"{\"type\": \"sine\", \"amplitude\": 1, \"omega\": 0.5}",
     "{\"type\": \"table\", \"values\": []}", "/data/simulate/input/0/values", "is an empty list",
     "at least one"},
    {"{\"type\": \"sine\", \"amplitude\": 1, \"omega\": 0.5}",
     "{\"type\": \"square\", \"amplitude\": 1, \"period\": 0}", "/data/simulate/input/0/period",
     "is too small", "between 1"},
    {"\"x0\": [0.5, 0.25]", "\"x0\": [[0.5, 0.25]]", "/data/simulate/x0/0",
     "is a list, must be a number", ""},
};

const Mistake components[] = {
    {"\"type\": \"zonotope\", \"strip\"", "\"type\": \"zonotopes\", \"strip\"",
     "/pipelines/0/backend/type", "no backend \"zonotopes\"", "did you mean \"zonotope\"?"},
    {"\"type\": \"zonotope\", \"strip\"", "\"type\": \"octagon\", \"strip\"",
     "/pipelines/0/backend/type", "no backend \"octagon\"", "cordon doctor"},
    {"\"backend\": \"line_zonotope\"", "\"backend\": \"line_zonotop\"", "/pipelines/1/backend",
     "no backend \"line_zonotop\"", "did you mean \"line_zonotope\"?"},
    {"\"backend\": \"line_zonotope\"", "\"backend\": 3", "/pipelines/1/backend",
     "is a number, must be a text or an object", "name of a backend"},
    {"\"backend\": \"line_zonotope\",\n", "", "/pipelines/1/backend", "is missing", "type", 32},
    {"\"max_generators\": 30", "\"max_generatrs\": 30", "/pipelines/0/observer/max_generatrs",
     "unknown parameter of observer \"descriptor\"", "did you mean \"max_generators\"?"},
    {"\"max_generators\": 30", "\"max_generators\": 0", "/pipelines/0/observer/max_generators",
     "is too small", "between 1 and 100000"},
    {"\"max_generators\": 30", "\"max_generators\": 1.5", "/pipelines/0/observer/max_generators",
     "must be an integer", "1 and 2"},
    {"\"max_generators\": 30", "\"static_at_start\": 1", "/pipelines/0/observer/static_at_start",
     "is a number, must be true or false", "true or false"},
    {"\"strip\": \"volume\"", "\"strip\": \"volum\"", "/pipelines/0/backend/strip",
     "unknown choice \"volum\"", "did you mean \"volume\"?"},
    {"\"dim\": 2", "\"dim\": 3", "/pipelines/1/observer/initial_set", "has the wrong dimension",
     "number of states"},
    {"\"max_generators\": 30",
     "\"initial_set\": {\"type\": \"box\", \"lower\": [0, \"-inf\"], \"upper\": [1, \"inf\"]}",
     "/pipelines/0/observer/initial_set", "is unbounded", "line_zonotope"},
    {"\"max_generators\": 30",
     "\"admissible_set\": {\"type\": \"box\", \"lower\": [0, 3], \"upper\": [1, 2]}",
     "/pipelines/0/observer/admissible_set/lower/1", "the box is empty", "exchange"},
    {"\"type\": \"descriptor\", \"max_generators\": 30", "\"type\": \"all_kinds\"",
     "/pipelines/0/observer/gain", "is missing", "a matrix"},
    {"\"type\": \"descriptor\", \"max_generators\": 30", "\"type\": \"all_kinds\", \"gain\": [1]",
     "/pipelines/0/observer/gain/0", "must be a list", "list of rows"},
    {"\"type\": \"descriptor\", \"max_generators\": 30",
     "\"type\": \"all_kinds\", \"gain\": [[1]], \"weight\": 2", "/pipelines/0/observer/weight",
     "is 2, must lie in [0, 1]", ""},
    {"\"name\": \"first\"", "\"name\": \"line_zonotope\"", "/pipelines/1",
     "has the same name as /pipelines/0", "give it a \"name\"", 32},
    {"\"name\": \"first\"", "\"name\": \"\"", "/pipelines/0/name", "is an empty text", ""},
    {"\"name\": \"first\"", "\"diagnosers\": {}", "/pipelines/0/diagnosers",
     "unknown key of a pipeline", "did you mean \"diagnoser\"?"},
    {"\"name\": \"first\"", "\"diagnoser\": {}", "/pipelines/0",
     "holds both \"observer\" and \"diagnoser\"", "remove one of the two", 27},
    {",\n\"observer\": {\"type\": \"descriptor\", \"max_generators\": 30}", "", "/pipelines/0",
     "holds neither \"observer\" nor \"diagnoser\"", "name the algorithm", 27},
    {"\"radius\"", "\"radus\"", "/metrics/0", "no metric \"radus\"", "did you mean \"radius\"?"},
    {"\"radius\"", "\"quantile\"", "/metrics/0/level", "is missing", "between 0 and 1"},
    {"\"radius\"", "\"radius\", \"radius\"", "/metrics/1", "repeats /metrics/0", "remove one"},
    {"\"level\": 0.5", "\"level\": 1.5", "/metrics/1/level", "is 1.5, must lie in [0, 1]", ""},
    {"\"level\": 0.5", "\"level\": 0.75", "/metrics/1/level", "is not known of 2 states",
     "give another one"},
    {"\"metrics\": [", "\"metrics\": \"all\", \"$comment\": [", "/metrics",
     "is a text, must be a list", "list of metrics"},
};

const Mistake syntax[] = {
    {"\"C\": [[1, 0]],", "\"C\": [[1, 0]]", "/system/C", "\",\" or \"}\" is missing, found a text",
     "", 11},
    {"\"C\": [[1, 0]]", "\"C\": [[1, 0,]]", "/system/C/0/2",
     "column 13: a value is missing, found \"]\"", "remove the comma"},
    {"\"C\": [[1, 0]]", "\"C\": [[1, .5]]", "/system/C/0/1",
     "column 11: a number cannot begin with", "0.5"},
    {"\"level\": 0.5", "\"level\": 0,5", "/metrics/1/level", "a key is missing, found \"5\"",
     "a decimal comma"},
    {"\"C\": [[1, 0]]", "\"C\": [[1, \u22120]]", "/system/C/0/1", "a value is missing",
     "write the minus sign as -"},
    {"\"C\": [[1, 0]]", "\"C\": [[1, 0.]]", "/system/C/0/1",
     "a digit is missing after the decimal point", ""},
    {"\"C\": [[1, 0]]", "\"C\": [[1,05, 0]]", "/system/C/0/1", "superfluous 0", "a decimal comma"},
    {"\"C\": [[1, 0]]", "\"C\": [[1, 00]]", "/system/C/0/1", "superfluous 0", "07"},
    {"\"C\": [[1, 0]]", "\"C\": [[1, True]]", "/system/C/0/1", "unknown word \"True\"",
     "true, false and null"},
    {"\"C\": [[1, 0]]", "\"C\": [[1, 'a']]", "/system/C/0/1", "texts are written in double quotes",
     ""},
    {"\"C\": [[1, 0]]", "\"C\": [[1, 0]] // the first state", "/system/C",
     "comments are not part of JSON", "$comment"},
    {"\"C\": [[1, 0]]", "C: [[1, 0]]", "/system/Bw",
     "a key in double quotes is missing, found \"C\"", "keys are texts"},
    {"\"C\": [[1, 0]]", "\"C\" [[1, 0]]", "/system/C", "a colon is missing after the key \"C\"",
     ""},
    {"\"a study\"", "\"a study", "/title", "column 10: a text without its closing quote", "\\n"},
    {"\"a study\"", "\"a \\study\"", "/title", "unknown escape sequence", "backslash"},
    {"\"a study\"", "\"\\ud800\"", "/title", "half of a surrogate pair", "the character itself"},
    {"\"metrics\": [\"radius\", {\"type\": \"quantile\", \"level\": 0.5}]\n}", "\"metrics\": [",
     "/metrics/0", "the file ends here", "complete", 38},
    {"\"level\": 0.5}]\n}", "\"level\": 0.5}]\n}}", "", "more text after the end", "too many", 38},
};

}  // namespace

TEST_CASE("the study that the mistakes are made in is valid") {
  CHECK(problems_of(valid_study).empty());
}

TEST_CASE("what is no control character may stand in a text") {
  for (const std::string good : {" ", "~", "\\u00a0", "\\u0100", "é€😀"}) {
    CHECK(problems_of(exchanged(valid_study, "\"a study\"", "\"" + good + "\"")).empty());
  }
}

TEST_CASE("mistakes at the top level") {
  for (const Mistake& mistake : top_level) expect_reported(valid_study, mistake);
}
TEST_CASE("mistakes in the system") {
  for (const Mistake& mistake : systems) expect_reported(valid_study, mistake);
}
TEST_CASE("mistakes in sets") {
  for (const Mistake& mistake : sets) expect_reported(valid_study, mistake);
}
TEST_CASE("mistakes in the data") {
  for (const Mistake& mistake : data) expect_reported(valid_study, mistake);
}
TEST_CASE("mistakes in components") {
  for (const Mistake& mistake : components) expect_reported(valid_study, mistake);
}
TEST_CASE("mistakes in the JSON text") {
  for (const Mistake& mistake : syntax) expect_reported(valid_study, mistake);
}
