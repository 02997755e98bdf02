// SPDX-License-Identifier: GPL-3.0-or-later
// A small backend without a known defect: the exchange form as it is, reduced to its interval hull.
// Mutants derive from it and break one thing each; without them it has to pass every law of the
// conformance kit.
#pragma once

#include <memory>
#include <vector>

#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/backend.hpp"
#include "cordon/registry/schema.hpp"

namespace mutants {

using namespace cordon;

/// A set that is its exchange form.
class LineSet : public Set {
 public:
  LineSet(const SetBackend& backend, LineForm form)
      : Set(backend, form.dim()), form_(std::move(form)) {}
  const LineForm& form() const { return form_; }

 protected:
  Complexity do_complexity() const override {
    return {form_.generators(), form_.lines(), form_.constraints()};
  }
  LineForm do_line_form() const override { return form_; }
  Answer do_is_empty(Certificate* why) const override;
  Answer do_contains(VectorIn x, Certificate* why) const override;
  Answer do_is_bounded() const override;
  double do_support(VectorIn d, Certificate* why) const override;
  Box do_interval_hull(std::vector<Certificate>* why) const override;

 private:
  LineForm form_;
};

/// The operations, exact by the block matrices of core/line_form.hpp but for maps by interval
/// matrices, hulls of sets with lines and reduction.
class Reference : public SetBackend {
 public:
  explicit Reference(BackendInfo info) : SetBackend(std::move(info)) {}

 protected:
  static const LineForm& form(const Set& X) { return static_cast<const LineSet&>(X).form(); }
  /// The one place where sets are made, so that a mutant of the questions replaces their type here.
  virtual std::unique_ptr<const Set> make(LineForm form) const {
    return std::make_unique<LineSet>(*this, std::move(form));
  }

  static LineForm predicted(const Set& X, const PredictionArgs& p);
  static LineForm corrected(const Set& X, MatrixIn C, VectorIn z, MatrixIn T, const Set& noise);
  /// The hull as a set within the budget; Errc::invalid if it has more edges than the budget
  /// generators.
  static LineForm boxed(const LineForm& X, Budget budget);
  static bool fits(const LineForm& X, Budget budget);

  Made do_import(const LineForm& X) const override { return {make(X), Tightness::exact}; }
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    return {make(predicted(X, p)), Tightness::exact};
  }
  Made do_correct(const Set& X, const CorrectionArgs& c) const override;
  Made do_interval_map(const Set& X, const IntervalMatrix& A) const override;
  Made do_intersection(const Set& X, MatrixIn R, const Set& Y) const override;
  Made do_convex_hull(const Set& X, const Set& Y) const override;
  Made do_reduce(const Set& X, Budget budget) const override;
  std::unique_ptr<const Set> do_serialize(const Set* X, Archive& archive) const override {
    LineForm own = X ? form(*X) : LineForm{};
    archive(own);
    return X ? nullptr : make(std::move(own));
  }
};

/// The reference with another type of set.
template <class SetType>
class With : public Reference {
 public:
  using Reference::Reference;

 private:
  std::unique_ptr<const Set> make(LineForm form) const override {
    return std::make_unique<SetType>(*this, std::move(form));
  }
};

/// A backend of the plugin: what is broken in it, and the laws (separated by spaces) each of which
/// has to notice.
struct Mutant {
  const char* name;
  const char* laws;
  const char* defect;
  std::unique_ptr<SetBackend> (*create)(BackendInfo info, const Params& params);
  const char* verdict =
      "breaks";  ///< the laws; or "crashes", "hangs" while they are checked; or "keeps" all
  ParamSchema schema = {};
};

template <class Backend>
std::unique_ptr<SetBackend> create(BackendInfo info, const Params&) {
  return std::make_unique<Backend>(std::move(info));
}

std::vector<Mutant> controls();
std::vector<Mutant> mutants_of_operations();
std::vector<Mutant> mutants_of_claims();
std::vector<Mutant> mutants_of_questions();
std::vector<Mutant> mutants_of_views();
std::vector<Mutant> mutants_of_contract();

}  // namespace mutants
