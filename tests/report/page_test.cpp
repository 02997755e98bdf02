// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/page.hpp"

#include <fstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "experiments/report/page_data.hpp"
#include "report/sample_reports.hpp"

using namespace cordon::report;
using Json = nlohmann::json;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  REQUIRE(from != std::string::npos);
  const std::size_t to = text.find(end, from + begin.size());
  REQUIRE(to != std::string::npos);
  return text.substr(from + begin.size(), to - from - begin.size());
}

Json data_of(const Report& report) {
  return Json::parse(between(page_of(report), "id=\"report-data\">", "</script>"));
}

}  // namespace

TEST_CASE("numbers have six digits, more where they differ little") {
  CHECK(packed_numbers({1.23456789, -1e-9, 1e300}) == "[1.23457,-1e-09,1e+300]");
  CHECK(packed_numbers({1000.00012, 1000.00034}) == "[1000.00012,1000.00034]");
  CHECK(packed_numbers({1000.0001234567, 1000.0003}) == "[1000.000123457,1000.0003]");
  CHECK(packed_numbers({cordon::infinity, -cordon::infinity, sample::missing}) ==
        "[\"inf\",\"-inf\",null]");
  CHECK(packed_numbers({1234567, 0, -0.0}) == "[1234567,0,0]");
  CHECK(packed_numbers({}) == "[]");
  CHECK(packed_numbers({0.1}) == "[0.1]");
}

TEST_CASE("integers in equal steps take no room") {
  CHECK(packed_numbers({0, 1, 2, 3}) == R"({"from":0,"by":1,"count":4})");
  CHECK(packed_numbers({5, 3, 1, -1, -3}) == R"({"from":5,"by":-2,"count":5})");
  CHECK(packed_numbers({0, 1, 2, 4}) == "[0,1,2,4]");
  CHECK(packed_numbers({0, 1, 2}) == "[0,1,2]");
  CHECK(packed_numbers({0, 0.5, 1, 1.5}) == "[0,0.5,1,1.5]");
}

TEST_CASE("the page holds the report") {
  const Report report = sample::every_kind();
  const Json data = data_of(report);
  CHECK(data["title"] == report.title);
  CHECK(data["pipelines"] == Json({"first", "second"}));
  CHECK(data["notes"] == Json({"A note that comes first."}));
  CHECK(data["versions"][1] == Json({"host", "a machine"}));
  CHECK(data["study"] == report.study);
  CHECK(data["palette"]["light"].size() == data["palette"]["dark"].size());
  REQUIRE(data["figures"].size() == report.figures.size());
  const std::vector<std::string> kinds = {"table",      "plot", "plot",     "plot",
                                          "projection", "plot", "timeline", "intervals"};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    CHECK(data["figures"][i]["kind"] == kinds[i]);
    CHECK(data["figures"][i]["id"] == report.figures[i].id);
    CHECK(data["figures"][i]["section"] == report.figures[i].section);
    CHECK(data["figures"][i]["title"] == report.figures[i].title);
    CHECK(data["figures"][i]["caption"] == report.figures[i].caption);
    CHECK(data["figures"][i]["pipeline"] == report.figures[i].pipeline);
  }
}

TEST_CASE("bands are rounded outwards") {
  const std::vector<double> values{1.23456789, -1.23456749, 9.9999999e-9, -9999999900.5, 0, 0.5};
  CHECK(packed_numbers(values, Rounding::down) == "[1.23456,-1.23457,9.99999e-09,-1e+10,0,0.5]");
  CHECK(packed_numbers(values, Rounding::up) == "[1.23457,-1.23456,1e-08,-9.99999e+09,0,0.5]");
  CHECK(packed_numbers({1e-310, cordon::infinity, -cordon::infinity, sample::missing},
                       Rounding::up) == "[1e-310,\"inf\",\"-inf\",null]");
  Report report;
  report.pipelines = {"a"};
  Plot plot{"k", "x_1", false, {}};
  plot.series.push_back(
      {Series::Kind::band, "band", 0, {0, 1}, {1.00000049, 1.5}, {1.00000051, 2.00000049}});
  report.figures.push_back({"f", "s", "t", "c", plot});
  const Json band = data_of(report)["figures"][0]["plot"]["series"][0];
  CHECK(band["y"][0].get<double>() <= 1.00000049);
  CHECK(band["upper"][1].get<double>() >= 2.00000049);
}

TEST_CASE("coordinates far from the origin keep what the frame shows") {
  Report report;
  report.pipelines = {"a"};
  const double far = 1e10;
  report.figures.push_back(
      {"f", "s", "t", "c",
       Projection{"x_1", "x_2", {{0, far, far + 1, 0, 1, {{0, {far + 0.12345}, {0.5}, {}}}, {}}}}});
  const Json set = data_of(report)["figures"][0]["projection"]["frames"][0]["sets"][0];
  CHECK(std::abs(set["x"][0].get<double>() - far - 0.12345) <= 2e-6);
}

TEST_CASE("curves in the page") {
  const Json figures = data_of(sample::every_kind())["figures"];
  const Json& plot = figures[1]["plot"];
  CHECK(plot["x_label"] == "k");
  CHECK(plot["y_label"] == "radius");
  CHECK(plot["log_y"] == false);
  CHECK(figures[2]["plot"]["log_y"] == true);
  CHECK(plot["thresholds"] == Json::parse(R"([{"name":"bound","value":1.85}])"));
  CHECK(plot["marks"][1] == Json::parse(R"({"x":26.0,"text":"empty","pipeline":1})"));
  CHECK(plot["series"][1]["y"][30].is_null());
  CHECK(plot["series"][1]["y"][31] == "inf");
  CHECK(plot["series"][0]["x"] == Json::parse(R"({"from":0,"by":1,"count":101})"));
  CHECK(plot["series"][1]["pipeline"] == 1);
  CHECK(plot["series"][0]["kind"] == "line");
  CHECK(figures[2]["plot"]["series"][0]["kind"] == "steps");
  const Json& band = figures[3]["plot"]["series"][0];
  CHECK(band["kind"] == "band");
  CHECK(band["upper"].size() == 101);
  CHECK(band["upper"][0].get<double>() == doctest::Approx(0.5));
  CHECK(figures[3]["plot"]["series"][2]["pipeline"] == -1);
  CHECK(figures[5]["plot"]["series"][0]["kind"] == "points");
  CHECK(figures[5]["plot"]["x_names"] == Json({"10", "20", "30"}));
}

TEST_CASE("small marks in the page") {
  Report report = sample::every_kind();
  std::get<Plot>(report.figures[1].content).marks = {{7, "begun anew", 1, true}};
  CHECK(data_of(report)["figures"][1]["plot"]["marks"][0] ==
        Json::parse(R"({"x":7,"text":"begun anew","pipeline":1,"small":true})"));
}

TEST_CASE("sets in the page") {
  const Json projection = data_of(sample::every_kind())["figures"][4]["projection"];
  REQUIRE(projection["frames"].size() == 12);
  const Json& first = projection["frames"][0];
  CHECK(first["k"] == 0);
  CHECK(first["left"] == -5);
  CHECK(first["top"] == 4);
  CHECK(first["truth"] == Json({-1, 0}));
  CHECK(first["sets"][0]["open"].empty());
  CHECK(first["sets"][1]["open"] == Json({0, 0, 0, 0, 0, 1}));
  CHECK(first["sets"][0]["x"][0].get<double>() ==
        doctest::Approx(-1 + 1.2 * 0.8660254).epsilon(1e-4));
  CHECK(projection["frames"][6]["sets"][1]["x"].empty());
}

TEST_CASE("coordinates keep what a small frame far from the origin shows") {
  Report report = sample::every_kind();
  report.figures = {{"sets", "s", "t", "",
                     Projection{"x",
                                "y",
                                {{0,
                                  1e6,
                                  1e6 + 1e-3,
                                  0,
                                  1e-9,
                                  {{0, {1e6 + 0.00025, 1e6 + 0.00075}, {1e-10, 9e-10}}}}}}}};
  const Json set = data_of(report)["figures"][0]["projection"]["frames"][0]["sets"][0];
  CHECK(set["x"][1].get<double>() - set["x"][0].get<double>() ==
        doctest::Approx(0.0005).epsilon(1e-4));
  CHECK(set["y"][0].get<double>() == doctest::Approx(1e-10));
}

TEST_CASE("tables, timelines and intervals in the page") {
  const Report report = sample::every_kind();
  const Json figures = data_of(report)["figures"];
  const Json& table = figures[0]["table"];
  CHECK(table["header"] == Json({"pipeline", "mean radius", "truth inside"}));
  CHECK(table["rows"][0][1] ==
        Json::parse(R"({"text":"1.5","best":true,"share":1,"number":true})"));
  CHECK(table["rows"][0][0] == Json::parse(R"({"text":"first"})"));
  CHECK(figures[6]["numbers"]["rows"][0] == Json({"healthy", "0", "20", "monitored"}));
  CHECK(figures[6]["numbers"]["rows"].back() == Json({"", "23", "", "isolated"}));
  CHECK(figures[7]["numbers"]["rows"][1] ==
        Json({"model 1, model 3", "model 1", "-inf", "2", "model 3", "1", "5", "overlap"}));
  const std::string page = page_of(report);
  CHECK(count(page, "<template id=\"drawing_modes\"><svg") == 1);
  CHECK(count(page, "<template id=\"drawing_tubes\"><svg") == 1);
  CHECK(count(page, "<template") == 2);
}

TEST_CASE("hostile names are text wherever they stand") {
  const std::string harmless = page_of(sample::with_names("x")),
                    page = page_of(sample::with_names(sample::hostile));
  for (const std::string mark : {"<script", "</script", "<style", "<b>", "<!--", "<svg", "<title"})
    CHECK(count(page, mark) == count(harmless, mark));
  CHECK(count(page, "alert(1)</script>") == 0);
  CHECK(between(page, "<title>", "</title>").find("&lt;script&gt;alert(1)") != std::string::npos);
  const Json data = data_of(sample::with_names(sample::hostile));
  CHECK(data["title"] == sample::hostile);
  CHECK(data["figures"][1]["plot"]["series"][0]["name"] == sample::hostile);
}

TEST_CASE("bytes that are no text do not break the page") {
  Report report = sample::with_names(std::string("\xff\0\x01\x1b", 4));
  CHECK_NOTHROW(data_of(report));
}

TEST_CASE("the page asks for nothing from elsewhere and runs only its own scripts") {
  const std::string page = page_of(sample::every_kind());
  const std::string policy =
      between(page, "http-equiv=\"Content-Security-Policy\" content=\"", "\"");
  CHECK(policy.starts_with("default-src 'none'"));
  CHECK(policy.find("unsafe") == std::string::npos);
  CHECK(count(policy, "'sha256-") == 6);
  CHECK(count(policy, "='") == 6);  // 32 bytes in base 64
  CHECK(count(policy, "=='") == 0);
  CHECK(count(page, "<script>") == 5);
  CHECK(count(page, " src=") == 0);
  CHECK(count(page, "<link") == 0);
  CHECK(count(page, "{{") == count(page_of(sample::with_names("x")), "{{"));
  CHECK(page.find("Permission is hereby granted") != std::string::npos);
}

TEST_CASE("a page of ten pipelines over a thousand steps is below 5 MB") {
  CHECK(page_of(sample::large()).size() < 5'000'000);
}

TEST_CASE("a report without anything in it is a page") {
  CHECK(data_of(Report{})["figures"].empty());
}
