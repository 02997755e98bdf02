// SPDX-License-Identifier: GPL-3.0-or-later
// The lines that a stream answers with, and those of its log.
#pragma once

#include <string>
#include <vector>

#include "cordon/study/alarms.hpp"
#include "cordon/study/online.hpp"

namespace cordon::apps {

/// What became of a sample that was not simply the next one.
std::string line_of(const Taken& taken, std::int64_t line);
/// Alarms that change by a request.
std::string line_of(Request request, const std::vector<AlarmChange>& alarms);
/// Everything that is wrong, on one line.
std::string error_text(const Error& error);
/// ", 2 refused, 3 filled": of samples that were not simply the next ones; "" where all were.
std::string counts_text(const TakenCounts& counts, std::int64_t refused);
/// What is wrong with a line; 0: with no line.
std::string error_line(const Error& error, std::int64_t line);

/// A sample or a request as it is given, and an alarm that has changed.
std::string log_line(const GivenLine& given);
std::string log_line(const AlarmChange& change);

}  // namespace cordon::apps
