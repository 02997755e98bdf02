// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/reading/read_sets.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/polytope.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;

/// A block of an exchange form that may be left out.
struct Block {
  bool good = true;               ///< absent or well-formed
  std::optional<Matrix> entries;  ///< none: absent
};

/// An empty list of generators or lines counts as absent.
Block read_block(const Cursor& set, const char* key) {
  const auto at = set.find(key);
  if (!at) return {};
  auto entries = read_matrix(*at);
  const bool good = entries.has_value();
  if (good && entries->size() == 0 &&
      (key == std::string_view("generators") || key == std::string_view("lines")))
    entries.reset();
  return {good, std::move(entries)};
}

bool expect_rows(const Cursor& set, const char* key, const Matrix& entries, Index rows,
                 const char* like) {
  if (entries.rows() == rows) return true;
  set.find(key)->error(
      "is " + shape(entries.rows(), entries.cols()) + ", must have " + counted(rows, "row") +
          " like " + child(set.pointer(), like),
      "rows belong to " +
          std::string(like == std::string_view("center") ? "states" : "constraints") +
          ", columns to generators");
  return false;
}

bool expect_cols(const Cursor& set, const char* key, const Matrix& entries, Index cols,
                 const char* like) {
  if (entries.cols() == cols) return true;
  set.find(key)->error("is " + shape(entries.rows(), entries.cols()) + ", must have " +
                       counted(cols, "column") + " like " + child(set.pointer(), like));
  return false;
}

std::optional<Vector> read_point(const Cursor& set, const char* key,
                                 const std::string& suggestion) {
  const auto at = set.need(key, suggestion);
  return at ? read_vector(*at, max_dimension) : std::nullopt;
}

/// Checks the bounds of one coordinate; `lower` and `upper` are the cursors of the two lists.
bool expect_interval(const Cursor& lower, const Cursor& upper, std::size_t i, double low,
                     double high) {
  if (low == infinity)
    lower.item(i).error("a lower bound cannot be \"inf\"", "write \"-inf\" for a free coordinate");
  if (high == -infinity)
    upper.item(i).error("an upper bound cannot be \"-inf\"", "write \"inf\" for a free coordinate");
  if (low == infinity || high == -infinity) return false;
  if (std::isinf(low) != std::isinf(high)) {
    (std::isinf(low) ? lower : upper)
        .item(i)
        .error("the coordinate is bounded on one side only: half-lines cannot be represented",
               "give a finite bound, or free the coordinate on both sides: \"-inf\" and \"inf\"");
    return false;
  }
  if (low > high) {
    lower.item(i).error("lies above the upper bound: the box is empty", "exchange the two bounds");
    return false;
  }
  return true;
}

std::optional<Box> read_box(const Cursor& set, bool finite) {
  const auto lower_at = set.need("lower", "a list of lower bounds"),
             upper_at = set.need("upper", "a list of upper bounds");
  const auto lower = lower_at ? read_bounds(*lower_at) : std::nullopt,
             upper = upper_at ? read_bounds(*upper_at) : std::nullopt;
  if (!lower || !upper || !expect_size(*upper_at, *upper, lower->size(), lower_at->pointer()))
    return std::nullopt;
  bool good = true;
  for (Index i = 0; i < lower->size(); ++i) {
    const double low = (*lower)[i], high = (*upper)[i];
    good = expect_interval(*lower_at, *upper_at, static_cast<std::size_t>(i), low, high) && good;
    if (finite && std::isinf(low) && std::isinf(high)) {
      lower_at->item(static_cast<std::size_t>(i))
          .error("the bounds of a polytope are finite", "give a box that contains the polytope");
      good = false;
    }
  }
  return good ? std::optional<Box>(Box{*lower, *upper}) : std::nullopt;
}

std::optional<LineForm> read_boxed(const Cursor& set) {
  const auto box = read_box(set, false);
  return box ? std::optional<LineForm>(make_box(*box)) : std::nullopt;
}

/// Blocks with constraints of zonotope, constrained_zonotope and line_zonotope; keys outside the
/// type are reported before.
std::optional<LineForm> read_generated(const Cursor& set) {
  const auto c = read_point(set, "center", "a list of numbers, one per state");
  const Block G = read_block(set, "generators"), M = read_block(set, "lines"),
              S = read_block(set, "S"), A = read_block(set, "A");
  const auto b_at = set.find("b");
  const auto b = b_at ? read_vector(*b_at) : std::optional<Vector>(Vector(0));
  bool good = c && G.good && M.good && S.good && A.good && b;
  if (!b_at && (S.entries || A.entries)) {
    set.need("b", "constraints are Sδ + Aξ = b");
    good = false;
  }
  if (!good) return std::nullopt;
  const Index n = c->size(), m = b->size();
  LineForm X;
  X.c = *c, X.b = *b;
  X.G = G.entries.value_or(Matrix(n, 0)), X.M = M.entries.value_or(Matrix(n, 0));
  good = expect_rows(set, "generators", X.G, n, "center") && good;
  good = expect_rows(set, "lines", X.M, n, "center") && good;
  X.A = A.entries.value_or(Matrix::Zero(m, X.G.cols())),
  X.S = S.entries.value_or(Matrix::Zero(m, X.M.cols()));
  if (A.entries)
    good = expect_rows(set, "A", X.A, m, "b") &&
           expect_cols(set, "A", X.A, X.G.cols(), "generators") && good;
  if (S.entries)
    good = expect_rows(set, "S", X.S, m, "b") && expect_cols(set, "S", X.S, X.M.cols(), "lines") &&
           good;
  return good ? std::optional<LineForm>(std::move(X)) : std::nullopt;
}

std::optional<LineForm> read_strip(const Cursor& set) {
  const auto rho = read_point(set, "rho", "the normal of {x : |rhoᵀx - d| ≤ sigma}");
  const auto d_at = set.need("d", "the middle of {x : |rhoᵀx - d| ≤ sigma}"),
             sigma_at = set.need("sigma", "the half width");
  const auto d = d_at ? read_number(*d_at) : std::nullopt,
             sigma = sigma_at ? read_number(*sigma_at) : std::nullopt;
  if (sigma && *sigma < 0) {
    sigma_at->error("is negative: the strip is empty", "the half width is at least 0");
    return std::nullopt;
  }
  return rho && d && sigma ? std::optional<LineForm>(make_strip(*rho, *d, *sigma)) : std::nullopt;
}

std::optional<LineForm> read_space(const Cursor& set) {
  const auto at = set.need("dim", "the dimension of the space");
  const auto dim = at ? read_integer(*at, 0, max_dimension) : std::nullopt;
  return dim ? std::optional<LineForm>(make_space(*dim)) : std::nullopt;
}

std::optional<LineForm> read_single_point(const Cursor& set) {
  const auto c = read_point(set, "center", "the point: a list of numbers");
  return c ? std::optional<LineForm>(make_point(*c)) : std::nullopt;
}

/// A polyhedron in exchange form; an error stands at `at`.
std::optional<LineForm> read_exactly(const Cursor& at, const std::function<Polytope()>& make,
                                     const std::string& suggestion) {
  try {
    const Polytope P = make();
    if (P.generators().rays.cols() == 0) return P.to_line_form().form;
    at.error("leaves the polytope unbounded on one side only: half-spaces cannot be represented",
             suggestion);
  } catch (const Error& error) {
    at.error(error.what(), suggestion);
  }
  return std::nullopt;
}

std::optional<LineForm> read_vertices(const Cursor& set, const Cursor& at) {
  for (const char* key : {"lower", "upper", "H", "h"}) {
    if (const auto other = set.find(key)) {
      other->error("cannot stand beside \"vertices\"",
                   "a polytope is given by its vertices or by its inequalities: remove one");
      return std::nullopt;
    }
  }
  const auto V = read_matrix(at);
  if (!V) return std::nullopt;
  if (V->rows() == 0) {
    at.error("has no vertices: the polytope is empty", "one vertex per row");
    return std::nullopt;
  }
  return read_exactly(
      at, [&] { return Polytope::from_generators(V->transpose()); },
      "give its inequalities with bounds, or a set of another type");
}

std::optional<LineForm> read_polytope(const Cursor& set) {
  if (const auto at = set.find("vertices")) return read_vertices(set, *at);
  if (!set.find("lower") && !set.find("upper")) {
    const auto H_at = set.need("H", "the rows of H x ≤ h; or \"vertices\", one per row");
    const auto h_at = set.need("h", "the right-hand side of H x ≤ h");
    const auto H = H_at ? read_matrix(*H_at) : std::nullopt;
    const auto h = h_at ? read_vector(*h_at) : std::nullopt;
    if (!H || !h || !expect_rows(set, "H", *H, h->size(), "h")) return std::nullopt;
    return read_exactly(
        *H_at, [&] { return Polytope::from_inequalities(*H, *h); },
        "give bounds: \"lower\" and \"upper\", lists of finite numbers");
  }
  const auto box = read_box(set, true);
  const auto H_at = set.need("H", "the rows of H x ≤ h"),
             h_at = set.need("h", "the right-hand side of H x ≤ h");
  const auto H = H_at ? read_matrix(*H_at) : std::nullopt;
  const auto h = h_at ? read_vector(*h_at) : std::nullopt;
  if (!box || !H || !h) return std::nullopt;
  const bool rows = expect_rows(set, "H", *H, h->size(), "h"),
             cols = expect_cols(set, "H", *H, box->dim(), "lower");
  return rows && cols ? std::optional<LineForm>(make_polytope(*box, *H, *h)) : std::nullopt;
}

struct SetType {
  const char* name;
  std::vector<std::string> keys;
  std::optional<LineForm> (*read)(const Cursor&);
};

const std::vector<SetType>& types() {
  static const std::vector<SetType> all = {
      {"box", {"type", "lower", "upper"}, read_boxed},
      {"zonotope", {"type", "center", "generators"}, read_generated},
      {"constrained_zonotope", {"type", "center", "generators", "A", "b"}, read_generated},
      {"line_zonotope", {"type", "center", "lines", "generators", "S", "A", "b"}, read_generated},
      {"strip", {"type", "rho", "d", "sigma"}, read_strip},
      {"space", {"type", "dim"}, read_space},
      {"point", {"type", "center"}, read_single_point},
      {"polytope", {"type", "lower", "upper", "H", "h", "vertices"}, read_polytope},
  };
  return all;
}

}  // namespace

const std::vector<std::string>& set_types() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const SetType& type : types()) all.emplace_back(type.name);
    return all;
  }();
  return names;
}

LineForm make_polytope(const Box& box, MatrixIn H, VectorIn h) {
  const LineForm B = make_box(box);
  const Index g = B.generators(), m = h.size();
  LineForm X{B.M,          Matrix::Zero(B.dim(), g + m), B.c,
             Matrix(m, 0), Matrix::Zero(m, g + m),       Vector(m)};
  X.G.leftCols(g) = B.G;
  X.A.leftCols(g) = linalg::product(H, B.G);
  const Matrix error = rounding::product_error(H, B.G);
  for (Index i = 0; i < m; ++i) {
    const Interval left =
        rounding::subtract({h[i], h[i]}, rounding::dot(H.row(i).transpose(), B.c));  // h_i - H_i c
    const double row_error = rounding::norm_1(error.row(i).transpose()).upper;
    const double largest = rounding::up(
        rounding::up(left.upper + rounding::norm_1(X.A.row(i).head(g).transpose()).upper) +
        row_error);
    if (largest < 0) return make_empty(B.dim());
    const double middle = largest / 2;
    X.b[i] = left.lower - middle;
    const double shift = rounding::up(rounding::up(left.upper - middle) -
                                      X.b[i]);  // how far the true right-hand side may lie above b
    const double below = rounding::up(X.b[i] - rounding::down(left.lower - middle));
    X.A(i, g + i) = rounding::up(middle + rounding::up(row_error + std::max(shift, below)));
  }
  return X;
}

std::optional<LineForm> read_set(const Cursor& at, std::vector<std::string>& warnings) {
  if (!at.expect(Kind::object,
                 "write a set: {\"type\": \"box\", \"lower\": [...], \"upper\": [...]}"))
    return std::nullopt;
  const auto type_at = at.need("type", suggest("", set_types()));
  const auto name = type_at ? read_choice(*type_at, set_types()) : std::nullopt;
  if (!name) return std::nullopt;
  const auto type = std::find_if(types().begin(), types().end(),
                                 [&](const SetType& t) { return t.name == *name; });
  at.expect_keys(type->keys, "key of a set of type " + in_quotes(*name), "");
  try {
    std::optional<LineForm> X = type->read(at);
    if (!X) return std::nullopt;
    check(*X, "the set");
    const Answer empty = is_empty(*X);
    if (empty == Answer::yes) {
      at.error("the set is empty",
               "no point satisfies its constraints; check their signs and bounds");
      return std::nullopt;
    }
    if (empty == Answer::unknown)
      warnings.push_back(at.pointer() + ": it could not be decided whether the set is empty");
    return X;
  } catch (const Error& error) {
    at.error(error.what(), "");
    return std::nullopt;
  }
}

std::optional<Box> read_plain_box(const Cursor& at, std::optional<Index> dim,
                                  const std::string& like) {
  if (!at.expect_keys({"lower", "upper"}, "key of bounds", "{\"lower\": [...], \"upper\": [...]}"))
    return std::nullopt;
  const auto lower_at = at.need("lower", "a list of lower bounds"),
             upper_at = at.need("upper", "a list of upper bounds");
  const auto lower = lower_at ? read_bounds(*lower_at) : std::nullopt,
             upper = upper_at ? read_bounds(*upper_at) : std::nullopt;
  if (!lower || !upper || !expect_size(*upper_at, *upper, lower->size(), lower_at->pointer()))
    return std::nullopt;
  if (dim && lower->size() != *dim) {
    at.error("has dimension " + std::to_string(lower->size()) + ", must have " +
             std::to_string(*dim) + " like " + like);
    return std::nullopt;
  }
  for (Index i = 0; i < lower->size(); ++i) {
    if ((*lower)[i] <= (*upper)[i]) continue;
    lower_at->item(as_size(i))
        .error("lies above the upper bound: the box is empty", "exchange the two bounds");
    return std::nullopt;
  }
  return Box{*lower, *upper};
}

std::optional<ValidRegion> read_region(const Cursor& at, std::optional<Index> states,
                                       std::optional<Index> inputs) {
  const std::string form = "{\"states\": {\"lower\": [...], \"upper\": [...]}, \"inputs\": {...}}";
  if (!at.expect_keys({"states", "inputs", "nonlinear_outputs"}, "key of a region", form))
    return std::nullopt;
  const std::size_t before = at.problems().met();
  ValidRegion region;
  const auto states_at = at.need("states", "bounds of all states: " + form);
  const auto inputs_at =
      inputs == Index{0} ? at.find("inputs") : at.need("inputs", "bounds of all inputs: " + form);
  if (states_at) region.states = read_plain_box(*states_at, states, "the states").value_or(Box{});
  if (inputs_at) region.inputs = read_plain_box(*inputs_at, inputs, "the inputs").value_or(Box{});
  if (const auto flag = at.find("nonlinear_outputs"))
    region.nonlinear_outputs = read_flag(*flag).value_or(false);
  return at.problems().met() == before ? std::optional(std::move(region)) : std::nullopt;
}

}  // namespace cordon::json
