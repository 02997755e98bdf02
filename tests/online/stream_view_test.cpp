// SPDX-License-Identifier: GPL-3.0-or-later
// What people see of a stream: pictures that fit their terminal, and lines elsewhere.
#include "stream_view.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include <doctest/doctest.h>

#include "online/study.hpp"

using namespace online_test;
using apps::StreamView;
using apps::TerminalSize;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Characters that are shown: without escape sequences.
std::size_t width_of(const std::string& line) {
  std::size_t width = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\x1b') {
      i = line.find_first_of("AmKJ", i);
    } else if (line[i] != '\r' && (static_cast<unsigned char>(line[i]) & 0xC0) != 0x80) {
      ++width;
    }
  }
  return width;
}

/// All that is written of a plant that leaks from k = 30 on.
struct Watched {
  Watched(const std::string& pipeline, std::optional<TerminalSize> terminal, int steps = 60)
      : session(loaded.study, loaded.registry, pipeline), view(loaded.study, session, terminal) {
    LeakyPlant plant;
    for (int k = 0; k < steps; ++k) text += view.show(session.take(plant.next(k >= 30)));
    last = view.last();
  }
  Loaded loaded{R"({"jumps": "fill"})"};
  OnlineSession session;
  StreamView view;
  std::string text, last;
};

}  // namespace

TEST_CASE("off a terminal every step, alarm and refused line is a line") {
  Watched bank("bank", std::nullopt);
  const auto lines = lines_of(bank.text);
  CHECK(lines.size() >= 61);
  CHECK(bank.text.find("\x1b") == std::string::npos);
  CHECK(bank.text.find("alarm raised at k = 3") != std::string::npos);
  CHECK(bank.last.empty());
  const Error error(Errc::invalid, "no\x1b[2J such line");
  CHECK(bank.view.show(error, 7) == "line 7 is refused: no\\u001b[2J such line\n");
  const auto changes = bank.session.acknowledge();
  CHECK(bank.view.show(changes).find("alarm acknowledged") == 0);
  Watched levels("zonotope", std::nullopt);
  CHECK(lines_of(levels.text)[0].find("k = 0  x_1 [") == 0);
}

TEST_CASE("pictures fit the terminal, whatever its size") {
  for (const std::size_t rows : {1, 2, 5, 10, 24}) {
    for (const std::size_t columns : {1, 2, 20, 80}) {
      for (const char* pipeline : {"bank", "constrained"}) {
        CAPTURE(rows);
        CAPTURE(columns);
        const Watched watched(pipeline, TerminalSize{rows, columns});
        const auto lines = lines_of(watched.last);
        CHECK(lines.size() <= std::max<std::size_t>(rows, 2) - 1);
        for (const std::string& line : lines)
          CHECK(width_of(line) <= std::max<std::size_t>(columns, 2));
      }
    }
  }
}

TEST_CASE("bounds at the ends of the numbers have their place in a picture") {
  const Loaded loaded;
  OnlineSession session(loaded.study, loaded.registry, "zonotope");
  StreamView view(loaded.study, session, TerminalSize{20, 100});
  const double most = std::numeric_limits<double>::max(), none = HUGE_VAL;
  for (const auto& [lower, upper] :
       {std::pair{-most, most}, std::pair{-none, none}, std::pair{-none, 0.},
        std::pair{5e-324, 1e-320}, std::pair{most / 2, most}}) {
    SessionStep told;
    told.estimate.emplace();
    told.estimate->estimate.set = session.session().backend().point(Vector::Zero(2));
    told.estimate->hull = {Vector::Constant(2, lower), Vector::Constant(2, upper)};
    Taken taken;
    taken.steps.push_back({told});
    view.show(taken);
    CHECK(view.last().find("x_1 [") != std::string::npos);
  }
}

TEST_CASE("a picture shows modes, bounds, alarms and counts") {
  const auto shows = [](const std::string& picture, const std::vector<const char*>& all) {
    for (const char* what : all)
      CHECK_MESSAGE(picture.find(what) != std::string::npos, what, picture);
  };
  shows(Watched("bank", TerminalSize{40, 100}, 20).last,
        {"bank", "k = 19", "healthy", "monitored", "leak", "excluded", "x_1", "|", "#",
         "no alarm stands", "20 samples"});
  const std::string picture = Watched("bank", TerminalSize{40, 100}).last;
  shows(picture, {"bank", "k = 59", "excluded", "ALARM, raised at k = 31: the samples",
                  "last: alarm", "60 samples"});
  CHECK(lines_of(picture)[0].find("\x1b[") == 0);  // goes up to the picture before
}
