// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/tubes/output_tube.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"
#include "cordon/tubes/line_proof.hpp"

namespace cordon {

namespace {

/// An affine expression of the unknowns: offset + lines·δ + factors·ξ, with columns from `line` and
/// `factor` on.
struct Part {
  Matrix M, G;
  Vector c;
  Vector size;  ///< of the terms of c and G ξ
  Index line = 0, factor = 0;
};

/// Are all sums of A B free of rounding, as they are added up? In doubt no.
bool is_exact_product(MatrixIn A, MatrixIn B) {
  constexpr double smallest = 1e-290;  // below, the error itself may be no double
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < B.cols(); ++j) {
      double sum = 0;
      for (Index k = 0; k < A.cols(); ++k) {
        const double product = A(i, k) * B(k, j);
        if (A(i, k) == 0 || B(k, j) == 0) continue;
        const double next = sum + product, added = next - sum;
        const double lost = (sum - (next - added)) + (product - added);
        if (!(std::abs(product) >= smallest) || lost != 0) return false;
        if (std::fma(A(i, k), B(k, j), -product) != 0) return false;
        sum = next;
      }
    }
  }
  return true;
}

/// T·part
Part mapped(MatrixIn T, const Part& part) {
  return {linalg::denoised_product(T, part.M),
          linalg::denoised_product(T, part.G),
          linalg::denoised_product(T, part.c),
          linalg::product(T.cwiseAbs(), part.size),
          part.line,
          part.factor};
}

/// The tube while it is built: unknowns are counted first, so that every block has its place.
class TubeBuilder {
 public:
  TubeBuilder(const TimedModel& model, const SetBackend& backend, const TubeSpan& span)
      : span_(span), X0_(imported(backend, model[0].X0)) {
    for (Index k = 0; k < model.count(); ++k) {
      times_.push_back({with_exact_effectiveness_applied(model[k].linear),
                        imported(backend, model[k].W), imported(backend, model[k].V)});
    }
    const LinearModel& m = at(0).m;
    n_ = m.states();
    inputs_ = m.inputs();
    outputs_ = m.outputs();
    if (m.is_descriptor()) E_.emplace(m.E);
    if (span.admissible_set && E_) XA_ = imported(backend, *span.admissible_set);
  }

  OutputTube build() {
    const Index N = span_.horizon, first_output = span_.last_output_only ? N : 0;
    const Index equations =
        E_ ? N + 1 : N;  // without E the equation of k = N only tells the free x_{N+1}
    const Index admissible = XA_ ? N : 0;
    const LineForm none{};
    const LineForm& XA = XA_ ? *XA_ : none;
    make_room(equations, first_output, admissible, XA);
    std::vector<Part> x{take(X0_)};
    for (Index k = 0; k < equations; ++k) {
      const Part w = take(at(k).W);
      x.push_back(take_free(n_));
      next_state(k, x[static_cast<std::size_t>(k)], w, x.back());
    }
    for (Index k = 1; k <= admissible; ++k) admit(x[static_cast<std::size_t>(k)], XA);
    for (Index k = first_output; k <= N; ++k)
      output(k, (k - first_output) * outputs_, x[static_cast<std::size_t>(k)]);
    return std::move(tube_);
  }

 private:
  /// The model of one time, with its sets as the backend writes them.
  struct Time {
    LinearModel m;
    LineForm W, V;
  };
  const Time& at(Index k) const {
    return times_[std::min(static_cast<std::size_t>(k), times_.size() - 1)];
  }

  void make_room(Index equations, Index first_output, Index admissible, const LineForm& XA) {
    const Index N = span_.horizon, inner = E_ && !E_->as_written ? E_->rank : 0;  // z of E = core z
    Index lines =
        X0_.lines() + equations * (n_ + inner) + admissible * (XA.lines() + determined().rows());
    Index factors = X0_.generators() + admissible * XA.generators();
    Index rows =
        X0_.constraints() + equations * (n_ + inner) + admissible * (XA.constraints() + n_);
    const auto count = [&](const LineForm& X) {
      lines += X.lines();
      factors += X.generators();
      rows += X.constraints();
    };
    for (Index k = 0; k < equations; ++k) count(at(k).W);
    for (Index k = first_output; k <= N; ++k) count(at(k).V);
    const Index outputs = outputs_ * (N + 1 - first_output), inputs = inputs_ * (N + 1);
    tube_ = {Matrix::Zero(outputs, lines),  Matrix::Zero(outputs, factors),
             Matrix::Zero(outputs, inputs), Vector::Zero(outputs),
             Matrix::Zero(rows, lines),     Matrix::Zero(rows, factors),
             Matrix::Zero(rows, inputs),    Vector::Zero(rows)};
    tube_.is_exact = !at(0).m.unscaled;
    tube_.c_size = Vector::Zero(outputs);
    tube_.b_size = Vector::Zero(rows);
  }

  /// As the backend writes the set, if that is the set.
  static LineForm imported(const SetBackend& backend, const LineForm& X) {
    const Enclosure set = backend.import(X);
    const bool is_same = set.tightness == Tightness::exact && set->has_exact_form();
    return is_same ? set->line_form() : X;
  }

  /// A point of the set, with unknowns and rows of its own.
  Part take(const LineForm& X) {
    const Vector size = X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum();
    const Part part{X.M, X.G, X.c, size, line_, factor_};
    tube_.S.block(row_, line_, X.constraints(), X.lines()) = X.S;
    tube_.A.block(row_, factor_, X.constraints(), X.generators()) = X.A;
    tube_.b.segment(row_, X.constraints()) = X.b;
    tube_.b_size.segment(row_, X.constraints()) = X.b.cwiseAbs() + X.A.cwiseAbs().rowwise().sum();
    line_ += X.lines();
    factor_ += X.generators();
    row_ += X.constraints();
    return part;
  }

  Part take_free(Index dim) {
    const Vector zero = Vector::Zero(dim);
    const Part part{Matrix::Identity(dim, dim), Matrix(dim, 0), zero, zero, line_, factor_};
    line_ += dim;
    return part;
  }

  /// T·part; remembers whether it was rounded.
  Part image(MatrixIn T, const Part& part) {
    for (const Matrix& columns : {part.M, part.G, Matrix(part.c)})
      tube_.is_exact = tube_.is_exact && is_exact_product(T, columns);
    return mapped(T, part);
  }

  /// Adds the expression to the rows from `row` on, whose right-hand side takes its offset.
  void add(Index row, const Part& part) {
    tube_.S.block(row, part.line, part.M.rows(), part.M.cols()) += part.M;
    tube_.A.block(row, part.factor, part.G.rows(), part.G.cols()) += part.G;
    auto right = tube_.b.segment(row, part.c.size());
    const bool is_sum = !right.isZero(0) && !part.c.isZero(0);
    tube_.is_exact = tube_.is_exact && !is_sum;
    right -= part.c;
    tube_.b_size.segment(row, part.c.size()) += part.size;
  }

  /// E x⁺ - A x - Bw w = B u_k
  void next_state(Index k, const Part& x, const Part& w, const Part& next) {
    if (E_ && !E_->as_written) {
      const Part z = take_free(E_->rank);
      add(row_, image(E_->core, z));
      add(row_, image(-E_->right, next));
      row_ += E_->rank;
      add(row_, image(E_->left, z));
    } else {
      add(row_, E_ ? image(E_->left, next) : next);
    }
    const LinearModel& m = at(k).m;
    add(row_, image(-m.A, x));
    add(row_, image(-m.Bw, w));
    tube_.Omega.block(row_, k * inputs_, n_, inputs_) = m.B;
    row_ += n_;
  }

  /// Rows that span the range of Eᵀ.
  const Matrix& determined() const {
    static const Matrix none;
    return !E_ ? none : E_->as_written ? E_->left : E_->right;
  }

  /// x - x_A - Eᵀλ = 0: x and x_A agree in what E does not determine.
  void admit(const Part& x, const LineForm& XA) {
    const Part a = take(XA), lambda = take_free(determined().rows());
    add(row_, x);
    add(row_, image(-Matrix::Identity(n_, n_), a));
    add(row_, image(-determined().transpose(), lambda));
    row_ += n_;
  }

  void output(Index k, Index row, const Part& x) {
    const auto& [m, W, V] = at(k);
    for (const Part& part : {image(m.C, x), image(m.Dv, take(V))}) {
      tube_.M.block(row, part.line, part.M.rows(), part.M.cols()) += part.M;
      tube_.G.block(row, part.factor, part.G.rows(), part.G.cols()) += part.G;
      auto offset = tube_.c.segment(row, part.c.size());
      tube_.is_exact = tube_.is_exact && (offset.isZero(0) || part.c.isZero(0));
      offset += part.c;
      tube_.c_size.segment(row, part.c.size()) += part.size;
    }
    tube_.H.block(row, k * inputs_, outputs_, inputs_) = m.D;
  }

  const TubeSpan& span_;
  LineForm X0_;
  std::vector<Time> times_;
  Index n_ = 0, inputs_ = 0, outputs_ = 0;
  std::optional<LineForm> XA_;
  std::optional<DescriptorMatrix> E_;
  OutputTube tube_;
  Index line_ = 0, factor_ = 0, row_ = 0;
};

}  // namespace

LineForm OutputTube::at(VectorIn u) const {
  return {M, G, c + linalg::product(H, u), S, A, b + linalg::product(Omega, u)};
}

OutputTube output_tube(const TimedModel& model, const SetBackend& backend, const TubeSpan& span) {
  if (span.horizon < 0) throw Error(Errc::invalid, "the horizon of a tube is negative");
  return TubeBuilder(model, backend, span).build();
}

Vector TubeConditions::terms(VectorIn reach) const {
  const Vector seen =
      b.cwiseAbs() + A.cwiseAbs().rowwise().sum() + linalg::product(Omega.cwiseAbs(), reach);
  if (Omega_magnitude.size() == 0) return seen.cwiseMax(magnitude);
  return seen.cwiseMax(linalg::product(Omega_magnitude, reach) + magnitude);
}

TubeConditions conditions_of(const OutputTube& tube) {
  Matrix columns(tube.b.size(), tube.A.cols() + tube.inputs());
  columns << tube.A, -tube.Omega;
  const Index all = columns.cols();
  const LinesEliminated rest = eliminate_lines_traced(
      {Matrix(0, tube.S.cols()), Matrix(0, all), Vector(0), tube.S, std::move(columns), tube.b},
      Vector(0));
  const Matrix shares = rest.rows.cwiseAbs();
  const TermsOfLines of_lines(tube.S, rest, tube.inputs());
  return {rest.set.A.leftCols(tube.A.cols()),
          -rest.set.A.rightCols(tube.inputs()),
          rest.set.b,
          linalg::product(shares, tube.b_size + tube.A.cwiseAbs().rowwise().sum() + of_lines.terms),
          linalg::product(shares, tube.Omega.cwiseAbs() + of_lines.input_terms),
          rest.follow && tube.is_exact ? 0 : rest.vanished};
}

}  // namespace cordon
