// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/svg.hpp"

#include <doctest/doctest.h>

#include "experiments/report/drawing.hpp"
#include "report/sample_reports.hpp"
#include "report/svg_tree.hpp"

using namespace cordon::report;
using namespace svg_tree;

TEST_CASE("every kind of figure is XML with its title") {
  const Report report = sample::every_kind();
  for (const Figure& figure : report.figures) {
    CAPTURE(figure.id);
    const Tree tree = drawn(figure, report);
    CHECK(tree.get<std::string>("svg.title") == figure.title);
    CHECK(attribute(tree.get_child("svg"), "xmlns") == "http://www.w3.org/2000/svg");
    CHECK(elements(tree, "script").empty());
    CHECK(elements(tree, "text").size() > 3);
  }
}

TEST_CASE("hostile names stay text") {
  const Report report = sample::with_names(sample::hostile);
  for (const Figure& figure : report.figures) {
    CAPTURE(figure.id);
    const Tree tree = drawn(figure, report);
    CHECK(tree.get<std::string>("svg.title") == sample::hostile);
    CHECK(elements(tree, "script").empty());
    CHECK(elements(tree, "b").empty());
  }
}

TEST_CASE("what XML cannot hold is replaced") {
  CHECK(escaped("a<b>&\"'") == "a&lt;b&gt;&amp;&quot;&#39;");
  CHECK(escaped(std::string("\0\x1b\x7f", 3)) == "\xEF\xBF\xBD\xEF\xBF\xBD\x7f");
  CHECK(escaped("\xff\xc3") == "\xEF\xBF\xBD\xEF\xBF\xBD");
  CHECK(escaped("\xEF\xBF\xBE") == "\xEF\xBF\xBD");
  CHECK(escaped("ü推\xF0\x9F\x9B\xB0\n") == "ü推\xF0\x9F\x9B\xB0\n");
}

TEST_CASE("texts are shortened to a width, between characters") {
  CHECK(shortened("short", 100) == "short");
  const std::string long_text = "推定推定推定推定推定推定";
  const std::string text = shortened(long_text, 60);
  CHECK(text == "推定推定…");
  CHECK(text_width(text) <= 60);
  CHECK(text_width("WWW") > text_width("iii"));
}

TEST_CASE("a line is drawn where its values are") {
  Plot plot{"k", "y", false, {{Series::Kind::line, "a", 0, {0, 1, 2}, {-1, 1, 0}}}};
  const Tree tree = drawn(plot);
  const auto curves = drawn_curves(tree);
  REQUIRE(curves.size() == 1);
  const auto points = points_of(*curves[0]);
  REQUIRE(points.size() == 3);
  CHECK(points[1].first - points[0].first == doctest::Approx(280));
  CHECK(points[2].first == doctest::Approx(626));
  CHECK(points[0].second - points[1].second ==
        doctest::Approx(2 * (points[2].second - points[1].second)));
  CHECK(points[1].second < points[0].second);
  CHECK(has_text(tree, "a"));
  CHECK(has_text(tree, "k"));
  CHECK(has_text(tree, "y"));
}

TEST_CASE("a gap interrupts a line, infinity leaves the frame, a single value is a point") {
  Plot plot{"k",
            "y",
            false,
            {{Series::Kind::line,
              "a",
              0,
              {0, 1, 2, 3, 4, 5},
              {1, 2, sample::missing, cordon::infinity, 2, sample::missing}}}};
  const auto curves_tree = drawn(plot);
  const auto curves = drawn_curves(curves_tree);
  REQUIRE(curves.size() == 2);
  CHECK(points_of(*curves[0]).size() == 2);
  const auto second = points_of(*curves[1]);
  REQUIRE(second.size() == 2);
  CHECK(second[0].second < 0);
  CHECK(second[1].second > 0);
  Plot single{"k",
              "y",
              false,
              {{Series::Kind::line, "a", 0, {0, 1, 2}, {sample::missing, 2, sample::missing}}}};
  const Tree tree = drawn(single);
  CHECK(drawn_curves(tree).empty());
  CHECK(elements(tree, "circle").size() == 1);
}

TEST_CASE("a value of steps holds until the next") {
  Plot plot{"k", "y", false, {{Series::Kind::steps, "a", 0, {0, 1}, {1, 2}}}};
  const Tree tree = drawn(plot);
  const auto points = points_of(*drawn_curves(tree).at(0));
  REQUIRE(points.size() == 3);
  CHECK(points[1].first == points[2].first);
  CHECK(points[1].second == points[0].second);
}

TEST_CASE("a band is an area between two lines") {
  Plot plot{"k",
            "y",
            false,
            {{Series::Kind::band, "a", 0, {0, 1, 2, 3}, {0, 0, sample::missing, 1}, {1, 1, 1, 2}}}};
  const Tree tree = drawn(plot);
  const auto areas = elements(tree, "polygon");
  REQUIRE(areas.size() == 2);
  const auto around = points_of(*areas[0]);
  REQUIRE(around.size() == 4);
  CHECK(around[0].first == around[3].first);
  CHECK(around[1].first == around[2].first);
  CHECK(around[0].second > around[3].second);
  CHECK(drawn_curves(tree).size() == 4);
}

TEST_CASE("a band has a gap where its upper bound is missing") {
  Plot plot{"k",
            "y",
            false,
            {{Series::Kind::band, "a", 0, {0, 1, 2, 3}, {0, 0, 0, 1}, {1, 1, sample::missing, 2}}}};
  CHECK(elements(drawn(plot), "polygon").size() == 2);
}

TEST_CASE("shades of a pipeline are told apart") {
  Plot plot{"k", "y", false, {}};
  for (int shade = 0; shade < 3; ++shade)
    plot.series.push_back({Series::Kind::line, "a", 0, {0, 1}, {0, 1}, {}, shade});
  const Tree tree = drawn(plot);
  const auto curves = drawn_curves(tree);
  REQUIRE(curves.size() == 3);
  CHECK(attribute(*curves[0], "stroke") == "#0072b2");
  CHECK(attribute(*curves[1], "stroke") != attribute(*curves[0], "stroke"));
  CHECK(attribute(*curves[2], "stroke") != attribute(*curves[1], "stroke"));
  CHECK(attribute(*curves[1], "stroke-dasharray") != attribute(*curves[2], "stroke-dasharray"));
}

TEST_CASE("a band without a name is drawn and has no entry in the legend") {
  const auto with_band = [](const std::string& name) {
    Figure figure{"id", "s", "T", "", Plot{"x", "y", false, {}}};
    std::get<Plot>(figure.content).series = {{Series::Kind::band, name, 0, {0, 1}, {1, 1}, {2, 2}},
                                             {Series::Kind::line, "mean", 0, {0, 1}, {1.5, 1.5}}};
    Report report;
    report.pipelines = {"p"};
    return drawn(figure, report);
  };
  const Tree named = with_band("band"), nameless = with_band("");
  CHECK(elements(named, "text").size() == elements(nameless, "text").size() + 1);
  CHECK_FALSE(elements(nameless, "polygon").empty());
}

TEST_CASE("a long legend has several rows within the drawing") {
  Plot plot = sample::plot(10, 5, false);
  for (Series& series : plot.series) series.name = "a pipeline with a rather long name";
  const Tree tree = drawn(plot);
  std::vector<double> rows;
  for (const Tree* text : elements(tree, "text")) {
    if (text->data() != "a pipeline with a rather long name") continue;
    CHECK(std::stod(attribute(*text, "x")) + text_width(text->data()) < 640);
    rows.push_back(std::stod(attribute(*text, "y")));
  }
  CHECK(rows.size() == 10);
  CHECK(rows.back() == rows.front() + 4 * 18);
  CHECK(rows.back() < std::stod(attribute(tree.get_child("svg"), "height")));
}

TEST_CASE("a logarithmic axis has powers of ten, and values that are not positive lie below it") {
  Plot plot{"k", "y", true, {{Series::Kind::line, "a", 0, {0, 1, 2}, {1e-3, 1e6, 0}}}};
  const Tree tree = drawn(plot);
  CHECK(has_text(tree, "10⁶"));
  CHECK(has_text(tree, "10⁰"));
  const auto points = points_of(*drawn_curves(tree).at(0));
  CHECK(points[2].second > 294);
}

TEST_CASE("words stand in place of numbers") {
  Plot plot{"budget", "y", false, {{Series::Kind::points, "a", 0, {0, 1}, {1, 2}}}};
  plot.x_names = {"ten", "twenty"};
  const Tree tree = drawn(plot);
  CHECK(has_text(tree, "ten"));
  CHECK(has_text(tree, "twenty"));
  CHECK_FALSE(has_text(tree, "0.5"));
  CHECK(elements(tree, "circle").size() == 3);  // one of them in the legend
}

TEST_CASE("pipelines beyond the number of colours are dashed") {
  Plot plot = sample::plot(10, 5, false);
  const Tree tree = drawn(plot);
  const auto curves = drawn_curves(tree);
  REQUIRE(curves.size() == 10);
  CHECK(attribute(*curves[0], "stroke") == attribute(*curves[8], "stroke"));
  CHECK(attribute(*curves[0], "stroke-dasharray") == "");
  CHECK(attribute(*curves[8], "stroke-dasharray") != "");
}

TEST_CASE("a projection shows six times, open edges dotted, empty sets in words") {
  const Tree tree = drawn(sample::projection());
  for (const std::string k : {"k = 0", "k = 2", "k = 4", "k = 6", "k = 8", "k = 11"})
    CHECK(has_text(tree, k));
  CHECK(has_text(tree, "Dotted edges: the set continues beyond the frame."));
  CHECK(has_text(tree, "second (proven empty from k = 6 on)"));
  CHECK(has_text(tree, "first"));
  CHECK(elements(tree, "polygon").size() == 9);
  std::size_t dotted = 0;
  for (const Tree* line : elements(tree, "line"))
    dotted += attribute(*line, "stroke-dasharray") == "1.5 4";
  CHECK(dotted == 1);
}

TEST_CASE("a projection shows no time at which all sets are empty") {
  Projection projection = sample::projection();
  for (std::size_t k : {1, 2, 9, 10, 11})
    for (Polygon& set : projection.frames[k].sets) set = {set.pipeline, {}, {}};
  const Tree tree = drawn(projection);
  for (const std::string k : {"k = 0", "k = 3", "k = 4", "k = 5", "k = 6", "k = 8"})
    CHECK(has_text(tree, k));
  CHECK(has_text(tree, "first (proven empty from k = 9 on)"));
  projection.frames[11] = sample::projection().frames[11];
  CHECK(has_text(drawn(projection), "second (proven empty from k = 6 on)"));
  for (SetFrame& frame : projection.frames)
    for (Polygon& set : frame.sets) set = {set.pipeline, {}, {}};
  CHECK(has_text(drawn(projection), "first (proven empty from k = 0 on)"));
}

TEST_CASE("sets that are points or segments are drawn") {
  Projection projection{
      "x", "y", {{0, 0, 1, 0, 1, {{0, {0.5}, {0.5}}, {1, {0.1, 0.9}, {0.1, 0.9}}}}}};
  const Tree tree = drawn(projection);
  CHECK(elements(tree, "circle").size() == 1);
  CHECK(elements(tree, "polygon").empty());
  std::size_t edges = 0;
  for (const Tree* line : elements(tree, "line"))
    edges += attribute(*line, "stroke-linecap") == "round";
  CHECK(edges == 1);
}

TEST_CASE("a plot whose range is given is cut off there") {
  Plot plot = Plot{"k", "x", false, {}};
  plot.series.push_back(
      {Series::Kind::band, "wide at times", 0, {0, 1, 2}, {-1, -100, -1}, {1, 100, 1}});
  CHECK_FALSE(has_text(drawn(plot), "0.5"));
  plot.range = {-1, 1};
  CHECK(has_text(drawn(plot), "0.5"));
  CHECK_FALSE(has_text(drawn(plot), "100"));
}

TEST_CASE("figures without anything in them are drawn") {
  CHECK_NOTHROW(drawn(Plot{}));
  CHECK_NOTHROW(drawn(Projection{}));
  CHECK_NOTHROW(drawn(Timeline{}));
  CHECK_NOTHROW(drawn(Intervals{}));
  CHECK_NOTHROW(drawn(Table{}));
}
