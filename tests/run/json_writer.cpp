// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/json_writer.hpp"

#include <cmath>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"

using namespace cordon;
using detail::json_string;
using detail::JsonWriter;

namespace {

struct Text final : detail::Sink {
  void write(std::string_view bytes) override { text += bytes; }
  std::string text;
};

}  // namespace

TEST_CASE("layout, numbers and nesting") {
  Text out;
  JsonWriter json(out);
  json.begin_object(JsonWriter::Layout::lines).member("a", 1).member("b", 0.1).member("yes", true);
  json.key("list")
      .begin_array(JsonWriter::Layout::lines)
      .value(-0.0)
      .value(1e-300)
      .null()
      .end_array();
  json.key("empty").begin_array(JsonWriter::Layout::lines).end_array();
  json.key("matrix")
      .matrix(Matrix{{1., 2.}, {3., HUGE_VAL}})
      .member("vector", Vector(Vector{{-HUGE_VAL, std::nan("")}}));
  json.key("raw").raw("{\"x\": 1}").end_object();
  CHECK(out.text == R"({
  "a": 1,
  "b": 0.1,
  "yes": true,
  "list": [
    -0,
    1e-300,
    null
  ],
  "empty": [],
  "matrix": [[1, 2], [3, "inf"]],
  "vector": ["-inf", null],
  "raw": {"x": 1}
})");
  CHECK_NOTHROW(nlohmann::json::parse(out.text));
}

TEST_CASE("an object without its end goes on, and an empty list may keep its lines") {
  Text out;
  JsonWriter(out).begin_object(JsonWriter::Layout::lines).member("a", 1);
  JsonWriter json = JsonWriter::going_on(out);
  json.key("none").begin_array(JsonWriter::Layout::open_lines).end_array();
  json.key("one").begin_array(JsonWriter::Layout::open_lines).value(1).end_array().end_object();
  CHECK(out.text == R"({
  "a": 1,
  "none": [
  ],
  "one": [
    1
  ]
})");
}

TEST_CASE("strings: escapes, control characters, UTF-8, and bytes that are none") {
  CHECK(json_string("a\"b\\c\n\t\r\x01\x1f/") == R"("a\"b\\c\n\t\r\u0001\u001f/")");
  CHECK(json_string("Zürich ξ 😀 \x7f") == "\"Zürich ξ 😀 \x7f\"");
  const std::string r = "\xEF\xBF\xBD";
  CHECK(json_string("a\xFF"
                    "b") == "\"a" + r + "b\"");
  CHECK(json_string("\xC0\xAF") == "\"" + r + r + "\"");                  // overlong
  CHECK(json_string("\xED\xA0\x80") == "\"" + r + r + r + "\"");          // surrogate
  CHECK(json_string("\xF4\x90\x80\x80") == "\"" + r + r + r + r + "\"");  // beyond U+10FFFF
  CHECK(json_string("x\xE2\x82") == "\"x" + r + r + "\"");                // cut short
  CHECK(json_string(std::string_view("a\0b", 3)) == R"("a\u0000b")");
}

TEST_CASE("any bytes give a string that parses, any number reads back") {
  CHECK(rc::check("bytes", [](const std::string& bytes) {
    RC_ASSERT(nlohmann::json::parse(json_string(bytes)).is_string());
  }));
  CHECK(rc::check("numbers", [](double x) {
    RC_PRE(std::isfinite(x));
    Text out;
    JsonWriter(out).value(x);
    RC_ASSERT(nlohmann::json::parse(out.text).get<double>() == x);
  }));
}

TEST_CASE("calls in a wrong order are defects") {
  Text out;
  CHECK_THROWS_AS(JsonWriter(out).key("a"), Error);
  CHECK_THROWS_AS(JsonWriter(out).begin_object().value(1), Error);
  CHECK_THROWS_AS(JsonWriter(out).begin_object().key("a").key("b"), Error);
  CHECK_THROWS_AS(JsonWriter(out).begin_object().end_array(), Error);
  CHECK_THROWS_AS(JsonWriter(out).begin_object().key("a").end_object(), Error);
}
