// SPDX-License-Identifier: GPL-3.0-or-later
#include "shrink.hpp"

#include <cmath>
#include <set>

namespace cordon::conformance {

namespace {

void drop_row(Matrix& A, Index i) {
  const Index below = A.rows() - i - 1;
  A.middleRows(i, below) = Matrix(A.bottomRows(below));
  A.conservativeResize(A.rows() - 1, Eigen::NoChange);
}
void drop_col(Matrix& A, Index j) {
  const Index after = A.cols() - j - 1;
  A.middleCols(j, after) = Matrix(A.rightCols(after));
  A.conservativeResize(Eigen::NoChange, A.cols() - 1);
}
void drop_entry(Vector& x, Index i) {
  const Index after = x.size() - i - 1;
  x.segment(i, after) = Vector(x.tail(after));
  x.conservativeResize(x.size() - 1);
}

/// Tries changes one after another and keeps those after which the case still fails.
class Shrinker {
 public:
  Shrinker(TestCase test, const std::function<bool(const TestCase&)>& fails, Index limit)
      : best_(std::move(test)), fails_(fails), left_(limit) {}

  TestCase run() {
    do {
      progress_ = false;
      drop_parts();
      simplify_entries();
    } while (progress_ && left_ > 0);
    return std::move(best_);
  }

 private:
  template <class Change>
  bool attempt(Change&& change) {
    if (left_ <= 0) return false;
    TestCase candidate = best_;
    change(candidate);
    for (TestSet& X : candidate.sets) X.refit();
    --left_;
    if (!fails_(candidate)) return false;
    best_ = std::move(candidate);
    progress_ = true;
    return true;
  }

  /// Calls drop(i) for i = count()-1 … 0; count may fall meanwhile.
  template <class Count, class Drop>
  void each(Count&& count, Drop&& drop) {
    for (Index i = count() - 1; i >= 0 && left_ > 0; --i) {
      if (i < count()) drop(i);
    }
  }

  void drop_coordinate(TestCase& test, char space, Index i) {
    for (TestSet& X : test.sets) {
      if (X.space != space) continue;
      drop_row(X.form.M, i);
      drop_row(X.form.G, i);
      drop_entry(X.form.c, i);
    }
    for (TestMatrix& A : test.matrices) {
      if (A.rows == space) drop_row(A.value, i);
      if (A.cols == space) drop_col(A.value, i);
    }
    for (TestVector& v : test.vectors) {
      if (v.space == space) drop_entry(v.value, i);
    }
  }

  void drop_parts() {
    std::set<char> spaces;
    for (const TestSet& X : best_.sets) spaces.insert(X.space);
    for (const TestMatrix& A : best_.matrices) spaces.insert({A.rows, A.cols});
    for (const TestVector& v : best_.vectors) spaces.insert(v.space);
    for (const char space : spaces) {
      each([&] { return best_.dim(space) > 1 ? best_.dim(space) : Index{0}; },
           [&](Index i) { attempt([&](TestCase& test) { drop_coordinate(test, space, i); }); });
    }
    for (std::size_t k = 0; k < best_.sets.size(); ++k) {
      each([&] { return best_.sets[k].form.constraints(); },
           [&](Index i) {
             attempt([&](TestCase& test) {
               LineForm& F = test.sets[k].form;
               drop_row(F.S, i);
               drop_row(F.A, i);
               drop_entry(F.b, i);
             });
           });
      each([&] { return best_.sets[k].form.generators(); },
           [&](Index j) {
             attempt([&](TestCase& test) {
               TestSet& X = test.sets[k];
               drop_col(X.form.G, j);
               drop_col(X.form.A, j);
               if (j < X.xi.size()) drop_entry(X.xi, j);
             });
           });
      each([&] { return best_.sets[k].form.lines(); },
           [&](Index j) {
             attempt([&](TestCase& test) {
               TestSet& X = test.sets[k];
               drop_col(X.form.M, j);
               drop_col(X.form.S, j);
               if (j < X.delta.size()) drop_entry(X.delta, j);
             });
           });
    }
    for (std::size_t k = 0; k < best_.numbers.size(); ++k) {
      while (best_.numbers[k].value > best_.numbers[k].lowest &&
             attempt([&](TestCase& test) { --test.numbers[k].value; })) {
      }
    }
  }

  /// `access(test)` is the array of `size` numbers.
  template <class Access>
  void simplify(Access&& access, Index size) {
    const auto array = [&](TestCase& test) { return access(test); };
    bool zero = true, one = true;
    for (Index k = 0; k < size; ++k) {
      zero = zero && array(best_)[k] == 0;
      one = one && std::abs(array(best_)[k]) <= 1;
    }
    if (zero) return;
    if (size > 1 && attempt([&](TestCase& test) { std::fill_n(array(test), size, 0.0); })) return;
    (void)one;
    for (Index k = 0; k < size && left_ > 0; ++k) {
      const double value = array(best_)[k];
      if (value == 0) continue;
      const double sign = value < 0 ? -1 : 1;
      for (const double simple : {0.0, 1.0, -1.0, sign * std::min(std::floor(std::abs(value)), 1e9),
                                  std::nearbyint(value * 2) / 2}) {
        if (simple == value) break;  // all that follow are no simpler
        if (attempt([&](TestCase& test) { array(test)[k] = simple; })) break;
      }
    }
  }

  void simplify_entries() {
    for (std::size_t k = 0; k < best_.sets.size(); ++k) {
      const LineForm F = best_.sets[k].form;
      simplify([k](TestCase& t) { return t.sets[k].form.c.data(); }, F.c.size());
      simplify([k](TestCase& t) { return t.sets[k].xi.data(); }, best_.sets[k].xi.size());
      simplify([k](TestCase& t) { return t.sets[k].delta.data(); }, best_.sets[k].delta.size());
      simplify([k](TestCase& t) { return t.sets[k].form.G.data(); }, F.G.size());
      simplify([k](TestCase& t) { return t.sets[k].form.M.data(); }, F.M.size());
      simplify([k](TestCase& t) { return t.sets[k].form.S.data(); }, F.S.size());
      simplify([k](TestCase& t) { return t.sets[k].form.A.data(); }, F.A.size());
      if (best_.sets[k].empty)
        simplify([k](TestCase& t) { return t.sets[k].form.b.data(); }, F.b.size());
    }
    for (std::size_t k = 0; k < best_.matrices.size(); ++k) {
      TestMatrix& A = best_.matrices[k];
      if (A.value.rows() == A.value.cols() && !A.value.isIdentity(0)) {
        attempt([&](TestCase& test) { test.matrices[k].value.setIdentity(); });
      }
      if (best_.matrices[k].value.rows() == best_.matrices[k].value.cols() &&
          best_.matrices[k].value.isIdentity(0))
        continue;
      simplify([k](TestCase& t) { return t.matrices[k].value.data(); },
               best_.matrices[k].value.size());
    }
    for (std::size_t k = 0; k < best_.vectors.size(); ++k) {
      simplify([k](TestCase& t) { return t.vectors[k].value.data(); },
               best_.vectors[k].value.size());
    }
  }

  TestCase best_;
  const std::function<bool(const TestCase&)>& fails_;
  Index left_;
  bool progress_ = false;
};

}  // namespace

TestCase shrink(TestCase test, const std::function<bool(const TestCase&)>& fails, Index limit) {
  return Shrinker(std::move(test), fails, limit).run();
}

}  // namespace cordon::conformance
