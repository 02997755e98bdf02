// SPDX-License-Identifier: GPL-3.0-or-later
// Drawings as trees of their elements.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include "experiments/report/drawing.hpp"
#include "experiments/report/svg.hpp"
#include "report/sample_reports.hpp"

namespace svg_tree {

using namespace cordon::report;

using Tree = boost::property_tree::ptree;

/// The drawing as a tree; throws if it is no XML.
inline Tree parsed(const std::string& svg) {
  std::istringstream stream(svg);
  Tree tree;
  boost::property_tree::read_xml(stream, tree);
  return tree;
}

inline void collect(const Tree& tree, const std::string& name, std::vector<const Tree*>& found) {
  for (const auto& [tag, child] : tree) {
    if (tag == name) found.push_back(&child);
    collect(child, name, found);
  }
}

inline std::vector<const Tree*> elements(const Tree& tree, const std::string& name) {
  std::vector<const Tree*> found;
  collect(tree, name, found);
  return found;
}

inline std::string attribute(const Tree& element, const std::string& name) {
  return element.get("<xmlattr>." + name, "");
}

inline std::vector<std::string> texts(const Tree& tree) {
  std::vector<std::string> out;
  for (const Tree* text : elements(tree, "text")) out.push_back(text->data());
  return out;
}

inline bool has_text(const Tree& tree, const std::string& text) {
  const std::vector<std::string> all = texts(tree);
  return std::find(all.begin(), all.end(), text) != all.end();
}

inline Tree drawn(const Figure& figure, const Report& report) {
  return parsed(svg_of(figure, report));
}

inline Tree drawn(decltype(Figure::content) content) {
  Report report = sample::every_kind();
  return drawn({"figure", "section", "title", "", std::move(content)}, report);
}

inline std::vector<Point> points_of(const Tree& element) {
  std::istringstream stream(attribute(element, "points"));
  std::vector<Point> points;
  Point point;
  char comma;
  while (stream >> point.first >> comma >> point.second) points.push_back(point);
  return points;
}

inline std::vector<const Tree*> drawn_curves(const Tree& tree) {
  return elements(tree, "polyline");
}

}  // namespace svg_tree
