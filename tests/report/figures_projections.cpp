// SPDX-License-Identifier: GPL-3.0-or-later
// Sets in two coordinates: which times, which window, and what of a set.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "experiments/report/read_report.hpp"
#include "report/find_figure.hpp"
#include "report/results_files.hpp"

using namespace cordon;
using namespace cordon::report;

namespace {

std::string line(const std::string& pipeline, int k, const std::string& blocks) {
  return R"({"pipeline": ")" + pipeline + R"(", "k": )" + std::to_string(k) +
         R"(, "tightness": "outer", "exchange": "exact", )" + blocks +
         R"(, "consistent": "yes", "proof": {"kind": "structure"}})" + "\n";
}

/// A box around (x, 0) with these half widths.
std::string box(double x, double a, double b) {
  return R"("dim": 2, "lines": 0, "generators": 2, "constraints": 0, "M": [[], []], "G": [[)" +
         std::to_string(a) + ", 0], [0, " + std::to_string(b) + R"(]], "c": [)" +
         std::to_string(x) + R"(, 0], "S": [], "A": [], "b": [])";
}

const std::string space =
    R"("dim": 2, "lines": 2, "generators": 0, "constraints": 0, "M": [[1, 0], [0, 1]], "G": [[], []], "c": [0, 0], "S": [], "A": [], "b": [])";
const std::string strip =
    R"("dim": 2, "lines": 1, "generators": 1, "constraints": 0, "M": [[1], [0]], "G": [[0], [2]], "c": [0, 1], "S": [], "A": [], "b": [])";
const std::string empty =
    R"("dim": 2, "lines": 0, "generators": 0, "constraints": 1, "M": [[], []], "G": [[], []], "c": [0, 0], "S": [[]], "A": [[]], "b": [1])";

const Projection* sets(const Report& report, const std::string& id = "sets_1_2") {
  for (const Figure& figure : report.figures) {
    if (figure.id == id) return &std::get<Projection>(figure.content);
  }
  return nullptr;
}

std::string steps(const std::string& pipeline, int count) {
  std::string rows;
  for (int k = 0; k < count; ++k)
    rows.append(pipeline).append(",").append(std::to_string(k)).append(",yes,exact,0,0,1,1\n");
  return rows;
}

const std::string header = "pipeline,k,consistent,tightness,lower_1,lower_2,upper_1,upper_2\n";

}  // namespace

TEST_CASE("sets of all kinds in one figure") {
  const ResultsFiles files;
  files.write("sets.jsonl", line("a", 0, space) + line("a", 1, box(1, 1, 1)) + line("a", 2, empty) +
                                line("b", 0, strip));
  const Report report = read_report(files.path());
  const Projection* figure = sets(report);
  REQUIRE(figure);
  CHECK(figure->x_label == "x_1");
  CHECK(figure->y_label == "x_2");
  REQUIRE(figure->frames.size() == 3);
  const SetFrame &first = figure->frames[0], &second = figure->frames[1],
                 &third = figure->frames[2];
  CHECK(first.k == 0);
  CHECK(first.truth == std::optional<std::pair<double, double>>({0.25, 0.5}));
  REQUIRE(first.sets.size() == 2);
  CHECK(first.sets[0].pipeline == 0);
  CHECK(first.sets[0].open == std::vector<bool>(4, true));
  CHECK(first.sets[1].pipeline == 1);
  CHECK(std::count(first.sets[1].open.begin(), first.sets[1].open.end(), true) == 2);
  CHECK(first.bottom < -1);
  CHECK(first.top > 3);
  REQUIRE(second.sets.size() == 1);
  CHECK(second.sets[0].x == std::vector<double>{0, 2, 2, 0});
  CHECK(second.sets[0].y == std::vector<double>{-1, -1, 1, 1});
  CHECK(second.sets[0].open.empty());
  CHECK(second.left < 0);
  CHECK(second.right > 2);
  CHECK(second.left > -0.5);
  REQUIRE(third.sets.size() == 1);
  CHECK(third.sets[0].x.empty());
  CHECK(third.truth.has_value());
  CHECK(third.left < 1);
  CHECK(third.right > 1);
  const auto tells_of_empty = [](const Report& told) {
    return find_figure(told, "sets_1_2")->caption.find("proven empty") != std::string::npos;
  };
  CHECK(tells_of_empty(report));
  files.write("sets.jsonl", line("a", 0, space) + line("b", 0, strip));
  CHECK_FALSE(tells_of_empty(read_report(files.path())));
}

TEST_CASE("a set that is much larger than others is cut by the window, the truth never is") {
  const ResultsFiles files;
  files.write("steps.csv", header + steps("a", 1) + steps("b", 1));
  files.write("data.csv", "k,x_1,x_2\n0,7,0\n");
  files.write("sets.jsonl", line("a", 0, box(0, 1, 1)) + line("b", 0, box(0, 1000, 0.5)));
  const SetFrame frame = sets(read_report(files.path()))->frames.at(0);
  CHECK(frame.left > -3);
  CHECK(frame.right > 7);
  CHECK(frame.right < 12);
  CHECK(frame.sets.at(0).open.empty());
  CHECK(std::count(frame.sets.at(1).open.begin(), frame.sets.at(1).open.end(), true) == 2);
  files.write("sets.jsonl", line("a", 0, box(0, 1, 1)) + line("b", 0, box(0, 19, 0.5)));
  CHECK(sets(read_report(files.path()))->frames.at(0).left < -19);
}

TEST_CASE("each coordinate of the window has its own unit") {
  const ResultsFiles files;
  files.write("steps.csv", header + steps("a", 1) + steps("b", 1));
  files.write("data.csv", "k,x_1,x_2\n0,0,0\n");
  const auto frame = [&](const std::string& a, const std::string& b) {
    files.write("sets.jsonl", line("a", 0, a) + line("b", 0, b));
    return sets(read_report(files.path()))->frames.at(0);
  };
  const SetFrame hugs = frame(box(0, 10000, 0.00001), box(0, 20000, 0.00002));
  CHECK(hugs.right == doctest::Approx(23200));
  CHECK(hugs.top == doctest::Approx(0.0000232));
  CHECK(hugs.sets.at(1).open.empty());
  const SetFrame cuts =
      frame(box(0, 10000, 0.00001), box(0, 20000, 1));  // too high, but not too wide
  CHECK(cuts.right == doctest::Approx(23200));
  CHECK(cuts.top == doctest::Approx(0.0000116));
  CHECK(cuts.bottom == doctest::Approx(-0.0000116));
  const SetFrame flat =
      frame(box(10000, 0, 2), box(10000, 0.0000000000001, 1));  // the width of rounding is none
  CHECK(flat.left < 0);
  CHECK(flat.top == doctest::Approx(2.32));
  const SetFrame points = frame(box(0, 0, 0), box(0, 0, 0));
  CHECK(points.right == doctest::Approx(1.16));
  CHECK(points.bottom == doctest::Approx(-1.16));
  files.write("data.csv", "k,x_1,x_2\n0,10000,0\n");
  CHECK(frame(box(10000, 0, 2), box(10000, 0, 1)).right == doctest::Approx(10011.6));
}

TEST_CASE("times: evenly, the first and the last, and those of events") {
  const ResultsFiles files;
  files.write("steps.csv", header + steps("a", 1000));
  std::string lines, data = "k,x_1,x_2,mode\n";
  for (int k = 0; k < 1000; ++k) {
    lines += line("a", k, box(k, 1, 1));
    data.append(std::to_string(k)).append(",0,0,").append(k == 333 ? "-1" : "0").append("\n");
  }
  files.write("sets.jsonl", lines);
  files.write("data.csv", data);
  const Projection figure = *sets(read_report(files.path()));
  std::vector<std::int64_t> times;
  for (const SetFrame& frame : figure.frames) {
    times.push_back(frame.k);
    CHECK(frame.sets.at(0).x.at(0) == frame.k - 1);
  }
  CHECK(std::is_sorted(times.begin(), times.end()));
  CHECK(times.size() >= 60);
  CHECK(times.size() <= 62);
  CHECK(times.front() == 0);
  CHECK(times.back() == 999);
  CHECK(std::count(times.begin(), times.end(), 333) == 1);
  CHECK(std::count(times.begin(), times.end(), 334) == 1);
}

TEST_CASE("which pairs of states: all up to four, then three") {
  const auto figures = [](int states) {
    const ResultsFiles files;
    std::string names = "pipeline,k,consistent,tightness", row = "a,0,yes,exact", rows = "[]",
                zeros = "0";
    for (const char* name : {",lower_", ",upper_"}) {
      for (int i = 1; i <= states; ++i) {
        names.append(name).append(std::to_string(i));
        row.append(",0");
      }
    }
    for (int i = 1; i < states; ++i) {
      rows.append(", []");
      zeros.append(", 0");
    }
    files.write("steps.csv", names + "\n" + row + "\n");
    files.write("data.csv", "k,y_1\n0,1\n");
    files.write("sets.jsonl",
                line("a", 0,
                     R"("dim": )" + std::to_string(states) +
                         R"(, "lines": 0, "generators": 0, "constraints": 0, "M": [)" + rows +
                         R"(], "G": [)" + rows + R"(], "c": [)" + zeros +
                         R"(], "S": [], "A": [], "b": [])"));
    std::string ids;
    for (const Figure& figure : read_report(files.path()).figures) {
      if (figure.id.rfind("sets_", 0) == 0) ids += figure.id.substr(5) + " ";
    }
    return ids;
  };
  CHECK(figures(1).empty());
  CHECK(figures(2) == "1_2 ");
  CHECK(figures(4) == "1_2 1_3 1_4 2_3 2_4 3_4 ");
  CHECK(figures(5) == "1_2 3_4 4_5 ");
  CHECK(figures(9) == "1_2 3_4 5_6 ");
}

TEST_CASE("a name that looks like the key of a time") {
  const ResultsFiles files;
  files.replace("results.json", R"("name": "a")", R"("name": "\"k\": 5,")");
  files.write("steps.csv", header + "\"\"\"k\"\": 5,\",0,yes,exact,0,0,1,1\n");
  files.write("sets.jsonl", line(R"(\"k\": 5,)", 0, box(0, 1, 1)));
  CHECK(sets(read_report(files.path()))->frames.size() == 1);
}

TEST_CASE("lines of other times are passed over, lines of another run are refused") {
  const ResultsFiles files;
  const std::string good = line("a", 0, box(0, 1, 1));
  files.write("sets.jsonl", good + R"({"pipeline": "a", "k": 77, broken)" + "\n");
  CHECK(sets(read_report(files.path()))->frames.size() == 1);
  files.write("sets.jsonl", good + R"({"pipeline": "a", "k": 1, broken)" + "\n");
  CHECK_THROWS_WITH_AS(read_report(files.path()), doctest::Contains("(line 2)"), InputError);
  files.write("sets.jsonl", line("c", 0, box(0, 1, 1)));
  CHECK_THROWS_WITH_AS(read_report(files.path()), doctest::Contains("names the pipeline \"c\""),
                       InputError);
  files.write(
      "sets.jsonl",
      line(
          "a", 0,
          R"("dim": 1, "lines": 0, "generators": 0, "constraints": 0, "M": [[]], "G": [[]], "c": [0], "S": [], "A": [], "b": [])"));
  CHECK_THROWS_WITH_AS(read_report(files.path()), doctest::Contains("steps.csv has 2 states"),
                       InputError);
}

TEST_CASE("sets too large for a window are left out, and told") {
  for (const char* half : {"1e308", "1.5e308", "1e200"}) {
    const ResultsFiles files;
    std::string text = strip;
    text.replace(text.find("[2]"), 3, std::string("[") + half + "]");
    CAPTURE(half);
    files.write("sets.jsonl", line("a", 0, text) + line("a", 1, box(1, 1, 1)));
    const Report report = read_report(files.path());
    for (const SetFrame& frame : sets(report)->frames) {
      for (const double edge : {frame.left, frame.right, frame.bottom, frame.top})
        CHECK(std::abs(edge) < 10);
    }
    CHECK(std::any_of(report.notes.begin(), report.notes.end(), [](const std::string& note) {
      return note.find("too large to be drawn") != std::string::npos;
    }));
  }
}

TEST_CASE("any bytes among the sets: a report or an InputError") {
  CHECK(rc::check([] {
    const ResultsFiles files;
    std::string text = line("a", 0, strip) + line("a", 1, box(1, 1, 1)) + line("a", 2, empty) +
                       line("b", 0, space);
    const auto count = *rc::gen::inRange(1, 4);
    for (int i = 0; i < count; ++i) {
      const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
      text.replace(at, *rc::gen::inRange<std::size_t>(0, 4),
                   *rc::gen::element<std::string>("1", "-", "1e308", "0", "[", "]", ",", "1e-300",
                                                  "\"", "9", "{}"));
    }
    files.write("sets.jsonl", text);
    try {
      const Report report = read_report(files.path());
      if (const Projection* figure = sets(report)) {
        for (const SetFrame& frame : figure->frames) {
          for (const double edge : {frame.left, frame.right, frame.bottom, frame.top})
            RC_ASSERT(std::isfinite(edge));
        }
      }
    } catch (const InputError&) {
    }
  }));
}
