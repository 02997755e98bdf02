// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/same_study.hpp"

#include <algorithm>
#include <fstream>

#include <doctest/doctest.h>

#include "run/scratch.hpp"
#include "study/fakes.hpp"

using namespace cordon;

namespace study_test {

namespace {

bool same(const Matrix& A, const Matrix& B) {
  return A.rows() == B.rows() && A.cols() == B.cols() && A == B;
}

bool same(const LineForm& a, const LineForm& b) {
  return a.M == b.M && a.G == b.G && a.c == b.c && a.S == b.S && a.A == b.A && a.b == b.b;
}

bool same(const Box& a, const Box& b) { return a.lower == b.lower && a.upper == b.upper; }

bool same(const Model& a, const Model& b) {
  const LinearModel &p = a.linear, &q = b.linear;
  using Part = Matrix LinearModel::*;
  for (const Part part :
       {&LinearModel::E, &LinearModel::A, &LinearModel::B, &LinearModel::Bw, &LinearModel::C,
        &LinearModel::D, &LinearModel::Dv, &LinearModel::A_radius, &LinearModel::B_radius,
        &LinearModel::C_radius, &LinearModel::F}) {
    if (!same(p.*part, q.*part)) return false;
  }
  return same(a.X0, b.X0) && same(a.W, b.W) && same(a.V, b.V) && same(a.U, b.U) &&
         same(p.actuator, q.actuator) && same(p.sensor, q.sensor);
}

bool same(const ComponentSpec& a, const ComponentSpec& b) {
  if (a.type != b.type || a.params.values().size() != b.params.values().size()) return false;
  for (const auto& [name, value] : a.params.values()) {
    const auto other = b.params.values().find(name);
    if (other == b.params.values().end() || value.index() != other->second.index()) return false;
    const auto equal = [&](const auto& x) {
      const auto& y = std::get<std::decay_t<decltype(x)>>(other->second);
      if constexpr (std::is_same_v<std::decay_t<decltype(x)>, LineForm>) {
        return same(x, y);
      } else if constexpr (std::is_same_v<std::decay_t<decltype(x)>,
                                          std::shared_ptr<const ComponentSpec>>) {
        return same(*x, *y);
      } else {
        return x == y;
      }
    };
    if (!std::visit(equal, value)) return false;
  }
  return true;
}

bool same(const Signal& a, const Signal& b) {
  return a.type == b.type && a.offset == b.offset && a.amplitude == b.amplitude &&
         a.omega == b.omega && a.phase == b.phase && a.from == b.from && a.period == b.period &&
         a.seed == b.seed && a.values == b.values;
}

bool same(const FaultSpec& a, const FaultSpec& b) {
  return a.from == b.from && a.to == b.to && a.name == b.name && a.mode == b.mode &&
         same(a.model, b.model) && same(a.actuator, b.actuator) && same(a.sensor, b.sensor);
}

bool same(const AdditiveFaultSpec& a, const AdditiveFaultSpec& b) {
  return a.fault == b.fault && a.from == b.from && a.to == b.to && same(a.signal, b.signal);
}

bool same(const std::optional<ComponentSpec>& a, const std::optional<ComponentSpec>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

}  // namespace

bool same(const Study& a, const Study& b) {
  const auto axes = [](const SweepAxis& p, const SweepAxis& q) {
    return p.name == q.name && p.path == q.path && p.values == q.values && p.repeat == q.repeat;
  };
  if (!std::equal(a.sweep.begin(), a.sweep.end(), b.sweep.begin(), b.sweep.end(), axes))
    return false;
  const auto modes = [](const Mode& p, const Mode& q) {
    return p.name == q.name && same(p.model, q.model);
  };
  if (a.nominal != b.nominal ||
      !std::equal(a.modes.begin(), a.modes.end(), b.modes.begin(), b.modes.end(), modes))
    return false;
  if (a.title != b.title || !same(a.model, b.model) || a.data.index() != b.data.index())
    return false;
  if (const auto* s = std::get_if<SimulateSpec>(&a.data)) {
    const auto& t = std::get<SimulateSpec>(b.data);
    if (s->steps != t.steps || s->seed != t.seed || s->noise != t.noise || s->x0 != t.x0)
      return false;
    if (s->parameters != t.parameters || s->x0_set.has_value() != t.x0_set.has_value())
      return false;
    if (s->x0_set && !same(*s->x0_set, *t.x0_set)) return false;
    if (!std::equal(s->additive_faults.begin(), s->additive_faults.end(), t.additive_faults.begin(),
                    t.additive_faults.end(), [](auto& x, auto& y) { return same(x, y); }))
      return false;
    if (s->seeds != t.seeds || !same(s->plant, t.plant) || !s->made_plant != !t.made_plant)
      return false;
    if (!std::equal(s->faults.begin(), s->faults.end(), t.faults.begin(), t.faults.end(),
                    [](auto& x, auto& y) { return same(x, y); }))
      return false;
    if (!std::equal(s->input.begin(), s->input.end(), t.input.begin(), t.input.end(),
                    [](auto& x, auto& y) { return same(x, y); }))
      return false;
  } else {
    const auto &c = std::get<CsvSpec>(a.data), &d = std::get<CsvSpec>(b.data);
    if (c.file != d.file || c.inputs != d.inputs || c.outputs != d.outputs || c.truth != d.truth ||
        c.mode != d.mode)
      return false;
  }
  const auto pipelines = [](const PipelineSpec& p, const PipelineSpec& q) {
    const auto mine = algorithms_of(p), others = algorithms_of(q);
    return p.name == q.name && same(p.backend, q.backend) &&
           std::equal(mine.begin(), mine.end(), others.begin(), others.end(),
                      [](const auto& x, const auto& y) {
                        return x.first == y.first && same(*x.second, *y.second);
                      });
  };
  return std::equal(a.pipelines.begin(), a.pipelines.end(), b.pipelines.begin(), b.pipelines.end(),
                    pipelines) &&
         std::equal(a.metrics.begin(), a.metrics.end(), b.metrics.begin(), b.metrics.end(),
                    [](auto& x, auto& y) { return same(x, y); });
}

Study read_file(const std::filesystem::path& file) {
  Registry registry;
  registry.add(register_fakes);
  return read_study(file, registry, SearchPath{}, StudyPlugins::load);
}

void expect_round_trip(const Study& study, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "resolved_again.json";
  std::ofstream(file, std::ios::binary) << study.resolved;
  const Study again = read_file(file);
  CHECK(same(study, again));
  CHECK(study.resolved == again.resolved);
  std::filesystem::remove(file);
}

void expect_round_trip(const Study& study) {
  const Scratch scratch;
  expect_round_trip(study, scratch.path());
}

}  // namespace study_test
