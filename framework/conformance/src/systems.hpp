// SPDX-License-Identifier: GPL-3.0-or-later
// Random systems with data that they have made: what laws about observers, diagnosers, designers
// and gains are tried on.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cordon/interfaces/model.hpp"
#include "law.hpp"

namespace cordon::conformance {

/// What the systems of a law may be.
struct SystemShape {
  Index modes = 1;
  Index inputs = 1, outputs = 2, disturbances = 2;  ///< at most
  Index samples = 6;
  bool uncertain = false, descriptor = false;  ///< now and then with A_radius, or with E
  bool nonlinear = false;    ///< now and then with Q: x⁺ = A x + Q (x_j²)_j + …
  bool faults = false;       ///< with F
  bool uncontrolled = true;  ///< may have no input
};

/// A case: sets X0, W, V; the inputs u, a column per time; A, B, Bw, C, D, Dv of every mode; E,
/// A_radius and F where there are any. In cases of style `full` all numbers are random and noise
/// acts on every state and output; all others have few binary digits, so that data of some steps
/// are exact, and are scaled by powers of two where the style says so.
TestCase system_case(const Setting& s, const SystemShape& shape);

Index modes_of(const TestCase& test);
Model model_of(const TestCase& test, Index mode = 0);
/// The same model as formulas, with square terms if there are any.
Model with_formulas(const Model& model, const Matrix* Q);
/// Modes "m1", "m2", …; the first is the nominal one.
ModeBank bank_of(const TestCase& test);
/// The matrix of that name; null if the case has none.
const Matrix* matrix_of(const TestCase& test, const std::string& name);

/// How w, v and the first state are drawn from their sets.
enum class Noise { vertices, uniform, zero };
inline Noise noise_of(const TestCase& test) { return static_cast<Noise>(test.seed % 3); }

struct Trajectory {
  std::vector<Sample> samples;  ///< from `first` on
  std::vector<Vector> states;   ///< of the same times
  std::vector<Index> mode;      ///< that the step from each time on, and its output, are of
  bool exact = true;            ///< no number was rounded: the data are those of the plant
  /// Noise has room in every state and output: rounding errors of data are within W and V.
  bool fat = true;
  /// Are data what the model allows, up to what noise has room for?
  bool is_consistent() const { return exact || fat; }
};

struct Course {
  std::uint64_t seed = 0;         ///< of the noise
  Index first = 0;                ///< time of the first sample
  std::vector<Index> modes = {};  ///< of every time; empty: mode 0
  Vector fault = {};              ///< n of all times; empty: 0
  bool gaps = false;              ///< outputs are missing now and then
};
/// What the plant does. Nothing where a shrunk case has no such trajectory.
std::optional<Trajectory> simulate(const TestCase& test, const Course& course);

/// As text, for witnesses: y, and the true states.
std::vector<std::pair<std::string, std::string>> described(const Trajectory& data);

/// Sums and products that know whether one of them was rounded.
class ExactSums {
 public:
  Vector product(const Matrix& A, const Vector& x);
  Vector sum(const Vector& x, const Vector& y);
  Vector squares(const Vector& x);
  bool exact() const { return exact_; }

 private:
  double plus(double a, double b);
  double times(double a, double b);
  bool exact_ = true;
};

}  // namespace cordon::conformance
