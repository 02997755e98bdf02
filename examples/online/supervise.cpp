// SPDX-License-Identifier: GPL-3.0-or-later
// The tanks supervised from a program of one's own: supervise STUDY < lines of samples
#include <cordon/study/online.hpp>
#include <iostream>
#include <string>

using namespace cordon;

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    Registry registry;
    const Study study = read_study(argv[1], registry, default_search_path(), StudyPlugins::refuse,
                                   StudyData::optional);
    OnlineSession session(study, registry, "supervision");
    SampleLines lines(study);  // samples may come from anywhere: a GivenSample is k, u and y
    for (std::string line; std::getline(std::cin, line);) {
      try {
        const GivenLine given = lines.read(line);
        if (!given.sample) continue;
        for (const TakenStep& step : session.take(*given.sample).steps) {
          for (const AlarmChange& change : step.alarms)
            std::cout << to_string(change.what) << ": " << change.alarm.text << '\n';
        }
      } catch (const Error& error) {
        if (session.has_ended()) throw;
        std::cerr << error.what() << '\n';  // of this line: the next one may be right
      }
    }
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
