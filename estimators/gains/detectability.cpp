// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/detectability.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/exact_modes.hpp"

namespace cordon::estimators {

namespace {

constexpr double tolerance = 1e-10;
constexpr double cleaned =
    1e-9;  // entries of a direction below this share of the largest are noise
constexpr double row_tolerance = 1e-8;     // above what cleaning can leave in a row
constexpr double rounded_one = 1 - 1e-12;  // 1, up to the rounding of eigenvalues

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x == 0 ? 0.0 : x);
  return text;
}

std::string number(std::complex<double> z) {
  if (z.imag() == 0) return number(z.real());
  return number(z.real()) + (z.imag() < 0 ? " - " : " + ") + number(std::abs(z.imag())) + "i";
}

/// v with its largest entry scaled to 1 and noise beside it removed.
std::string direction(Eigen::VectorXcd v) {
  Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  v /= std::complex<double>(v[largest]);
  std::string text = "(";
  for (Index i = 0; i < v.size(); ++i) {
    const auto clean = [](double x) { return std::abs(x) < 1e-9 ? 0.0 : x; };
    text += (i ? ", " : "") + number({clean(v[i].real()), clean(v[i].imag())});
  }
  return text + ")";
}

/// v ≠ 0 with A v = λ v and C v = 0, or nothing. [X -Y; Y X] stands for the complex matrix X + iY.
std::optional<Eigen::VectorXcd> hidden(const Matrix& A, const Matrix& C,
                                       std::complex<double> lambda) {
  const Index n = A.rows(), p = C.rows();
  const auto scaled = [](const Matrix& M) {
    const double size = M.size() == 0 ? 0.0 : M.cwiseAbs().maxCoeff();
    return size > 0 ? Matrix(M / size) : M;
  };
  const double size = std::max(std::abs(lambda), A.cwiseAbs().maxCoeff());
  const Matrix X = size > 0 ? Matrix((lambda.real() * Matrix::Identity(n, n) - A) / size)
                            : Matrix(Matrix::Zero(n, n));
  const Matrix Y =
      size > 0 ? Matrix(lambda.imag() / size * Matrix::Identity(n, n)) : Matrix(Matrix::Zero(n, n));
  const Matrix outputs = scaled(C), none = Matrix::Zero(p, n);
  Matrix M(2 * (n + p), 2 * n);
  M << X, -Y, Y, X, outputs, none, none, outputs;
  const linalg::Svd svd = linalg::svd(M);
  if (svd.sigma[2 * n - 1] > tolerance * svd.sigma[0]) return std::nullopt;
  const Vector v = svd.V.col(2 * n - 1);
  Eigen::VectorXcd found(n);
  for (Index i = 0; i < n; ++i) found[i] = {v[i], v[n + i]};
  const double largest = found.cwiseAbs().maxCoeff();
  found = (found.array().abs() <= cleaned * largest).select(0.0, found);
  // Small against the largest entry is not enough: every row must cancel against its own terms.
  const Vector entries = found.cwiseAbs(),
               shown = (C.cast<std::complex<double>>() * found).cwiseAbs();
  const Vector moved = (A.cast<std::complex<double>>() * found - lambda * found).cwiseAbs();
  const bool silent = (shown.array() <= row_tolerance * (C.cwiseAbs() * entries).array()).all();
  const bool stays = (moved.array() <=
                      row_tolerance * (A.cwiseAbs() * entries + std::abs(lambda) * entries).array())
                         .all();
  return silent && stays ? std::optional(found) : std::nullopt;
}

/// In words, but for how it shows: "the mode 1.2 of A, along (0, 1)".
std::optional<std::string> hidden_mode(const Matrix& A, const Matrix& C, double least_modulus) {
  if (A.rows() == 0) return std::nullopt;
  const Eigen::VectorXcd values = linalg::eigenvalues(A);
  for (const std::complex<double>& value : values) {
    if (std::abs(value) < least_modulus || value.imag() < 0) continue;  // of a pair the upper one
    if (const auto v = hidden(A, C, value))
      return "the mode " + number(value) + " of A, along " + direction(*v) + ",";
  }
  return std::nullopt;
}

/// Named is the mode of the largest modulus in the part that is proven to be hidden, not one that
/// nearly is.
Obstacle proven(const exact::HiddenModes& modes) {
  const std::string hides = " does not show in the outputs";
  if (!modes.map.allFinite() || !modes.basis.allFinite())
    return {Answer::no, "a mode of A" + hides};
  std::complex<double> largest = 0;
  for (const std::complex<double>& value : linalg::eigenvalues(modes.map)) {
    if (value.imag() >= 0 && std::abs(value) >= std::abs(largest)) largest = value;
  }
  const std::string name = "the mode " + number(largest) + " of A";
  const auto inside = hidden(modes.map, Matrix(0, modes.count), largest);
  if (!inside) return {Answer::no, name + hides};
  return {Answer::no, name + ", along " +
                          direction(modes.basis.cast<std::complex<double>>() * *inside) + "," +
                          hides};
}
Obstacle nearly(std::string mode) {
  return {Answer::unknown, std::move(mode) + " hardly shows in the outputs"};
}

/// Nothing for a system that is too large.
std::optional<exact::HiddenModes> exactly_hidden(const Matrix& A, const Matrix& C, double rate) {
  try {
    return exact::hidden_modes(A, C, rate);
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    return std::nullopt;
  }
}

}  // namespace

std::optional<Obstacle> undetectable_mode(const Matrix& A, const Matrix& C, double rate) {
  std::optional<std::string> mode = hidden_mode(A, C, std::sqrt(rate) * rounded_one);
  if (!mode) return std::nullopt;
  // |λ|² ≥ the next double above a rate is > rate; a mode on the unit circle itself is no longer
  // detectable
  const double above = rate == 1 ? rate : std::nextafter(rate, 2 * rate);
  const std::optional<exact::HiddenModes> modes = exactly_hidden(A, C, above);
  if (!modes) return nearly(std::move(*mode));
  if (!modes->decay) return proven(*modes);
  if (modes->count > 0) return std::nullopt;
  return nearly(std::move(*mode));
}

std::string not_detectable(const Obstacle& hidden) {
  const bool is_proven = hidden.gain_exists == Answer::no;
  return std::string(is_proven ? "no gain exists, the pair (A, C) is not detectable: "
                               : "no gain was sought, the pair (A, C) is hardly detectable: ") +
         hidden.reason;
}

std::optional<Obstacle> unobservable_mode(const Matrix& A, const Matrix& C) {
  std::optional<std::string> mode = hidden_mode(A, C, 0);
  if (!mode) return std::nullopt;
  const std::optional<exact::HiddenModes> modes = exactly_hidden(A, C, 1);
  return modes && modes->count > 0 ? proven(*modes) : nearly(std::move(*mode));
}

}  // namespace cordon::estimators
