// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever the bytes of a study are: it is read, or refused with a cordon::Error that has its
// problems.
#include <random>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/experiments/sweep.hpp"
#include "run/scratch.hpp"
#include "study/fakes.hpp"

using namespace cordon;
using namespace study_test;

namespace {

/// Reads the last point of a sweep.
void read_last_point(const Study& study, const Registry& registry) {
  std::vector<std::size_t> last;
  for (const SweepAxis& axis : study.sweep) last.push_back(axis.values.size() - 1);
  try {
    RC_ASSERT(!study_at(study, last, registry).resolved.empty());
  } catch (const InputError& error) {
    RC_ASSERT(!error.diagnostics().empty());
  }
}

/// Reads a damaged study; true if it was still valid. Any other exception than the two kinds fails
/// the test.
bool survives(const Scratch& scratch, const std::string& text) {
  Registry registry;
  registry.add(register_fakes);
  try {
    const Study study = read_study(scratch.write("s.json", text), registry, SearchPath{});
    RC_ASSERT(!study.pipelines.empty());
    RC_ASSERT(!study.resolved.empty());
    read_last_point(study, registry);
    return true;
  } catch (const InputError& error) {
    RC_ASSERT(!error.diagnostics().empty());
    for (const Diagnostic& d : error.diagnostics()) RC_ASSERT(!d.message.empty());
    return false;
  }
}

const std::vector<std::string> tokens = {"{",         "}",
                                         "[",         "]",
                                         "\"",        ",",
                                         ":",         "0",
                                         "-1",        "1e999",
                                         "1e308",     "-1e308",
                                         "5e-324",    "null",
                                         "true",      "NaN",
                                         "\"inf\"",   "[]",
                                         "[[]]",      "{}",
                                         "\"type\"",  "\"box\"",
                                         "\"space\"", "\"\"",
                                         "1000",      "9007199254740993",
                                         "\xff",      "\xf0\x9f",
                                         "\\u0000",   "\n"};

}  // namespace

TEST_CASE("truncated at every byte") {
  const Scratch scratch;
  for (const std::string text :
       {valid_study, diagnosis_study, uncertain_study, study_test::design_study, sweep_study}) {
    for (std::size_t size = 0; size + 2 < text.size(); ++size)
      CHECK_FALSE(survives(scratch, text.substr(0, size)));
  }
}

TEST_CASE("random bytes and tokens exchanged") {
  const Scratch scratch;
  CHECK(rc::check("damaged studies", [&] {
    std::string text = *rc::gen::element(valid_study, diagnosis_study, uncertain_study,
                                         study_test::design_study, sweep_study);
    for (int edits = *rc::gen::inRange(1, 6); edits > 0; --edits) {
      const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
      switch (*rc::gen::inRange(0, 4)) {
        case 0:
          text[at] = *rc::gen::arbitrary<char>();
          break;
        case 1:
          text.erase(at, *rc::gen::inRange<std::size_t>(1, 20));
          break;
        case 2:
          text.insert(at, *rc::gen::elementOf(tokens));
          break;
        default:
          text.insert(at, text.substr(*rc::gen::inRange<std::size_t>(0, text.size()),
                                      *rc::gen::inRange<std::size_t>(1, 60)));
      }
      if (text.empty()) text = "{";
    }
    survives(scratch, text);
  }));
}

TEST_CASE("every value exchanged for every token") {
  const Scratch scratch;
  int valid = 0, refused = 0;
  std::mt19937_64 random(99);
  for (const std::string text :
       {valid_study, diagnosis_study, uncertain_study, study_test::design_study, sweep_study}) {
    for (std::size_t at = 0; at < text.size(); ++at) {
      const bool starts = text[at] == '[' || text[at] == '{' || text[at] == '"' ||
                          (text[at] >= '0' && text[at] <= '9');
      if (!starts) continue;
      std::size_t end = at + 1;
      if (text[at] == '"') end = text.find('"', at + 1) + 1;
      if (text[at] == '[') end = text.find(']', at + 1) + 1;
      if (text[at] == '{') end = text.find('}', at + 1) + 1;
      for (int i = 0; i < 3; ++i) {
        std::string damaged = text;
        damaged.replace(at, end - at, tokens[random() % tokens.size()]);
        ++(survives(scratch, damaged) ? valid : refused);
      }
    }
  }
  CHECK(valid > 10);
  CHECK(refused > 100);
}

TEST_CASE("sizes beyond the limits are refused before memory is asked for") {
  const Scratch scratch;
  std::string many = "[";
  for (int i = 0; i < 2000; ++i) many += "0,";
  many += "0]";
  std::string rows = "[";
  for (int i = 0; i < 600; ++i) rows += many + ",";
  rows += many + "]";
  CHECK_FALSE(survives(scratch, exchanged(valid_study, "[[0.5, 1], [0, 2]]", rows)));
  CHECK_FALSE(survives(scratch, exchanged(valid_study, "[[0.5, 1], [0, 2]]", "[" + many + "]")));
  CHECK_FALSE(
      survives(scratch, exchanged(valid_study, "\"lower\": [-1, -1, -1]", "\"lower\": " + many)));
  CHECK_FALSE(survives(
      scratch, exchanged(valid_study, "\"a study\"", "\"" + std::string(1 << 20, 'x') + "\"")));
  CHECK_FALSE(survives(
      scratch, exchanged(valid_study, "\"title\"", "\"" + std::string(1 << 20, '/') + "\"")));
}
