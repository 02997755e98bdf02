// SPDX-License-Identifier: GPL-3.0-or-later
#include "tables/latex_table.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "study/results/table_text.hpp"

namespace cordon::detail {

namespace {

/// A number of a comparison table, which consists of digits and a few marks, in the mathematics of
/// LaTeX.
std::string latex_number(std::string_view text, bool best) {
  if (text == "–") return "--";
  std::string out;
  bool exponent = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view rest = text.substr(i);
    const auto takes = [&](std::string_view what) {
      if (!rest.starts_with(what)) return false;
      i += what.size() - 1;
      return true;
    };
    if (exponent && !(text[i] >= '0' && text[i] <= '9')) {
      out += '}';
      exponent = false;
    }
    if (takes("e+") || takes("e-")) {
      out += text[i] == '-' ? "\\cdot10^{-" : "\\cdot10^{";
      exponent = true;
      while (i + 2 < text.size() && text[i + 1] == '0') ++i;
    } else if (takes("±")) {
      out += "\\pm";
    } else if (takes("∞")) {
      out += "\\infty";
    } else if (takes(" †")) {
      out += "^{\\dagger}";
    } else if (takes(" %")) {
      out += "\\,\\%";
    } else {
      out += text[i];
    }
  }
  if (exponent) out += '}';
  return fmt::format(fmt::runtime(best ? "$\\mathbf{{{}}}$" : "${}$"), out);
}

/// The title as a label: letters and digits, everything else as single hyphens.
std::string label_of(std::string_view title) {
  std::string label;
  for (const char c : title) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain) {
      label += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    } else if (!label.empty() && label.back() != '-') {
      label += '-';
    }
  }
  while (label.ends_with('-')) label.pop_back();
  return label.empty() ? "results" : label;
}

/// The first cell of a row: a bracket or star would be an argument of the command before it, across
/// spaces and lines.
std::string first_latex_cell(std::string text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first != std::string::npos && (text[first] == '[' || text[first] == '*') ? "{}" + text
                                                                                  : text;
}

/// The two lines of a heading.
struct Heading {
  std::string first, second;
  std::size_t columns = 1;
};

/// Where the space after the first word is, of which a percent sign is part.
std::size_t after_first_word(std::string_view title) {
  const std::size_t space = title.find(' ');
  return space != std::string::npos && title.substr(space).starts_with(" %")
             ? title.find(' ', space + 1)
             : space;
}

/// Long titles of numbers take two lines, and a measure spans the multiples of the best beside it:
/// a page is narrow.
std::vector<Heading> headings_of(const ComparisonTable& table) {
  std::vector<Heading> headings;
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    const ComparisonColumn& column = table.columns[j];
    const bool spans = j + 1 < table.columns.size() && table.columns[j + 1].relative;
    const std::size_t middle =
        column.number && !spans ? after_first_word(column.title) : std::string::npos;
    if (column.relative) {
      headings.push_back({"", latex_text(column.title), 0});
    } else if (middle != std::string::npos) {
      headings.push_back({latex_text(column.title.substr(0, middle)),
                          latex_text(column.title.substr(middle + 1))});
    } else {
      headings.push_back({latex_text(column.title), "", spans ? 2U : 1U});
    }
  }
  return headings;
}

std::string heading_text(const ComparisonTable& table) {
  const std::vector<Heading> headings = headings_of(table);
  std::string first = "    ", rules = "    ", second = "    ";
  for (std::size_t j = 0; j < headings.size(); ++j) {
    const Heading& heading = headings[j];
    second += (j > 0 ? " & " : "") + heading.second;
    if (heading.columns == 0) continue;
    first += j > 0 ? " & " : "";
    if (heading.columns == 2) {
      first += "\\multicolumn{2}{c}{" + heading.first + "}";
      rules += fmt::format("\\cmidrule(lr){{{}-{}}}", j + 1, j + 2);
    } else {
      first += j == 0 ? first_latex_cell(heading.first) : heading.first;
    }
  }
  const bool has_second = std::any_of(headings.begin(), headings.end(),
                                      [](const Heading& h) { return !h.second.empty(); });
  std::string text = first + " \\\\\n";
  if (rules.size() > 4) text += rules + "\n";
  return has_second ? text + second + " \\\\\n" : text;
}

}  // namespace

void write_latex(Sink& file, const std::string& title, const ComparisonTable& table) {
  std::string caption = latex_text(title);
  if (!caption.ends_with('.') && !caption.ends_with('?') && !caption.ends_with('!')) caption += '.';
  for (const std::string& note : table.notes) caption.append(" ").append(latex_text(note));
  file.write(
      "% Needs \\usepackage{booktabs,graphicx}; in two-column papers table* in place of table. "
      "Shrunk where it is wider than the "
      "text.\n\\begin{table}\n  \\centering\\footnotesize\\setlength{\\tabcolsep}{4pt}\n");
  file.write("  \\caption{" + caption + "}\n  \\label{tab:" + label_of(title) + "}\n");
  file.write(
      "  \\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n  "
      "\\begin{tabular}{");
  for (const ComparisonColumn& column : table.columns) file.write(column.number ? "r" : "l");
  file.write("}\n    \\toprule\n" + heading_text(table));
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (std::find(table.groups.begin(), table.groups.end(), i) != table.groups.end())
      file.write("    \\midrule\n");
    std::string line = "    ";
    for (std::size_t j = 0; j < table.columns.size(); ++j) {
      const ComparisonCell& cell = table.rows[i][j];
      line += j > 0 ? " & " : "";
      const std::string text =
          table.columns[j].number ? latex_number(cell.text, cell.best) : latex_text(cell.text);
      line += j == 0 ? first_latex_cell(text) : text;
    }
    file.write(line + " \\\\\n");
  }
  file.write("    \\bottomrule\n  \\end{tabular}}\n\\end{table}\n");
}

}  // namespace cordon::detail
