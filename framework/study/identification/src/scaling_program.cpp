// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/identification/scaling_program.hpp"

#include <numeric>
#include <optional>

#include "cordon/interfaces/descriptor_matrix.hpp"

namespace cordon::identification {

namespace {

class ProgramMaker {
 public:
  ProgramMaker(const Model& model, std::span<const Sample> samples, const Factors& factors)
      : model_(model), linear_(model.linear), samples_(samples), factors_(factors) {
    if (linear_.is_descriptor()) E_.emplace(linear_.E);
    times_ = std::ssize(samples) + (has_static_rows() ? 1 : 0);
  }

  ScalingProgram make() {
    for (Index j = 0; j < factors_.count; ++j) column(0, infinity, 1);
    states_ = columns_;
    for (Index i = 0; i < times_ * linear_.states(); ++i) column(-infinity, infinity, 0);
    write_start();
    for (Index k = 0; k < std::ssize(samples_); ++k) {
      write_outputs(samples_[as_size(k)], k);
      if (k + 1 < times_) {
        write_step(samples_[as_size(k)], k);
      } else {
        made_.step_rows.push_back(-1);
      }
    }
    finish();
    return std::move(made_);
  }

 private:
  bool has_static_rows() const { return E_ && E_->rank < linear_.states(); }
  Index state(Index k, Index i) const { return states_ + k * linear_.states() + i; }

  Index column(double lower, double upper, double cost) {
    lower_.push_back(lower);
    upper_.push_back(upper);
    cost_.push_back(cost);
    return columns_++;
  }
  Index row(double lower, double upper) {
    row_lower_.push_back(lower);
    row_upper_.push_back(upper);
    return rows_++;
  }
  void entry(Index row, Index col, double value) {
    if (value != 0) made_.program.entries.push_back({row, col, value});
  }

  /// ξ_j of generators, each within its factor or within 1.
  Index generators(const std::vector<Index>& factors) {
    const Index first = columns_;
    for (const Index factor : factors) {
      if (factor < 0) {
        column(-1, 1, 0);
        continue;
      }
      const Index xi = column(-infinity, infinity, 0);
      for (const double sign : {1.0, -1.0}) {
        const Index bound = row(-infinity, 0);
        entry(bound, xi, sign);
        entry(bound, factor, -1);
      }
    }
    return first;
  }
  void write_generators(Index at, MatrixIn G, Index i, Index first) {
    for (Index j = 0; j < G.cols(); ++j) entry(at, first + j, -G(i, j));
  }

  void write_start() {
    const LineForm& X0 = model_.X0;
    const Index first = generators(std::vector<Index>(as_size(X0.generators()), -1));
    const Index lines = columns_;
    for (Index j = 0; j < X0.lines(); ++j) column(-infinity, infinity, 0);
    for (Index i = 0; i < linear_.states(); ++i) {
      const Index at = row(X0.c[i], X0.c[i]);
      entry(at, state(0, i), 1);
      write_generators(at, X0.G, i, first);
      write_generators(at, X0.M, i, lines);
    }
  }

  void write_outputs(const Sample& sample, Index k) {
    std::vector<Index>& rows =
        made_.output_rows.emplace_back(as_size(linear_.outputs()), Index{-1});
    const std::vector<Index> present = present_outputs(sample);
    if (present.empty()) return;
    const Matrix G = linear_.Dv * model_.V.G;
    const Vector known = linear_.D * sample.u + linear_.Dv * model_.V.c;
    const Index first = generators(factors_.of_noises);
    for (const Index i : present) {
      const double left = sample.y[i] - known[i];
      const Index at = rows[as_size(i)] = row(left, left);
      for (Index j = 0; j < linear_.states(); ++j) entry(at, state(k, j), linear_.C(i, j));
      write_generators(at, -G, i, first);
    }
  }

  void write_step(const Sample& sample, Index k) {
    const Matrix G = linear_.Bw * model_.W.G;
    const Vector known = linear_.B * sample.u + linear_.Bw * model_.W.c;
    const Index first = generators(factors_.of_disturbances);
    const Index z = E_ && !E_->as_written ? write_core(k) : -1;
    made_.step_rows.push_back(rows_);
    for (Index i = 0; i < linear_.states(); ++i) {
      const Index at = row(known[i], known[i]);
      if (!E_) entry(at, state(k + 1, i), 1);
      for (Index j = 0; E_ && j < E_->left.cols(); ++j)
        entry(at, z < 0 ? state(k + 1, j) : z + j, E_->left(i, j));
      for (Index j = 0; j < linear_.states(); ++j) entry(at, state(k, j), -linear_.A(i, j));
      write_generators(at, G, i, first);
    }
  }

  /// core z = right x_{k+1}: the first column of z.
  Index write_core(Index k) {
    const Index z = columns_;
    for (Index j = 0; j < E_->rank; ++j) column(-infinity, infinity, 0);
    for (Index i = 0; i < E_->rank; ++i) {
      const Index at = row(0, 0);
      for (Index j = 0; j < E_->rank; ++j) entry(at, z + j, E_->core(i, j));
      for (Index j = 0; j < linear_.states(); ++j) entry(at, state(k + 1, j), -E_->right(i, j));
    }
    return z;
  }

  void finish() {
    const auto vector = [](const std::vector<double>& numbers) {
      return Vector(Eigen::Map<const Vector>(numbers.data(), std::ssize(numbers)));
    };
    SparseProgram& program = made_.program;
    program.cost = vector(cost_);
    program.lower = vector(lower_), program.upper = vector(upper_);
    program.row_lower = vector(row_lower_), program.row_upper = vector(row_upper_);
  }

  const Model& model_;
  const LinearModel& linear_;
  std::span<const Sample> samples_;
  const Factors& factors_;
  std::optional<DescriptorMatrix> E_;
  Index times_;  ///< of which there are states
  ScalingProgram made_;
  std::vector<double> lower_, upper_, cost_, row_lower_, row_upper_;
  Index columns_ = 0, rows_ = 0, states_ = 0;
};

}  // namespace

Factors factors_of(const Model& model, Scaled scaled) {
  const auto all = [](Index count, Index factor) {
    return std::vector<Index>(as_size(count), factor);
  };
  Factors made{all(model.W.generators(), -1), all(model.V.generators(), -1), 1};
  if (scaled == Scaled::both || scaled == Scaled::disturbances)
    made.of_disturbances.assign(made.of_disturbances.size(), 0);
  if (scaled == Scaled::both || scaled == Scaled::noises)
    made.of_noises.assign(made.of_noises.size(), 0);
  if (scaled == Scaled::each) {
    std::iota(made.of_disturbances.begin(), made.of_disturbances.end(), Index{0});
    std::iota(made.of_noises.begin(), made.of_noises.end(), model.W.generators());
    made.count = model.W.generators() + model.V.generators();
  }
  return made;
}

ScalingProgram scaling_program(const Model& model, std::span<const Sample> samples,
                               const Factors& factors) {
  return ProgramMaker(model, samples, factors).make();
}

}  // namespace cordon::identification
