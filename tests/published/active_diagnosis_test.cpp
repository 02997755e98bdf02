// SPDX-License-Identifier: GPL-3.0-or-later
// Table 2 of [Rego2025, sec. 6.2]: 500 runs of every model, and how many of them lie in the output
// tubes of which models. The diagonal and the zeros are facts about the tubes; the other entries
// depend on how the authors drew the disturbances.
#include <doctest/doctest.h>

#include "diagnosers/tube_membership/membership.hpp"
#include "diagnosis/four_models.hpp"

using namespace cordon;
using namespace diagnosis_test;

namespace {

constexpr std::uint64_t runs = 500;

using Table = std::array<std::array<int, 4>, 4>;

Vector stacked(const std::vector<Vector>& parts) {
  Vector all(0);
  for (const Vector& part : parts) {
    all.conservativeResize(all.size() + part.size());
    all.tail(part.size()) = part;
  }
  return all;
}

/// Row i: of how many runs of model i it is not proven that they lie outside the tube of model j.
Table table(const std::vector<Vector>& inputs, std::uint64_t first_seed, bool vertex) {
  static const Plugins plugins;
  const auto backend = plugins.backend("line_zonotope");
  const ModeBank bank = four_models();
  std::vector<OutputTube> tubes;
  for (const Mode& mode : bank.modes) tubes.push_back(output_tube(mode.model, *backend, {3}));
  const Vector u = stacked(inputs);
  Table counts{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::uint64_t seed = first_seed; seed < first_seed + runs; ++seed) {
      std::vector<Vector> outputs;
      for (const Simulated& now : simulate(bank.modes[i].model, inputs, seed, vertex))
        outputs.push_back(now.sample.y);
      const Vector y = stacked(outputs);
      for (std::size_t j = 0; j < 4; ++j)
        counts[i][j] += diagnosers::membership(tubes[j], u, y) != Answer::no;
    }
  }
  return counts;
}

}  // namespace

TEST_CASE("Table 2, input by line zonotopes: 500 on the diagonal, 0 elsewhere") {
  for (std::uint64_t block = 0; block < 10; ++block) {
    CAPTURE(block);
    const Table found = table(separating_input(), 1 + block * runs, block % 2 == 1);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) CHECK(found[i][j] == (i == j ? 500 : 0));
    }
  }
}

TEST_CASE(
    "Table 2, input by constrained zonotopes: the published zeros, and many runs of models 1, 3 "
    "and 4 in each other's tubes") {
  const std::vector<Vector> published{Vector{{.5, -1}}, Vector{{2.9286, -1}}, Vector{{3.1628, -1}},
                                      Vector{{.5, -1}}};
  const Table found = table(published, 1, false);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      CAPTURE(i);
      CAPTURE(j);
      if (i == j) {
        CHECK(found[i][j] == 500);
      } else if (i == 1 || j == 1) {
        CHECK(found[i][j] == 0);
      } else {
        CHECK(found[i][j] > 50);  // 98 to 483 in the paper
        CHECK(found[i][j] < 500);
      }
    }
  }
}

TEST_CASE("The reference input, Table 1: every model can show what any other shows") {
  const Table found = table(reference_input(), 1, false);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      CAPTURE(i);
      CAPTURE(j);
      CHECK((i == j ? found[i][j] == 500 : found[i][j] > 10));
    }
  }
}
