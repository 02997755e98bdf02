// SPDX-License-Identifier: GPL-3.0-or-later
// One template between a value type of `sets` and the framework's abstract set. A representation
// describes itself by a struct:
//
//   struct Representation {
//     using Value = …;                                       the value type
//     struct Result { Value value; Tightness tightness; };   of an operation alone
//     Index dim(const Value&); LineForm line_form(const Value&); Complexity complexity(const
//     Value&); Answer is_empty(const Value&, Certificate*), contains(const Value&, VectorIn,
//     Certificate*), is_bounded(const Value&); double support(const Value&, VectorIn,
//     Certificate*);  Box interval_hull(const Value&, std::vector<Certificate>*);
//     std::optional<Volume> volume(const Value&); Result import(const LineForm&); Result
//     predict(const Value& X, MatrixIn A, VectorIn f, std::span<const Operand<Value>>); Result
//     correct(const Value& X, MatrixIn C, VectorIn z, const Operand<Value>& noise); Result
//     interval_map(const Value&, const IntervalMatrix&);  Result intersection(const Value&,
//     MatrixIn R, const Value&); Result convex_hull(const Value&, const Value&);
//     std::optional<Result> reduce(const Value&, Budget);
//   };
//
// Where it has them as well, they are asked in place of the defaults of Set and SetBackend:
//
//     bool has_exact_form(const Value&);  View view(const Value&);  Vector maximizer(const Value&,
//     VectorIn d);  Answer is_subset(const Value&, const Value&, Certificate*),
//     is_disjoint(const Value&, const Value&, Certificate*);  Result import_view(const View&),
//     product(const Value&, const Value&);  void serialize(Value&, Archive&): writes the value or
//     reads it, and refuses what cannot be one.
//
// All are const member functions; preconditions are those of Set and SetBackend (shapes fit,
// numbers are finite).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <boost/container/small_vector.hpp>

#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/backend.hpp"

namespace cordon::plugins {

/// As many as the terms of most sums, without memory of their own.
template <class T>
using Few = boost::container::small_vector<T, 6>;

/// T·value, a view.
template <class Value>
struct Operand {
  MatrixIn T;
  const Value& value;
};

template <class Value>
struct ResultOf {
  Value value;
  Tightness tightness = Tightness::exact;
};

template <class Representation>
class ValueSet final : public Set {
 public:
  using Value = typename Representation::Value;
  ValueSet(const SetBackend& backend, const Representation& representation, Value value)
      : Set(backend, representation.dim(value)),
        representation_(representation),
        value_(std::move(value)) {}
  const Value& value() const { return value_; }

 private:
  Complexity do_complexity() const override { return representation_.complexity(value_); }
  LineForm do_line_form() const override { return representation_.line_form(value_); }
  Answer do_is_empty(Certificate* why) const override {
    return representation_.is_empty(value_, why);
  }
  Answer do_contains(VectorIn x, Certificate* why) const override {
    return representation_.contains(value_, x, why);
  }
  Answer do_is_bounded() const override { return representation_.is_bounded(value_); }
  double do_support(VectorIn d, Certificate* why) const override {
    return representation_.support(value_, d, why);
  }
  Box do_interval_hull(std::vector<Certificate>* why) const override {
    return representation_.interval_hull(value_, why);
  }
  std::optional<Volume> do_volume() const override { return representation_.volume(value_); }
  bool do_has_exact_form() const override {
    if constexpr (requires { representation_.has_exact_form(value_); }) {
      return representation_.has_exact_form(value_);
    } else {
      return Set::do_has_exact_form();
    }
  }
  View do_view() const override {
    if constexpr (requires { representation_.view(value_); }) {
      return representation_.view(value_);
    } else {
      return Set::do_view();
    }
  }
  Vector do_maximizer(VectorIn d) const override {
    if constexpr (requires { representation_.maximizer(value_, d); }) {
      return representation_.maximizer(value_, d);
    } else {
      return Set::do_maximizer(d);
    }
  }
  // Both sets are of the same backend.
  Answer do_is_subset_of(const Set& other, Certificate* why) const override {
    if constexpr (requires { representation_.is_subset(value_, value_, why); }) {
      return representation_.is_subset(value_, static_cast<const ValueSet&>(other).value(), why);
    } else {
      return Answer::unknown;
    }
  }
  Answer do_is_disjoint_from(const Set& other, Certificate* why) const override {
    if constexpr (requires { representation_.is_disjoint(value_, value_, why); }) {
      return representation_.is_disjoint(value_, static_cast<const ValueSet&>(other).value(), why);
    } else {
      return Answer::unknown;
    }
  }

  const Representation& representation_;  // lives in the backend, which the set keeps alive
  Value value_;
};

template <class Representation>
class ValueBackend final : public SetBackend {
 public:
  ValueBackend(BackendInfo info, Representation representation)
      : SetBackend(std::move(info)), representation_(std::move(representation)) {}

 private:
  using Value = typename Representation::Value;
  using Own = ValueSet<Representation>;

  /// The framework hands over sets of this backend only.
  static const Value& value(const Set& X) { return static_cast<const Own&>(X).value(); }

  Made make(ResultOf<Value> result) const {
    return {std::make_unique<Own>(*this, representation_, std::move(result.value)),
            result.tightness};
  }

  Made do_import(const LineForm& X) const override { return make(representation_.import(X)); }
  Made do_import_view(const View& X) const override {
    if constexpr (requires { representation_.import_view(X); }) {
      return make(representation_.import_view(X));
    } else {
      return SetBackend::do_import_view(X);
    }
  }
  Made do_product(const Set& X, const Set& Y) const override {
    if constexpr (requires { representation_.product(value(X), value(Y)); }) {
      return make(representation_.product(value(X), value(Y)));
    } else {
      return {};
    }
  }

  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    Few<Operand<Value>> operands;
    for (const Term& term : p.terms) operands.push_back({term.T, value(*term.set)});
    return make(representation_.predict(value(X), p.A, p.f, {operands.data(), operands.size()}));
  }
  Made do_correct(const Set& X, const CorrectionArgs& c) const override {
    return make(representation_.correct(value(X), c.C, c.z,
                                        Operand<Value>{c.noise.T, value(*c.noise.set)}));
  }
  Made do_interval_map(const Set& X, const IntervalMatrix& A) const override {
    return make(representation_.interval_map(value(X), A));
  }
  Made do_intersection(const Set& X, MatrixIn R, const Set& Y) const override {
    return make(representation_.intersection(value(X), R, value(Y)));
  }
  Made do_convex_hull(const Set& X, const Set& Y) const override {
    return make(representation_.convex_hull(value(X), value(Y)));
  }
  Made do_reduce(const Set& X, Budget budget) const override {
    auto result = representation_.reduce(value(X), budget);
    return result ? make(std::move(*result)) : Made{};
  }
  std::unique_ptr<const Set> do_serialize(const Set* X, Archive& archive) const override {
    if constexpr (requires(Value some) { representation_.serialize(some, archive); }) {
      Value own = X ? value(*X) : Value();
      representation_.serialize(own, archive);
      if (X) return nullptr;
      return std::make_unique<Own>(*this, representation_, std::move(own));
    } else {
      return SetBackend::do_serialize(X, archive);
    }
  }

  Representation representation_;
};

}  // namespace cordon::plugins
