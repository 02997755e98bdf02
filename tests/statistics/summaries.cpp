// SPDX-License-Identifier: GPL-3.0-or-later
// The tables as files: what stands in them, and that names cannot break them.
#include "study/results/summaries.hpp"

#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/text.hpp"
#include "run/scratch.hpp"
#include "study/results/table_text.hpp"
#include "study/text/string_sink.hpp"
#include "table.hpp"

using namespace cordon;
using detail::AtomicDirectory;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity(),
                 none = std::numeric_limits<double>::quiet_NaN();

/// All files of a sweep.
std::map<std::string, std::string> written(const ResultTable& table) {
  const Scratch scratch;
  AtomicDirectory directory(scratch.path());
  detail::write_summaries(directory, table, summarise(table));
  directory.commit();
  return tree(scratch.path());
}

ResultTable two_budgets() {
  ResultTable table = tables::sweep();
  table.columns = {
      {"radius_mean", false}, {"wall_s", true}, {"step_us", true}, {"generators_max", false}};
  table.rows = {{0, {0, 0}, {1, .5, 20, 30}, ""},
                {1, {0, 0}, {2, .25, 10, none}, ""},
                {0, {0, 1}, {2, .5, 40, 30}, ""},
                {1, {0, 1}, {4, .25, 10, none}, ""},
                {0, {1, 0}, {1.5e-7, .5, 20, 40}, ""},
                {1, {1, 0}, {inf, .25, 10, none}, ""},
                {0, {1, 1}, {1.5e-7, none, 20, 40}, ""},
                {1, {1, 1}, {none, .25, 10, none}, "over, \"the\" limit"}};
  return table;
}

}  // namespace

TEST_CASE("the files of a sweep") {
  const auto files = written(two_budgets());
  REQUIRE(files.size() == 5);
  CHECK(files.at("summary.csv") ==
        "pipeline,budget,measure,points,failed,count,infinite,mean,deviation,min,q05,q25,median,"
        "q75,q95,max,relative\n"
        "first,10,radius_mean,2,0,2,0,1.5,0.7071067811865476,1,1.05,1.25,1.5,1.75,1.95,2,1\n"
        "first,10,generators_max,2,0,2,0,30,0,30,30,30,30,30,30,30,\n"
        "second,10,radius_mean,2,0,2,0,3,1.4142135623730951,2,2.1,2.5,3,3.5,3.9,4,2\n"
        "first,20,radius_mean,2,0,2,0,1.5e-07,0,1.5e-07,1.5e-07,1.5e-07,1.5e-07,1.5e-07,1.5e-07,1."
        "5e-07,1\n"
        "first,20,generators_max,2,0,2,0,40,0,40,40,40,40,40,40,40,\n"
        "second,20,radius_mean,2,1,0,1,,,,,,,,,,\n");
  CHECK(files.at("times.csv") ==
        "pipeline,budget,measure,points,failed,count,infinite,mean,deviation,min,q05,q25,median,"
        "q75,q95,max,relative\n"
        "first,10,wall_s,2,0,2,0,0.5,0,0.5,0.5,0.5,0.5,0.5,0.5,0.5,2\n"
        "first,10,step_us,2,0,2,0,30,14.142135623730951,20,21,25,30,35,39,40,3\n"
        "second,10,wall_s,2,0,2,0,0.25,0,0.25,0.25,0.25,0.25,0.25,0.25,0.25,1\n"
        "second,10,step_us,2,0,2,0,10,0,10,10,10,10,10,10,10,1\n"
        "first,20,wall_s,2,0,1,0,0.5,0,0.5,0.5,0.5,0.5,0.5,0.5,0.5,\n"
        "first,20,step_us,2,0,2,0,20,0,20,20,20,20,20,20,20,1\n"
        "second,20,wall_s,2,1,1,0,0.25,0,0.25,0.25,0.25,0.25,0.25,0.25,0.25,\n"
        "second,20,step_us,2,1,1,0,10,0,10,10,10,10,10,10,10,\n");
  CHECK(files.at("benchmarks.csv") ==
        "benchmark,instance,result,time\n"
        "Budgets,\"first budget=10,seed=1\",1,0.5\n"
        "Budgets,\"second budget=10,seed=1\",1,0.25\n"
        "Budgets,\"first budget=10,seed=2\",1,0.5\n"
        "Budgets,\"second budget=10,seed=2\",1,0.25\n"
        "Budgets,\"first budget=20,seed=1\",1,0.5\n"
        "Budgets,\"second budget=20,seed=1\",1,0.25\n"
        "Budgets,\"first budget=20,seed=2\",1,\n"
        "Budgets,\"second budget=20,seed=2\",,0.25\n");
}

TEST_CASE("the tables of a sweep as they are printed") {
  const auto files = written(two_budgets());
  CHECK(
      files.at("summary.md") ==
      "## Budgets\n\n"
      "| budget | pipeline | mean radius | × best | used generators | µs/step | × best | failed |\n"
      "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n"
      "| 10 | first | **1.500 ± 0.71** | 1 | 30 | 30 ± 14 | 3 | 0/2 |\n"
      "| 10 | second | 3 ± 1.4 | 2 | – | **10** | 1 | 0/2 |\n"
      "| 20 | first | 1.500e-07 | 1 | 40 | 20 | 1 | 0/2 |\n"
      "| 20 | second | ∞ | – | – | 10 | – | 1/2 |\n"
      "\nMean ± standard deviation over up to 2 repetitions.\n");
  CHECK(files.at("summary.tex") ==
        "% Needs \\usepackage{booktabs,graphicx}; in two-column papers table* in place of table. "
        "Shrunk where it is wider than the "
        "text.\n"
        "\\begin{table}\n"
        "  \\centering\\footnotesize\\setlength{\\tabcolsep}{4pt}\n"
        "  \\caption{Budgets. Mean $\\pm$ standard deviation over up to 2 repetitions.}\n"
        "  \\label{tab:budgets}\n"
        "  \\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n"
        "  \\begin{tabular}{llrrrrrr}\n"
        "    \\toprule\n"
        "    budget & pipeline & \\multicolumn{2}{c}{mean radius} & used & "
        "\\multicolumn{2}{c}{$\\mu$s/step} & failed \\\\\n"
        "    \\cmidrule(lr){3-4}\\cmidrule(lr){6-7}\n"
        "     &  &  & $\\times$ best & generators &  & $\\times$ best &  \\\\\n"
        "    \\midrule\n"
        "    10 & first & $\\mathbf{1.500 \\pm 0.71}$ & $1$ & $30$ & $30 \\pm 14$ & $3$ & $0/2$ "
        "\\\\\n"
        "    10 & second & $3 \\pm 1.4$ & $2$ & -- & $\\mathbf{10}$ & $1$ & $0/2$ \\\\\n"
        "    \\midrule\n"
        "    20 & first & $1.500\\cdot10^{-7}$ & $1$ & $40$ & $20$ & $1$ & $0/2$ \\\\\n"
        "    20 & second & $\\infty$ & -- & -- & $10$ & -- & $1/2$ \\\\\n"
        "    \\bottomrule\n"
        "  \\end{tabular}}\n"
        "\\end{table}\n");
}

TEST_CASE("verdicts: what was claimed held, did not hold, or is not known") {
  ResultTable table;
  table.title = "Verdicts";
  table.columns = {{"violated_at", false}, {"inner_outside", false}, {"inconsistent", false},
                   {"horizon", false},     {"separates", false},     {"wall_s", true},
                   {"infeasible", false}};
  const auto add = [&](std::vector<double> values, double infeasible = none) {
    values.push_back(infeasible);
    table.pipelines.push_back("p" + std::to_string(table.rows.size()));
    table.rows.push_back({table.rows.size(), {}, std::move(values), ""});
  };
  add({none, none, 0, none, none, 1});
  add({7, none, 0, none, none, 1});
  add({none, 0, 0, none, none, 1});
  add({none, none, 3, none, none, 1});
  add({none, none, none, 3, 1, 1});
  add({none, none, none, 3, 0, 1});
  add({none, none, none, 3, none, 1});
  add({5, none, none, 3, 1, 1});
  add({none, none, none, 3, none, 1}, 1);
  add({none, none, none, 3, 1, 1}, 0);
  CHECK(written(table).at("benchmarks.csv") ==
        "benchmark,instance,result,time\n"
        "Verdicts,p0,1,1\nVerdicts,p1,0,1\nVerdicts,p2,0,1\nVerdicts,p3,0,1\nVerdicts,p4,1,"
        "1\nVerdicts,p5,0,1\nVerdicts,p6,,"
        "1\nVerdicts,p7,0,1\nVerdicts,p8,infeasible,1\nVerdicts,p9,1,1\n");
}

TEST_CASE("shares are per cents, and marks are mathematics") {
  ResultTable table;
  table.title = "Marks";
  table.measures = tables::told();
  table.pipelines = {"a", "b"};
  table.columns = {
      {"radius_mean", false}, {"contains_truth_share", false}, {"inconsistent_from", false}};
  table.rows = {{0, {}, {1, .5, 3}, ""}, {1, {}, {inf, 1, none}, ""}};
  const std::string tex = written(table).at("summary.tex");
  CHECK(tex.find(" a & $1^{\\dagger}$ & -- & $50\\,\\%^{\\dagger}$ \\\\\n") != std::string::npos);
  CHECK(tex.find(" b & $\\infty$ & -- & $100\\,\\%$ \\\\\n") != std::string::npos);
  CHECK(tex.find("$\\dagger$: an estimate was proven empty") != std::string::npos);
}

TEST_CASE("names that try to break out") {
  ResultTable table = two_budgets();
  table.title = "50 % of A_1 & {B} \\input{x} <script>é";
  table.pipelines = {"=HYPERLINK(\"x\"),|`*_", "-1.5"};
  table.axes[0].name = "a|b,c";
  table.axes[0].values = {R"("@x\ny")", "-3"};
  const auto files = written(table);
  const std::string& tex = files.at("summary.tex");
  CHECK(tex.find("\\caption{50 \\% of A\\_1 \\& \\{B\\} \\textbackslash{}input\\{x\\} "
                 "\\textless{}script\\textgreater{}é. Mean") != std::string::npos);
  CHECK(tex.find("\\label{tab:50-of-a-1-b-input-x-script}") != std::string::npos);
  CHECK(tex.find("=HYPERLINK(\\textquotedbl{}x\\textquotedbl{}),\\textbar{}`*\\_ &") !=
        std::string::npos);
  const std::string& md = files.at("summary.md");
  CHECK(md.find("## 50 % of A\\_1 &amp; {B} \\\\input{x} &lt;script&gt;é\n") == 0);
  CHECK(md.find("| a\\|b,c | pipeline |") != std::string::npos);
  CHECK(md.find("| @x\\\\u000ay | =HYPERLINK(\"x\"),\\|\\`\\*\\_ |") != std::string::npos);
  const std::string& csv = files.at("summary.csv");
  CHECK(csv.find("pipeline,\"a|b,c\",measure") == 0);
  CHECK(csv.find("\n\"'=HYPERLINK(\"\"x\"\"),|`*_\",'@x\\u000ay,radius_mean,") !=
        std::string::npos);
  CHECK(csv.find("\n-1.5,-3,radius_mean,") != std::string::npos);  // a number is no formula
}

TEST_CASE("fields of CSV files") {
  CHECK(detail::csv_field("") == "");
  CHECK(detail::csv_field("plain text") == "plain text");
  CHECK(detail::csv_field("a,b") == "\"a,b\"");
  CHECK(detail::csv_field("a\"b") == "\"a\"\"b\"");
  CHECK(detail::csv_field("+1e3") == "+1e3");
  CHECK(detail::csv_field("+1+1") == "'+1+1");
  CHECK(detail::csv_field("-a") == "'-a");
  CHECK(detail::csv_field("@a") == "'@a");
  CHECK(detail::csv_field("a=b") == "a=b");
  CHECK(detail::csv_field("\tx") == "'\tx");
}

TEST_CASE("rows that begin with a bracket, a star or a dollar") {
  ResultTable table = two_budgets();
  table.axes[0].name = "[2pt]";
  table.axes[0].values = {"[10,20]", R"(" * $a$")"};
  table.pipelines = {"[first]", "*second $x$"};
  auto files = written(table);
  std::string tex = files.at("summary.tex");
  CHECK(tex.find("    {}[2pt] & pipeline &") != std::string::npos);
  CHECK(tex.find("    {}[10,20] & [first] &") != std::string::npos);
  CHECK(tex.find("    {} * \\$a\\$ & *second") != std::string::npos);
  CHECK(files.at("summary.md").find("\\*second \\$x\\$ |") != std::string::npos);
}

TEST_CASE(
    "whatever a name is, a Markdown row stays a row, and LaTeX gets no bare special character") {
  CHECK(rc::check([] {
    const auto name = *rc::gen::container<std::string>(rc::gen::weightedOneOf<char>(
        {{3, rc::gen::elementOf(std::string("|\\`*_[]#~&<>{}$^%\"\n\r\t "))},
         {1, rc::gen::arbitrary<char>()}}));
    const std::string md = detail::markdown_text(name);
    RC_ASSERT(md.find_first_of("\n\r<>") == std::string::npos);
    std::size_t slashes = 0;
    for (const char c : md) {
      if (c == '|' || c == '$') RC_ASSERT(slashes % 2 == 1);
      slashes = c == '\\' ? slashes + 1 : 0;
    }
    const std::string tex = detail::latex_text(name);
    RC_ASSERT(tex.find_first_of("\n\r\t<>|\"^~") == std::string::npos);
    for (std::size_t i = 0; i < tex.size(); ++i) {
      if (std::string_view("&#%_").find(tex[i]) != std::string_view::npos)
        RC_ASSERT((i > 0 && tex[i - 1] == '\\'));
    }
  }));
}

TEST_CASE("a table without a title, or without anything") {
  const auto files = written(ResultTable{});
  CHECK(files.at("summary.tex").find("\\label{tab:results}") != std::string::npos);
  CHECK(files.at("summary.csv") ==
        "pipeline,measure,points,failed,count,infinite,mean,deviation,min,q05,q25,median,q75,q95,"
        "max,relative\n");
  CHECK(files.at("benchmarks.csv") == "benchmark,instance,result,time\n");
}
