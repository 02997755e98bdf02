// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>
#include <cstdio>

#include "input_design/plugins.hpp"
#include "designers/tube/separation.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using namespace cordon::designers;

TEST_CASE("proto") {
  auto backend = examples::backend("line_zonotope");
  const ModeBank bank = examples::four_descriptor_models();
  std::vector<OutputTube> tubes;
  for (const Mode& mode : bank.modes) tubes.push_back(output_tube(mode.model, *backend, {3}));
  for (auto& t : tubes) std::printf("rows %ld lines %ld g %ld cond %ld\n", t.b.size(), t.S.cols(), t.A.cols(), conditions_of(t).b.size());
  const auto pairs = pair_programs(tubes);
  for (const Vector& u : {examples::published_line_input(), examples::published_constrained_input(), examples::reference_input()}) {
    for (const PairProgram& pair : pairs) {
      const PairSeparation s = separation(pair, u);
      std::printf("%ld%ld rows %ld g %ld kappa %.10f lower %.10f %s\n", s.i, s.j, pair.rows(), pair.G.cols(), s.kappa, s.kappa_lower,
                  std::string(to_string(s.disjoint)).c_str());
    }
  }
}
