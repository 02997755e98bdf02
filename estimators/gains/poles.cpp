// SPDX-License-Identifier: GPL-3.0-or-later
// The gain that puts the eigenvalues of A - L C̄ where they are asked for.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <map>

#include "components.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/exact_modes.hpp"
#include "gains/detectability.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/pole_placement.hpp"
#include "gains/theta.hpp"

namespace cordon::estimators {

namespace {

constexpr double pole_tolerance = 1e-8;

constexpr const char* poles_details =
    "The eigenvalues of A - L C are put at the given poles, to 1e-8. For one output L is unique; "
    "for several, eigenvectors are\n"
    "chosen as perpendicular to each other as the outputs allow, so that the poles move least with "
    "A. Every mode of A must show "
    "in\n"
    "the outputs, and a pole may be asked for as often as the rank of C. For observers that "
    "correct "
    "a predicted set C A\n"
    "stands for C.";

struct Pole {
  double real = 0, imaginary = 0;
  auto operator<=>(const Pole&) const = default;
};

std::vector<Pole> poles_from(const Params& params) {
  const Vector& real = params.vector("poles");
  std::vector<Pole> poles;
  for (Index i = 0; i < real.size(); ++i) {
    poles.push_back({real[i] + 0.0, params.has("poles_imaginary")
                                        ? params.vector("poles_imaginary")[i] + 0.0
                                        : 0.0});
  }
  return poles;
}

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", x);
  return buffer;
}

std::string text(const Pole& pole) {
  if (pole.imaginary == 0) return text(pole.real);
  return text(pole.real) + (pole.imaginary < 0 ? " - " : " + ") + text(std::abs(pole.imaginary)) +
         "i";
}

std::map<Pole, Index> counted(const std::vector<Pole>& poles) {
  std::map<Pole, Index> counts;
  for (const Pole& pole : poles) ++counts[pole];
  return counts;
}

class Poles final : public FormedDesigner {
 public:
  explicit Poles(std::vector<Pole> poles) : poles_(std::move(poles)) {}

 private:
  GainDesign do_design(const Model& model, GainForm form) const override {
    const Matrix& A = model.linear.A;
    const Matrix C = shown_errors(model.linear, form).value;
    if (static_cast<Index>(poles_.size()) != model.linear.states()) {
      return {Answer::no,
              {},
              "there must be as many poles as states",
              "give the real part of every pole"};
    }
    const Matrix shown = shown_outputs(model.linear);
    if (const auto hidden = unobservable_mode(A, shown)) {
      const std::string what =
          hidden->gain_exists == Answer::no ? " is not observable: " : " is hardly observable: ";
      return {hidden->gain_exists,
              {},
              "the pair (A, C)" + what + hidden->reason,
              "use \"kalman\", which leaves such modes"};
    }
    if (form == GainForm::filter && unobservable_mode(A, C)) {
      return {Answer::unknown,
              {},
              "the pair (A, C A) is not observable: modes of A that decay at once keep their "
              "eigenvalue 0",
              "use \"kalman\", which leaves such modes"};
    }
    const Index rank = exact::rank(form == GainForm::filter ? C : shown);
    for (const auto& [pole, count] : counted(poles_)) {
      if (count <= rank) continue;
      return {Answer::no,
              {},
              "the pole " + text(pole) + " is asked for " + std::to_string(count) +
                  " times, the outputs have rank " + std::to_string(rank) + ": " +
                  name_of_loop(form) + " would have no basis of eigenvectors",
              "ask for different poles"};
    }
    std::vector<std::complex<double>> values;
    for (const Pole& pole : poles_) values.emplace_back(pole.real, pole.imaginary);
    std::optional<PlacedPoles> placed = placed_poles(A, C, values);
    if (!placed || !(placed->error <= pole_tolerance)) {
      const std::string why =
          placed ? "they came out " + text(placed->error) + " away, more than 1e-08"
                 : "their eigenvectors are too nearly dependent";
      return {Answer::unknown,
              {},
              "the poles were not placed: " + why,
              "ask for poles further apart, or nearer to those of A"};
    }
    if (std::string problem = gain_problem(model, placed->L, form); !problem.empty()) {
      return {Answer::unknown,
              {},
              "the placed gain does not serve: " + std::move(problem),
              "ask for poles nearer to 0"};
    }
    Gain gain;
    gain.certificate = certify(model, placed->L, theta_of(model), form);
    gain.L = std::move(placed->L);
    return {Answer::yes, std::move(gain)};
  }

  std::vector<Pole> poles_;
};

std::string numbers(Index count) {
  return std::to_string(count) + (count == 1 ? " number" : " numbers");
}

std::vector<Diagnostic> check_poles(const GainContext& context, const Params& params) {
  const Index n = context.model.linear.states(), count = params.vector("poles").size();
  std::vector<Diagnostic> problems;
  if (count != n) {
    problems.push_back({"/poles",
                        "holds " + numbers(count) + ", there are " + std::to_string(n) + " states",
                        "give the real part of every pole"});
  }
  if (params.has("poles_imaginary") && params.vector("poles_imaginary").size() != count) {
    problems.push_back({"/poles_imaginary",
                        "holds " + numbers(params.vector("poles_imaginary").size()) +
                            ", poles holds " + std::to_string(count),
                        "give one for every pole, 0 for real ones"});
  }
  if (!problems.empty()) return problems;
  const std::map<Pole, Index> counts = counted(poles_from(params));
  for (const auto& [pole, times] : counts) {
    if (!(std::hypot(pole.real, pole.imaginary) < 1)) {
      problems.push_back(
          {"/poles", text(pole) + " lies outside the unit circle", "ask for stable poles"});
    }
    const auto conjugate = counts.find({pole.real, 0.0 - pole.imaginary});
    if (conjugate == counts.end() || conjugate->second != times) {
      problems.push_back(
          {"/poles_imaginary", text(pole) + " has no conjugate", "give pairs a + ib and a - ib"});
    }
  }
  return problems;
}

}  // namespace

CORDON_COMPONENT(gain, poles) {
  ParamSchema schema;
  schema
      .vector("poles",
              "eigenvalues of A - L C inside the unit circle, their real parts, one per state")
      .required();
  schema.vector("poles_imaginary", "their imaginary parts, in pairs of opposite sign; absent: 0");
  registrar.add(GainEntry{{"poles", "puts the eigenvalues of A - L C where they are asked for",
                           "Kautsky1985", std::move(schema), poles_details},
                          check_poles,
                          [](const Params& params) -> std::unique_ptr<GainDesigner> {
                            const bool same_size = !params.has("poles_imaginary") ||
                                                   params.vector("poles_imaginary").size() ==
                                                       params.vector("poles").size();
                            if (!same_size)
                              throw Error(Errc::invalid,
                                          "poles and poles_imaginary must have the same size");
                            return std::make_unique<Poles>(poles_from(params));
                          }});
}

}  // namespace cordon::estimators
