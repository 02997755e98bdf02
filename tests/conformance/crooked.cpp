// SPDX-License-Identifier: GPL-3.0-or-later
// Backends that break one law each, for the test of the command: `lossy` loses a generator of every sum, `crashing` ends the
// process on points, `hanging` never returns from a hull.
#include <csignal>
#include <memory>
#include <thread>

#include "cordon/registry/plugin.hpp"

namespace {

using namespace cordon;

class Form final : public Set {
 public:
  Form(const SetBackend& backend, LineForm form) : Set(backend, form.dim()), form_(std::move(form)) {}

 private:
  Complexity do_complexity() const override { return {form_.generators(), form_.lines(), form_.constraints()}; }
  LineForm do_line_form() const override { return form_; }
  LineForm form_;
};

enum class Defect { lossy, crashing, hanging };

class Crooked final : public SetBackend {
 public:
  Crooked(BackendInfo info, Defect defect) : SetBackend(std::move(info)), defect_(defect) {}

 private:
  Made do_import(const LineForm& X) const override {
    if (defect_ == Defect::crashing && X.generators() == 0 && X.constraints() == 0) std::raise(SIGSEGV);
    return {std::make_unique<Form>(*this, X), Tightness::exact};
  }
  Made do_predict(const Set& X, const Predict& p) const override {
    Made made = SetBackend::do_predict(X, p);
    if (defect_ != Defect::lossy || p.terms.empty()) return made;
    LineForm form = made.set->line_form();
    const Index g = form.generators();
    if (g > 0) form.G.col(g - 1).setZero();
    return {std::make_unique<Form>(*this, form), Tightness::exact};
  }
  Made do_convex_hull(const Set& X, const Set& Y) const override {
    while (defect_ == Defect::hanging) std::this_thread::sleep_for(std::chrono::seconds(1));
    return SetBackend::do_convex_hull(X, Y);
  }

  Defect defect_;
};

template <Defect defect>
void add(Registrar& registrar, const std::string& name) {
  registrar.backend({{name, "a backend with a defect", "", {}}, [name](const Params&) {
                       BackendInfo info;
                       info.name = name;
                       info.summary = "a backend with a defect";
                       return std::make_unique<Crooked>(info, defect);
                     }});
}

void register_components(Registrar& registrar) {
  add<Defect::lossy>(registrar, "lossy");
  add<Defect::crashing>(registrar, "crashing");
  add<Defect::hanging>(registrar, "hanging");
}

}  // namespace

CORDON_PLUGIN("crooked", "1.0.0", "GPL-3.0-or-later", "the Cordon authors", "backends with defects", register_components)
