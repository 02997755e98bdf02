// SPDX-License-Identifier: GPL-3.0-or-later
// A node as a formula that people read.
#include <charconv>

#include "cordon/formulas/expression.hpp"

namespace cordon::formulas {

namespace {

/// How strongly an operation binds its operands, loosest first.
enum class Binding { sum, product, sign, power, atom };

std::string number_text(Interval value) {
  char text[32];
  // The middle of what is not known to the last digit; no more digits than that is.
  const double number = value.is_point() ? value.lower : 0.5 * value.lower + 0.5 * value.upper;
  const auto end = value.is_point() ? std::to_chars(text, text + sizeof text, number)
                                    : std::to_chars(text, text + sizeof text, number,
                                                    std::chars_format::general, 6);
  return {text, end.ptr};
}

const char* name_of(Operation operation) {
  for (const FunctionName& function : function_names())
    if (function.operation == operation) return function.name;
  return "?";
}

class Writer {
 public:
  Writer(const Graph& graph, std::size_t longest) : graph_(graph), longest_(longest) {}

  std::string take() && { return std::move(text_); }

  void write(int index, Binding around, int depth = 0) {
    if (text_.size() > longest_ || depth > deepest) {
      if (!text_.ends_with("…")) text_ += "…";
      return;
    }
    const Node& node = graph_[index];
    const Binding own = binding(node);
    if (own < around) text_ += "(";
    write_inside(node, depth + 1);
    if (own < around) text_ += ")";
  }

 private:
  static constexpr int deepest = 30;

  static Binding binding(const Node& node) {
    switch (node.operation) {
      case Operation::constant:
        return node.value.lower < 0 ? Binding::sign : Binding::atom;
      case Operation::add:
      case Operation::subtract:
        return Binding::sum;
      case Operation::multiply:
        return Binding::product;
      case Operation::negate:
        return Binding::sign;
      case Operation::power:
        return node.number == -1 ? Binding::product : Binding::power;
      case Operation::real_power:
        return Binding::power;
      default:
        return Binding::atom;
    }
  }

  void write_pair(const Node& node, const char* between, Binding left, Binding right, int depth) {
    write(node.a, left, depth);
    text_ += between;
    write(node.b, right, depth);
  }

  void write_product(const Node& node, int depth) {
    const Node& right = graph_[node.b];
    if (right.operation != Operation::power || right.number != -1)
      return write_pair(node, "*", Binding::product, Binding::sign, depth);
    write(node.a, Binding::product, depth);
    text_ += "/";
    write(right.a, Binding::power, depth);
  }

  void write_inside(const Node& node, int depth) {
    switch (node.operation) {
      case Operation::constant:
        text_ += number_text(node.value);
        return;
      case Operation::variable:
        text_ += graph_.name(node.number);
        return;
      case Operation::add:
        return write_pair(node, " + ", Binding::sum, Binding::product, depth);
      case Operation::subtract:
        return write_pair(node, " - ", Binding::sum, Binding::product, depth);
      case Operation::negate:
        text_ += "-";
        return write(node.a, Binding::sign, depth);
      case Operation::multiply:
        return write_product(node, depth);
      case Operation::power:
        if (node.number == -1) {
          text_ += "1/";
          return write(node.a, Binding::power, depth);
        }
        write(node.a, Binding::atom, depth);
        text_ += "^" + std::to_string(node.number);
        return;
      case Operation::real_power:
        write(node.a, Binding::atom, depth);
        text_ += "^" + number_text(node.value);
        return;
      default:
        text_ += std::string(name_of(node.operation)) + "(";
        if (node.b >= 0) {
          write_pair(node, ", ", Binding::sum, Binding::sum, depth);
        } else {
          write(node.a, Binding::sum, depth);
        }
        text_ += ")";
    }
  }

  const Graph& graph_;
  std::size_t longest_;
  std::string text_;
};

}  // namespace

std::string Graph::to_string(int node, std::size_t longest) const {
  Writer writer(*this, longest);
  writer.write(node, Binding::sum);
  return std::move(writer).take();
}

}  // namespace cordon::formulas
