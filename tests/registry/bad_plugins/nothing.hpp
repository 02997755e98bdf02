// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/registry/plugin.hpp"

/// A metric without values: something to register.
class Nothing final : public cordon::Metric {
  std::vector<cordon::MetricValue> do_step(const cordon::StepView&) override { return {}; }
  std::vector<cordon::MetricValue> do_summary() const override { return {}; }
};

inline cordon::MetricEntry nothing(const char* name, cordon::ParamSchema schema = {},
                                   const char* summary = "nothing") {
  return {{name, summary, "", std::move(schema)},
          [](const cordon::Params&) { return std::make_unique<Nothing>(); }};
}
