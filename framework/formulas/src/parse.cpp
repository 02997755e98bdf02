// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/parse.hpp"

#include <algorithm>

#include "cordon/core/error.hpp"
#include "cordon/formulas/elementary.hpp"
#include "tokens.hpp"

namespace cordon::formulas {

namespace {

constexpr std::string_view discontinuous[] = {"sign",  "sgn", "if",   "floor", "ceil",
                                              "round", "mod", "fmod", "step",  "heaviside"};
constexpr std::pair<std::string_view, std::string_view> other_names[] = {
    {"ln", "log"},      {"pow", "^"},       {"power", "^"},  {"square", "^2"}, {"arcsin", "asin"},
    {"arccos", "acos"}, {"arctan", "atan"}, {"fabs", "abs"}, {"tg", "tan"},
};

const FunctionName* function_of(std::string_view name) {
  for (const FunctionName& function : function_names())
    if (function.name == name) return &function;
  return nullptr;
}

std::string quoted(std::string_view text) { return "\"" + std::string(text.substr(0, 60)) + "\""; }

class Parser {
 public:
  Parser(std::string_view text, Graph& graph, const Vocabulary& vocabulary,
         std::vector<FormulaError>& errors)
      : tokens_(text), graph_(graph), vocabulary_(vocabulary), errors_(errors) {}

  Expression formula() {
    advance();
    if (token_.kind == Token::Kind::end) fail("there is no formula");
    const Expression result = sum();
    if (token_.kind != Token::Kind::end) fail_at_rest();
    return result;
  }

 private:
  /// Counts how deep the formula is nested.
  class Depth {
   public:
    explicit Depth(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > deepest_formula)
        parser_.fail("more than " + std::to_string(deepest_formula) +
                     " parentheses, signs or exponents within each other");
    }
    ~Depth() { --parser_.depth_; }
    Depth(const Depth&) = delete;
    Depth& operator=(const Depth&) = delete;

   private:
    Parser& parser_;
  };

  void advance() { token_ = tokens_.next(); }

  [[noreturn]] void fail(std::string message, std::string suggestion = "") {
    throw NoFormula{{tokens_.column(token_.position), std::move(message), std::move(suggestion)}};
  }

  [[noreturn]] void fail_at_rest() {
    if (token_.is(')')) fail("\")\" closes nothing");
    if (token_.is(','))
      fail("a comma stands where no arguments are", "decimal numbers are written with a point");
    fail(quoted(token_.text) + " follows where the formula is complete",
         "write an operator between them");
  }

  void note(std::size_t position, std::string message, std::string suggestion = "") {
    errors_.push_back({tokens_.column(position), std::move(message), std::move(suggestion)});
  }

  /// The node, which is noted if it is constant and has no value.
  Expression checked(Expression made, std::size_t position) {
    const Node& node = graph_[made.node()];
    const auto is_constant = [&](int operand) {
      return operand < 0 || graph_[operand].operation == Operation::constant;
    };
    const bool has_operands = node.a >= 0;
    if (has_operands && is_constant(node.a) && is_constant(node.b)) {
      // What stands for an unknown name may have no value where the name would have one.
      if (!substituted_) note(position, graph_.to_string(made.node()) + " has no value");
      return graph_.constant(1.0);
    }
    return made;
  }

  /// Stands for what is wrong, so that the rest is read.
  Expression substitute() {
    substituted_ = true;
    return graph_.constant(1.0);
  }

  Expression sum() {
    Expression left = product();
    while (token_.is('+') || token_.is('-')) {
      const bool plus = token_.is('+');
      const std::size_t position = token_.position;
      advance();
      const Expression right = product();
      left = checked(plus ? left + right : left - right, position);
    }
    return left;
  }

  Expression product() {
    Expression left = sign();
    while (token_.is('*') || token_.is('/')) {
      const bool times = token_.is('*');
      const std::size_t position = token_.position;
      advance();
      const Expression right = sign();
      left = checked(left * (times ? right : checked(power(right, -1), position)), position);
    }
    return left;
  }

  Expression sign() {
    if (!token_.is('-')) return power_of_atom();
    const Depth depth(*this);
    advance();
    return -sign();
  }

  Expression power_of_atom() {
    const Expression base = atom();
    if (!token_.is('^')) return base;
    const Depth depth(*this);
    const std::size_t position = token_.position;
    advance();
    return checked(power(base, sign()), position);
  }

  Expression atom() {
    const Token token = token_;
    switch (token.kind) {
      case Token::Kind::number:
        advance();
        return graph_.constant(token.value);
      case Token::Kind::name:
        advance();
        return token_.is('(') ? call(token) : named(token);
      case Token::Kind::symbol:
        if (!token.is('('))
          fail(quoted(token.text) + " stands where a number, a name or \"(\" is expected");
        return inside_parentheses();
      case Token::Kind::end:
        break;
    }
    fail("the formula ends where a number, a name or \"(\" is expected");
  }

  Expression inside_parentheses() {
    const Depth depth(*this);
    const std::size_t position = token_.position;
    advance();
    const Expression inside = sum();
    close(position);
    return inside;
  }

  void close(std::size_t opened) {
    if (token_.is(')')) return advance();
    const std::string where = std::to_string(tokens_.column(opened));
    if (token_.kind == Token::Kind::end) fail("the \"(\" of column " + where + " is not closed");
    if (token_.is(',')) fail_at_rest();
    fail(quoted(token_.text) + " stands where \")\" is expected, for the \"(\" of column " + where,
         "write an operator before it");
  }

  Expression named(const Token& token) {
    if (token.text == "pi") return graph_.constant(elementary::pi);
    if (const auto known = vocabulary_.known.find(token.text); known != vocabulary_.known.end())
      return known->second;
    if (function_of(token.text)) {
      note(token.position, std::string(token.text) + " is a function and has no arguments here",
           "write " + std::string(token.text) + "(…)");
    } else {
      note_unknown(token, false);
    }
    return substitute();
  }

  void note_unknown(const Token& token, bool is_call) {
    const std::string name(token.text.substr(0, 60));
    if (const auto elsewhere = vocabulary_.refused.find(token.text);
        elsewhere != vocabulary_.refused.end())
      return note(token.position, elsewhere->second);
    if (std::ranges::find(discontinuous, token.text) != std::end(discontinuous))
      return note(
          token.position,
          name + " is not continuous, and nothing could be said between the points of a set",
          "abs, min and max are there");
    for (const auto& [written, instead] : other_names)
      if (token.text == written)
        return note(token.position, "there is no function " + name,
                    "write " + std::string(instead));
    std::vector<std::string> candidates;
    if (is_call) {
      for (const FunctionName& function : function_names()) candidates.emplace_back(function.name);
    } else {
      for (const auto& [known, node] : vocabulary_.known) candidates.push_back(known);
      candidates.emplace_back("pi");
    }
    note(token.position, (is_call ? "there is no function " : "nothing is called ") + name,
         suggest(name, candidates));
  }

  Expression call(const Token& name) {
    const Depth depth(*this);
    const FunctionName* const function = function_of(name.text);
    if (!function) {
      if (vocabulary_.known.contains(name.text)) {
        note(name.position, std::string(name.text) + " is not a function", "write * for a product");
      } else {
        note_unknown(name, true);
      }
    }
    const std::size_t opened = token_.position;
    std::vector<Expression> arguments;
    do {
      advance();
      if (arguments.empty() && token_.is(')')) break;
      arguments.push_back(sum());
    } while (token_.is(','));
    close(opened);
    if (!function) return substitute();
    if (static_cast<int>(arguments.size()) != function->arguments) {
      note(name.position, std::string(name.text) + " takes " + std::to_string(function->arguments) +
                              (function->arguments == 1 ? " argument, not " : " arguments, not ") +
                              std::to_string(arguments.size()));
      return substitute();
    }
    const int second = function->arguments == 2 ? arguments[1].node() : -1;
    return checked({graph_, graph_.make(function->operation, arguments[0].node(), second)},
                   name.position);
  }

  Tokens tokens_;
  Graph& graph_;
  const Vocabulary& vocabulary_;
  std::vector<FormulaError>& errors_;
  Token token_;
  int depth_ = 0;
  bool substituted_ = false;
};

}  // namespace

std::string why_no_name(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_part = [&](char c) { return is_letter(c) || c == '_' || (c >= '0' && c <= '9'); };
  if (name.empty() || !is_letter(name[0]) || !std::ranges::all_of(name, is_part))
    return "a name is a letter, then letters, digits and _";
  if (name.size() > 60) return "a name has at most 60 characters";
  if (name == "pi") return "pi is 3.14159…";
  if (name == "k") return "k is the number of the step";
  if (function_of(name)) return "it is the name of a function";
  return "";
}

std::optional<Expression> parse(std::string_view text, Graph& graph, const Vocabulary& vocabulary,
                                std::vector<FormulaError>& errors) {
  if (text.size() > longest_formula) {
    errors.push_back({0,
                      "the formula has " + std::to_string(text.size()) + " characters, at most " +
                          std::to_string(longest_formula) + " are read",
                      ""});
    return std::nullopt;
  }
  const std::size_t before = errors.size();
  try {
    const Expression made = Parser(text, graph, vocabulary, errors).formula();
    if (errors.size() == before) return made;
  } catch (const NoFormula& problem) {
    errors.push_back(problem.error);
  }
  return std::nullopt;
}

}  // namespace cordon::formulas
