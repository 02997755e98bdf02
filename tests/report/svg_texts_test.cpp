// SPDX-License-Identifier: GPL-3.0-or-later
// Marks, timelines, intervals and tables as drawings: where their texts stand.
#include <algorithm>

#include <doctest/doctest.h>

#include "report/svg_tree.hpp"

using namespace cordon::report;
using namespace svg_tree;

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

TEST_CASE("texts of lines a few steps apart stand on both sides of them") {
  Plot plot{"k", "y", false, {{Series::Kind::line, "a", 0, {0, 100}, {0, 1}}}};
  plot.marks = {{50, "detected: departure from healthy"}, {51, "isolated: leak in tank 2"}};
  const Tree tree = drawn(plot);
  std::vector<double> lines;
  for (const Tree* line : elements(tree, "line")) {
    if (attribute(*line, "stroke-dasharray") == "3 3")
      lines.push_back(std::stod(attribute(*line, "x1")));
  }
  REQUIRE(lines.size() == 2);
  std::vector<const Tree*> found;
  for (const Tree* text : elements(tree, "text")) {
    if (text->data().find(": ") == std::string::npos) continue;
    found.push_back(text);
    CHECK(attribute(*text, "paint-order") == "stroke");
  }
  REQUIRE(found.size() == 2);
  CHECK(attribute(*found[0], "y") == attribute(*found[1], "y"));
  CHECK(attribute(*found[0], "text-anchor") == "end");
  CHECK(std::stod(attribute(*found[0], "x")) < lines[0]);
  CHECK(attribute(*found[1], "text-anchor") == "");
  CHECK(std::stod(attribute(*found[1], "x")) > lines[1]);
}

TEST_CASE("small marks are triangles at the axis, those of pipelines above each other") {
  Plot plot{"k", "y", false, {{Series::Kind::line, "a", 0, {0, 100}, {0, 1}}}};
  plot.marks = {{50, "begun anew", 0, true}, {50, "begun anew", 1, true}};
  const Tree tree = drawn(plot);
  const auto triangles = elements(tree, "polygon");
  REQUIRE(triangles.size() == 3);  // one of them in the legend
  const auto first = points_of(*triangles[0]), second = points_of(*triangles[1]);
  CHECK(first[0].second == 294);
  CHECK(second[0].second == first[2].second);
  CHECK(first[2].first == second[2].first);
  CHECK(attribute(*triangles[0], "fill") != attribute(*triangles[1], "fill"));
  const std::vector<std::string> all = texts(tree);
  CHECK(std::count(all.begin(), all.end(), "begun anew") == 1);
}

TEST_CASE("a timeline has a bar per span, from its first sample to the one after its last") {
  Timeline timeline{{"only"},
                    {{0, 0, 3, Timeline::State::candidate},
                     {0, 4, 4, Timeline::State::excluded},
                     {0, 0, 4, Timeline::State::truth}},
                    {{4, "excluded at 4"}}};
  const Tree tree = drawn(timeline);
  std::vector<const Tree*> bars;
  for (const Tree* bar : elements(tree, "rect")) {
    if (std::stod(attribute(*bar, "height")) == 15) bars.push_back(bar);
  }
  REQUIRE(bars.size() == 2);
  CHECK(std::stod(attribute(*bars[0], "width")) ==
        doctest::Approx(4 * std::stod(attribute(*bars[1], "width"))).epsilon(0.01));
  std::vector<std::string> marked;  // where the vertical line of the mark is
  for (const Tree* line : elements(tree, "line")) {
    if (attribute(*line, "stroke-dasharray") == "3 3") marked.push_back(attribute(*line, "x1"));
  }
  CHECK(marked == std::vector{attribute(*bars[1], "x")});
  const Tree* frame = nullptr;
  for (const Tree* box : elements(tree, "rect")) {
    if (attribute(*box, "stroke") == "#8a94a5") frame = box;
  }
  REQUIRE(frame);
  CHECK(attribute(*frame, "x") == attribute(*bars[0], "x"));
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

TEST_CASE("a table of many columns is no wider than other figures, and its numbers stay whole") {
  const std::string sentence =
      "initial set of 0 lines, 3 generators, 0 constraints; outputs of 12 samples not keeping to V";
  Table table{{"Pipeline"}, {{{"constrained zonotopes"}}}};
  for (int i = 0; i < 9; ++i) {
    table.header.push_back("Proven not empty");
    table.rows[0].push_back({"1.500 ± 0.01", false, 0, true});
  }
  table.header.push_back("Assumed");
  table.rows[0].push_back({sentence});
  table.rows[0].front().text = "constrained_zonotope";
  const Tree tree = drawn(table);
  CHECK(std::stod(attribute(tree.get_child("svg"), "width")) <= 1100);
  const std::vector<std::string> all = texts(tree);
  CHECK(std::count(all.begin(), all.end(), "1.500 ± 0.01") == 9);
  CHECK(has_text(tree, "constrained_"));
  CHECK_FALSE(has_text(tree, "Proven not empty"));
  table.header.resize(2);
  table.rows[0].resize(2);
  CHECK(has_text(drawn(table), "Proven not empty"));
  CHECK(has_text(drawn(table), "constrained_zonotope"));
}

TEST_CASE("pictures of sets have three ticks across where their texts have room") {
  const auto ticks = [](double left, double right) {
    Projection projection{"x", "y", {{0, left, right, 0, 1, {{0, {left, right}, {0, 1}}}}}};
    const Tree tree = drawn(projection);
    std::vector<double> places;
    double before = -1e9;
    for (const Tree* text : elements(tree, "text")) {
      const bool below =
          attribute(*text, "text-anchor") == "middle" && attribute(*text, "class") == "soft";
      if (!below) continue;
      const double place = std::stod(attribute(*text, "x")), half = text_width(text->data()) / 2;
      CHECK(place - half > before);
      before = place + half;
      CHECK(before <= std::stod(attribute(tree.get_child("svg"), "width")));
      places.push_back(place);
    }
    return places.size();
  };
  CHECK(ticks(-0.0063123, 0.0112345) >= 3);
  CHECK(ticks(-0.0351234, -0.0151234) >= 3);
  CHECK(ticks(0, 1) >= 3);
  CHECK(ticks(1e6 - 1e-3, 1e6 + 1e-3) >= 1);
}

TEST_CASE("a note stands below the legend") {
  Plot plot{"x", "y", false, {{Series::Kind::line, "a", 0, {0, 100}, {0, 1}}}};
  const auto height = [&] { return std::stod(attribute(drawn(plot).get_child("svg"), "height")); };
  const double without = height();
  plot.note = "Lines: means.";
  CHECK(has_text(drawn(plot), "Lines: means."));
  CHECK(height() == without + 18);
}
