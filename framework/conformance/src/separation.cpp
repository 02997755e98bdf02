// SPDX-License-Identifier: GPL-3.0-or-later
#include "separation.hpp"

#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_questions.hpp"

namespace cordon::conformance {

namespace {

/// Rows Σ coefficient · variable = constant over lines and factors, entry by entry.
class Rows {
 public:
  explicit Rows(double widened) : widened_(widened) {}

  Index lines(Index count) {
    const Index first = lines_;
    lines_ += count;
    return first;
  }
  /// Lines that are an element of a zonotope.
  Index element(const LineForm& X) {
    const Index x = lines(X.dim()), factors = factors_;
    factors_ += X.generators();
    for (Index i = 0; i < X.dim(); ++i) {
      const Index row = add_row(X.c[i]);
      line(row, x + i, 1);
      for (Index j = 0; j < X.generators(); ++j)
        entries_.push_back({row, factors + j, true, -X.G(i, j) * widened_});
    }
    return x;
  }
  Index add_row(double constant) {
    b_.push_back(constant);
    return static_cast<Index>(b_.size()) - 1;
  }
  void line(Index row, Index variable, double value) {
    entries_.push_back({row, variable, false, value});
  }
  void product(Index row, const Matrix& M, Index i, Index first, double sign) {
    for (Index j = 0; j < M.cols(); ++j) line(row, first + j, sign * M(i, j));
  }
  LineForm form() const {
    const auto m = static_cast<Index>(b_.size());
    LineForm X{
        Matrix(0, lines_),       Matrix(0, factors_),       Vector(0),
        Matrix::Zero(m, lines_), Matrix::Zero(m, factors_), Eigen::Map<const Vector>(b_.data(), m)};
    for (const auto& [row, col, factor, value] : entries_) (factor ? X.A : X.S)(row, col) += value;
    return X;
  }

 private:
  struct Entry {
    Index row, col;
    bool factor;
    double value;
  };
  double widened_;
  Index lines_ = 0, factors_ = 0;
  std::vector<double> b_;
  std::vector<Entry> entries_;
};

/// The lines of all outputs that a mode makes.
std::vector<Index> outputs_of(Rows& rows, const Model& model, const Matrix& u) {
  const LinearModel& m = model.linear;
  std::vector<Index> outputs;
  Index x = rows.element(model.X0);
  for (Index k = 0; k < u.rows(); ++k) {
    const Index forced = rows.lines(u.cols());
    for (Index j = 0; j < u.cols(); ++j) rows.line(rows.add_row(u(k, j)), forced + j, 1);
    const Index v = rows.element(model.V), y = rows.lines(m.outputs());
    for (Index i = 0; i < m.outputs(); ++i) {
      const Index row = rows.add_row(0);
      rows.line(row, y + i, 1);
      rows.product(row, m.C, i, x, -1);
      rows.product(row, m.D, i, forced, -1);
      rows.product(row, m.Dv, i, v, -1);
    }
    outputs.push_back(y);
    if (k + 1 == u.rows()) break;
    const Index w = rows.element(model.W), next = rows.lines(m.states());
    for (Index i = 0; i < m.states(); ++i) {
      const Index row = rows.add_row(0);
      rows.line(row, next + i, 1);
      rows.product(row, m.A, i, x, -1);
      rows.product(row, m.B, i, forced, -1);
      rows.product(row, m.Bw, i, w, -1);
    }
    x = next;
  }
  return outputs;
}

}  // namespace

Answer outputs_meet(const Model& one, const Model& two, const Matrix& u, bool last_only,
                    double widened) {
  Rows rows(widened);
  const auto first = outputs_of(rows, one, u), second = outputs_of(rows, two, u);
  for (std::size_t k = last_only ? first.size() - 1 : 0; k < first.size(); ++k) {
    for (Index i = 0; i < one.outputs(); ++i) {
      const Index row = rows.add_row(0);
      rows.line(row, first[k] + i, 1);
      rows.line(row, second[k] + i, -1);
    }
  }
  try {
    return negate(exact::is_empty(rows.form()));
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    return Answer::unknown;
  }
}

}  // namespace cordon::conformance
