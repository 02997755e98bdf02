// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that sees libmatio.
#include "mat_libmatio.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <matio.h>
#include <memory>
#include <utility>

#include "cordon/core/error.hpp"
#include "cordon/registry/build.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "experiments/interchange/utf16.hpp"
#include "mat_layout.hpp"

namespace cordon::mat {

namespace {

using Kind = Value::Kind;

struct CloseFile {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, CloseFile>;
using MatVariable = std::unique_ptr<matvar_t, FreeVariable>;

// ---- writing

constexpr std::size_t largest_variable = (std::size_t{1} << 31) - (std::size_t{1} << 24);

std::size_t size_of(const Value& value) {
  std::size_t bytes = 200 + 8 * static_cast<std::size_t>(value.numbers.size()) +
                      2 * value.text.size() + 64 * value.names.size();
  for (const Value& item : value.items) bytes += size_of(item);
  return bytes;
}

matvar_t* checked(matvar_t* variable) {
  if (!variable) throw Error(Errc::internal, "a variable of a MAT-file could not be made");
  return variable;
}

matvar_t* to_matio(const char* name, const Value& value);

matvar_t* text_to_matio(const char* name, const std::string& utf8) {
  const bool ascii = std::all_of(utf8.begin(), utf8.end(),
                                 [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  std::u16string units = to_utf16(utf8);
  std::string bytes = utf8;
  std::size_t dims[2] = {units.empty() ? std::size_t{0} : 1, units.size()};
  void* data = ascii ? static_cast<void*>(bytes.data()) : static_cast<void*>(units.data());
  return checked(
      Mat_VarCreate(name, MAT_C_CHAR, ascii ? MAT_T_UTF8 : MAT_T_UTF16, 2, dims, data, 0));
}

matvar_t* structs_to_matio(const char* name, const Value& value) {
  std::vector<const char*> names;
  for (const std::string& one : value.names) names.push_back(one.c_str());
  std::size_t dims[2] = {static_cast<std::size_t>(value.rows),
                         static_cast<std::size_t>(value.cols)};
  MatVariable all(checked(
      Mat_VarCreateStruct(name, 2, dims, names.data(), static_cast<unsigned>(names.size()))));
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    const std::size_t field = i % names.size();
    Mat_VarSetStructFieldByIndex(all.get(), field, i / names.size(),
                                 to_matio(names[field], value.items[i]));
  }
  return all.release();
}

matvar_t* to_matio(const char* name, const Value& value) {
  std::size_t dims[2] = {static_cast<std::size_t>(value.rows),
                         static_cast<std::size_t>(value.cols)};
  if (value.is(Kind::text)) return text_to_matio(name, value.text);
  if (value.is(Kind::structs)) return structs_to_matio(name, value);
  if (value.is(Kind::cell)) {
    std::vector<MatVariable> items;
    for (const Value& item : value.items) items.emplace_back(to_matio(nullptr, item));
    std::vector<matvar_t*> plain;
    for (const MatVariable& item : items) plain.push_back(item.get());
    plain.push_back(nullptr);  // so that there is an address
    matvar_t* all = checked(Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, dims, plain.data(), 0));
    for (MatVariable& item : items) item.release();
    return all;
  }
  dims[0] = static_cast<std::size_t>(value.numbers.rows()),
  dims[1] = static_cast<std::size_t>(value.numbers.cols());
  Matrix numbers = value.numbers;
  double none = 0;
  void* data = numbers.size() > 0 ? numbers.data() : &none;
  return checked(Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, data, 0));
}

// ---- reading

constexpr std::size_t most_sparse =
    1'000'000;  // entries of a matrix of a study, those that are 0 included

bool is_moderate(const matvar_t& v) {
  std::size_t size = 1;
  for (int i = 0; i < v.rank; ++i) {
    if (v.dims[i] > static_cast<std::size_t>(max_numbers)) return false;
    size *= v.dims[i];
    if (size > static_cast<std::size_t>(max_numbers)) return false;
  }
  return true;
}

/// Why this variable, of which only the sizes are read so far, cannot be taken; empty if it can.
std::string objection(const matvar_t& v, int depth, std::size_t& budget) {
  if (v.rank < 2 || v.rank > 16 || !v.dims) return "it is damaged";
  for (int i = 2; i < v.rank; ++i) {
    if (v.dims[i] != 1) return "it has " + std::to_string(v.rank) + " dimensions";
  }
  const std::string too_large = "it holds more than " + std::to_string(max_numbers) + " numbers";
  if (!is_moderate(v)) return too_large;
  const std::size_t size = v.dims[0] * v.dims[1];
  const std::size_t cost =
      1 + (v.class_type == MAT_C_SPARSE ? std::min<std::size_t>(size, most_sparse) : size);
  if (cost > budget) return too_large;
  budget -= cost;
  if (depth > max_nesting) return "it is nested more than " + std::to_string(max_nesting) + " deep";
  return "";
}

Value read_numbers(const matvar_t& v);
Value read_text(const matvar_t& v);
Value read_sparse(const matvar_t& v);
Value read_items(const matvar_t& v, Kind kind, int depth, std::size_t& budget);

Value read(const matvar_t& v, int depth, std::size_t& budget) {
  const std::string why = objection(v, depth, budget);
  if (!why.empty()) return refused(why);
  switch (v.class_type) {
    case MAT_C_CELL:
      return read_items(v, Kind::cell, depth, budget);
    case MAT_C_STRUCT:
      return read_items(v, Kind::structs, depth, budget);
    case MAT_C_CHAR:
      return read_text(v);
    case MAT_C_SPARSE:
      return read_sparse(v);
    case MAT_C_DOUBLE:
    case MAT_C_SINGLE:
    case MAT_C_INT8:
    case MAT_C_UINT8:
    case MAT_C_INT16:
    case MAT_C_UINT16:
    case MAT_C_INT32:
    case MAT_C_UINT32:
    case MAT_C_INT64:
    case MAT_C_UINT64:
      return read_numbers(v);
    case MAT_C_EMPTY:
      return matrix(Matrix(0, 0));
    case MAT_C_FUNCTION:
      return refused("it is a function");
    case MAT_C_OBJECT:
    case MAT_C_OPAQUE:
      return refused(
          "it is an object; save its numbers, those of a state-space model with [A,B,C,D] = "
          "ssdata(sys)");
  }
  return refused("its class is not known");
}

/// Whether the integer became another number as a double.
template <class T>
bool is_rounded(T x, double y) {
  if constexpr (sizeof(T) < 8 || !std::is_integral_v<T>) {
    return false;
  } else {
    const double end =
        std::ldexp(1.0, std::numeric_limits<T>::digits);  // one more than the largest
    return y >= end || static_cast<T>(y) != x;
  }
}

template <class T>
void copy(const void* data, std::size_t count, double* out, bool& inexact) {
  for (std::size_t i = 0; i < count; ++i) {
    T x;
    std::memcpy(&x, static_cast<const char*>(data) + i * sizeof(T), sizeof(T));
    out[i] = static_cast<double>(x);
    inexact = inexact || is_rounded(x, out[i]);
  }
}

/// Empty, or why the numbers cannot be taken.
std::string convert(matio_types type, const void* data, std::size_t bytes, std::size_t count,
                    double* out) {
  const std::size_t size = Mat_SizeOf(type);
  if (count == 0) return "";
  if (!data || size == 0 || bytes / size < count) return "it is damaged";
  bool inexact = false;
  switch (type) {
    case MAT_T_DOUBLE:
      copy<double>(data, count, out, inexact);
      break;
    case MAT_T_SINGLE:
      copy<float>(data, count, out, inexact);
      break;
    case MAT_T_INT8:
      copy<std::int8_t>(data, count, out, inexact);
      break;
    case MAT_T_UINT8:
      copy<std::uint8_t>(data, count, out, inexact);
      break;
    case MAT_T_INT16:
      copy<std::int16_t>(data, count, out, inexact);
      break;
    case MAT_T_UINT16:
      copy<std::uint16_t>(data, count, out, inexact);
      break;
    case MAT_T_INT32:
      copy<std::int32_t>(data, count, out, inexact);
      break;
    case MAT_T_UINT32:
      copy<std::uint32_t>(data, count, out, inexact);
      break;
    case MAT_T_INT64:
      copy<std::int64_t>(data, count, out, inexact);
      break;
    case MAT_T_UINT64:
      copy<std::uint64_t>(data, count, out, inexact);
      break;
    default:
      return "it is damaged";
  }
  return inexact ? "it holds integers beyond 2^53 that are no doubles" : "";
}

Value read_numbers(const matvar_t& v) {
  if (v.isComplex) return refused("it is complex");
  Matrix numbers(static_cast<Index>(v.dims[0]), static_cast<Index>(v.dims[1]));
  const std::string why = convert(v.data_type, v.data, v.nbytes,
                                  static_cast<std::size_t>(numbers.size()), numbers.data());
  return why.empty() ? matrix(std::move(numbers)) : refused(why);
}

Value read_sparse(const matvar_t& v) {
  if (v.isComplex) return refused("it is complex");
  if (v.dims[0] * std::max<std::size_t>(v.dims[1], 1) > most_sparse)
    return refused("it has more than 1000000 entries");
  Matrix numbers = Matrix::Zero(static_cast<Index>(v.dims[0]), static_cast<Index>(v.dims[1]));
  const auto* s = static_cast<const mat_sparse_t*>(v.data);
  if (!s || numbers.size() == 0) return matrix(std::move(numbers));
  if (!s->jc || s->njc != v.dims[1] + 1) return refused("it is damaged");
  const std::size_t count = s->jc[v.dims[1]];
  if (count > s->nir || count > s->ndata || (count > 0 && !s->ir)) return refused("it is damaged");
  std::vector<double> entries(count);
  const std::string why =
      convert(v.data_type, s->data, s->ndata * Mat_SizeOf(v.data_type), count, entries.data());
  if (!why.empty()) return refused(why);
  std::vector<std::size_t> last(v.dims[0],
                                v.dims[1]);  // the column with the last entry of each row
  for (std::size_t j = 0; j < v.dims[1]; ++j) {
    if (s->jc[j] > s->jc[j + 1] || s->jc[j + 1] > count) return refused("it is damaged");
    for (std::size_t k = s->jc[j]; k < s->jc[j + 1]; ++k) {
      if (s->ir[k] >= v.dims[0]) return refused("it is damaged");
      if (std::exchange(last[s->ir[k]], j) == j) return refused("it has two entries at one place");
      numbers(static_cast<Index>(s->ir[k]), static_cast<Index>(j)) = entries[k];
    }
  }
  return matrix(std::move(numbers));
}

Value read_text(const matvar_t& v) {
  const std::size_t size = v.dims[0] * v.dims[1];
  if (size == 0) return text("");
  if (v.dims[0] != 1) return refused("it is a text of several rows; use a cell array of texts");
  if (!v.data) return refused("it is damaged");
  const auto* bytes = static_cast<const char*>(v.data);
  switch (v.data_type) {
    case MAT_T_INT8:
    case MAT_T_UINT8:
    case MAT_T_UTF8:
      return text(std::string(bytes, bytes + v.nbytes));
    case MAT_T_UINT16:
    case MAT_T_UTF16: {
      std::u16string units(v.nbytes / 2, u'\0');
      std::memcpy(units.data(), bytes, 2 * units.size());
      return text(to_utf8(units));
    }
    default:
      return refused("its characters are of a kind that is not known");
  }
}

Value read_items(const matvar_t& v, Kind kind, int depth, std::size_t& budget) {
  Value value;
  value.kind = kind;
  value.rows = static_cast<Index>(v.dims[0]), value.cols = static_cast<Index>(v.dims[1]);
  std::size_t count = v.dims[0] * v.dims[1];
  if (kind == Kind::structs) {
    const unsigned fields = Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&v));
    char* const* names = Mat_VarGetStructFieldnames(&v);
    if (fields > 10'000 || (fields > 0 && !names)) return refused("it is damaged");
    for (unsigned i = 0; i < fields; ++i) value.names.emplace_back(names[i] ? names[i] : "");
    count *= fields;
  }
  auto* const* items = static_cast<matvar_t* const*>(v.data);
  if (count > 0 && (!items || v.nbytes / sizeof(matvar_t*) < count))
    return refused("it is damaged");
  for (std::size_t i = 0; i < count; ++i) {
    value.items.push_back(items[i] ? read(*items[i], depth + 1, budget) : matrix(Matrix(0, 0)));
  }
  return value;
}

/// As `objection`, for everything inside as well: the children of structs and cells are known
/// before their data.
std::string objection_inside(const matvar_t& v, int depth, std::size_t& budget) {
  std::string why = objection(v, depth, budget);
  if (!why.empty() || (v.class_type != MAT_C_CELL && v.class_type != MAT_C_STRUCT)) return why;
  const std::size_t count = v.data ? v.nbytes / sizeof(matvar_t*) : 0;
  for (std::size_t i = 0; i < count && why.empty(); ++i) {
    const matvar_t* item = static_cast<matvar_t* const*>(v.data)[i];
    if (item) why = objection_inside(*item, depth + 1, budget);
  }
  return why;
}

}  // namespace

void write_variables(const char* path, const Variables& variables) {
  const std::string header = "MATLAB 5.0 MAT-file, written by Cordon " + build_info().version;
  MatFile file(Mat_CreateVer(path, header.c_str(), MAT_FT_MAT5));
  if (!file) throw Error(Errc::io, "cannot make the MAT-file: libmatio cannot write to memory");
  for (const Variable& variable : variables) {
    if (size_of(variable.value) > largest_variable) {
      throw Error(Errc::invalid, "the variable " + variable.name +
                                     " is larger than 2 GB, more than a MAT-file can hold");
    }
    const MatVariable v(to_matio(variable.name.c_str(), variable.value));
    if (Mat_VarWrite(file.get(), v.get(), MAT_COMPRESSION_ZLIB) != 0) {
      throw Error(Errc::internal, "libmatio cannot write the variable " + variable.name);
    }
  }
  if (Mat_Close(file.release()) != 0) throw Error(Errc::io, "cannot make the MAT-file");
}

Variables read_variables(const char* path) {
  check_layout(path);
  const MatFile file(Mat_Open(path, MAT_ACC_RDONLY));
  if (!file) throw Error(Errc::invalid, "libmatio cannot open it");
  Variables variables;
  std::size_t budget = static_cast<std::size_t>(max_numbers);
  while (const MatVariable v{Mat_VarReadNextInfo(file.get())}) {
    if (!v->name) continue;
    std::size_t left = budget;
    std::string why = objection_inside(*v, 0, left);
    if (why.empty() && Mat_VarReadDataAll(file.get(), v.get()) != 0) why = "it is damaged";
    variables.push_back({v->name, why.empty() ? read(*v, 0, budget) : refused(why)});
    if (variables.size() > 10'000) throw Error(Errc::invalid, "it holds more than 10000 variables");
  }
  return variables;
}

}  // namespace cordon::mat
