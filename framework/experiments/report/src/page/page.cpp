// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/page.hpp"

#include <initializer_list>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "experiments/report/drawing.hpp"
#include "experiments/report/page_data.hpp"
#include "experiments/report/svg.hpp"
#include "page/assets.hpp"

namespace cordon::report {

namespace {

using page::Asset;

const std::initializer_list<const Asset*> scripts = {
    &page::chart_js, &page::parts_js, &page::plot_js, &page::projection_js, &page::report_js};

/// A hexadecimal number in base 64, as a policy of the page wants it.
std::string base_64(std::string_view hex) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  int count = 0;
  for (const char c : hex) {
    bits = bits << 4 | static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10);
    count += 4;
    if (count < 6) continue;
    count -= 6;
    out += digits[bits >> count & 63];
  }
  if (count > 0) out += digits[bits << (6 - count) & 63];
  while (out.size() % 4 != 0) out += '=';
  return out;
}

std::string hash_of(const Asset& asset) {
  return fmt::format("'sha256-{}'", base_64(asset.sha256));
}

/// Drawings that are the same in the page as on paper; they wait in templates for their place.
std::string drawings_of(const Report& report) {
  std::string out;
  for (const Figure& figure : report.figures) {
    if (!std::holds_alternative<Timeline>(figure.content) &&
        !std::holds_alternative<Intervals>(figure.content))
      continue;
    out += fmt::format("<template id=\"drawing_{}\">{}</template>\n", escaped(figure.id),
                       svg_of(figure, report));
  }
  return out;
}

/// `text` with {{NAME}} replaced by the part of that name. What is put in is not looked at again.
std::string filled(std::string_view text,
                   const std::map<std::string, std::string, std::less<>>& parts) {
  std::string out;
  for (;;) {
    const std::size_t begin = text.find("{{"), end = text.find("}}", begin);
    out += text.substr(0, begin);
    if (begin == std::string_view::npos) return out;
    const auto part = parts.find(text.substr(begin + 2, end - begin - 2));
    if (part == parts.end())
      throw Error(Errc::internal,
                  "the page has no such part: " + std::string(text.substr(begin, 40)));
    out += part->second;
    text.remove_prefix(end + 2);
  }
}

}  // namespace

std::string page_of(const Report& report) {
  std::string hashes, elements;
  for (const Asset* script : scripts) {
    hashes += fmt::format("{}{}", hashes.empty() ? "" : " ", hash_of(*script));
    elements += fmt::format("<script>{}</script>\n", script->text);
  }
  return filled(page::report_html.text, {{"title", escaped(report.title)},
                                         {"style", std::string(page::report_css.text)},
                                         {"style_hashes", hash_of(page::report_css)},
                                         {"script_hashes", hashes},
                                         {"scripts", elements},
                                         {"chart_licence", escaped(page::chart_licence.text)},
                                         {"drawings", drawings_of(report)},
                                         {"data", page_data(report)}});
}

}  // namespace cordon::report
