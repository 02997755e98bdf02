// SPDX-License-Identifier: GPL-3.0-or-later
// Sets, with their operations and questions.
#include <pybind11/stl.h>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_budget.hpp"
#include "cordon/solvers/polytope.hpp"
#include "cordon/values/convex_set.hpp"

namespace cordon::python {

namespace {

/// Without the interpreter's lock; Ctrl-C ends work in exact arithmetic, which may take long.
template <class Work>
auto watched(Work&& work) {
  Signals signals;
  const ExactWatch watch([&] { signals.look(); });
  return unlocked(std::forward<Work>(work));
}

std::shared_ptr<const SetBackend> backend_of(const std::string& name, const py::dict& params) {
  const Params given = params_from(params);
  return watched([&] { return representation(name, given); });
}

Inequalities inequalities_from(py::handle H, py::handle h) {
  Inequalities rows{matrix_of(H, "H"), vector_of(h, "h")};
  if (rows.H.rows() != rows.h.size()) {
    throw Error(Errc::dimension, "H has " + std::to_string(rows.H.rows()) + " rows, h has " +
                                     std::to_string(rows.h.size()) + " entries");
  }
  return rows;
}

py::dict view_of(const ConvexSet& X) {
  const View seen = watched([&] { return X.view(); });
  py::dict made = form_of(seen.form);
  made["H"] = array_of(seen.rows.rows() > 0 ? seen.rows.H : Matrix(0, seen.dim()));
  made["h"] = array_of(seen.rows.h);
  made["claim"] = std::string(to_string(seen.claim));
  return made;
}

ConvexSet of_view(const py::dict& blocks, const std::string& claim, const std::string& backend,
                  const py::dict& params) {
  View X{form_from(blocks)};
  if (blocks.contains("H")) {
    X.rows = inequalities_from(blocks["H"], blocks["h"]);
    if (X.rows.rows() == 0) X.rows = {};
  }
  X.claim = claim == "exact" ? Tightness::exact : Tightness::outer;
  check(X, "the set");
  const auto made = backend_of(backend, params);
  return watched([&] { return ConvexSet::of(X, made); });
}

/// {x : H x ≤ h}. What holds no half-spaces gets the exchange form of the polyhedron, which is made
/// by exact arithmetic.
ConvexSet of_inequalities(py::handle H, py::handle h, const std::string& name,
                          const py::dict& params) {
  const Inequalities rows = inequalities_from(H, h);
  const auto backend = backend_of(name, params);
  return watched([&]() -> ConvexSet {
    std::optional<ConvexSet> made;
    try {
      made = ConvexSet::of(with_rows({make_space(rows.H.cols())}, rows), backend);
      if (made->claim() == Tightness::exact) return *made;
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported) throw;
    }
    try {
      const auto form = Polytope::from_inequalities(rows.H, rows.h).to_line_form();
      return ConvexSet::of({form.form, {}, form.tightness}, backend);
    } catch (const Error& error) {  // unbounded on one side, or too large
      if (error.code() != Errc::unsupported || !made) throw;
      return *made;
    }
  });
}

/// None: as many as there are.
Index budget_of(py::handle given, const char* name) {
  return given.is_none() ? Budget::unlimited : count_of(given, name);
}

py::dict sizes_of(const ConvexSet& X) {
  const Complexity size = X.complexity();
  py::dict made;
  made["generators"] = size.generators;
  made["lines"] = size.lines;
  made["constraints"] = size.constraints;
  for (const Complexity::Named& other : size.others) made[py::str(other.name)] = other.count;
  return made;
}

py::tuple support_of(const ConvexSet& X, py::handle direction) {
  const Vector d = vector_of(direction, "d");
  Vector at;
  Certificate why;
  const double value = watched([&] { return X.support(d, &at, &why); });
  return py::make_tuple(value, at.size() == X.dim() ? py::object(array_of(at)) : py::none(),
                        certificate_of(why));
}

py::tuple hull_of(const ConvexSet& X) {
  std::vector<Certificate> why;
  const Box hull = watched([&] { return X.hull(&why); });
  py::list proofs;
  for (const Certificate& proof : why) proofs.append(certificate_of(proof));
  return py::make_tuple(array_of(hull.lower), array_of(hull.upper), proofs);
}

/// Of half-spaces that are the set, whatever the exchange form beside them holds, at once.
Matrix vertices_of(const ConvexSet& X) {
  if (X.representation() != "polytope") return X.vertices();
  const View seen = X.view();
  if (seen.claim != Tightness::exact || seen.rows.rows() == 0) return X.vertices();
  const Polytope P = Polytope::from_inequalities(seen.rows.H, seen.rows.h);
  return P.is_empty() || P.is_bounded() ? P.generators().vertices : X.vertices();
}

template <class Ask>
py::tuple asked(Ask&& ask) {
  Certificate why;
  const Answer answer = watched([&] { return ask(&why); });
  return answer_of(answer, why);
}

void bind_constructors(py::class_<ConvexSet>& set) {
  set.def_static("box",
                 [](py::handle lower, py::handle upper) {
                   return ConvexSet::box(vector_of(lower, "lower"), vector_of(upper, "upper"));
                 })
      .def_static("zonotope",
                  [](py::handle c, py::handle G) {
                    return ConvexSet::zonotope(vector_of(c, "c"), matrix_of(G, "G"));
                  })
      .def_static("point",
                  [](py::handle x, const std::string& name, const py::dict& params) -> ConvexSet {
                    return backend_of(name, params)->point(vector_of(x, "x"));
                  })
      .def_static("space",
                  [](py::handle n, const std::string& name, const py::dict& params) -> ConvexSet {
                    return backend_of(name, params)->space(count_of(n, "n"));
                  })
      .def_static("empty",
                  [](py::handle n, const std::string& name, const py::dict& params) -> ConvexSet {
                    return backend_of(name, params)->empty(count_of(n, "n"));
                  })
      .def_static("strip",
                  [](py::handle rho, py::handle d, py::handle sigma) {
                    return ConvexSet::strip(vector_of(rho, "rho"), number_of(d, "d"),
                                            number_of(sigma, "sigma"));
                  })
      .def_static("inequalities", &of_inequalities)
      .def_static("of_view", &of_view);
}

void bind_operations(py::class_<ConvexSet>& set) {
  set.def("as_",
          [](const ConvexSet& X, const std::string& name, const py::dict& params) {
            const auto backend = backend_of(name, params);
            return watched([&] { return X.as(backend); });
          })
      .def("map",
           [](const ConvexSet& X, py::handle A) {
             const Matrix made = matrix_of(A, "A");
             return watched([&] { return made * X; });
           })
      .def("scale",
           [](const ConvexSet& X, py::handle s) {
             const double factor = number_of(s, "the factor");
             return watched([&] { return factor * X; });
           })
      .def("translate",
           [](const ConvexSet& X, py::handle t) {
             const Vector made = vector_of(t, "t");
             return watched([&] { return X + made; });
           })
      .def("translate_back",
           [](const ConvexSet& X, py::handle t) {
             const Vector made = -vector_of(t, "t");
             return watched([&] { return X + made; });
           })
      .def("affine_map",
           [](const ConvexSet& X, py::handle A, py::handle t) {
             const Matrix map = matrix_of(A, "A");
             const Vector shift = vector_of(t, "t");
             return watched([&] { return X.affine_map(map, shift); });
           })
      .def("sum",
           [](const ConvexSet& X, const ConvexSet& Y) { return watched([&] { return X + Y; }); })
      .def("intersection",
           [](const ConvexSet& X, const ConvexSet& Y) { return watched([&] { return X & Y; }); })
      .def("intersect",
           [](const ConvexSet& X, py::handle R, const ConvexSet& Y) {
             const Matrix made = matrix_of(R, "R");
             return watched([&] { return X.intersect(made, Y); });
           })
      .def("correct",
           [](const ConvexSet& X, py::handle C, py::handle y, const ConvexSet& V) {
             const Matrix map = matrix_of(C, "C");
             const Vector value = vector_of(y, "y");
             return watched([&] { return X.correct(map, value, V); });
           })
      .def("product", [](const ConvexSet& X,
                         const ConvexSet& Y) { return watched([&] { return X.product(Y); }); })
      .def("convex_hull",
           [](const ConvexSet& X, const ConvexSet& Y) {
             return watched([&] { return X.convex_hull(Y); });
           })
      .def("reduce", [](const ConvexSet& X, py::handle generators, py::handle constraints) {
        const Budget budget{budget_of(generators, "generators"),
                            budget_of(constraints, "constraints")};
        return watched([&] { return X.reduce(budget.generators, budget.constraints); });
      });
}

void bind_questions(py::class_<ConvexSet>& set) {
  set.def("is_empty",
          [](const ConvexSet& X) {
            return asked([&](Certificate* why) { return X.is_empty(why); });
          })
      .def("contains",
           [](const ConvexSet& X, py::handle x) {
             const Vector point = vector_of(x, "x");
             return asked([&](Certificate* why) { return X.contains(point, why); });
           })
      .def("is_subset",
           [](const ConvexSet& X, const ConvexSet& Y) {
             return asked([&](Certificate* why) { return X.is_subset(Y, why); });
           })
      .def("is_disjoint",
           [](const ConvexSet& X, const ConvexSet& Y) {
             return asked([&](Certificate* why) { return X.is_disjoint(Y, why); });
           })
      .def("is_bounded",
           [](const ConvexSet& X) { return asked([&](Certificate*) { return X.is_bounded(); }); });
}

}  // namespace

void bind_sets(py::module_& module) {
  py::class_<ConvexSet> set(module, "ConvexSet");
  bind_constructors(set);
  bind_operations(set);
  bind_questions(set);
  set.def_property_readonly("dim", &ConvexSet::dim)
      .def_property_readonly("representation", &ConvexSet::representation)
      .def_property_readonly("claim",
                             [](const ConvexSet& X) { return std::string(to_string(X.claim())); })
      .def_property_readonly(
          "rounding",
          [](const ConvexSet& X) { return std::string(to_string(X.backend().info().rounding)); })
      .def_property_readonly("sizes", &sizes_of)
      .def("view", &view_of)
      .def("support", &support_of)
      .def("hull", &hull_of)
      .def("volume",
           [](const ConvexSet& X) {
             const Volume found = watched([&] { return X.volume(); });
             return py::make_tuple(found.value, found.exact);
           })
      .def("vertices",
           [](const ConvexSet& X) {
             const Matrix found = watched([&] { return vertices_of(X); });
             return array_of(found);
           })
      .def("gauge",
           [](const ConvexSet& X, py::handle x) {
             const Vector point = vector_of(x, "x");
             const Interval found = watched([&] { return X.gauge(point); });
             return py::make_tuple(found.lower, found.upper);
           })
      .def("__str__", [](const ConvexSet& X) { return to_string(X); });
}

}  // namespace cordon::python
