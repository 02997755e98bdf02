// SPDX-License-Identifier: GPL-3.0-or-later
// Both descriptions of a polytope as a text, and back.
#include <algorithm>
#include <sstream>
#include <string>

#include "cordon/core/error.hpp"
#include "solvers/polytope_representation.hpp"

namespace cordon {

namespace {

using rational::Rational;
using rational::RationalVector;

[[noreturn]] void refuse(const char* what) {
  throw Error(Errc::invalid, std::string("the descriptions of a polytope: ") + what);
}

/// A line of sizes, then one per row: "= 1 -1/2" or "+ 0 3".
void write(std::ostream& out, const Description& in) {
  out << in.dim << ' ' << in.rows.size() << '\n';
  for (std::size_t i = 0; i < in.rows.size(); ++i) {
    out << (in.linear[i] ? '=' : '+');
    for (const Rational& x : in.rows[i]) out << ' ' << x.get_str(16);
    out << '\n';
  }
}

Rational number(std::istream& in) {
  std::string text;
  if (!(in >> text)) refuse("a number is missing");
  Rational x;
  if (x.set_str(text, 16) != 0 || sgn(x.get_den()) <= 0)
    refuse("there is something else than a number");
  x.canonicalize();
  return x;
}

/// `bytes`: of the text, in which nothing larger has room.
Description read(std::istream& in, std::size_t bytes) {
  Description out;
  long rows = -1;
  if (!(in >> out.dim >> rows) || out.dim < 0 || rows < 0) refuse("sizes are missing");
  const auto most = static_cast<Index>(bytes);
  if (out.dim > most || rows > most) refuse("sizes are too large");
  for (long i = 0; i < rows; ++i) {
    char kind = 0;
    if (!(in >> kind) || (kind != '=' && kind != '+')) refuse("the kind of a row is missing");
    RationalVector row;
    for (Index j = 0; j <= out.dim; ++j) row.push_back(number(in));
    out.add(std::move(row), kind == '=');
  }
  return out;
}

bool are_generators(const Description& given) {
  for (std::size_t i = 0; i < given.rows.size(); ++i) {
    const Rational& first = given.rows[i][0];
    if (first != 0 && (first != 1 || given.linear[i])) return false;
  }
  const bool has_point = std::any_of(given.rows.begin(), given.rows.end(),
                                     [](const RationalVector& row) { return sgn(row[0]) != 0; });
  return given.rows.empty() || has_point;
}

/// conv(points) ⊕ cone(rays) ⊕ span(lines) ⊆ {x : inequalities}
bool fits(const Description& generators, const Description& inequalities) {
  for (std::size_t i = 0; i < generators.rows.size(); ++i) {
    for (std::size_t j = 0; j < inequalities.rows.size(); ++j) {
      const int sign = sgn(rational::dot(generators.rows[i], inequalities.rows[j]));
      if (sign < 0 || (sign > 0 && (generators.linear[i] || inequalities.linear[j]))) return false;
    }
  }
  return true;
}

bool are_of_one_set(const Description& generators, const Description& inequalities) {
  try {
    return fits(generators_of(inequalities), inequalities_of(generators));
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    refuse("they are too large to be compared");
  }
}

}  // namespace

std::string Polytope::descriptions() const {
  std::ostringstream out;
  write(out, representation_->generators());
  write(out, representation_->inequalities());
  return std::move(out).str();
}

Polytope Polytope::from_descriptions(const std::string& text) {
  std::istringstream in(text);
  Description generators = read(in, text.size()), inequalities = read(in, text.size());
  std::string more;
  if (in >> more) refuse("something is left over");
  if (generators.dim != inequalities.dim) refuse("they are of two dimensions");
  if (!are_generators(generators)) refuse("there are no such generators");
  if (!fits(generators, inequalities) || !are_of_one_set(generators, inequalities))
    refuse("they are of two sets");
  return Representation::minimal(std::move(generators), std::move(inequalities));
}

}  // namespace cordon
