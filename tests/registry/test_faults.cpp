// SPDX-License-Identifier: GPL-3.0-or-later
// A plugin that loads, but whose components cannot be made: each fails in its own way.
#include <stdexcept>

#include "cordon/registry/plugin.hpp"

namespace {

using namespace cordon;

/// A type whose code is in this library alone.
class OwnException final : public std::exception {
 public:
  const char* what() const noexcept override { return "an exception of the plugin's own"; }
};

using Make = std::unique_ptr<Metric> (*)(const Params&);

void register_components(Registrar& registrar) {
  const auto metric = [&](const char* name, Make make) {
    registrar.add(MetricEntry{{name, "never works", "", {}}, make});
  };
  metric("throws_own", [](const Params&) -> std::unique_ptr<Metric> { throw OwnException(); });
  metric("throws_int", [](const Params&) -> std::unique_ptr<Metric> { throw 7; });
  metric("throws_error", [](const Params&) -> std::unique_ptr<Metric> {
    throw Error(Errc::unsupported, "cannot enclose");
  });
  metric("throws_input_error", [](const Params&) -> std::unique_ptr<Metric> {
    throw InputError("study.json", {{"/a", "is wrong", "repair it"}});
  });
  metric("returns_nothing", [](const Params&) -> std::unique_ptr<Metric> { return nullptr; });
}

}  // namespace

CORDON_PLUGIN("test_faults", "0.1.0", "GPL-3.0-or-later", "The Cordon authors",
              "failures for tests", register_components)
