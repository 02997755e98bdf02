// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas over numbers of 200 digits, their derivatives by differences: nothing is shared with the
// rules of the product.
#pragma once

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <boost/multiprecision/mpfr.hpp>

#include "cordon/formulas/evaluator.hpp"
#include "cordon/formulas/parse.hpp"

namespace cordon::test {

using Digits = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<200>,
                                             boost::multiprecision::et_off>;

/// How often a random test is repeated; more at night.
inline int repetitions(int usual) {
  const char* wanted = std::getenv("CORDON_FORMULAS");
  return wanted ? std::max(usual, std::atoi(wanted)) : usual;
}

/// `place`: where within constants that are intervals their numbers are, from 0 to 1.
inline Digits value_of(const formulas::Graph& graph, int node, const std::vector<Digits>& x,
                       double place = 0.5) {
  using formulas::Operation;
  std::vector<Digits> values(static_cast<std::size_t>(node) + 1);
  const auto within = [&](Interval range) {
    return Digits(range.lower) + (Digits(range.upper) - Digits(range.lower)) * place;
  };
  for (int i = 0; i <= node; ++i) {
    const formulas::Node& n = graph[i];
    const Digits a = n.a >= 0 ? values[static_cast<std::size_t>(n.a)] : Digits(0),
                 b = n.b >= 0 ? values[static_cast<std::size_t>(n.b)] : Digits(0);
    Digits& result = values[static_cast<std::size_t>(i)];
    switch (n.operation) {
      case Operation::constant:
        result = within(n.value);
        break;
      case Operation::variable:
        result = x[static_cast<std::size_t>(n.number)];
        break;
      case Operation::add:
        result = a + b;
        break;
      case Operation::subtract:
        result = a - b;
        break;
      case Operation::negate:
        result = -a;
        break;
      case Operation::multiply:
        result = a * b;
        break;
      case Operation::power: {
        result = 1;
        for (int k = 0; k < std::abs(n.number); ++k) result *= a;
        if (n.number < 0) result = 1 / result;
        break;
      }
      case Operation::real_power:
        result = exp(within(n.value) * log(a));
        break;
      case Operation::square_root:
        result = sqrt(a);
        break;
      case Operation::exponential:
        result = exp(a);
        break;
      case Operation::logarithm:
        result = log(a);
        break;
      case Operation::sine:
        result = sin(a);
        break;
      case Operation::cosine:
        result = cos(a);
        break;
      case Operation::tangent:
        result = tan(a);
        break;
      case Operation::arcsine:
        result = asin(a);
        break;
      case Operation::arccosine:
        result = acos(a);
        break;
      case Operation::arctangent:
        result = atan(a);
        break;
      case Operation::absolute_value:
        result = abs(a);
        break;
      case Operation::minimum:
        result = isnan(a) || isnan(b) ? a + b : (a < b ? a : b);
        break;
      case Operation::maximum:
        result = isnan(a) || isnan(b) ? a + b : (a > b ? a : b);
        break;
    }
  }
  return values[static_cast<std::size_t>(node)];
}

inline std::vector<Digits> digits(const std::vector<double>& x) { return {x.begin(), x.end()}; }

inline const Digits& difference_step() {
  static const Digits h("1e-50");
  return h;
}

/// Central differences, with an error of h² times derivatives of higher order.
inline Digits derivative_of(const formulas::Graph& graph, int node, std::vector<Digits> x, int i) {
  const Digits h = difference_step();
  x[static_cast<std::size_t>(i)] += h;
  const Digits ahead = value_of(graph, node, x);
  x[static_cast<std::size_t>(i)] -= 2 * h;
  return (ahead - value_of(graph, node, x)) / (2 * h);
}

inline Digits second_derivative_of(const formulas::Graph& graph, int node, std::vector<Digits> x,
                                   int i, int j) {
  const Digits h = difference_step();
  x[static_cast<std::size_t>(j)] += h;
  const Digits ahead = derivative_of(graph, node, x, i);
  x[static_cast<std::size_t>(j)] -= 2 * h;
  return (ahead - derivative_of(graph, node, x, i)) / (2 * h);
}

inline bool holds(Interval range, const Digits& x) {
  return Digits(range.lower) <= x && x <= Digits(range.upper);
}

using Random = std::mt19937_64;

inline double uniform(Random& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}
inline int among(Random& random, int count) {
  return std::uniform_int_distribution<int>(0, count - 1)(random);
}

/// A formula of `operations` random operations over the graph's variables.
inline int random_formula(formulas::Graph& graph, Random& random, int operations,
                          bool smooth = false) {
  using namespace formulas;
  std::vector<Expression> made;
  for (Index i = 0; i < graph.variables(); ++i) made.push_back(graph.variable(i));
  made.push_back(graph.constant(uniform(random, -3, 3)));
  made.push_back(graph.constant(static_cast<double>(among(random, 5))));
  const auto any = [&] {
    // More often what was made last, so that most of it is used.
    const int back = std::min(among(random, static_cast<int>(made.size())),
                              among(random, static_cast<int>(made.size())));
    return made[made.size() - 1 - static_cast<std::size_t>(back)];
  };
  for (int k = 0; k < operations; ++k) {
    const Expression a = any(), b = any();
    switch (among(random, smooth ? 18 : 21)) {
      case 0:
      case 1:
        made.push_back(a + b);
        break;
      case 2:
        made.push_back(a - b);
        break;
      case 3:
      case 4:
      case 5:
        made.push_back(a * b);
        break;
      case 6:
        made.push_back(a / b);
        break;
      case 7:
        made.push_back(power(a, among(random, 9) - 4));
        break;
      case 8:
        made.push_back(sqrt(a));
        break;
      case 9:
        made.push_back(exp(a));
        break;
      case 10:
        made.push_back(log(a));
        break;
      case 11:
        made.push_back(sin(a));
        break;
      case 12:
        made.push_back(cos(a));
        break;
      case 13:
        made.push_back(tan(a));
        break;
      case 14:
        made.push_back(asin(a));
        break;
      case 15:
        made.push_back(acos(a));
        break;
      case 16:
        made.push_back(atan(a));
        break;
      case 17:
        made.push_back(power(a, uniform(random, -2, 3)));
        break;
      case 18:
        made.push_back(abs(a));
        break;
      case 19:
        made.push_back(min(a, b));
        break;
      default:
        made.push_back(max(a, b));
        break;
    }
  }
  return made.back().node();
}

inline std::vector<std::string> variable_names(int count) {
  std::vector<std::string> names;
  for (int i = 1; i <= count; ++i) names.push_back("x" + std::to_string(i));
  return names;
}

/// The node of a formula in the graph's variables.
inline int node_of(const std::string& formula, formulas::Graph& graph) {
  formulas::Vocabulary vocabulary;
  for (Index i = 0; i < graph.variables(); ++i)
    vocabulary.known.emplace(graph.name(static_cast<int>(i)), graph.variable(i));
  std::vector<formulas::FormulaError> errors;
  return formulas::parse(formula, graph, vocabulary, errors).value().node();
}

/// Bounded where they are defined, though a part of them is not.
inline const std::vector<std::string> formulas_with_poles = {
    "asin((8 - x1^-2)^-2)", "sin(x1^-2)",    "atan(x1^-2)",
    "exp(-x1^-2)",          "sin(1/x1)",     "atan(1/x1)",
    "x1*atan(x1^-3)",       "atan(tan(x1))", "cos(tan(2*x1))",
    "atan(x1^-0.5)*x1"};
inline const std::vector<std::vector<Interval>> boxes_with_poles = {
    {{-2.621841209400408, 3.7517703636521409}}, {{-1, 1}}, {{-0.25, 2}}, {{0, 3}}, {{-3, 0}}};

/// The middles of so many parts.
inline std::vector<double> points_between(Interval side, int count) {
  std::vector<double> points;
  for (int i = 0; i < count; ++i)
    points.push_back(side.lower + (side.upper - side.lower) * (i + 0.5) / count);
  return points;
}

}  // namespace cordon::test
