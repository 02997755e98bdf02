// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/page_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "page/palette.hpp"
#include "page/svg_parts.hpp"
#include "study/text/json_writer.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::report {

namespace {

using detail::JsonWriter;

std::string rounded(double value, int digits) {
  if (std::isnan(value)) return "null";
  if (std::isinf(value)) return value > 0 ? "\"inf\"" : "\"-inf\"";
  if (std::abs(value) < 1e15 && value == std::floor(value))
    return fmt::format("{:.0f}", value == 0 ? 0.0 : value);
  return fmt::format("{:.{}g}", value, digits);
}

/// The same, never above or never below the value.
std::string rounded(double value, int digits, Rounding rounding) {
  std::string text = rounded(value, digits);
  if (rounding == Rounding::nearest || !std::isfinite(value)) return text;
  const auto fits = [&] {
    return rounding == Rounding::down ? std::strtod(text.c_str(), nullptr) <= value
                                      : std::strtod(text.c_str(), nullptr) >= value;
  };
  if (fits()) return text;
  const double half = std::pow(10.0, std::floor(std::log10(std::abs(value))) - digits + 1) / 2;
  text = fmt::format("{:.{}g}", rounding == Rounding::down ? value - half : value + half, digits);
  return fits() ? text : fmt::format("{}", value);
}

/// Digits that show the differences between values, where these are small beside the values.
int digits_of(const std::vector<double>& values) {
  double lower = INFINITY, upper = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  const double spread = upper - lower, size = std::max(std::abs(lower), std::abs(upper));
  if (!(spread > 0) || !std::isfinite(spread)) return 6;
  return std::clamp(6 + static_cast<int>(std::ceil(std::log10(size / spread))), 6, 17);
}

bool has_equal_steps(const std::vector<double>& values) {
  if (values.size() < 4) return false;
  const double by = values[1] - values[0];
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(std::abs(values[i]) < 1e15) || values[i] != std::floor(values[i])) return false;
    if (i > 0 && values[i] - values[i - 1] != by) return false;
  }
  return true;
}

void write_texts(JsonWriter& json, const std::vector<std::string>& texts) {
  json.begin_array();
  for (const std::string& text : texts) json.value(text);
  json.end_array();
}

void write_numbers(JsonWriter& json, const Numbers& numbers) {
  json.begin_object().key("header");
  write_texts(json, numbers.header);
  json.key("rows").begin_array();
  for (const auto& row : numbers.rows) write_texts(json, row);
  json.end_array().end_object();
}

std::string_view name_of(Series::Kind kind) {
  switch (kind) {
    case Series::Kind::band:
      return "band";
    case Series::Kind::points:
      return "points";
    case Series::Kind::steps:
      return "steps";
    case Series::Kind::line:
      break;
  }
  return "line";
}

void write(JsonWriter& json, const Plot& plot) {
  json.key("plot")
      .begin_object()
      .member("x_label", plot.x_label)
      .member("y_label", plot.y_label)
      .member("log_y", plot.log_y);
  json.key("x_names");
  write_texts(json, plot.x_names);
  json.key("series").begin_array(JsonWriter::Layout::lines);
  for (const Series& series : plot.series) {
    json.begin_object()
        .member("kind", name_of(series.kind))
        .member("name", series.name)
        .member("pipeline", series.pipeline);
    const bool band = series.kind == Series::Kind::band;  // which encloses what it shows
    json.member("shade", series.shade).key("x").raw(packed_numbers(series.x));
    json.key("y").raw(packed_numbers(series.y, band ? Rounding::down : Rounding::nearest));
    json.key("upper")
        .raw(packed_numbers(series.upper, band ? Rounding::up : Rounding::nearest))
        .end_object();
  }
  json.end_array().key("thresholds").begin_array();
  for (const auto& [name, value] : plot.thresholds) {
    if (std::isfinite(value))
      json.begin_object().member("name", name).member("value", value).end_object();
  }
  json.end_array().key("range").begin_array();
  if (plot.range) json.value(plot.range->first).value(plot.range->second);
  json.end_array().key("marks").begin_array();
  for (const Mark& mark : plot.marks) {
    if (!std::isfinite(mark.x)) continue;
    json.begin_object()
        .member("x", mark.x)
        .member("text", mark.text)
        .member("pipeline", mark.pipeline);
    if (mark.small) json.member("small", true);
    json.end_object();
  }
  json.end_array().end_object();
}

/// With all digits that the number has.
std::string with_all_digits(double value) {
  return std::isfinite(value) ? fmt::format("{}", value + 0.0) : rounded(value, 17);
}

/// Coordinates in a frame: what its drawing can show, and no more.
std::string coordinates(const std::vector<double>& values, double span) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(5 - std::log10(span))), 0, 300);
  std::string out = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out += ',';
    const double scale = std::pow(10.0, decimals), whole = std::round(values[i] * scale);
    out += with_all_digits(std::isfinite(whole) ? whole / scale : values[i]);
  }
  return out + ']';
}

void write(JsonWriter& json, const Projection& projection) {
  json.key("projection")
      .begin_object()
      .member("x_label", projection.x_label)
      .member("y_label", projection.y_label);
  json.key("frames").begin_array(JsonWriter::Layout::lines);
  for (const SetFrame& frame : projection.frames) {
    json.begin_object()
        .member("k", frame.k)
        .member("left", frame.left)
        .member("right", frame.right);
    if (!frame.time.empty()) json.member("time", frame.time);
    json.member("bottom", frame.bottom).member("top", frame.top).key("sets").begin_array();
    for (const Polygon& set : frame.sets) {
      json.begin_object()
          .member("pipeline", set.pipeline)
          .key("x")
          .raw(coordinates(set.x, frame.right - frame.left));
      json.key("y").raw(coordinates(set.y, frame.top - frame.bottom)).key("open").begin_array();
      if (std::find(set.open.begin(), set.open.end(), true) != set.open.end()) {
        for (const bool open : set.open) json.value(open ? 1 : 0);
      }
      json.end_array().end_object();
    }
    json.end_array().key("truth");
    if (frame.truth && std::isfinite(frame.truth->first) && std::isfinite(frame.truth->second)) {
      json.begin_array().value(frame.truth->first).value(frame.truth->second).end_array();
    } else {
      json.null();
    }
    json.end_object();
  }
  json.end_array().end_object();
}

void write(JsonWriter& json, const Table& table) {
  json.key("table").begin_object().key("header");
  write_texts(json, table.header);
  json.key("rows").begin_array(JsonWriter::Layout::lines);
  for (const auto& row : table.rows) {
    json.begin_array();
    for (const Table::Cell& cell : row) {
      json.begin_object().member("text", cell.text);
      if (cell.best) json.member("best", true);
      if (cell.share > 0) json.key("share").raw(rounded(std::min(1.0, cell.share), 3));
      if (cell.number) json.member("number", true);
      json.end_object();
    }
    json.end_array();
  }
  json.end_array().end_object();
}

void write(JsonWriter& json, const Timeline& timeline) {
  json.key("numbers");
  write_numbers(json, numbers_of(timeline));
}

void write(JsonWriter& json, const Intervals& intervals) {
  json.key("numbers");
  write_numbers(json, numbers_of(intervals));
}

constexpr std::string_view kinds[] = {"plot", "projection", "timeline", "intervals", "table"};

void write_colours(JsonWriter& json, std::string_view name,
                   const std::array<std::string_view, 8>& colours) {
  json.key(name).begin_array();
  for (const std::string_view colour : colours) json.value(colour);
  json.end_array();
}

}  // namespace

std::string packed_numbers(const std::vector<double>& values, Rounding rounding) {
  if (has_equal_steps(values)) {
    return fmt::format(R"({{"from":{:.0f},"by":{:.0f},"count":{}}})", values[0],
                       values[1] - values[0], values.size());
  }
  const int digits = digits_of(values);
  std::string out = "[";
  for (std::size_t i = 0; i < values.size(); ++i)
    out += fmt::format("{}{}", i > 0 ? "," : "", rounded(values[i], digits, rounding));
  return out + ']';
}

namespace {
std::string plain_text(double value) { return fmt::format("{:.6g}", value); }
}  // namespace

Numbers numbers_of(const Timeline& timeline) {
  Numbers numbers{{"row", "from " + timeline.x_label, "to " + timeline.x_label, "state"}, {}};
  for (const Timeline::Span& span : timeline.spans) {
    numbers.rows.push_back({timeline.rows.at(span.row), plain_text(span.from), plain_text(span.to),
                            std::string(name_of(span.state))});
  }
  for (const Mark& mark : timeline.marks)
    numbers.rows.push_back({"", plain_text(mark.x), "", mark.text});
  return numbers;
}

Numbers numbers_of(const Intervals& intervals) {
  Numbers numbers{{"row", "of", "from", "to", "of", "from", "to", "verdict"}, {}};
  for (const Intervals::Row& row : intervals.rows) {
    numbers.rows.push_back({row.name, row.first, plain_text(row.first_lower),
                            plain_text(row.first_upper), row.second, plain_text(row.second_lower),
                            plain_text(row.second_upper), row.verdict});
  }
  return numbers;
}

std::string page_data(const Report& report) {
  detail::StringSink sink;
  JsonWriter json(sink);
  json.begin_object(JsonWriter::Layout::lines).member("title", report.title).key("pipelines");
  write_texts(json, report.pipelines);
  json.key("palette").begin_object();
  write_colours(json, "light", on_white);
  write_colours(json, "dark", on_black);
  json.end_object().key("notes");
  write_texts(json, report.notes);
  json.key("figures").begin_array(JsonWriter::Layout::lines);
  for (const Figure& figure : report.figures) {
    json.begin_object()
        .member("id", figure.id)
        .member("section", figure.section)
        .member("title", figure.title);
    json.member("caption", figure.caption)
        .member("pipeline", figure.pipeline)
        .member("kind", kinds[figure.content.index()]);
    std::visit([&](const auto& content) { write(json, content); }, figure.content);
    json.end_object();
  }
  json.end_array().key("versions").begin_array();
  for (const auto& [name, value] : report.versions)
    json.begin_array().value(name).value(value).end_array();
  json.end_array().member("study", report.study).end_object();

  // Inside a `script` element, `<` is the only character that could end it.
  std::string out;
  for (const char c : sink.text) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace cordon::report
