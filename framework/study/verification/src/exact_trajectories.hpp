// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "cordon/interfaces/model.hpp"

namespace cordon::verification {

/// The states that explain samples, by exact polytopes, where these do: of linear models without
/// intervals, up to n = 4, as long as numbers and time allow.
class ExactTrajectories {
 public:
  ExactTrajectories(const Model& model, const LineForm& start,
                    const std::optional<LineForm>& admissible);
  ~ExactTrajectories();
  ExactTrajectories(ExactTrajectories&&) noexcept;

  using Deadline = std::optional<std::chrono::steady_clock::time_point>;
  /// The hull of the last states: none where it is not known. `samples`: those of before, and more.
  std::optional<Box> hull(const std::vector<Sample>& samples, const Deadline& deadline) {
    return hull(whole_.get(), samples, deadline);
  }
  /// The same with all sets a millionth smaller about their centres: what lies in it is no matter
  /// of rounding.
  std::optional<Box> inner_hull(const std::vector<Sample>& samples, const Deadline& deadline) {
    return hull(smaller_.get(), samples, deadline);
  }

 private:
  struct Sequence;
  static std::optional<Box> hull(Sequence* of, const std::vector<Sample>& samples,
                                 const Deadline& deadline);

  std::unique_ptr<Sequence> whole_, smaller_;
};

}  // namespace cordon::verification
