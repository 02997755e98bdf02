// SPDX-License-Identifier: GPL-3.0-or-later
// Studies and sets that go to MATLAB come back as they were.
#include "cordon/experiments/interchange.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "experiments/interchange/json_to_mat.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "experiments/interchange/model_to_mat.hpp"
#include "run/scratch.hpp"
#include "study/fakes.hpp"
#include "study/reading/read_parts.hpp"
#include "study/reading/read_sets.hpp"
#include "study/same_study.hpp"

using namespace cordon;
using mat::Value;
using study_test::exchanged;

namespace {

void put(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::filesystem::path mat_of(const Scratch& scratch, const mat::Variables& variables) {
  put(scratch / "in.mat", mat::to_bytes(variables));
  return scratch / "in.mat";
}

Study read(const std::filesystem::path& file) {
  Registry registry;
  registry.add(study_test::register_fakes);
  return read_study(file, registry, SearchPath{});
}

/// The problems of reading this struct as a system.
std::vector<Diagnostic> problems_of(const mat::Variables& variables,
                                    const std::string& variable = "") {
  const Scratch scratch;
  try {
    mat_to_json(mat_of(scratch, variables), {scratch / "out.json"}, variable);
  } catch (const InputError& error) {
    CHECK_FALSE(std::filesystem::exists(scratch / "out.json"));
    return error.diagnostics();
  }
  return {};
}

void expect_problem(const mat::Variables& variables, const std::string& pointer,
                    const std::string& message) {
  const auto problems = problems_of(variables);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == pointer);
  CHECK(problems[0].message.find(message) != std::string::npos);
  CHECK(problems[0].line == 0);
}

Value box(const Matrix& lower, const Matrix& upper) {
  mat::Struct set;
  set.set("lower", mat::matrix(lower)).set("upper", mat::matrix(upper));
  return std::move(set).value();
}

/// Two states, one input, one output.
mat::Variables plain() {
  return {{"A", mat::matrix(Matrix{{1, 0.1}, {0, 1}})},
          {"B", mat::matrix(Matrix{{0}, {0.1}})},
          {"C", mat::matrix(Matrix{{1, 0}})},
          {"D", mat::matrix(Matrix{{0}})},
          {"W", box(Matrix{{-0.1}, {-0.1}}, Matrix{{0.1}, {0.1}})},
          {"V", box(Matrix{{-0.1}}, Matrix{{0.1}})}};
}

mat::Variables with(mat::Variables all, const std::string& name, Value value) {
  for (mat::Variable& v : all) {
    if (v.name != name) continue;
    v.value = std::move(value);
    return all;
  }
  all.push_back({name, std::move(value)});
  return all;
}

}  // namespace

TEST_CASE("a system survives the way to a MAT-file and back") {
  const Scratch scratch;
  for (const char* text : {study_test::valid_study, study_test::diagnosis_study,
                           study_test::uncertain_study, study_test::design_study}) {
    put(scratch / "study.json", text);
    const Study study = read(scratch / "study.json");
    study_to_mat(study, {scratch / "study.mat"}, false);
    const ImportedStudy back = mat_to_json(scratch / "study.mat", {scratch / "back.json"});
    CHECK(back.ignored.empty());
    CHECK(back.missing.empty());
    CHECK_FALSE(back.sets_only);
    // the beginning of a study names components that the fakes lack: the system is what counts
    json::Problems problems;
    std::vector<std::string> warnings;
    const json::Value root = json::parse(bytes_of(scratch / "back.json"), problems);
    const json::SystemPart imported =
        json::read_system(*json::Cursor(root, "", problems).find("system"), warnings);
    REQUIRE_FALSE(problems.any());
    ModeBank b;
    b.modes.push_back({imported.nominal, imported.model});
    b.modes.insert(b.modes.end(), imported.modes.begin(), imported.modes.end());
    const ModeBank a = bank_of(study);
    REQUIRE(a.size() == b.size());
    for (Index j = 0; j < a.size(); ++j) {
      CAPTURE(j);
      CHECK(a[j].name == b[j].name);
      const LinearModel &m = a[j].model.linear, &n = b[j].model.linear;
      CHECK(m.is_descriptor() == n.is_descriptor());
      for (const auto part :
           {&LinearModel::E, &LinearModel::A, &LinearModel::B, &LinearModel::Bw, &LinearModel::C,
            &LinearModel::D, &LinearModel::Dv, &LinearModel::A_radius, &LinearModel::B_radius,
            &LinearModel::C_radius, &LinearModel::F}) {
        REQUIRE((m.*part).rows() == (n.*part).rows());
        REQUIRE((m.*part).cols() == (n.*part).cols());
        CHECK(m.*part == n.*part);
      }
      CHECK(m.actuator.lower == n.actuator.lower);
      CHECK(m.actuator.upper == n.actuator.upper);
      CHECK(m.sensor.lower == n.sensor.lower);
      for (const auto part : {&Model::X0, &Model::W, &Model::V, &Model::U}) {
        const LineForm &X = a[j].model.*part, &Y = b[j].model.*part;
        CHECK(X.c == Y.c);
        CHECK(X.G == Y.G);
        CHECK(X.M == Y.M);
        CHECK(X.b == Y.b);
        CHECK(X.A == Y.A);
        CHECK(X.S == Y.S);
      }
    }
    std::filesystem::remove(scratch / "study.mat");
    std::filesystem::remove(scratch / "back.json");
  }
}

TEST_CASE("boxes are recognised, and only boxes") {
  CHECK(rc::check("make_box of the bounds is the set", [] {
    const auto n = *rc::gen::inRange<Index>(1, 5);
    Box box{Vector(n), Vector(n)};
    for (Index i = 0; i < n; ++i) {
      const double x = *rc::gen::inRange(-1000, 1000) / 64.0,
                   y = *rc::gen::inRange(-1000, 1000) / 256.0;
      box.lower[i] = std::min(x, y), box.upper[i] = std::max(x, y);
      if (*rc::gen::inRange(0, 5) == 0) box.lower[i] = -infinity, box.upper[i] = infinity;
      if (*rc::gen::inRange(0, 5) == 0) box.lower[i] = box.upper[i] = x;
    }
    const LineForm X = make_box(box);
    const auto found = mat::as_box(X);
    RC_ASSERT(found.has_value());
    RC_ASSERT(found->lower == box.lower);
    RC_ASSERT(found->upper == box.upper);
    const LineForm Y = make_box(*found);
    RC_ASSERT(X.c == Y.c);
    RC_ASSERT(X.G == Y.G);
    RC_ASSERT(X.M == Y.M);
  }));
  CHECK_FALSE(mat::as_box(make_zonotope(Vector{{0, 0}}, Matrix{{1, 0.5}, {0, 1}})));
  CHECK_FALSE(mat::as_box(make_zonotope(Vector{{0, 0}}, Matrix{{0, 1}, {1, 0}})));
  CHECK_FALSE(mat::as_box(make_strip(Vector{{1, 0}}, 0, 1)));
  LineForm cut = make_box({Vector{{0}}, Vector{{1}}});
  cut.A = Matrix{{1}}, cut.b = Vector{{0}}, cut.S = Matrix(1, 0);
  CHECK_FALSE(mat::as_box(cut));
}

TEST_CASE("bounds that are no doubles are not written") {
  CHECK_FALSE(mat::as_box(make_zonotope(Vector{{0.1}}, Matrix{{0.7}})));  // 0.1 + 0.7 is rounded
  CHECK_FALSE(
      mat::as_box(make_zonotope(Vector{{1e308}}, Matrix{{1.7e308}})));  // there is no such double
  CHECK_FALSE(mat::as_box(make_zonotope(Vector{{1}}, Matrix{{1e-300}})));
  const Value X = mat::to_mat(make_zonotope(Vector{{0.1}}, Matrix{{0.7}}));
  CHECK(X.field("type")->text == "zonotope");
  CHECK_FALSE(X.field("lower"));
  CHECK(X.field("c")->numbers(0, 0) == 0.1);
  CHECK(X.field("G")->numbers(0, 0) == 0.7);
}

TEST_CASE("sets come back bit by bit, and as they were written") {
  const Scratch scratch;
  CHECK(rc::check("random zonotopes", [&] {
    const auto n = *rc::gen::inRange<Index>(1, 4), m = *rc::gen::inRange<Index>(1, 4);
    const bool diagonal = *rc::gen::arbitrary<bool>();
    const auto any = [] {
      return std::ldexp(*rc::gen::inRange(-100000, 100000) / 977.0, *rc::gen::inRange(-60, 60));
    };
    Vector c(n);
    Matrix G = Matrix::Zero(n, diagonal ? n : m);
    for (Index i = 0; i < n; ++i) c[i] = any();
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < G.cols(); ++j) {
        if (!diagonal || i == j) G(i, j) = diagonal ? std::abs(any()) + 1e-9 : any();
      }
    }
    const auto back = mat_to_json(mat_of(scratch, {{"X", mat::to_mat(make_zonotope(c, G))}}),
                                  {scratch / "set.json", true});
    RC_ASSERT(back.sets_only);
    json::Problems problems;
    std::vector<std::string> warnings;
    const json::Value root = json::parse(bytes_of(scratch / "set.json"), problems);
    const auto X = json::read_set(json::Cursor(root, "", problems), warnings);
    RC_ASSERT(X.has_value());
    RC_ASSERT(X->c == c);
    RC_ASSERT(X->G.rows() == n);
    if (G.cwiseAbs().minCoeff() > 0 || diagonal) RC_ASSERT((X->G.cols() == G.cols() && X->G == G));
    const Value written = mat::to_mat(make_zonotope(c, G));
    for (Index i = 0; written.field("lower") && i < n; ++i) {  // in more digits
      const long double center = c[i], radius = G.row(i).cwiseAbs().maxCoeff();
      RC_ASSERT(center - radius == static_cast<long double>(written.field("lower")->numbers(i, 0)));
      RC_ASSERT(center + radius == static_cast<long double>(written.field("upper")->numbers(i, 0)));
    }
  }));
}

TEST_CASE("the fields of a set") {
  const Value X = mat::to_mat(make_box({Vector{{-1, -infinity}}, Vector{{3, infinity}}}));
  CHECK(X.field("type")->text == "box");
  CHECK(X.field("lower")->numbers == Matrix{{-1}, {-infinity}});
  CHECK(X.field("upper")->numbers == Matrix{{3}, {infinity}});
  CHECK(X.field("c")->numbers == Matrix{{1}, {0}});
  CHECK(X.field("G")->numbers == Matrix{{2}, {0}});
  CHECK(X.field("M")->numbers == Matrix{{0}, {1}});
  CHECK(mat::to_mat(make_space(2)).field("type")->text == "space");
  CHECK(mat::to_mat(make_point(Vector{{1}})).field("type")->text == "point");
  CHECK(mat::to_mat(make_strip(Vector{{1, 1}}, 0, 1)).field("type")->text == "line_zonotope");
  CHECK(mat::to_mat(make_zonotope(Vector{{0, 0}}, Matrix{{1, 1}, {0, 1}})).field("type")->text ==
        "zonotope");
}

TEST_CASE("sets of every type come back") {
  const Scratch scratch;
  const std::string sets = R"([
    {"type": "box", "lower": [-1, "-inf"], "upper": [1, "inf"]},
    {"type": "zonotope", "center": [1, 2], "generators": [[1, 0.5], [0, 1]]},
    {"type": "constrained_zonotope", "center": [0, 0], "generators": [[1, 0], [0, 1]], "A": [[1, 1]], "b": [0.5]},
    {"type": "line_zonotope", "center": [0, 0], "lines": [[1], [1]], "generators": [[0], [1]], "S": [[1]], "A": [[-1]], "b": [2]},
    {"type": "space", "dim": 3},
    {"type": "point", "center": [4, 5, 6]}])";
  put(scratch / "sets.json", sets);
  CHECK(json_file(scratch / "sets.json") == JsonFile::sets);
  sets_to_mat(scratch / "sets.json", {scratch / "sets.mat"});
  const ImportedStudy back = mat_to_json(scratch / "sets.mat", {scratch / "back.json"});
  CHECK(back.sets_only);
  rewrite_matrices(scratch / "sets.json", {scratch / "same.json"}, MatrixForm::dense);
  CHECK(bytes_of(scratch / "back.json") == bytes_of(scratch / "same.json"));
}

TEST_CASE("one set, and the types that are not exchange forms") {
  const Scratch scratch;
  mat::Struct strip, polytope, hull;
  strip.set("rho", mat::matrix(Matrix{{1, 2}}))
      .set("d", mat::number(0.5))
      .set("sigma", mat::number(1));
  polytope.set("H", mat::matrix(Matrix{{1, 1}}))
      .set("h", mat::number(1))
      .set("lower", mat::matrix(Matrix{{-1}, {-1}}));
  polytope.set("upper", mat::matrix(Matrix{{1}, {1}}));
  hull.set("type", mat::text("polytope"))
      .set("vertices", mat::matrix(Matrix{{0, 0}, {1, 0}, {0, 1}}));
  const std::pair<Value, std::string> cases[] = {
      {std::move(strip).value(), R"({"type": "strip", "rho": [1, 2], "d": 0.5, "sigma": 1})"},
      {std::move(polytope).value(),
       R"({"type": "polytope", "lower": [-1, -1], "upper": [1, 1], "H": [[1, 1]], "h": [1]})"},
      {std::move(hull).value(), R"({"type": "polytope", "vertices": [[0, 0], [1, 0], [0, 1]]})"}};
  for (const auto& [value, text] : cases) {
    put(scratch / "want.json", text);
    rewrite_matrices(scratch / "want.json", {scratch / "same.json", true}, MatrixForm::dense);
    mat_to_json(mat_of(scratch, {{"S", value}}), {scratch / "back.json", true});
    CHECK(bytes_of(scratch / "back.json") == bytes_of(scratch / "same.json"));
  }
}

TEST_CASE("matrices beside a struct with a system are left out, and named") {
  const Scratch scratch;
  mat::Struct system;
  for (const mat::Variable& v : plain())
    system.set(v.name, v.name == "A" ? mat::matrix(Matrix{{3, 0}, {0, 3}}) : v.value);
  const auto all = with(plain(), "system", std::move(system).value());
  const ImportedStudy imported = mat_to_json(mat_of(scratch, all), {scratch / "out.json"});
  CHECK(read(scratch / "out.json").model.linear.A(0, 0) == 3);
  REQUIRE(imported.ignored.size() == 1);
  CHECK(imported.ignored[0] ==
        "the variables A, B, C, D, W, V (the system is taken from a struct beside them)");
  CHECK(mat_to_json(mat_of(scratch, all), {scratch / "chosen.json"}, "system").ignored.empty());
}

TEST_CASE("two variables of one name are an error") {
  const Scratch scratch;
  const std::string again = mat::to_bytes({{"A", mat::matrix(Matrix{{5, 0}, {0, 5}})}});
  put(scratch / "in.mat", mat::to_bytes(plain()) + again.substr(128));  // without the header
  CHECK_THROWS_WITH_AS(mat_to_json(scratch / "in.mat", {scratch / "out.json"}),
                       doctest::Contains("stands there twice"), InputError);
  CHECK_FALSE(std::filesystem::exists(scratch / "out.json"));
}

TEST_CASE("titles have no control characters") {
  const Scratch scratch;
  mat::Struct about;
  about.set("title", mat::text(std::string("a\0b\n\x7F\"ü", 8)));
  mat_to_json(mat_of(scratch, with(plain(), "cordon", std::move(about).value())),
              {scratch / "out.json"});
  CHECK(read(scratch / "out.json").title == "a b  \"ü");
}

TEST_CASE("matrices alone are a system") {
  const Scratch scratch;
  const ImportedStudy imported = mat_to_json(mat_of(scratch, plain()), {scratch / "out.json"});
  CHECK(imported.files == std::vector<std::filesystem::path>{scratch / "out.json"});
  CHECK(imported.missing.empty());
  const Study study = read(scratch / "out.json");
  CHECK(study.title == "in");
  CHECK(study.model.linear.A == Matrix{{1, 0.1}, {0, 1}});
  CHECK(study.model.linear.Bw == Matrix::Identity(2, 2));
  CHECK(std::get<SimulateSpec>(study.data).input.size() == 1);
}

TEST_CASE("without W and V the study says what is missing") {
  const Scratch scratch;
  mat::Variables all = plain();
  all.resize(4);
  const ImportedStudy imported = mat_to_json(mat_of(scratch, all), {scratch / "out.json"});
  CHECK(imported.missing == std::vector<std::string>{"W", "V"});
  try {
    read(scratch / "out.json");
    FAIL("W and V are not there");
  } catch (const InputError& error) {
    REQUIRE(error.diagnostics().size() == 2);
    CHECK(error.diagnostics()[0].pointer == "/system/W");
  }
}

TEST_CASE("a matrix without columns says that there are none, [] says nothing") {
  const Scratch scratch;
  mat::Variables all = plain();
  all.resize(4);
  all.push_back({"V", box(Matrix{{-0.1}}, Matrix{{0.1}})});
  const ImportedStudy none = mat_to_json(
      mat_of(scratch, with(all, "Bw", mat::matrix(Matrix(2, 0)))), {scratch / "out.json"});
  CHECK(none.missing.empty());
  CHECK(read(scratch / "out.json").model.linear.disturbances() == 0);
  const ImportedStudy absent = mat_to_json(
      mat_of(scratch, with(all, "Bw", mat::matrix(Matrix(0, 0)))), {scratch / "out.json", true});
  CHECK(absent.missing == std::vector<std::string>{"W"});
}

TEST_CASE("two actuators, two outputs") {
  const Scratch scratch;
  mat::Variables all = with(plain(), "B", mat::matrix(Matrix{{1, 0}, {0, 1}}));
  all = with(with(all, "D", mat::matrix(Matrix(0, 0))), "C", mat::matrix(Matrix{{1, 0}, {0, 1}}));
  all = with(all, "V", box(Matrix{{-1}, {-1}}, Matrix{{1}, {1}}));
  mat::Struct mode;  // a row of two numbers is no range
  mode.set("name", mat::text("half")).set("actuator", mat::matrix(Matrix{{0.5, 0.25}}));
  all = with(all, "modes", mat::Struct::array({mode}));
  mat::Struct data;  // where both ways fit, a column is a sample
  data.set("u", mat::matrix(Matrix{{1, 2}, {3, 4}})).set("y", mat::matrix(Matrix{{5, 6}, {7, 8}}));
  mat_to_json(mat_of(scratch, with(all, "data", std::move(data).value())), {scratch / "out.json"});
  CHECK(bytes_of(scratch / "out.csv") == "k,u_1,u_2,y_1,y_2\n0,1,3,5,7\n1,2,4,6,8\n");
  const Study study = read(scratch / "out.json");
  CHECK(study.modes.at(0).model.linear.B == Matrix{{0.5, 0}, {0, 0.25}});
}

TEST_CASE("which variable is taken") {
  const Scratch scratch;
  mat::Struct one, two;
  for (mat::Struct* s : {&one, &two}) {
    for (const mat::Variable& v : plain()) s->set(v.name, v.value);
  }
  one.set("C1", mat::number(1));
  const Value first = std::move(one).value(), second = std::move(two).value();
  const ImportedStudy imported = mat_to_json(
      mat_of(scratch, {{"plant", first}, {"x", mat::number(1)}}), {scratch / "out.json"});
  CHECK(imported.ignored == std::vector<std::string>{"C1"});
  const auto several = problems_of({{"plant", first}, {"other", second}});
  REQUIRE(several.size() == 1);
  CHECK(several[0].suggestion.find("--variable") != std::string::npos);
  CHECK(several[0].suggestion.find("plant") != std::string::npos);
  CHECK(problems_of({{"plant", first}, {"system", second}}).empty());
  CHECK(problems_of({{"plant", first}, {"other", second}}, "other").empty());
  CHECK(problems_of({{"plant", first}}, "plantt")[0].suggestion.find("plant") != std::string::npos);
  CHECK(problems_of({{"x", mat::number(1)}})[0].message.find("no system and no sets") !=
        std::string::npos);
  CHECK(problems_of({{"x", mat::number(1)}}, "x")[0].message.find("neither a system nor sets") !=
        std::string::npos);
}

TEST_CASE("what is wrong in a system is told by its field") {
  const double nan = std::nan("");
  expect_problem(with(plain(), "A", mat::matrix(Matrix{{1, nan}, {0, 1}})), "/A",
                 "holds NaN in row 1, column 2");
  expect_problem(with(plain(), "A", mat::matrix(Matrix{{1, infinity}, {0, 1}})), "/A",
                 "holds Inf in row 1, column 2");
  expect_problem(with(plain(), "A", mat::text("x")), "/A", "is a text");
  expect_problem(with(plain(), "C", mat::matrix(Matrix{{1, 0, 0}})), "/C", "must have 2 columns");
  expect_problem(with(plain(), "W", mat::number(1)), "/W",
                 "must be a struct with the fields of a set");
  expect_problem(with(plain(), "W", box(Matrix{{nan}, {1}}, Matrix{{2}, {2}})), "/W/lower",
                 "holds NaN");
  expect_problem(with(plain(), "W", box(Matrix{{3}, {1}}, Matrix{{2}, {2}})), "/W/lower/0",
                 "above the upper bound");
  expect_problem(with(plain(), "W", box(Matrix{{1, 1}, {1, 1}}, Matrix{{2}, {2}})), "/W/lower",
                 "must be a vector");
  expect_problem(with(plain(), "V", box(Matrix{{1}, {1}}, Matrix{{2}, {2}})), "/V",
                 "has dimension 2");
  expect_problem(with(plain(), "Ts", mat::number(0)), "/Ts", "continuous time");
  expect_problem(with(plain(), "type", mat::text("ltti")), "/type", "unknown choice");
  expect_problem(with(plain(), "modes", mat::number(1)), "/modes", "must be a struct array");
  CHECK(problems_of(with(plain(), "Ts", mat::number(0.1))).empty());
  mat::Struct set;
  set.set("type", mat::text("zonotope"))
      .set("c", mat::matrix(Matrix{{0}, {0}}))
      .set("A", mat::matrix(Matrix{{1}}))
      .set("b", mat::number(1));
  const auto problems = problems_of(with(plain(), "W", std::move(set).value()));
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].message.find("does not belong to a set of type") != std::string::npos);
  mat::Struct unknown;
  unknown.set("type", mat::text("zonotop")).set("c", mat::matrix(Matrix{{0}, {0}}));
  CHECK(problems_of(with(plain(), "W", std::move(unknown).value()))[0].suggestion.find(
            "zonotope") != std::string::npos);
}

TEST_CASE("effectiveness of modes: numbers, or rows [low high]") {
  const Scratch scratch;
  mat::Struct weak, deaf;
  weak.set("name", mat::text("weak"))
      .set("actuator", mat::matrix(Matrix{{0.25, 0.5}}))
      .set("sensor", mat::matrix(Matrix(0, 0)));
  deaf.set("name", mat::text("deaf"))
      .set("actuator", mat::matrix(Matrix(0, 0)))
      .set("sensor", mat::number(0));
  const auto modes = mat::Struct::array({weak, deaf});
  mat_to_json(mat_of(scratch, with(plain(), "modes", modes)), {scratch / "out.json"});
  const Study study = read(scratch / "out.json");
  REQUIRE(study.modes.size() == 2);
  CHECK(study.modes[0].model.linear.actuator.lower[0] == 0.25);
  CHECK(study.modes[0].model.linear.actuator.upper[0] == 0.5);
  CHECK(study.modes[1].model.linear.C.isZero(0));
  mat::Struct wrong;
  wrong.set("name", mat::text("x")).set("actuator", mat::matrix(Matrix{{1, 1, 1}}));
  expect_problem(with(plain(), "modes", mat::Struct::array({wrong})), "/modes/0/actuator",
                 "is 1 × 3");
}

TEST_CASE("data become a CSV file, whichever way they stand") {
  const Scratch scratch;
  const Matrix u{{1, 2, 3}}, y{{0.1, 0.25, -1e-300}}, x{{1, 2, 3}, {4, 5, 6}};
  mat::Struct rows, columns;
  rows.set("u", mat::matrix(u))
      .set("y", mat::matrix(y))
      .set("x", mat::matrix(x))
      .set("mode", mat::matrix(Matrix{{0, 0, -1}}));
  columns.set("u", mat::matrix(u.transpose()))
      .set("y", mat::matrix(y.transpose()))
      .set("x", mat::matrix(x.transpose()));
  columns.set("mode", mat::matrix(Matrix{{0}, {0}, {-1}}));
  std::string first;
  for (mat::Struct* data : {&rows, &columns}) {
    const ImportedStudy imported =
        mat_to_json(mat_of(scratch, with(plain(), "data", std::move(*data).value())),
                    {scratch / "out.json", true});
    REQUIRE(imported.files.size() == 2);
    const std::string text = bytes_of(scratch / "out.csv");
    CHECK(text ==
          "k,u_1,y_1,x_1,x_2,mode\n0,1,0.1,1,4,healthy\n1,2,0.25,2,5,healthy\n2,3,-1e-300,3,6,\n");
    const Study study = read(scratch / "out.json");
    const auto source = open_data(study);
    CHECK(source->size() == 3);
    CHECK(source->next()->truth == Vector{{1, 4}});
  }
}

TEST_CASE("data that are wrong") {
  const auto data = [](const char* name, Matrix numbers) {
    mat::Struct all;
    for (const auto& [key, value] : std::vector<std::pair<std::string, Matrix>>{
             {"u", Matrix{{1, 2}}}, {"y", Matrix{{1, 2}}}, {"mode", Matrix{{0, 0}}}}) {
      all.set(key, mat::matrix(key == name ? numbers : value));
    }
    return with(plain(), "data", std::move(all).value());
  };
  CHECK(problems_of(data("", Matrix())).empty());
  expect_problem(data("u", Matrix{{1, 2, 3}}), "/data/u", "has 3 samples, the others have 2");
  expect_problem(data("u", Matrix(0, 0)), "/data/u", "is missing");
  expect_problem(data("y", Matrix{{1, std::nan("")}}), "/data/y", "holds NaN or Inf in sample 2");
  expect_problem(data("y", Matrix{{1, 2, 3}, {4, 5, 6}}), "/data/y", "is 2 × 3, must have 1 row");
  expect_problem(data("mode", Matrix{{0, 1}}), "/data/mode", "holds 1 in sample 2");
  expect_problem(data("mode", Matrix{{0, -2}}), "/data/mode", "holds -2 in sample 2");
  expect_problem(data("mode", Matrix{{0.5, 0}}), "/data/mode", "holds 0.5 in sample 1");
}

TEST_CASE("nothing is replaced unless asked for") {
  const Scratch scratch;
  put(scratch / "out.json", "mine");
  const auto mat = mat_of(scratch, plain());
  CHECK_THROWS_WITH_AS(mat_to_json(mat, {scratch / "out.json"}),
                       doctest::Contains("exists already"), Error);
  CHECK(bytes_of(scratch / "out.json") == "mine");
  CHECK(tree(scratch.path()).size() == 2);
  mat_to_json(mat, {scratch / "out.json", true});
  CHECK(bytes_of(scratch / "out.json") != "mine");
  CHECK_THROWS_WITH_AS(mat_to_json(mat, {scratch / "absent" / "out.json"}),
                       doctest::Contains("no directory"), Error);
  CHECK_THROWS_WITH_AS(mat_to_json(mat, {scratch.path(), true}),
                       doctest::Contains("is a directory"), Error);
}
