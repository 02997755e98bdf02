// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/json_text.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace cordon::json;

namespace {

/// The value as nlohmann-json would hold it.
nlohmann::json converted(const Value& value) {
  switch (value.kind) {
    case Value::Kind::boolean:
      return value.flag;
    case Value::Kind::number:
      return value.number;
    case Value::Kind::text:
      return value.text();
    case Value::Kind::array: {
      nlohmann::json list = nlohmann::json::array();
      for (const Value& item : value.items()) list.push_back(converted(item));
      return list;
    }
    case Value::Kind::object: {
      nlohmann::json object = nlohmann::json::object();
      for (std::size_t i = 0; i < value.items().size(); ++i)
        object[value.keys()[i]] = converted(value.items()[i]);
      return object;
    }
    default:
      return nullptr;
  }
}

std::string sole_problem(const std::string& text) {
  Problems problems;
  parse(text, problems);
  REQUIRE(problems.count() == 1);
  return problems.sorted()[0].message;
}

const std::string sample =
    R"({"a": [1, -2.5e-3, 0, -0, 1E+2, 5e-324], "text": "q\"\\\/\b\f\n\r\t\u00e9\ud83d\ude00 é€😀",
  "empty": [[], {}, ""], "t": true, "f": false, "n": null, "nested": {"a/b": {"~": [[[[]]]]}}})";

}  // namespace

TEST_CASE("values agree with another parser") {
  Problems problems;
  const Value value = parse(sample, problems);
  CHECK_FALSE(problems.any());
  CHECK(converted(value) == nlohmann::json::parse(sample));
}

TEST_CASE("after random damage, what is accepted and what it means agree with another parser") {
  std::mt19937_64 random(20240817);
  int accepted = 0, refused = 0;
  const std::string bytes = "{}[]\",:0123456789.-+eE \n\\tfnu/\x80\xc3\xff";
  for (int trial = 0; trial < 40000; ++trial) {
    std::string text = sample;
    for (auto edits = 1 + random() % 2; edits > 0; --edits) {
      const std::size_t at = random() % text.size();
      const int kind = static_cast<int>(random() % 3);
      if (kind == 0) text[at] = bytes[random() % bytes.size()];
      if (kind == 1) text.erase(at, 1);
      if (kind == 2) text.insert(at, 1, bytes[random() % bytes.size()]);
    }
    Problems problems;
    const Value value = parse(text, problems);
    std::vector<std::string> reasons;
    for (const auto& d : problems.sorted()) reasons.push_back(d.message);
    bool ours_only = false;  // stricter or kinder than the other parser on purpose
    for (const auto& r : reasons)
      ours_only = ours_only || r.find("repeated") != std::string::npos ||
                  r.find("range of double") != std::string::npos;
    if (ours_only) continue;
    CAPTURE(text);
    const nlohmann::json other = nlohmann::json::parse(text, nullptr, false);
    const bool good = !problems.any();
    REQUIRE(good == !other.is_discarded());
    if (good) REQUIRE(converted(value) == other);
    ++(good ? accepted : refused);
  }
  CHECK(accepted > 1000);
  CHECK(refused > 1000);
}

TEST_CASE("numbers are the doubles next to their text, whatever their length") {
  std::mt19937_64 random(7);
  const auto digits = [&](std::size_t most) {
    std::string text;
    for (std::size_t i = 1 + random() % most; i > 0; --i)
      text += static_cast<char>('0' + random() % 10);
    return text;
  };
  for (int trial = 0; trial < 20000; ++trial) {
    std::string text = random() % 2 ? "-" : "";
    text += random() % 4 ? std::to_string(1 + random() % 9) + digits(random() % 8 ? 3 : 40) : "0";
    if (random() % 4) text += "." + digits(random() % 8 ? 20 : 60);
    if (random() % 2) text += (random() % 2 ? "e-" : "E+0") + digits(2);
    CAPTURE(text);
    Problems problems;
    const Value list = parse("[" + text + "," + text + "]", problems);
    REQUIRE_FALSE(problems.any());
    const double expected = std::strtod(text.c_str(), nullptr);  // in the locale "C"
    for (const Value& item : list.items()) {
      REQUIRE(item.number == expected);
      REQUIRE(std::signbit(item.number) == std::signbit(expected));
    }
  }
  Problems problems;
  const Value integers = parse(
      "[9223372036854775807, -9223372036854775809, 18446744073709551616, 9007199254740993, -0]",
      problems);
  REQUIRE_FALSE(problems.any());
  CHECK(integers.items()[0].number == 9223372036854775808.0);
  CHECK(integers.items()[1].number == -9223372036854775808.0);
  CHECK(integers.items()[2].number == 18446744073709551616.0);
  CHECK(integers.items()[3].number == 9007199254740992.0);
  CHECK(std::signbit(integers.items()[4].number));
}

TEST_CASE("a wrong number does not end the reading") {
  Problems problems;
  const Value root =
      parse("{\"a\": [1e999, -1e-999, NaN, -Infinity, null, -7],\n\"b\" :nan\n}", problems);
  REQUIRE(problems.count() == 5);
  const auto told = problems.sorted();
  CHECK(told[0].message == "\"1e999\" is beyond the range of double numbers");
  CHECK(told[1].message == "\"-1e-999\" is beyond the range of double numbers");
  CHECK(told[2].message == "NaN is not a number");
  CHECK(told[3].message == "Infinity is not a number");
  CHECK(told[3].pointer == "/a/3");
  CHECK(told[4].pointer == "/b");
  CHECK(told[4].line == 2);
  const auto& items = root.find("a")->items();
  for (std::size_t i = 0; i < 4; ++i) CHECK(items[i].kind == Value::Kind::broken);
  CHECK(items[4].kind == Value::Kind::null);
  CHECK(items[5].number == -7);
}

TEST_CASE("every refusal says where and why") {
  struct Refusal {
    std::string text, pointer;
    int line;
    std::string message;
  };
  const std::vector<Refusal> refusals = {
      {"", "", 1, "column 1: a value is missing: the file ends here"},
      {std::string("{}\0{}", 5), "", 1,
       "column 3: more text after the end of the document, found \"\\u0000\""},
      {"{} // x", "", 1, "column 4: comments are not part of JSON"},
      {"[\n# x\n]", "", 2, "column 1: comments are not part of JSON"},
      {"{\"a\": 1,\n \"b\": 2,\n}", "/b", 3, "column 1: a key is missing, found \"}\""},
      {"[1, 2, ]", "/2", 1, "column 8: a value is missing, found \"]\""},
      {"[1, 2", "/1", 1, "column 6: \",\" or \"]\" is missing, the file ends here"},
      {"[1 2]", "/0", 1, "column 4: \",\" or \"]\" is missing, found \"2\""},
      {"{\"a\": {\"b\" 1}}", "/a/b", 1,
       "column 12: a colon is missing after the key \"b\", found \"1\""},
      {"{a: 1}", "/", 1, "column 2: a key in double quotes is missing, found \"a\""},
      {"{\"a\": 0,5}", "/a", 1, "column 9: a key is missing, found \"5\""},
      {"[\u22125]", "/0", 1, "column 2: a value is missing, found \"\u2212\""},
      {"{\"a\": 'b'}", "/a", 1, "column 7: texts are written in double quotes"},
      {"[.5]", "/0", 1, "column 2: a number cannot begin with \".\""},
      {"[7, -07]", "/1", 1, "column 6: a number begins with a superfluous 0"},
      {"[1.]", "/0", 1, "column 4: a digit is missing after the decimal point, found \"]\""},
      {"[1e+]", "/0", 1, "column 5: a digit is missing in the exponent, found \"]\""},
      {"[True]", "/0", 1, "column 2: unknown word \"True\""},
      {"[nullify]", "/0", 1, "column 2: unknown word \"nullify\""},
      {"[\"é\", \"a\nb\"]", "/1", 1, "column 7: a text without its closing quote on the line"},
      {"[\"a\tb\"]", "/0", 1, "column 4: a control character in a text"},
      {"[\"a\\x\"]", "/0", 1, "column 4: unknown escape sequence in a text"},
      {"[\"\\u12G4\"]", "/0", 1, "column 5: \\u needs four hexadecimal digits"},
      {"[\"\\ud83dx\"]", "/0", 1, "column 3: half of a surrogate pair in a text"},
  };
  for (const Refusal& r : refusals) {
    CAPTURE(r.text);
    Problems problems;
    CHECK(parse(r.text, problems).kind == Value::Kind::broken);
    REQUIRE(problems.count() == 1);
    CHECK(problems.sorted()[0].pointer == r.pointer);
    CHECK(problems.sorted()[0].line == r.line);
    CHECK(problems.sorted()[0].message == r.message);
  }
}

TEST_CASE("a repeated key is named with both lines, among few keys and many") {
  for (const int keys : {3, 100'000}) {
    std::string text = "{";
    for (int i = 0; i < 2 * keys; ++i)
      text += (i > 0 ? ",\n\"" : "\"") + std::to_string(i % keys) + "\": " + std::to_string(i);
    Problems problems;
    const Value root = parse(text + "}", problems);
    CHECK(problems.count() == static_cast<std::size_t>(keys));
    CHECK(root.items().size() == static_cast<std::size_t>(keys));
    CHECK(root.items().back().number == keys - 1);
    CHECK(problems.found()[2].pointer == "/2");
    CHECK(problems.found()[2].line == keys + 3);
    CHECK(problems.found()[2].message == "the key is repeated (first on line 3)");
  }
}

TEST_CASE("every value knows its line, for every line break") {
  for (const std::string end : {"\n", "\r\n"}) {
    Problems problems;
    const Value root = parse(
        "{" + end + "\"a\": 1," + end + end + "\"b\": [" + end + "2, \"x\"" + end + "]}", problems);
    REQUIRE_FALSE(problems.any());
    CHECK(root.line == 1);
    CHECK(root.find("a")->line == 2);
    CHECK(root.find("b")->line == 4);
    CHECK(root.find("b")->items()[1].line == 5);
    CHECK(root.find("c") == nullptr);
  }
  Problems problems;
  const Value root = parse("[\n1\n,[\n],\n\n{}\n,\"x\"\n, NaN\n,true\n]\n", problems);
  std::vector<int> lines;
  for (const Value& item : root.items()) lines.push_back(item.line);
  CHECK(lines == std::vector<int>{2, 3, 6, 7, 8, 9});
}

TEST_CASE("a byte order mark is skipped, a second one is not") {
  Problems problems;
  CHECK(parse("\xEF\xBB\xBF{}", problems).kind == Value::Kind::object);
  CHECK_FALSE(problems.any());
  parse("\xEF\xBB\xBF\xEF\xBB\xBF{}", problems);
  CHECK(problems.any());
}

TEST_CASE("nesting is limited to 64 levels") {
  Problems problems;
  parse(std::string(64, '[') + std::string(64, ']'), problems);
  CHECK_FALSE(problems.any());
  CHECK(sole_problem(std::string(65, '[') + std::string(65, ']')).find("deeper than 64") !=
        std::string::npos);
  CHECK(sole_problem(std::string(1'000'000, '[')).find("deeper than 64") != std::string::npos);
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"a\":";
  CHECK(sole_problem(objects).find("deeper than 64") != std::string::npos);
}

TEST_CASE("text that is not UTF-8 is refused with its place") {
  for (const char* bad : {"\xff", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                          "\xf8\x88\x80\x80\x80", "\x80", "\xe2\x82"}) {
    Problems problems;
    CHECK(parse(std::string("{\n\"é") + bad + "\": 1}", problems).kind == Value::Kind::broken);
    REQUIRE(problems.count() == 1);
    CHECK(problems.sorted()[0].message == "column 3: not valid UTF-8");
    CHECK(problems.sorted()[0].line == 2);
  }
}

TEST_CASE("numbers beyond double are refused, the smallest and the largest are kept") {
  Problems problems;
  const Value list = parse("[1.7976931348623157e308, 2.2250738585072014e-308, -0.0]", problems);
  REQUIRE_FALSE(problems.any());
  CHECK(list.items()[0].number == std::numeric_limits<double>::max());
  CHECK(list.items()[1].number == std::numeric_limits<double>::min());
  CHECK(std::signbit(list.items()[2].number));
  CHECK(sole_problem("[1e309]").find("range of double") != std::string::npos);
  CHECK(sole_problem("[-1" + std::string(400, '0') + "]").find("range of double") !=
        std::string::npos);
}

TEST_CASE("the list of problems is bounded and says what it leaves out") {
  std::string text = "[";
  for (int i = 0; i < 5000; ++i) text += "NaN,";
  Problems problems;
  parse(text + "0]", problems);
  CHECK(problems.count() == 5000);
  const auto sorted = problems.sorted();
  CHECK(sorted.size() == 1001);
  CHECK(sorted.back().message == "and 4000 more problems");
}

TEST_CASE("what a file holds cannot steer a terminal") {
  CHECK(in_quotes("a\x1b[2Jb\x7f\n") == "\"a\\u001b[2Jb\\u007f\\u000a\"");
  CHECK(in_quotes(std::string(1000, 'x')).size() < 80);
  Problems problems;
  parse("{\"\\u001b[2J\": NaN}", problems);
  CHECK(problems.sorted()[0].pointer == "/\\u001b[2J");
}

TEST_CASE("pointers escape the two special characters") {
  CHECK(child("", "a/b~c") == "/a~1b~0c");
  CHECK(child("/x", std::size_t{3}) == "/x/3");
}
