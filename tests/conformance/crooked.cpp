// SPDX-License-Identifier: GPL-3.0-or-later
// Backends that break one law each, for the test of the command: `lossy` loses a generator of every
// sum, `crashing` ends the process on points, `hanging` never returns from a hull.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <thread>

#include "cordon/registry/plugin.hpp"

namespace {

using namespace cordon;

class Form final : public Set {
 public:
  Form(const SetBackend& backend, LineForm form)
      : Set(backend, form.dim()), form_(std::move(form)) {}

 private:
  Complexity do_complexity() const override {
    return {form_.generators(), form_.lines(), form_.constraints()};
  }
  LineForm do_line_form() const override { return form_; }
  LineForm form_;
};

enum class Defect { lossy, crashing, hanging };

class Crooked final : public SetBackend {
 public:
  Crooked(BackendInfo info, Defect defect) : SetBackend(std::move(info)), defect_(defect) {}

 private:
  Made do_import(const LineForm& X) const override {
    if (defect_ == Defect::crashing && X.generators() == 0 && X.constraints() == 0)
      std::raise(SIGSEGV);
    return {std::make_unique<Form>(*this, X), Tightness::exact};
  }
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    LineForm sum = cordon::affine_map(X.line_form(), p.A, p.f);
    for (const Term& term : p.terms) {
      sum = minkowski_sum(
          sum, cordon::affine_map(term.set->line_form(), term.T, Vector::Zero(p.A.rows())));
    }
    if (defect_ == Defect::lossy && !p.terms.empty() && sum.generators() > 0)
      sum.G.rightCols(1).setZero();
    return {std::make_unique<Form>(*this, sum), Tightness::exact};
  }
  Made do_convex_hull(const Set& X, const Set& Y) const override {
    while (defect_ == Defect::hanging) std::this_thread::sleep_for(std::chrono::seconds(1));
    const LineForm A = X.line_form(), B = Y.line_form();
    return {std::make_unique<Form>(*this, cordon::convex_hull(A, B)),
            A.lines() + B.lines() > 0 ? Tightness::outer : Tightness::exact};
  }

  Defect defect_;
};

template <Defect defect>
void add(Registrar& registrar, const std::string& name) {
  registrar.add(BackendEntry{{name, "a backend with a defect", "", {}}, [name](const Params&) {
                               BackendInfo info;
                               info.name = name;
                               info.summary = "a backend with a defect";
                               return std::make_unique<Crooked>(info, defect);
                             }});
}

/// Backends that cannot be made.
std::unique_ptr<SetBackend> not_made(const Params&) {
  throw Error(Errc::invalid, "the table of half axes is missing");
}
std::unique_ptr<SetBackend> not_survived(const Params&) { std::_Exit(7); }

void register_components(Registrar& registrar) {
  registrar.add(BackendEntry{{"unmade", "a backend with a defect", "", {}}, not_made});
  registrar.add(BackendEntry{{"unsurvived", "a backend with a defect", "", {}}, not_survived});
  add<Defect::lossy>(registrar, "lossy");
  add<Defect::crashing>(registrar, "crashing");
  add<Defect::hanging>(registrar, "hanging");
}

}  // namespace

CORDON_PLUGIN("crooked", "1.0.0", "GPL-3.0-or-later", "the Cordon authors", "backends with defects",
              register_components)
