// SPDX-License-Identifier: GPL-3.0-or-later
// Representations whose exchange form tells less than they know: discs, which answer by their
// support function, and polyhedra, which bring inequalities along.
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/line_form_set.hpp"
#include "cordon/solvers/certificate.hpp"

using namespace cordon;

namespace {

/// {x : ‖x - c‖₂ ≤ r} in the plane.
class Disc final : public Set {
 public:
  Disc(const SetBackend& backend, Vector c, double r)
      : Set(backend, c.size()), c_(std::move(c)), r_(r) {}

  const Vector& center() const { return c_; }
  double radius() const { return r_; }

 private:
  Complexity do_complexity() const override { return {0, 0, 0, {{"numbers", dim() + 1}}}; }
  LineForm do_line_form() const override {
    return make_box({c_.array() - r_ * (1 + 1e-12), c_.array() + r_ * (1 + 1e-12)});
  }
  double do_support(VectorIn d, Certificate*) const override {
    return (d.dot(c_) + r_ * d.norm()) + 1e-14 * (d.norm() * (c_.norm() + r_));
  }
  Vector do_maximizer(VectorIn d) const override { return c_ + r_ * d.normalized(); }
  Answer do_is_subset_of(const Set& other, Certificate*) const override {
    const auto& disc = static_cast<const Disc&>(other);
    const double room = disc.r_ - r_, way = (c_ - disc.c_).norm();
    return way < room * (1 - 1e-9)   ? Answer::yes
           : way > room * (1 + 1e-9) ? Answer::no
                                     : Answer::unknown;
  }

  Vector c_;
  double r_;
};

class Discs final : public SetBackend {
 public:
  explicit Discs(Tightness of_points = Tightness::outer)
      : SetBackend({.name = "discs", .exact_exchange = false, .summary = "discs", .citation = ""}),
        of_points_(of_points) {}

  Enclosure disc(Vector c, double r) const {
    return {std::make_shared<Disc>(*this, std::move(c), r), Tightness::exact};
  }

 private:
  Made do_import(const LineForm& X) const override {
    const double r = X.G.colwise().norm().sum() * (1 + 1e-12);
    return {std::make_unique<Disc>(*this, X.c, r), of_points_};
  }
  Made do_product(const Set& X, const Set& Y) const override {
    Vector c(X.dim() + Y.dim());
    c << static_cast<const Disc&>(X).center(), static_cast<const Disc&>(Y).center();
    const double r =
        std::hypot(static_cast<const Disc&>(X).radius(), static_cast<const Disc&>(Y).radius());
    return {std::make_unique<Disc>(*this, c, r * (1 + 1e-12)), Tightness::outer};
  }

  Tightness of_points_;
};

/// {x : H x ≤ h}, by its inequalities alone.
class HalfSpaces final : public Set {
 public:
  HalfSpaces(const SetBackend& backend, Inequalities rows)
      : Set(backend, rows.H.cols()), rows_(std::move(rows)) {}

 private:
  Complexity do_complexity() const override { return {0, 0, 0, {{"facets", rows_.rows()}}}; }
  LineForm do_line_form() const override { return make_space(dim()); }
  bool do_has_exact_form() const override { return rows_.rows() == 0; }
  View do_view() const override { return {do_line_form(), rows_, Tightness::exact}; }

  Inequalities rows_;
};

class Polyhedra final : public SetBackend {
 public:
  Polyhedra()
      : SetBackend({.name = "half_spaces", .unbounded = true, .summary = "", .citation = ""}) {}

  Enclosure of(Matrix H, Vector h) const {
    return {std::make_shared<HalfSpaces>(*this, Inequalities{std::move(H), std::move(h)}),
            Tightness::exact};
  }

 private:
  Made do_import(const LineForm& X) const override {
    return {std::make_unique<HalfSpaces>(*this, Inequalities{Matrix(0, X.dim()), Vector(0)}),
            Tightness::outer};
  }
};

}  // namespace

TEST_CASE("discs whose boxes meet are told apart by a direction") {
  const auto discs = std::make_shared<Discs>();
  const Enclosure X = discs->disc(Vector{{0.0, 0.0}}, 1), Y = discs->disc(Vector{{1.9, 1.9}}, 1);
  Certificate why;
  REQUIRE(X->is_disjoint_from(*Y, &why) == Answer::yes);
  CHECK(why.kind == Certificate::Kind::direction);
  CHECK(X->support(why.data) + Y->support(-why.data) < 0);
  CHECK(X->is_disjoint_from(*discs->disc(Vector{{1.4, 1.4}}, 1)) == Answer::unknown);  // they meet
  CHECK(X->is_disjoint_from(*discs->disc(Vector{{1.0, 1.0}}, 1)) == Answer::unknown);
}

TEST_CASE("a corner of the box is outside the disc, though inside its form") {
  const auto discs = std::make_shared<Discs>();
  const Enclosure X = discs->disc(Vector{{3.0, 3e-5}}, 1e-6);
  Certificate why;
  const Vector corner = Vector{{3.0, 3e-5}} + 0.8e-6 * Vector::Ones(2);
  REQUIRE(X->contains(corner, &why) == Answer::no);
  CHECK(why.kind == Certificate::Kind::direction);
  CHECK(why.data.dot(corner) > X->support(why.data));
  CHECK(X->contains(Vector{{3.0, 3e-5}}) == Answer::unknown);  // inside, which the form cannot tell
}

TEST_CASE("a set's own answers are asked before its form") {
  const auto discs = std::make_shared<Discs>();
  const Enclosure X = discs->disc(Vector{{0.0, 0.0}}, 1), Y = discs->disc(Vector{{0.5, 0.0}}, 2);
  CHECK(X->is_subset_of(*Y) == Answer::yes);
  CHECK(Y->is_subset_of(*X) == Answer::no);
  const auto others = std::make_shared<Discs>();  // another backend sees the forms only
  CHECK(X->is_subset_of(*others->disc(Vector{{0.5, 0.0}}, 2)) == Answer::unknown);
  CHECK(X->complexity().count("numbers") == 3);
  CHECK(X->complexity().count("facets") == 0);
  CHECK(discs->product(X, Y)->dim() == 4);
  CHECK(discs->product(X, Y)->support(Vector::Unit(4, 3)) == doctest::Approx(std::sqrt(5.0)));
}

TEST_CASE("support tells where it is reached") {
  const auto discs = std::make_shared<Discs>();
  const Vector d{{3.0, 4.0}};
  Vector at;
  CHECK(discs->disc(Vector{{1.0, 0.0}}, 5)->support(d, &at) == doctest::Approx(28));
  CHECK((at - Vector{{4.0, 4.0}}).norm() < 1e-12);
  const Enclosure box = line_form_set(make_box({Vector{{0.0, 0.0}}, Vector{{1.0, 2.0}}}),
                                      Rounding::nominal, Tightness::exact);
  CHECK(box->support(d, &at) == doctest::Approx(11));
  CHECK((at - Vector{{1.0, 2.0}}).norm() < 1e-12);
}

TEST_CASE("a view along directions knows what the form does not") {
  const auto discs = std::make_shared<Discs>();
  const View X = discs->disc(Vector{{0.0, 0.0}}, 1)->view_along(Matrix{{1.0, 1.0}, {1.0, -1.0}});
  CHECK(X.claim == Tightness::outer);
  REQUIRE(X.rows.rows() == 2);
  CHECK(X.rows.h[0] == doctest::Approx(std::sqrt(2.0)));
  CHECK_THROWS_AS(discs->disc(Vector{{0.0, 0.0}}, 1)->view_along(Matrix(3, 1)), Error);
}

TEST_CASE("inequalities are exchanged") {
  const auto polyhedra = std::make_shared<Polyhedra>();
  const Enclosure triangle =
      polyhedra->of(Matrix{{-1.0, 0.0}, {0.0, -1.0}, {1.0, 1.0}}, Vector{{0.0, 0.0, 1.0}});
  CHECK(triangle->support(Vector{{1.0, 0.0}}) == doctest::Approx(1));
  CHECK(triangle->interval_hull().lower == Vector{{0.0, 0.0}});
  CHECK(triangle->is_bounded() == Answer::yes);
  CHECK(triangle->contains(Vector{{0.25, 0.25}}) == Answer::yes);
  CHECK(triangle->contains(Vector{{0.75, 0.75}}) == Answer::no);
  const Enclosure form = line_form_set(make_space(2), Rounding::nominal, Tightness::exact);
  const Enclosure held = form->backend().import(triangle);  // with slack factors
  CHECK(held.tightness == Tightness::exact);
  CHECK(held->contains(Vector{{0.25, 0.25}}) == Answer::yes);
  CHECK(held->contains(Vector{{0.75, 0.75}}) == Answer::no);
  CHECK(held->is_subset_of(*triangle) != Answer::no);
  const Enclosure inside = line_form_set(make_box({Vector{{0.1, 0.1}}, Vector{{0.2, 0.2}}}),
                                         Rounding::nominal, Tightness::exact);
  CHECK(inside->is_subset_of(*triangle) == Answer::yes);
  const Enclosure half = polyhedra->of(Matrix{{1.0, 0.0}}, Vector{{-1.0}});
  CHECK(half->is_bounded() != Answer::yes);
  CHECK(half->is_disjoint_from(*triangle) == Answer::yes);
  CHECK(form->backend().import(half).tightness == Tightness::outer);
  CHECK(polyhedra->of(Matrix{{1.0}, {-1.0}}, Vector{{1.0, -2.0}})->is_empty() == Answer::yes);
}
