// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/svg.hpp"

#include <sstream>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <doctest/doctest.h>

#include "experiments/report/drawing.hpp"
#include "report/sample_reports.hpp"

using namespace cordon::report;

namespace {

using Tree = boost::property_tree::ptree;

/// The drawing as a tree; throws if it is no XML.
Tree parsed(const std::string& svg) {
  std::istringstream stream(svg);
  Tree tree;
  boost::property_tree::read_xml(stream, tree);
  return tree;
}

void collect(const Tree& tree, const std::string& name, std::vector<const Tree*>& found) {
  for (const auto& [tag, child] : tree) {
    if (tag == name) found.push_back(&child);
    collect(child, name, found);
  }
}

std::vector<const Tree*> elements(const Tree& tree, const std::string& name) {
  std::vector<const Tree*> found;
  collect(tree, name, found);
  return found;
}

std::string attribute(const Tree& element, const std::string& name) {
  return element.get("<xmlattr>." + name, "");
}

std::vector<std::string> texts(const Tree& tree) {
  std::vector<std::string> out;
  for (const Tree* text : elements(tree, "text")) out.push_back(text->data());
  return out;
}

bool has_text(const Tree& tree, const std::string& text) {
  const std::vector<std::string> all = texts(tree);
  return std::find(all.begin(), all.end(), text) != all.end();
}

Tree drawn(const Figure& figure, const Report& report) { return parsed(svg_of(figure, report)); }

Tree drawn(decltype(Figure::content) content) {
  Report report = sample::every_kind();
  return drawn({"figure", "section", "title", "", std::move(content)}, report);
}

std::vector<Point> points_of(const Tree& element) {
  std::istringstream stream(attribute(element, "points"));
  std::vector<Point> points;
  Point point;
  char comma;
  while (stream >> point.first >> comma >> point.second) points.push_back(point);
  return points;
}

std::vector<const Tree*> drawn_curves(const Tree& tree) { return elements(tree, "polyline"); }

}  // namespace

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

TEST_CASE("thresholds have their names, and marks theirs where they do not cover each other") {
  Plot plot{"k", "y", false, {{Series::Kind::line, "a", 0, {0, 100}, {0, 1}}}};
  plot.thresholds = {{"bound", 0.5}, {"at infinity", cordon::infinity}};
  for (int i = 0; i < 5; ++i) plot.marks.push_back({50, "something happens " + std::to_string(i)});
  plot.marks.push_back({200, "outside"});
  const Tree tree = drawn(plot);
  CHECK(has_text(tree, "bound"));
  CHECK_FALSE(has_text(tree, "at infinity"));
  for (int i = 0; i < 5; ++i)
    CHECK(has_text(tree, "something happens " + std::to_string(i)) == (i < 3));
  CHECK_FALSE(has_text(tree, "outside"));
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

TEST_CASE("a timeline has a bar per span, from half a step before to half a step after") {
  Timeline timeline{{"only"},
                    {{0, 0, 3, Timeline::State::candidate},
                     {0, 4, 4, Timeline::State::excluded},
                     {0, 0, 4, Timeline::State::truth}},
                    {}};
  const Tree tree = drawn(timeline);
  std::vector<const Tree*> bars;
  for (const Tree* bar : elements(tree, "rect")) {
    if (std::stod(attribute(*bar, "height")) == 15) bars.push_back(bar);
  }
  REQUIRE(bars.size() == 2);
  CHECK(std::stod(attribute(*bars[0], "width")) ==
        doctest::Approx(4 * std::stod(attribute(*bars[1], "width"))).epsilon(0.01));
  for (const std::string text : {"only", "possible", "excluded", "true mode", "k"})
    CHECK(has_text(tree, text));
  CHECK_FALSE(has_text(tree, "monitored"));
}

TEST_CASE("intervals show their ends, a gap where there is one, and the verdict") {
  const Tree tree = drawn(sample::intervals());
  for (const std::string text : {"model 1  [−1.25, 0.5]", "model 2  [0.75, 3]", "model 1  [−∞, 2]",
                                 "proven disjoint", "overlap"}) {
    CHECK(has_text(tree, text));
  }
  std::size_t gaps = 0;
  for (const Tree* bar : elements(tree, "rect")) gaps += attribute(*bar, "fill") == "#009e73";
  CHECK(gaps == 1);
}

TEST_CASE("a table has all its cells, the best ones bold and shaded") {
  const Tree tree = drawn(sample::table());
  CHECK(elements(tree, "text").size() == 12);
  std::size_t bold = 0, shaded = 0;
  for (const Tree* text : elements(tree, "text")) bold += attribute(*text, "font-weight") == "bold";
  for (const Tree* rectangle : elements(tree, "rect"))
    shaded += attribute(*rectangle, "fill") == "#0072b2";
  CHECK(bold == 1);
  CHECK(shaded == 2);
}

TEST_CASE("a long cell of a table is broken, not cut") {
  std::string text;
  for (int i = 0; i < 30; ++i) text += (i > 0 ? " × " : "") + std::string("[-0.1717, 0.25]");
  const Tree tree = drawn(Table{{"residual", "holds"}, {{{text}, {"yes"}}, {{"none"}, {"no"}}}});
  std::string shown;
  for (const std::string& line : texts(tree)) shown += line + ' ';
  CHECK(shown.find("…") == std::string::npos);
  std::size_t boxes = 0;
  for (std::size_t at = 0; (at = shown.find("[-0.1717,", at)) != std::string::npos; ++at) ++boxes;
  CHECK(boxes == 30);
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
