// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <fstream>
#include <unistd.h>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "study/data/csv_source.hpp"
#include "study/text/numbers.hpp"

using namespace cordon;

namespace {

/// A file with these bytes, gone with the object.
class File {
 public:
  explicit File(const std::string& bytes)
      : path_(std::filesystem::temp_directory_path() /
              ("cordon-csv-" + std::to_string(::getpid()) + ".csv")) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~File() { std::filesystem::remove(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// One state, one input "u", one output "y"; truth "x" on request.
Study study_of(const std::filesystem::path& file, bool truth = false) {
  Study study;
  LinearModel& m = study.model.linear;
  m.A = m.B = m.C = m.D = m.Bw = m.Dv = Matrix::Ones(1, 1);
  CsvSpec spec;
  spec.file = file;
  spec.inputs = {"u"};
  spec.outputs = {"y"};
  if (truth) spec.truth = {"x"};
  study.data = spec;
  return study;
}

std::vector<Record> all(const std::string& bytes, bool truth = false) {
  const File file(bytes);
  const auto data = open_data(study_of(file.path(), truth));
  std::vector<Record> records;
  while (auto record = data->next()) records.push_back(std::move(*record));
  CHECK(data->size() == static_cast<std::int64_t>(records.size()));
  return records;
}

std::vector<Diagnostic> problems(const std::string& bytes, bool truth = false) {
  const File file(bytes);
  try {
    open_data(study_of(file.path(), truth));
  } catch (const InputError& e) {
    CHECK(e.file() == file.path().string());
    return e.diagnostics();
  }
  return {};
}

bool mentions(const Diagnostic& d, const std::string& text) {
  return (d.message + " | " + d.suggestion).find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("columns are found by name, in any order, beside columns of text") {
  const auto records =
      all("time,y,note,u,x\n2024-01-01,1.5,\"a, \"\"b\"\"\nc\",-2e-3,7\nx, +3 ,,4,8\n", true);
  REQUIRE(records.size() == 2);
  CHECK(records[0].sample.k == 0);
  CHECK(records[0].sample.y[0] == 1.5);
  CHECK(records[0].sample.u[0] == -2e-3);
  CHECK((*records[0].truth)[0] == 7);
  CHECK(records[1].sample.k == 1);
  CHECK(records[1].sample.y[0] == 3);
  CHECK((*records[1].truth)[0] == 8);
  CHECK_FALSE(all("u,y\n1,2\n")[0].truth.has_value());
}

TEST_CASE("line ends, byte order mark, quotes and blank lines at the end") {
  for (const std::string text :
       {"u,y\n1,2\n3,4\n", "u,y\r\n1,2\r\n3,4\r\n", "u,y\r1,2\r3,4", "u,y\n1,2\n3,4",
        "\xEF\xBB\xBFu,y\n1,2\n3,4\n\n\n", "\"u\",\"y\"\n\"1\",\"2\"\n3,\"4\"",
        " u , y \n1,2\n3,4\r\n\r\n"}) {
    CAPTURE(text);
    const auto records = all(text);
    REQUIRE(records.size() == 2);
    CHECK(records[1].sample.u[0] == 3);
    CHECK(records[1].sample.y[0] == 4);
  }
}

TEST_CASE("each defect is reported with its line") {
  struct Case {
    std::string text;
    int line;
    std::string message;
  };
  const Case cases[] = {
      {"", 0, "the file is empty"},
      {"\xEF\xBB\xBF", 0, "the file is empty"},
      {"u,y\n", 0, "no row"},
      {"u,y", 0, "no row"},
      {"u,Y\n1,2\n", 1, "there is no column \"y\""},
      {"u,y,u\n1,2,3\n", 1, "\"u\" appears more than once"},
      {"u,y\n1,2\n3\n", 3, "the row has 1 field, the header 2"},
      {"u,y\n1,2,3\n", 2, "the row has 3 fields"},
      {"u,y\n1,2\n\n3,4\n", 3, "blank line"},
      {"u,y\n1,abc\n", 2, "column \"y\": \"abc\" is not a number"},
      {"u,y\n1,\n", 2, "column \"y\": is empty"},
      {"u,y\n1,nan\n", 2, "\"nan\" is not finite"},
      {"u,y\n1,-inf\n", 2, "\"-inf\" is not finite"},
      {"u,y\n1,1e999\n", 2, "beyond the range"},
      {"u,y\n1,0x10\n", 2, "not a number"},
      {"u,y\n1,2 3\n", 2, "not a number"},
      {"u,y\n1,+-3\n", 2, "not a number"},
      {"u,y\n1,\"2,5\"\n", 2, "\"2,5\" is not a number"},
      {std::string("u,y\n1,2\0"
                   "3\n",
                   10),
       2, "not a number"},
      {"u,y\n1,\"2\n", 2, "never closed"},
      {"u,y\n1,\"2\"3\n", 2, "text after a closing quote"},
      {"u,y\n1,2\"3\n", 2, "a quote inside a field"},
      {"\"u,y\n1,2\n", 1, "header row: a quote is never closed"},
      {"u,y\r\n\"a\nb\",2\r\n1,x\r\n", 4, "\"x\" is not a number"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    const auto found = problems(c.text);
    REQUIRE_FALSE(found.empty());
    CAPTURE(found.back().message);
    CHECK(mentions(found.back(), c.message));
    CHECK(found.back().line == c.line);
  }
}

TEST_CASE("fields that hold no number come with what to do") {
  const auto suggestion = [](const std::string& text) { return problems(text).front().suggestion; };
  CHECK(suggestion("u,y\n1,err\n").find("leave the field empty") != std::string::npos);
  CHECK(suggestion("u,y\n1,\n").find("\"missing\": \"skip\"") != std::string::npos);
  CHECK(suggestion("u,y\nNA,1\n").find("only outputs may be missing") != std::string::npos);
  CHECK(suggestion("u,y\n,1\n").find("only outputs may be missing") != std::string::npos);
  CHECK(suggestion("u,y\n1\n").find("each row has a field") != std::string::npos);
  CHECK(suggestion("u,y\n").find("a row for every step") != std::string::npos);
}

TEST_CASE("other separators and encodings are named") {
  CHECK(mentions(problems("u;y\n1;2\n").front(), "semicolons"));
  CHECK(mentions(problems("# of Monday\nu,y\n1,2\n").front(), "the first line is a comment"));
  CHECK(mentions(problems("u,y,m\xE8tre\n1,2,3\n").front(), "Latin-1"));
  CHECK(problems("u,y\n1,5,2,5\n").front().suggestion.find("decimal comma") != std::string::npos);
  CHECK(mentions(problems("u,y\n\"1,5\",2\n").front(), "decimals are separated by a point"));
  CHECK(mentions(problems("u,y\n\xE2\x88\x92"
                          "1.5,2\n")
                     .front(),
                 "U+2212"));
  CHECK(mentions(problems("u\ty\n1\t2\n").front(), "tabs"));
  CHECK(mentions(problems(std::string("\xFF\xFEu\0,\0y\0\n\0", 10)).front(), "UTF-16"));
}

TEST_CASE("a missing column is named by its place in the study, with a suggestion") {
  const File file("u,postion\n1,2\n3,x\n");
  Study study = study_of(file.path());
  std::get<CsvSpec>(study.data).outputs = {"position"};
  try {
    open_data(study);
    FAIL("accepted");
  } catch (const InputError& e) {
    REQUIRE(e.diagnostics().size() ==
            1);  // the column "postion" is not used, so its text is no defect
    CHECK(e.diagnostics()[0].pointer == "/data/csv/outputs/0");
    CHECK(e.diagnostics()[0].suggestion == "did you mean \"postion\"?");
  }
}

TEST_CASE("all problems come together, up to twenty") {
  CHECK(problems("u,y\na,b\n1\nc,2\n").size() == 4);
  std::string text = "u,y\n";
  for (int i = 0; i < 1000; ++i) text += "a,b\n";
  const auto found = problems(text);
  CHECK(found.size() == 20);
  CHECK(mentions(found.back(), "reading stopped here"));
}

TEST_CASE("missing files and directories") {
  Study study = study_of("/nonexistent/file.csv");
  CHECK_THROWS_WITH_AS(open_data(study), doctest::Contains("there is no such file"), InputError);
  study = study_of(std::filesystem::temp_directory_path());
  CHECK_THROWS_WITH_AS(open_data(study), doctest::Contains("is a directory"), InputError);
  study = study_of("/dev/zero");
  CHECK_THROWS_WITH_AS(open_data(study), doctest::Contains("not a regular file"), InputError);
}

TEST_CASE("numbers of columns must fit the model") {
  const File file("u,y\n1,2\n");
  Study study = study_of(file.path());
  std::get<CsvSpec>(study.data).inputs = {"u", "y"};
  std::get<CsvSpec>(study.data).truth = {"u", "y"};
  CHECK_THROWS_WITH_AS(open_data(study), doctest::Contains("2 errors"), InputError);
}

TEST_CASE("a file without structure is refused without taking its size in memory") {
  CHECK(mentions(problems("u,y\n1,\"" + std::string(3 << 20, 'a')).back(), "longer than 1 MiB"));
  CHECK(mentions(problems("u,y\n" + std::string(3 << 20, ',') + "\n1,x\n").front(),
                 "longer than 1 MiB"));
}

TEST_CASE("a file that changes between check and reading is an error") {
  const File file("u,y\n1,2\n3,4\n");
  const auto data = open_data(study_of(file.path()));
  std::ofstream(file.path(), std::ios::binary) << "u,y\n1,2\n3,b\n";
  // the reader may hold the old bytes in its buffer: both are sound, silence about a bad number is
  // not
  try {
    data->next();
    CHECK(data->next()->sample.y[0] == 4);
  } catch (const Error& e) {
    CHECK(e.code() == Errc::io);
  }
}

TEST_CASE("hostile bytes never crash, and give rows or problems") {
  CHECK(rc::check("any bytes", [](const std::vector<std::uint8_t>& picks) {
    static const char alphabet[] = {'u', 'y', ',', '\n', '\r',   '"',    '1', '.',
                                    'e', '-', ' ', '\0', '\xFF', '\xEF', ';', '\t'};
    std::string text = "u,y\n";
    if (!picks.empty() && picks[0] % 3 == 0) text.clear();
    for (const std::uint8_t pick : picks) text += alphabet[pick % sizeof(alphabet)];
    const auto found = problems(text);
    if (!found.empty()) return;
    for (const Record& r : all(text)) RC_ASSERT(r.sample.u.allFinite() && r.sample.y.allFinite());
  }));
}

TEST_CASE("numbers: shortest text reads back") {
  CHECK(rc::check("round trip", [](double x) {
    RC_PRE(std::isfinite(x));
    RC_ASSERT(detail::parse_number(detail::to_text(x)).value == x);
  }));
  CHECK(detail::to_text(0.1) == "0.1");
  CHECK(detail::to_text(1e300) == "1e+300");
  CHECK(detail::to_text(-HUGE_VAL) == "-inf");
}

TEST_CASE("the true modes may be recorded") {
  const auto study = [](const std::filesystem::path& file) {
    Study one = study_of(file);
    one.modes = {{"leak", one.model}, {"stuck, closed", one.model}};
    std::get<CsvSpec>(one.data).mode = "state of health";
    return one;
  };
  const File file("u,y,state of health\n1,2,healthy\n1,2, leak \n1,2,\n1,2,\"stuck, closed\"\n");
  const auto data = open_data(study(file.path()));
  for (const Index mode : {0, 1, -1, 2}) CHECK(data->next()->mode == mode);
  CHECK_FALSE(data->next());
  CHECK_FALSE(open_data(study_of(file.path()))->next()->mode);       // not asked for
  const File by_run("u,y,state of health\n1,2,0\n1,2,-1\n1,2,2\n");  // numbers in the bank
  const auto recorded = open_data(study(by_run.path()));
  for (const Index mode : {0, -1, 2}) CHECK(recorded->next()->mode == mode);
  const File beyond("u,y,state of health\n1,2,3\n");
  CHECK_THROWS_AS(open_data(study(beyond.path())), InputError);
  const auto first_problem = [&](const std::string& bytes) {
    const File bad(bytes);
    try {
      open_data(study(bad.path()));
    } catch (const InputError& e) {
      CHECK(e.diagnostics().size() == 1);
      return e.diagnostics()[0];
    }
    return Diagnostic{};
  };
  const Diagnostic unknown = first_problem("u,y,state of health\n1,2,healthy\n1,2,leek\n");
  CHECK(unknown.line == 3);
  CHECK(unknown.message == "column \"state of health\": there is no mode \"leek\"");
  CHECK(unknown.suggestion == "did you mean \"leak\"?");
  const Diagnostic absent = first_problem("u,y,health\n1,2,healthy\n");
  CHECK(absent.pointer == "/data/csv/mode");
  CHECK(absent.message == "there is no column \"state of health\" in the header");
  const Diagnostic foreign = first_problem("u,y,\"mode\n\x1b[31m\"\n1,2,3\n");
  CHECK(foreign.suggestion.find("\\u000a\\u001b") != std::string::npos);
  CHECK(foreign.suggestion.find("\n") == std::string::npos);
}

TEST_CASE("outputs without a value are refused with the way out, or missing in their samples") {
  const std::string bytes = "u,y\n1,2\n1,\n1, nan\n1,NaN \n1,3\n";
  const auto refused = problems(bytes);
  REQUIRE(refused.size() == 3);
  CHECK(refused[0].line == 3);
  for (const Diagnostic& problem : refused) CHECK(mentions(problem, "\"missing\": \"skip\""));
  const File file(bytes);
  Study study = study_of(file.path());
  std::get<CsvSpec>(study.data).missing = MissingValue::skip;
  const auto data = open_data(study);
  std::vector<std::vector<Index>> missing;
  while (const auto record = data->next()) {
    missing.push_back(record->sample.missing);
    CHECK(std::isnan(record->sample.y[0]) == !record->sample.is_complete());
  }
  CHECK(missing == std::vector<std::vector<Index>>{{}, {0}, {0}, {0}, {}});
  // inputs have a value, and outputs are numbers
  for (const char* wrong : {"u,y\n,2\n", "u,y\nnan,2\n", "u,y\n1,x\n", "u,y\n1,inf\n"}) {
    const File other(wrong);
    Study with_gaps = study_of(other.path());
    std::get<CsvSpec>(with_gaps.data).missing = MissingValue::skip;
    CHECK_THROWS_AS(open_data(with_gaps), InputError);
  }
}
