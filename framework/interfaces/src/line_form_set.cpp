// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/line_form_set.hpp"

#include <memory>
#include <utility>

#include "cordon/interfaces/backend.hpp"
#include "line_form_sets.hpp"

namespace cordon {

namespace {

class LineFormSet final : public Set {
 public:
  LineFormSet(std::shared_ptr<const SetBackend> backend, LineForm X)
      : Set(*backend, X.dim()), keeper_(std::move(backend)), X_(std::move(X)) {}

 private:
  Complexity do_complexity() const override {
    return {X_.generators(), X_.lines(), X_.constraints()};
  }
  LineForm do_line_form() const override { return X_; }

  std::shared_ptr<const SetBackend> keeper_;  ///< of the reference that Set holds
  LineForm X_;
};

class LineFormBackend final : public SetBackend {
 public:
  explicit LineFormBackend(Rounding rounding)
      : SetBackend({.name = "line_form",
                    .unbounded = true,
                    .intersections = true,
                    .rounding = rounding,
                    .summary = "the exchange form itself",
                    .citation = ""}) {}

  std::unique_ptr<const Set> hold(LineForm X) const {
    return std::make_unique<LineFormSet>(shared_from_this(), std::move(X));
  }

 private:
  Made do_import(const LineForm& X) const override { return {hold(X), Tightness::exact}; }
};

}  // namespace

Enclosure line_form_set(LineForm X, Rounding rounding, Tightness claim) {
  const auto backend = std::make_shared<const LineFormBackend>(rounding);
  return {SetPtr(backend->hold(std::move(X))), claim};
}

bool detail::is_line_form_set(const Set& X) {
  return dynamic_cast<const LineFormBackend*>(&X.backend()) != nullptr;
}

}  // namespace cordon
