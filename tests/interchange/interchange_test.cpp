// SPDX-License-Identifier: GPL-3.0-or-later
// Studies that go to MATLAB come back as they were, and what MATLAB wrote becomes one.
#include "cordon/experiments/interchange.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/study/data.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "interchange/mat_variables.hpp"
#include "run/scratch.hpp"
#include "study/fakes.hpp"
#include "study/reading/read_parts.hpp"
#include "study/same_study.hpp"

using namespace cordon;
using namespace interchange_test;

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
        json::read_recorded_system(*json::Cursor(root, "", problems).find("system"), warnings);
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
