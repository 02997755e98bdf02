// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

namespace cordon::report {

namespace {

/// Without the noise of 3 · 0.1.
double clean(double value) { return std::strtod(fmt::format("{:.14g}", value).c_str(), nullptr); }

}  // namespace

std::string superscript(int number) {
  constexpr std::array<std::string_view, 10> digits = {"⁰", "¹", "²", "³", "⁴",
                                                       "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out;
  for (const char c : std::to_string(number))
    out += c == '-' ? "⁻" : digits[static_cast<std::size_t>(c - '0')];
  return out;
}

std::vector<double> nice_ticks(double lower, double upper, int count, bool whole) {
  const double rough = (upper - lower) / std::max(1, count);
  if (!(rough > 0) || !std::isfinite(rough)) return {lower};
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= rough * (1 - 1e-9)) step = factor * power;
  }
  if (whole) step = std::max(1.0, step);
  std::vector<double> ticks;
  const double first = std::ceil(lower / step - 1e-9), last = std::floor(upper / step + 1e-9);
  for (int i = 0; first + i <= last && i < 100; ++i) {
    const double tick = clean((first + i) * step) + 0.0;
    // far from the origin, ticks may not be told apart
    if (ticks.empty() || tick != ticks.back()) ticks.push_back(tick);
  }
  return ticks;
}

std::vector<double> upright_ticks(double lower, double upper, int count) {
  std::vector<double> ticks = nice_ticks(lower, upper, count);
  return ticks.size() < 3 && count >= 3 ? nice_ticks(lower, upper, 2 * count) : ticks;
}

std::vector<double> log_ticks(double lower, double upper) {
  const int first = static_cast<int>(std::floor(std::log10(lower) + 1e-9)),
            last = static_cast<int>(std::ceil(std::log10(upper) - 1e-9));
  const int every = std::max(1, (last - first + 7) / 8);
  std::vector<double> ticks;
  for (int power = first; power <= last; power += every) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = clean(factor * std::pow(10.0, power));
      const bool wanted = factor == 1 || last - first <= 3;
      if (wanted && tick >= lower * (1 - 1e-9) && tick <= upper * (1 + 1e-9)) ticks.push_back(tick);
    }
  }
  return ticks.size() < 3 ? upright_ticks(lower, upper, 4) : ticks;
}

bool has_powers(double lower, double upper) {
  const std::vector<double> ticks = log_ticks(lower, upper);
  return !ticks.empty() && (ticks.front() < 1e-3 || ticks.back() > 1e4);
}

std::string short_text(double value, int digits) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  std::string text = fmt::format("{:.{}e}", value, digits - 1);
  const std::size_t e = text.find('e');
  const int exponent = std::atoi(text.c_str() + e + 1);
  if (value != 0 && (exponent >= 6 || exponent < -4)) {
    std::string mantissa = text.substr(0, e);
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
    if (mantissa == "1" || mantissa == "-1") {
      mantissa.pop_back();
    } else {
      mantissa += "·";
    }
    text = mantissa + "10" + superscript(exponent);
  } else {
    text = fmt::format("{:.{}g}", value == 0 ? 0.0 : value, digits);
  }
  return text[0] == '-' ? "−" + text.substr(1) : text;
}

int digits_within(double lower, double upper) {
  const double size = std::max(std::abs(lower), std::abs(upper)) / (upper - lower);
  return std::isfinite(size) && size > 0
             ? std::clamp(static_cast<int>(std::ceil(std::log10(size))) + 4, 6, 15)
             : 6;
}

std::string log_text(double value, bool powers) {
  if (!powers) return short_text(value);
  const double power = std::floor(std::log10(value) + 1e-9);
  const std::string factor = short_text(value / std::pow(10.0, power)),
                    ten = "10" + superscript(static_cast<int>(power));
  return factor == "1" ? ten : factor + "·" + ten;
}

double Axis::operator()(double value) const {
  const double beyond = 20 * (end - begin);
  if (std::isinf(value)) return value > 0 ? begin + beyond : begin - beyond;
  if (log && !(value > 0)) return begin - beyond;
  const double share =
      log ? std::log(value / lower) / std::log(upper / lower) : (value - lower) / (upper - lower);
  return begin + std::clamp(share, -20.0, 20.0) * (end - begin);
}

Axis axis_over(const std::vector<double>& values, bool log, double begin, double end) {
  double lower = INFINITY, upper = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value) || (log && value <= 0)) continue;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  if (lower > upper) return {log ? 0.1 : 0.0, log ? 10.0 : 1.0, begin, end, log};
  if (log) {
    const double margin = lower == upper ? 2 : std::pow(upper / lower, 0.05);
    return {lower / margin, upper * margin, begin, end, log};
  }
  const double margin =
      lower == upper ? (lower != 0 ? 0.1 * std::abs(lower) : 1) : 0.05 * (upper - lower);
  return {lower >= 0 && lower < 0.35 * upper ? 0.0 : lower - margin, upper + margin, begin, end,
          log};
}

}  // namespace cordon::report
