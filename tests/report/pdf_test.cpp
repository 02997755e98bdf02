// SPDX-License-Identifier: GPL-3.0-or-later
// Figures as PDF, by the program that draws them.
#include "experiments/report/pdf.hpp"

#include <cstdlib>
#include <filesystem>
#include <optional>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/experiments/report.hpp"
#include "report/results_files.hpp"

using namespace cordon;
namespace fs = std::filesystem;

namespace {

const char* const drawing =
    R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 64 48" width="64" height="48">
<line x1="0" y1="0" x2="64" y2="48" stroke="#000000"/><text x="9" y="30" fill="#000">µ</text></svg>)";

/// Sets an environment variable for a while.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace

TEST_CASE("a drawing becomes a document of its size") {
  const std::string pdf = report::PdfConverter().pdf_of(drawing);
  CHECK(pdf.starts_with("%PDF-"));
  CHECK(pdf.find("[ 0 0 48 36 ]") != std::string::npos);  // points: 3/4 of the drawing's units
}

TEST_CASE("the files of a report, beside those of other kinds") {
  const ResultsFiles files;
  ReportOptions options;
  options.html = false;
  options.svg = options.pdf = true;
  write_report(files.path(), options);
  std::size_t drawings = 0;
  for (const auto& entry : fs::directory_iterator(files.path() / "figures")) {
    if (entry.path().extension() != ".svg") continue;
    ++drawings;
    const std::string name = "figures/" + entry.path().stem().string() + ".pdf";
    CHECK(files.read(name).starts_with("%PDF-"));
  }
  CHECK(drawings > 5);
}

TEST_CASE("without the program an error names it, its package and what works without") {
  const ResultsFiles files;
  ReportOptions options;
  options.pdf = true;
  const Environment path("PATH", "/nonexistent");
  for (const char* part : {"rsvg-convert is missing", "librsvg2-bin", "--svg"})
    CHECK_THROWS_WITH_AS(write_report(files.path(), options), doctest::Contains(part), Error);
  CHECK_FALSE(fs::exists(files.path() / "figures" / "bounds_1.pdf"));
}

TEST_CASE("what is no drawing is no document, and nothing stays behind") {
  Scratch scratch;
  const Environment temporary("TMPDIR", scratch.path().string());
  {
    const report::PdfConverter converter;
    CHECK_THROWS_WITH_AS(converter.pdf_of("<no drawing"), doctest::Contains("ended with code"),
                         Error);
    CHECK(converter.pdf_of(drawing).starts_with("%PDF-"));
    CHECK_FALSE(fs::is_empty(scratch.path()));
  }
  CHECK(fs::is_empty(scratch.path()));
}
