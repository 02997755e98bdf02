// SPDX-License-Identifier: GPL-3.0-or-later
// Models of published examples, and the plugins of this build.
#pragma once

#include "cordon/registry/registry.hpp"

inline cordon::Box cube(cordon::Index n, double radius) {
  return {cordon::Vector::Constant(n, -radius), cordon::Vector::Constant(n, radius)};
}

/// The descriptor system of [Rego2025, sec. 6.1]; X0 is the whole space.
inline cordon::Model descriptor_example() {
  using namespace cordon;
  Model model;
  LinearModel& m = model.linear;
  m.E = Matrix{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  m.A = Matrix{{.5, 0, .5}, {.8, .95, 0}, {-1, .5, 1}};
  m.B = Matrix{{1, 0}, {0, 1}, {0, 0}};
  m.Bw = Matrix{{.1, 0, 0}, {0, 1.5, 0}, {0, 0, .6}};
  m.C = Matrix{{1, 0, 1}, {1, -1, 0}};
  m.D = Matrix::Zero(2, 2);
  m.Dv = Matrix{{.5, 0}, {0, 1.5}};
  model.X0 = make_space(3);
  model.W = make_box(cube(3, 1));
  model.V = make_box(cube(2, 1));
  return model;
}

/// X0 of (38).
inline cordon::LineForm bounded_start() {
  using namespace cordon;
  return make_zonotope(Vector{{.5, .5, .25}}, Matrix{{.1, 0, 0}, {0, 1.5, 0}, {0, 0, .6}});
}

/// A registry with the plugins of this build, and nothing else.
class Plugins {
 public:
  Plugins() {
    registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  }

  std::shared_ptr<const cordon::SetBackend> backend(const std::string& name,
                                                    cordon::Params params = {}) const {
    return registry.make<cordon::BackendEntry>(
        name, complete(registry.info("backend", name), std::move(params)));
  }
  std::shared_ptr<cordon::Observer> observer(const std::string& name, const cordon::Model& model,
                                             std::shared_ptr<const cordon::SetBackend> backend,
                                             cordon::Params params = {}) const {
    return registry.make<cordon::ObserverEntry>(
        name, {model, std::move(backend)},
        complete(registry.info("observer", name), std::move(params)));
  }

  cordon::Registry registry;

 private:
  static cordon::Params complete(const cordon::ComponentInfo* info, cordon::Params params) {
    if (!info) throw cordon::Error(cordon::Errc::plugin, "component missing");
    const auto problems = info->schema.complete(params);
    if (!problems.empty()) throw cordon::InputError("parameters", problems);
    return params;
  }
};
