// SPDX-License-Identifier: GPL-3.0-or-later
#include "read_continuous.hpp"

#include "study/text/numbers.hpp"

namespace cordon::json {

namespace {

using sampling::DisturbanceSignal;
using sampling::Sampling;

const char* const write_sampled =
    "write the model from sample to sample instead, without \"continuous\"";

void refuse(const Cursor& at, const ContinuousPart& part, const Error& why,
            const std::string& suggestion) {
  at.error("cannot be sampled every " + detail::to_text(part.time) + " s: " + why.what(),
           suggestion);
}

/// Reports what cannot be sampled.
bool can_sample(const Cursor& system, const ContinuousPart& part, bool exact, const Model& model) {
  const LinearModel& linear = model.linear;
  const std::size_t before = system.problems().met();
  if (linear.is_descriptor()) {
    system.find("type")->error("a descriptor system is not sampled", write_sampled);
    return false;
  }
  if (linear.states() > sampling::max_states) {
    system.find("A")->error("has " + counted(linear.states(), "state") + ", a system of at most " +
                                std::to_string(sampling::max_states) + " is sampled",
                            write_sampled);
  }
  if (linear.faults() > 0 && !exact) {
    system.find("F")->error("cannot be sampled with an A that is known by an interval",
                            "F is exact from sample to sample: " + std::string(write_sampled));
  }
  if (model.W.lines() > 0 && (part.disturbance == DisturbanceSignal::any || !exact)) {
    system.find("W")->error(
        "must be bounded: what of an unbounded disturbance is left from sample to sample is no "
        "subspace that is known in advance",
        exact ? "bound it, or write \"disturbance\": \"held\"" : "bound it");
  }
  return system.problems().met() == before;
}

}  // namespace

const std::vector<std::string>& disturbance_signal_names() {
  static const std::vector<std::string> names{"any", "held"};
  return names;
}

std::shared_ptr<const ContinuousPart> read_continuous(const Cursor& system) {
  const std::size_t before = system.problems().met();
  const auto at = system.find("continuous"), disturbance = system.find("disturbance");
  ContinuousPart part;
  if (disturbance) {
    const auto name = read_choice(*disturbance, disturbance_signal_names());
    if (name && *name == "held") part.disturbance = DisturbanceSignal::held;
  }
  const bool continuous =
      at && at->expect(Value::Kind::boolean, "true or false") && at->value().flag;
  if (disturbance && !continuous && system.problems().met() == before) {
    disturbance->error("belongs to systems in continuous time",
                       "write \"continuous\": true, or remove it: w is constant from k to k + 1");
  }
  if (!continuous) return nullptr;
  const auto time = system.find("sampling_time");
  if (!time) {
    at->error("needs a \"sampling_time\"",
              "give the seconds from sample to sample, in the unit of "
              "time of A");
  }
  const auto seconds = time && time->is(Value::Kind::number) ? time->value().number : 0;
  if (!(seconds > 0) || system.problems().met() != before) return nullptr;
  part.time = seconds;
  return std::make_shared<const ContinuousPart>(std::move(part));
}

std::shared_ptr<const ContinuousPart> sample(const Cursor& system, const ContinuousPart& part,
                                             sampling::Matrices matrices, Model& model,
                                             std::vector<std::string>& warnings) {
  const bool exact = matrices == sampling::Matrices::doubles && !model.linear.is_uncertain();
  if (!can_sample(system, part, exact, model)) return nullptr;
  try {
    auto made = std::make_shared<ContinuousPart>(part);
    made->sampling =
        std::make_shared<const Sampling>(model.linear, part.time, part.disturbance, matrices);
    made->Bw = model.linear.Bw;
    if (!made->sampling->is_fine(made->Bw, model.W)) {
      warnings.push_back(system.pointer() + " (line " + std::to_string(system.value().line) +
                         "): the state turns or decays so often within a sampling time that the "
                         "set of what w does to it is enclosed by one that may be nearly twice as "
                         "wide; sample more often");
    }
    model = sampling::sampled(model, *made->sampling);
    return made;
  } catch (const Error& e) {
    refuse(*system.find("A"), part, e,
           "is A in 1/s? choose other units or a shorter \"sampling_time\"");
    return nullptr;
  }
}

bool sample(const Cursor& additive, const ContinuousPart& part, Additive& fault) {
  if (!fault.F) return true;
  if (part.sampling->keeps_matrices()) {
    try {
      fault.F = part.sampling->nearest_integral(*fault.F);
      return true;
    } catch (const Error& e) {
      refuse(*additive.find("F"), part, e, "choose other units");
      return false;
    }
  }
  if (fault.Fy) {
    additive.error("holds F and Fy, and its f is not the same set in both from sample to sample",
                   part.sampling->encloses_matrices()
                       ? "write a mode each for F and for Fy"
                       : "write \"disturbance\": \"held\", or a mode each for F and for Fy");
    return false;
  }
  const auto f = sample(*additive.find("f"), part, *fault.F, fault.f);
  if (!f) return false;
  fault.F = Matrix::Identity(fault.F->rows(), fault.F->rows());
  fault.f = *f;
  return true;
}

std::optional<LineForm> sample(const Cursor& at, const ContinuousPart& part, const Matrix& B,
                               const LineForm& W) {
  try {
    if (W.lines() == 0) return part.sampling->disturbances(B, W);
  } catch (const Error& e) {
    refuse(at, part, e, "choose other units");
    return std::nullopt;
  }
  at.error(
      "must be bounded: what of an unbounded signal is left from sample to sample is no "
      "subspace that is known in advance",
      "bound it");
  return std::nullopt;
}

}  // namespace cordon::json
