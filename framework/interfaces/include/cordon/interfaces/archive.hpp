// SPDX-License-Identifier: GPL-3.0-or-later
// What later steps of a component depend on, as bytes, written and read by one function.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/diagnoser.hpp"
#include "cordon/interfaces/observer.hpp"

namespace cordon {

/// Members are handed over in a fixed order, `archive(x_, widths_)`: an archive that writes copies
/// them, one that reads assigns them. Numbers keep every bit, NaN included, and sets the numbers
/// that they are made of (SetBackend::serialize); a set that is held in two places is one set
/// afterwards as well. Every value is told by its type, so that bytes that were not written this
/// way are refused: Errc::invalid, and no more memory is asked for than they are long. Types of
/// one's own take part by a member function `void serialize(Archive&)`.
///
/// Bytes are those of one machine: numbers in its order, and of one version of the components.
class Archive {
 public:
  /// Writes.
  explicit Archive(std::shared_ptr<const SetBackend> backend);
  /// Reads what another one has written.
  Archive(std::shared_ptr<const SetBackend> backend, std::string bytes);
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  ~Archive();

  bool is_reading() const { return reading_; }
  /// What has been written.
  const std::string& bytes() const { return bytes_; }
  /// Throws Errc::invalid if something is left to read.
  void expect_end() const;

  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }

  /// The name of what follows; reading refuses another one.
  void section(std::string_view name);
  /// A number of a kind that has so many; reading refuses others.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void choice(Enum& value, int kinds) {
    auto number = static_cast<std::int64_t>(value);
    integer(number);
    if (number < 0 || number >= kinds) refuse("a choice that there is not");
    value = static_cast<Enum>(number);
  }
  /// A vector or a matrix whose shape is that of the member: reading refuses another one.
  void same_shape(Vector& value);
  void same_shape(Matrix& value);
  /// A set of this dimension; reading refuses another one, and none.
  void set(Enclosure& value, Index dimension);

  /// Throws Errc::invalid: what is read does not fit.
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  void one(bool& value);
  void one(double& value);
  void one(std::string& value);
  void one(Vector& value);
  void one(Matrix& value);
  void one(Answer& value) { choice(value, 3); }
  void one(Tightness& value) { choice(value, 2); }
  void one(Decision& value) { choice(value, 4); }
  void one(Box& value);
  void one(LineForm& value);
  void one(Sample& value);
  void one(Certificate& value);
  void one(Contradiction& value);
  void one(SetPtr& value);
  void one(Enclosure& value);

  template <class Number>
  requires(std::integral<Number> && !std::same_as<Number, bool>) void one(Number& value) {
    auto number = static_cast<std::int64_t>(value);
    integer(number);
    value = static_cast<Number>(number);
    const bool fits = static_cast<std::int64_t>(value) == number;
    if (!fits || (std::is_unsigned_v<Number> && number < 0)) refuse("a number out of range");
  }
  template <class T>
  void one(std::optional<T>& value) {
    bool there = value.has_value();
    one(there);
    if (!there) value.reset();
    if (there && !value) value.emplace();
    if (there) one(*value);
  }
  template <class T>
  void one(std::vector<T>& values) {
    sequence(values);
  }
  template <class T>
  void one(std::deque<T>& values) {
    sequence(values);
  }
  template <class T, std::size_t N>
  void one(std::array<T, N>& values) {
    for (T& value : values) one(value);
  }
  template <class First, class Second>
  void one(std::pair<First, Second>& value) {
    one(value.first);
    one(value.second);
  }
  template <class T>
  requires requires(T& value, Archive& archive) { value.serialize(archive); }
  void one(T& value) { value.serialize(*this); }
  template <class Values>
  void sequence(Values& values) {
    const std::size_t count = length(values.size());
    if (reading_) values.clear();
    for (std::size_t i = 0; i < count; ++i) {
      if (reading_) values.emplace_back();
      one(values[i]);
    }
  }

  void integer(std::int64_t& value);
  /// Of what follows, of at least one byte each.
  std::size_t length(std::size_t size);
  void tag(char type);
  void raw(void* data, std::size_t size);
  void numbers(double* data, Index count);

  std::shared_ptr<const SetBackend> backend_;
  bool reading_;
  std::string bytes_;
  std::size_t at_ = 0;  ///< of the next byte to read
  std::vector<SetPtr> sets_;
};

}  // namespace cordon
