// SPDX-License-Identifier: GPL-3.0-or-later
// Backends whose every answer is that of rational arithmetic: no law may find fault with them. One
// holds what it is given and asks about it exactly, one holds polyhedra.
#include "cordon/core/error.hpp"
#include "cordon/registry/plugin.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/polytope.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace {

using namespace cordon;

class ExactForm final : public Set {
 public:
  ExactForm(const SetBackend& backend, LineForm form)
      : Set(backend, form.dim()), form_(std::move(form)) {}

 private:
  Complexity do_complexity() const override {
    return {form_.generators(), form_.lines(), form_.constraints()};
  }
  LineForm do_line_form() const override { return form_; }
  Answer do_is_empty(Certificate*) const override { return exact::is_empty(form_); }
  Answer do_contains(VectorIn x, Certificate*) const override { return exact::contains(form_, x); }
  double do_support(VectorIn d, Certificate*) const override {
    return exact::support(form_, d).upper;
  }

  LineForm form_;
};

class ExactForms final : public SetBackend {
 public:
  explicit ExactForms(BackendInfo info) : SetBackend(std::move(info)) {}

 private:
  Made do_import(const LineForm& X) const override {
    return {std::make_unique<ExactForm>(*this, X), Tightness::exact};
  }
  Made do_reduce(const Set& X, Budget budget) const override {
    if (X.complexity().generators <= budget.generators &&
        X.complexity().constraints <= budget.constraints)
      return {};
    const Box hull = interval_hull(X.line_form());
    if (hull.is_empty() || !hull.is_bounded())
      throw Error(Errc::unsupported, "exact_forms reduces bounded sets to boxes");
    return {std::make_unique<ExactForm>(*this, make_box(hull)), Tightness::outer};
  }
};

class Polyhedron final : public Set {
 public:
  Polyhedron(const SetBackend& backend, Polytope value, LineForm form)
      : Set(backend, value.dim()), value_(std::move(value)), form_(std::move(form)) {}
  const Polytope& value() const { return value_; }

 private:
  Complexity do_complexity() const override {
    return {form_.generators(), form_.lines(), form_.constraints()};
  }
  LineForm do_line_form() const override { return form_; }
  Answer do_is_empty(Certificate*) const override {
    return value_.is_empty() ? Answer::yes : Answer::no;
  }
  Answer do_contains(VectorIn x, Certificate*) const override {
    return value_.contains(x) ? Answer::yes : Answer::no;
  }
  Answer do_is_bounded() const override { return value_.is_bounded() ? Answer::yes : Answer::no; }
  double do_support(VectorIn d, Certificate*) const override { return value_.support(d).upper; }
  Box do_interval_hull(std::vector<Certificate>*) const override { return value_.interval_hull(); }

  Polytope value_;
  LineForm form_;
};

/// Its sets equal their exchange forms, and are exact where that took no rounding. Slow: for laws
/// of maps in few dimensions.
class Polyhedra final : public SetBackend {
 public:
  explicit Polyhedra(BackendInfo info) : SetBackend(std::move(info)) {}

 private:
  static const Polytope& value(const Set& X) { return static_cast<const Polyhedron&>(X).value(); }
  Made made(Polytope value) const {
    Polytope::Export out = value.to_line_form();
    // the form is what others see: hold no less than it
    if (out.tightness == Tightness::outer) value = Polytope::from(out.form);
    return {std::make_unique<Polyhedron>(*this, std::move(value), std::move(out.form)),
            out.tightness};
  }
  Made do_import(const LineForm& X) const override { return made(Polytope::from(X)); }
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    Polytope sum = value(X).affine_map(p.A, p.f);
    for (const Term& term : p.terms)
      sum = sum.minkowski_sum(value(*term.set).affine_map(term.T, Vector::Zero(p.A.rows())));
    return made(std::move(sum));
  }
};

template <class Backend>
void add(Registrar& registrar, const std::string& name, const std::string& summary) {
  registrar.add(BackendEntry{{name, summary, "", {}}, [name, summary](const Params&) {
                               BackendInfo info;
                               info.name = name;
                               info.summary = summary;
                               info.unbounded = true;
                               info.intersections = true;
                               return std::make_unique<Backend>(std::move(info));
                             }});
}

void register_components(Registrar& registrar) {
  add<ExactForms>(registrar, "exact_forms", "sets in exchange form, with exact answers");
  add<Polyhedra>(registrar, "polyhedra", "polyhedra over the rationals");
}

}  // namespace

CORDON_PLUGIN("rational", "1.0.0", "GPL-3.0-or-later", "the Cordon authors",
              "backends in rational arithmetic", register_components)
