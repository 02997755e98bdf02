// SPDX-License-Identifier: GPL-3.0-or-later
// Measurements that say what is known already: repeated, proportional and dependent rows, noise
// that is a point, sets without interior, plants without noise. In some directions rounding is left
// only, and nothing may be concluded from it.
#include "operations.hpp"

namespace cordon::conformance {

namespace {

TestSet point(const Setting& s, char space, Index n) {
  TestSet V;
  V.name = "V";
  V.space = space;
  V.form = make_point(s.random.chance(0.5) ? Vector(Vector::Zero(n)) : s.make().vector(n));
  V.delta = V.xi = Vector(0);
  return V;
}

/// Numbers of few digits in most cases: the known point of X is then proven to survive.
Setting plain(Setting s) {
  if (s.random.chance(0.6)) s.style = Style::tame;
  return s;
}

/// Rows without zeros: what cancels in their products does so by rounding only.
Matrix dense(const Setting& s, Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& entry : A.reshaped())
    entry = s.random.sign() * static_cast<double>(s.random.between(1, 6)) / 2;
  return A;
}

/// Rows for X; some are normal to its known point, so that its measurement is 0.
Matrix rows_for(const Setting& s, const TestCase& test, Index rows) {
  if (s.random.chance(0.2)) return s.make().map(rows, s.n);
  Matrix C = dense(s, rows, s.n);
  const Vector x = test.set(0).point();
  for (Index i = 0; i < rows && s.n > 1; ++i) {
    if (s.random.chance(0.5)) continue;
    const Index j = s.random.below(s.n - 1);
    C.row(i).setZero();
    C.row(i).segment(j, 2) << (x[j + 1] == 0 ? 1.0 : x[j + 1]), (x[j] == 0 ? 1.0 : -x[j]);
    if (x[j] == 0 || x[j + 1] == 0)
      C.row(i) = (x.array() == 0).select(C.row(i).transpose().array(), 0.0).transpose();
  }
  return C;
}

/// X, in every second case no more than a full zonotope, and V, in most cases a point.
TestCase overlapping_sets(const Setting& s) {
  TestCase test;
  test.sets.push_back(s.make().set("X", 'n', s.n, s.shape));
  if (s.random.chance(0.5)) {
    TestSet& X = test.sets.front();
    const Index g = s.random.between(s.n, s.n + 2);
    const Vector center = s.random.chance(0.5) ? Vector(Vector::Zero(s.n)) : s.make().vector(s.n);
    X.form = make_zonotope(
        center, s.random.chance(0.5) ? dense(s, s.n, g) : Matrix(Matrix::Identity(s.n, g)));
    X.delta = Vector(0);
    X.xi = Vector(g);
    for (double& x : X.xi) x = static_cast<double>(s.random.between(-2, 2)) / 2;
  }
  const Index q = s.random.between(0, 2);
  test.sets.push_back(s.random.chance(0.7) ? point(s, 'q', q)
                                           : s.make().set("V", 'q', q, {false, 3, 1}));
  return test;
}

void add_rows(const Setting& s, TestCase& test, Index p) {
  test.matrices.push_back({"C", 'p', 'n', rows_for(s, test, p)});
  test.matrices.push_back({"T", 'p', 'q', s.make().map(p, test.dim('q'))});
}

Verdict judge(const Context& context, const TestCase& test, Applied applied) {
  Verdict verdict =
      encloses(context, applied.result, applied.truth, applied.points, applied.sure, test.seed);
  verdict.derived.insert(verdict.derived.end(), applied.derived.begin(), applied.derived.end());
  return verdict;
}

Measurement rows_of(const TestCase& test) {
  return {test.matrix(0), test.matrix(1), Vector::Zero(test.matrix(0).rows())};
}

TestCase generate_repeated(const Setting& setting) {
  const Setting s = plain(setting);
  TestCase test = overlapping_sets(s);
  add_rows(s, test, s.random.between(1, 2));
  test.numbers.push_back({"times", s.random.between(2, 3), 1});
  return test;
}

/// C is a column of factors times one row.
TestCase generate_proportional(const Setting& setting) {
  const Setting s = plain(setting);
  TestCase test = overlapping_sets(s);
  const Index p = s.random.between(2, 3);
  test.matrices.push_back({"row", 'r', 'n', rows_for(s, test, 1)});
  test.matrices.push_back({"T", 'p', 'q', s.make().map(p, test.dim('q'))});
  test.matrices.push_back({"factors", 'p', 'r', s.make().matrix(p, 1)});
  return test;
}

/// C is a matrix with more rows than columns times fewer rows.
TestCase generate_dependent(const Setting& setting) {
  const Setting s = plain(setting);
  TestCase test = overlapping_sets(s);
  const Index r = s.random.between(1, 2), p = s.random.between(r + 1, 4);
  test.matrices.push_back({"rows", 'r', 'n', rows_for(s, test, r)});
  test.matrices.push_back({"T", 'p', 'q', s.make().map(p, test.dim('q'))});
  test.matrices.push_back({"mixed", 'p', 'r', s.make().matrix(p, r)});
  return test;
}

/// In few digits, so that the rows are dependent as they are stored: rounded ones may determine
/// every state.
Verdict check_mixed(const Context& context, const TestCase& test) {
  const Matrix rows = test.matrix(0).cast<float>().cast<double>(),
               mixed = (8 * test.matrix(2)).array().round() / 8;
  const Matrix C = mixed * rows;
  Applied applied = apply_measurement(context, test, {C, test.matrix(1), Vector::Zero(C.rows())});
  applied.derived.emplace_back("C", describe(C));
  return judge(context, test, std::move(applied));
}

TestCase generate_point_noise(const Setting& setting) {
  const Setting s = plain(setting);
  TestCase test = overlapping_sets(s);
  test.sets[1] = point(s, 'q', s.random.between(1, 2));
  add_rows(s, test, s.random.between(1, 2));
  return test;
}

TestCase generate_flat(const Setting& setting) {
  const Setting s = plain(setting);
  TestCase test = overlapping_sets(s);
  LineForm& X = test.sets[0].form;
  const Index r = s.random.between(0, s.n - 1);
  X.G = dense(s, s.n, r) * dense(s, r, X.generators());
  add_rows(s, test, s.random.between(1, 2));
  return test;
}

TestCase generate_steps(const Setting& setting) {
  const Setting s = plain(setting);
  TestCase test = overlapping_sets(s);
  test.sets.pop_back();
  test.matrices.push_back(
      {"A", 'n', 'n', s.random.chance(0.5) ? dense(s, s.n, s.n) : s.make().map(s.n, s.n)});
  test.matrices.push_back({"C", 'p', 'n', rows_for(s, test, s.random.between(1, 3))});
  test.numbers.push_back({"steps", s.random.between(1, 3), 0});
  return test;
}

/// Numbers are tame: states and outputs are computed without rounding.
Verdict check_steps(const Context& context, const TestCase& test) {
  if (!test.tame()) return Verdict::inapplicable();
  const Operand start = import_operand(context, test.set(0));
  const Enclosure nothing = context.backend->import(make_point(Vector(0)));
  const Matrix &A = test.matrix(0), &C = test.matrix(1);
  const Index n = A.rows(), p = C.rows();
  Enclosure X = start.set;
  Vector x = start.points.front();
  double terms = start.size;
  for (Index k = 0; k <= test.number(0); ++k) {
    if (k > 0) {
      const Term none[] = {{Matrix(n, 0), nothing}};
      X = context.backend->predict(X, {A, Vector::Zero(n), none});
      x = A * x;
      terms *= std::max(1.0, A.cwiseAbs().rowwise().sum().maxCoeff());
    }
    X = context.backend->correct(X, {C, C * x, {Matrix(p, 0), nothing}});
    Truth truth;
    truth.add(make_point(x), {x}, terms, 0);
    Verdict verdict = encloses(context, X, truth, {x}, start.sure, test.seed);
    if (!verdict.failed()) continue;
    verdict.derived.emplace_back("k", std::to_string(k));
    verdict.derived.emplace_back("state", describe_vector(x));
    return verdict;
  }
  return {};
}

}  // namespace

void add_measurements(LawList& list) {
  const auto check = [](const Context& context, const TestCase& test) {
    return judge(context, test, apply_measurement(context, test, rows_of(test)));
  };
  const auto repeat = [](const Context& context, const TestCase& test) {
    return judge(context, test, apply_measurement(context, test, rows_of(test), test.number(0)));
  };
  const std::string kept = "{x ∈ X : z - C x ∈ T V} ⊆ correct(X, C, z, T V) ";
  list.push_back({{"soundness.repeated_strips", kept + "when it is carried out again and again"},
                  generate_repeated,
                  repeat});
  list.push_back(
      {{"soundness.proportional_strips", kept + "for rows of C that are multiples of one"},
       generate_proportional,
       check_mixed});
  list.push_back({{"soundness.dependent_strips", kept + "for linearly dependent rows of C"},
                  generate_dependent,
                  check_mixed});
  list.push_back({{"soundness.point_noise", kept + "for a point V"}, generate_point_noise, check});
  list.push_back(
      {{"soundness.flat_strips", kept + "for X without interior"}, generate_flat, check, {}, 1, 2});
  list.push_back({{"soundness.noise_free_steps",
                   "the state of a plant without noise stays in predictions and corrections"},
                  generate_steps,
                  check_steps});
}

}  // namespace cordon::conformance
