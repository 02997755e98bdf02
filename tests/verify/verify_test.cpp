// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon verify` on one short run: falsified results end with code 4 and name the place, damaged
// files with code 2 and a message.
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::Outcome;

constexpr int unharmed = 0, refused = 2, violated = 4, undecided = 5;

Outcome cordon(const std::string& arguments) { return test::cordon_with(arguments + " 2>&1"); }

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

Json pipeline(const std::string& backend, const std::string& rounding) {
  return {{"name", backend + " " + rounding},
          {"backend", {{"type", backend}, {"rounding", rounding}}},
          {"observer", {{"type", "prediction_correction"}}}};
}

/// A run of four steps that every test copies.
class Run {
 public:
  Run() {
    const auto box = [](const Json& lower, const Json& upper) {
      return Json{{"type", "box"}, {"lower", lower}, {"upper", upper}};
    };
    Json study{{"cordon", 1}, {"title", "two states"}};
    study["system"] = {{"type", "lti"},
                       {"A", {{0.9, 0.2}, {0.0, 0.8}}},
                       {"Bw", {{1.0, 0.0}, {0.0, 1.0}}},
                       {"C", Json::array({{1.0, 0.0}})},
                       {"Dv", Json::array({Json::array({1.0})})},
                       {"X0", box({-1, -1}, {1, 1})},
                       {"W", box({-.1, -.1}, {.1, .1})},
                       {"V", box(Json::array({-.2}), Json::array({.2}))}};
    study["data"]["simulate"] = {{"steps", 3}, {"seed", 1}, {"noise", "uniform"}, {"x0", {.5, .5}}};
    for (const char* backend : {"line_zonotope", "constrained_zonotope", "zonotope", "interval"}) {
      study["pipelines"].push_back(pipeline(backend, "nominal"));
    }
    write(home_ / "study.json", study.dump());
    const Outcome outcome =
        cordon("run --quiet --out " + original().string() + " " + (home_ / "study.json").string());
    CAPTURE(outcome.out);
    REQUIRE(outcome.code == 0);
  }
  fs::path original() const { return home_ / "original"; }

  /// What `verify` says of a copy after `change`.
  Outcome verify(const std::function<void(const fs::path&)>& change) const {
    const fs::path copy = home_ / "copy";
    fs::remove_all(copy);
    fs::copy(original(), copy, fs::copy_options::recursive);
    fs::remove(copy / "manifest.json");  // which knows the files as they were
    change(copy);
    return cordon("verify " + copy.string());
  }
  Outcome with_results(const std::function<void(Json&)>& change) const {
    return verify([&](const fs::path& copy) {
      Json results = Json::parse(bytes_of(copy / "results.json"));
      change(results);
      write(copy / "results.json", results.dump());
    });
  }
  Outcome with_set(std::size_t line, const std::function<void(Json&)>& change) const {
    return verify([&](const fs::path& copy) {
      std::istringstream lines(bytes_of(copy / "sets.jsonl"));
      std::string all, text;
      for (std::size_t i = 0; std::getline(lines, text); ++i) {
        Json set = Json::parse(text);
        if (i == line) change(set);
        all += set.dump() + "\n";
      }
      write(copy / "sets.jsonl", all);
    });
  }
  Outcome with_text(const char* file, const std::string& old, const std::string& now) const {
    return verify([&](const fs::path& copy) {
      std::string text = bytes_of(copy / file);
      const std::size_t at = text.find(old);
      REQUIRE(at != std::string::npos);
      write(copy / file, text.replace(at, old.size(), now));
    });
  }

 private:
  Scratch home_;
};

const Run& run() {
  static const Run one;
  return one;
}

bool names(const Outcome& outcome, const std::string& text) {
  return outcome.out.find(text) != std::string::npos;
}

constexpr std::size_t pipelines = 4, steps = 4;

}  // namespace

TEST_CASE("a run that was not touched is verified") {
  const Outcome outcome = run().verify([](const fs::path&) {});
  CAPTURE(outcome.out);
  CHECK(outcome.code == unharmed);
}

TEST_CASE("diagnoses are passed over and named; what surrounds them is checked") {
  const Json diagnosis{{"name", "bank of observers"},
                       {"backend", "zonotope"},
                       {"diagnoser", "observer_bank"},
                       {"rounding", "nominal"},
                       {"steps", {{{"k", 0}, {"decision", "monitoring"}}}}};
  const auto amid = [&](Json& results) {
    Json& all = results["pipelines"];
    all.insert(all.begin() + 1, diagnosis);
  };
  Outcome outcome = run().with_results(amid);
  CAPTURE(outcome.out);
  CHECK(outcome.code == unharmed);
  CHECK(names(outcome, "not re-checked: bank of observers"));
  CHECK(names(outcome, "Every claim that was checked holds."));
  outcome = run().with_results([&](Json& results) {
    amid(results);
    Json& bound = results["pipelines"][4]["steps"][2]["hull"]["upper"][0];
    bound = bound.get<double>() - 1e-6;
  });
  CHECK(outcome.code == violated);
  CHECK(names(outcome, "/pipelines/4/steps/2/hull"));
  outcome = run().verify([&](const fs::path& copy) {
    Json results = Json::parse(bytes_of(copy / "results.json"));
    results["pipelines"] = {diagnosis};
    write(copy / "results.json", results.dump());
    write(copy / "sets.jsonl", "");
  });
  CHECK(outcome.code == undecided);
  CHECK(names(outcome, "nothing was checked"));
  CHECK(names(outcome, "not re-checked: bank of observers"));
  CHECK_FALSE(names(outcome, "Every claim"));
  Json damaged = diagnosis;
  damaged["rounding"] = "sideways";
  CHECK(run().with_results([&](Json& results) { results["pipelines"].push_back(damaged); }).code ==
        refused);
}

TEST_CASE("a bound moved inward by 1e-6 is found, for every backend and coordinate") {
  for (std::size_t p = 0; p < pipelines; ++p) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (const std::string side : {"lower", "upper"}) {
        const Outcome outcome = run().with_results([&](Json& results) {
          Json& bound = results["pipelines"][p]["steps"][steps - 1]["hull"][side][i];
          bound = bound.get<double>() + (side == "lower" ? 1e-6 : -1e-6);
        });
        CAPTURE(p);
        CAPTURE(i);
        CAPTURE(side);
        CAPTURE(outcome.out);
        CHECK(outcome.code == violated);
        CHECK(names(outcome, "/pipelines/" + std::to_string(p) + "/steps/3/hull"));
      }
    }
  }
}

TEST_CASE("falsified sets, answers, claims and proofs are found where they stand") {
  const auto found = [](const Outcome& outcome, const std::string& place) {
    CAPTURE(outcome.out);
    CHECK(outcome.code == violated);
    CHECK(names(outcome, place));
  };
  for (const std::size_t p : {std::size_t{0}, std::size_t{1}}) {
    const std::size_t last = p * steps + steps - 1;
    const std::string line = "sets.jsonl:" + std::to_string(last + 1),
                      hull = "/pipelines/" + std::to_string(p) + "/steps/3/hull";
    found(run().with_set(last,
                         [](Json& set) {
                           for (Json& row : set["G"]) {
                             for (Json& entry : row) entry = 0.98 * entry.get<double>();
                           }
                         }),
          hull);  // its stored proofs are about other generators
    found(run().with_set(
              last,
              [](Json& set) {
                set["proof"] = {{"kind", "farkas"}, {"margin", 1.0}, {"data", Json::array()}};
              }),
          line);
    found(run().with_results([&](Json& results) {
      results["pipelines"][p]["steps"][steps - 1]["consistent"] = "no";
    }),
          line);
  }
  // the first set of the intervals is the exact one; smaller by a millionth, it lies in its hull
  // still
  found(run().with_set(3 * steps,
                       [](Json& set) {
                         for (Json& row : set["G"]) {
                           for (Json& entry : row) entry = (1 - 1e-6) * entry.get<double>();
                         }
                       }),
        "sets.jsonl:13");
  // zonotopes enclose the strip's intersection only
  const std::size_t zonotope = 2;
  found(run().with_results([&](Json& results) {
    results["pipelines"][zonotope]["steps"][steps - 1]["tightness"] = "exact";
  }),
        "sets.jsonl:12");
  // a measurement that the model does not allow for the sets that were recorded
  found(run().verify([](const fs::path& copy) {
    std::istringstream lines(bytes_of(copy / "data.csv"));
    std::string all, text;
    for (int row = 0; std::getline(lines, text); ++row) {
      if (row == 3) {
        const std::size_t comma = text.find(','), next = text.find(',', comma + 1);
        const double y = std::stod(text.substr(comma + 1, next - comma - 1));
        text = text.substr(0, comma + 1) + std::to_string(y + 0.05) + text.substr(next);
      }
      all += text + "\n";
    }
    write(copy / "data.csv", all);
  }),
        "/pipelines/0/steps/2/hull");
}

TEST_CASE("damaged files are refused with their place") {
  const auto refuses = [](const Outcome& outcome, const std::string& place) {
    CAPTURE(outcome.out);
    CHECK(outcome.code == refused);
    CHECK(names(outcome, place));
  };
  for (const char* file : {"results.json", "sets.jsonl", "data.csv"}) {
    CAPTURE(file);
    refuses(run().verify([&](const fs::path& copy) { fs::remove(copy / file); }), file);
    refuses(run().verify([&](const fs::path& copy) { write(copy / file, ""); }), file);
    refuses(run().verify([&](const fs::path& copy) {
      const std::string text = bytes_of(copy / file);
      write(copy / file, text.substr(0, text.size() / 2));
    }),
            file);
  }
  refuses(run().with_text("sets.jsonl", "\"dim\": 2", "\"dim\": 3"), "line 1");
  refuses(run().with_text("sets.jsonl", "\"generators\": 3", "\"generators\": 1e300"), "line 1");
  refuses(run().with_text("sets.jsonl", "\"c\": [0, 0]", "\"c\": [0, NaN]"), "/c/1");
  refuses(run().with_text("sets.jsonl", "\"c\": [0, 0]", "\"c\": [0, 1e999]"), "/c/1");
  refuses(run().with_text("sets.jsonl", "\"k\": 0", "\"k\": 0, \"k\": 0"), "repeated");
  refuses(run().with_text("sets.jsonl", "\"k\": 0", "\"k\": 1"), "k = 0");
  refuses(run().verify([](const fs::path& copy) {
    const std::string text = bytes_of(copy / "sets.jsonl");
    const std::size_t first = text.find('\n') + 1, second = text.find('\n', first) + 1;
    write(copy / "sets.jsonl",
          text.substr(first, second - first) + text.substr(0, first) + text.substr(second));
  }),
          "line 1");
  refuses(run().verify([](const fs::path& copy) {  // a step that is in no file any more
    Json results = Json::parse(bytes_of(copy / "results.json"));
    results["pipelines"][0]["steps"].erase(1);
    write(copy / "results.json", results.dump());
    const std::string text = bytes_of(copy / "sets.jsonl");
    const std::size_t first = text.find('\n') + 1, second = text.find('\n', first) + 1;
    write(copy / "sets.jsonl", text.substr(0, first) + text.substr(second));
  }),
          "has no step k = 1");
  refuses(run().verify([](const fs::path& copy) {  // nor the last one
    Json results = Json::parse(bytes_of(copy / "results.json"));
    results["pipelines"][0]["steps"].erase(steps - 1);
    write(copy / "results.json", results.dump());
    std::istringstream lines(bytes_of(copy / "sets.jsonl"));
    std::string text, kept;
    for (int line = 0; std::getline(lines, text); ++line) {
      if (line != steps - 1) kept += text + "\n";
    }
    write(copy / "sets.jsonl", kept);
  }),
          "has no step k = " + std::to_string(steps - 1));
  refuses(run().with_text("data.csv", "y_1", "w_1"), "y_1");
  refuses(run().with_text("data.csv", "\n1,", "\n7,"), "k = 1");
  refuses(run().verify([](const fs::path& copy) {
    const std::string text = bytes_of(copy / "data.csv");
    write(copy / "data.csv", text.substr(0, text.find('\n', text.find('\n') + 1) + 1));
  }),
          "k = 1");
}

TEST_CASE("what two files say of one set, or a summary of its steps, has to be the same") {
  const auto refuses = [](const Outcome& outcome, const std::string& place) {
    CAPTURE(outcome.out);
    CHECK(outcome.code == refused);
    CHECK(names(outcome, place));
  };
  const std::size_t zonotope = 2 * steps;
  refuses(run().with_set(zonotope + 1, [](Json& set) { set["tightness"] = "exact"; }), "line 10");
  refuses(run().with_set(zonotope + 1, [](Json& set) { set["consistent"] = "no"; }), "line 10");
  refuses(run().with_set(zonotope + 1, [](Json& set) { set["tightness"] = "tight"; }), "line 10");
  const auto with = [](const char* part, const char* key, const Json& value) {
    return run().with_results([&](Json& results) { results["pipelines"][1][part][key] = value; });
  };
  for (const char* part : {"summary", "numbers"}) {
    for (const char* key : {"steps", "consistent", "inconsistent", "undecided"})
      refuses(with(part, key, 13), std::string("/pipelines/1/") + part + "/" + key);
    refuses(with(part, "inconsistent_from", 0),
            std::string("/pipelines/1/") + part + "/inconsistent_from");
  }
  refuses(with("last", "k", 2), "/pipelines/1/last");
  refuses(with("last", "width", {1e-9, 1e-9}), "/pipelines/1/last");
  refuses(run().with_results(
              [](Json& results) { results["pipelines"][1]["last"]["hull"]["upper"][0] = 101; }),
          "/pipelines/1/last");
}

TEST_CASE("numbers at the ends of the range end in a verdict, not in a crash") {
  for (const char* huge : {"1e308", "-1e308", "1e-320", "1e150"}) {
    CAPTURE(huge);
    for (const Outcome& outcome :
         {run().with_text("sets.jsonl", "\"c\": [0", "\"c\": [" + std::string(huge)),
          run().with_text("sets.jsonl", "\"A\": [[1", "\"A\": [[" + std::string(huge)),
          run().with_text("sets.jsonl", "\"data\": [1", "\"data\": [" + std::string(huge))}) {
      CAPTURE(outcome.out);
      CHECK((outcome.code == unharmed || outcome.code == refused || outcome.code == violated ||
             outcome.code == 5));
    }
  }
}

TEST_CASE("answers and bounds without a certificate are decided by the recorded set") {
  const auto without_proofs = [](Json& set) {
    set["proof"] = {{"kind", "none"}};
    set.erase("hull_proofs");
  };
  for (std::size_t p = 0; p < pipelines; ++p) {
    CAPTURE(p);
    Outcome outcome = run().with_set(p * steps + 1, without_proofs);
    CAPTURE(outcome.out);
    CHECK(outcome.code == unharmed);
    outcome = run().with_set(p * steps + 1, [&](Json& set) {
      without_proofs(set);
      for (Json& row : set["G"]) {
        for (Json& entry : row) entry = 1.5 * entry.get<double>();
      }
    });
    CAPTURE(outcome.out);
    CHECK(outcome.code == violated);
  }
  const Outcome outcome = run().verify([](const fs::path& copy) {
    Json results = Json::parse(bytes_of(copy / "results.json"));
    results["pipelines"][0]["steps"][1]["consistent"] = "no";
    write(copy / "results.json", results.dump());
    std::istringstream lines(bytes_of(copy / "sets.jsonl"));
    std::string all, text;
    for (std::size_t i = 0; std::getline(lines, text); ++i) {
      Json set = Json::parse(text);
      if (i == 1) set["proof"] = {{"kind", "none"}};
      all += set.dump() + "\n";
    }
    write(copy / "sets.jsonl", all);
  });
  CAPTURE(outcome.out);
  CHECK(outcome.code == violated);
  CHECK(names(outcome, "without a proof"));
}
