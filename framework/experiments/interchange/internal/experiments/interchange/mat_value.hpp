// SPDX-License-Identifier: GPL-3.0-or-later
// The values of MATLAB as far as they are read and written here. Knows no file format.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cordon/core/types.hpp"

namespace cordon::mat {

/// A matrix of real numbers (of any numeric class, full or sparse), a text of one row, a cell
/// array, a struct array, or something of a file that is not read.
struct Value {
  enum class Kind : std::uint8_t { numbers, text, cell, structs, refused };

  Kind kind = Kind::numbers;
  Matrix numbers;                  ///< of `numbers`
  std::string text;                ///< of `text`, UTF-8; of `refused` why it was not read
  Index rows = 0, cols = 0;        ///< of cells and structs
  std::vector<std::string> names;  ///< of structs: their fields
  std::vector<Value> items;  ///< of cells and structs, column by column; of each struct its fields,
                             ///< in the order of `names`

  bool is(Kind k) const { return kind == k; }
  /// The field of the struct at this place; null if there is none.
  const Value* field(std::string_view name, Index element = 0) const;
};

struct Variable {
  std::string name;
  Value value;
};
using Variables = std::vector<Variable>;

Value number(double x);
Value matrix(Matrix numbers);
Value text(std::string utf8);
/// 1 × n.
Value cell(std::vector<Value> items);
Value cell(const std::vector<std::string>& texts);
Value refused(std::string why);

/// A struct that is made field by field. The names are taken as they are.
class Struct {
 public:
  Struct& set(std::string name, Value value);
  Value value() &&;
  /// Structs with the same fields in the same order, as a struct array 1 × n.
  static Value array(std::vector<Struct> elements);

 private:
  std::vector<std::string> names_;
  std::vector<Value> fields_;
};

/// Names that MATLAB takes for variables and fields: a letter, then letters, digits and
/// underscores, 63 at most. Runs of other characters become an underscore, and keywords begin with
/// an x.
std::string valid_name(std::string_view name);
/// The same for several names; those that would be equal get "_2", "_3", ….
std::vector<std::string> valid_names(const std::vector<std::string>& names);

}  // namespace cordon::mat
