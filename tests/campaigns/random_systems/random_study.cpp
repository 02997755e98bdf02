// SPDX-License-Identifier: GPL-3.0-or-later
#include "random_study.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "campaigns/draw.hpp"

namespace cordon::campaigns {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Vector& x) {
  Json list = Json::array();
  for (const double value : x) list.push_back(value);
  return list;
}

Json to_json(const Matrix& A) {
  Json rows = Json::array();
  for (Index i = 0; i < A.rows(); ++i) rows.push_back(to_json(Vector(A.row(i))));
  return rows;
}

Json box(const Vector& center, const Vector& radius) {
  return {{"type", "box"},
          {"lower", to_json(Vector(center - radius))},
          {"upper", to_json(Vector(center + radius))}};
}

/// The largest sum of magnitudes of a row bounds the spectral radius.
Matrix with_norm(Matrix A, double norm) {
  const double largest = A.rows() ? A.cwiseAbs().rowwise().sum().maxCoeff() : 0;
  return largest > 0 ? Matrix(A * (norm / largest)) : A;
}

class StudyMaker {
 public:
  StudyMaker(std::uint64_t number, Start start)
      : draw_(0x9e3779b97f4a7c15 * (number + 1)), number_(number), start_(start) {}

  Json make() {
    draw_.write_decimals(!draw_.one_in(3));
    n_ = draw_.one_in(5) ? 5 + draw_.below(2) : 1 + draw_.below(4);
    p_ = 1 + draw_.below(3);
    descriptor_ = draw_.one_in(3);
    draw_dynamics();
    draw_outputs();
    draw_units();
    Json study{{"cordon", 1}, {"title", "random system " + std::to_string(number_)}};
    study["system"] = system();
    study["data"]["simulate"] = data();
    study["pipelines"] = pipelines();
    study["metrics"] = {"contains_truth"};
    return study;
  }

 private:
  void draw_dynamics() {
    A_ = draw_.matrix(n_, n_);
    switch (draw_.below(6)) {
      case 0:
        A_ = with_norm(A_, 1.3);
        break;
      case 1:  // singular
        A_.row(draw_.below(n_)) = A_.row(0);
        A_ = with_norm(A_, 0.9);
        break;
      case 2:
        A_ = A_.triangularView<Eigen::StrictlyUpper>();
        break;
      case 3:
        if (draw_.one_in(3)) A_.setZero();
        break;
      default:
        A_ = with_norm(A_, 0.95);
    }
    B_ = draw_.matrix(n_, draw_.one_in(2) ? 0 : 1 + draw_.below(2));
    Bw_ = draw_.matrix(n_, draw_.one_in(4) ? 0 : 1 + draw_.below(n_));
    if (draw_.one_in(10)) Bw_.setZero();
    if (descriptor_) draw_E();
  }

  void draw_E() {
    const Index rank = draw_.one_in(4) ? n_ : draw_.below(n_ + 1);
    E_ = Matrix::Zero(n_, n_);
    for (Index i = 0; i < rank; ++i) E_(i, i) = 1;
    if (!draw_.one_in(2)) {  // small integers: the product is exact
      Matrix L = Matrix::Identity(n_, n_), R = L;
      for (Index i = 0; i < n_; ++i) {
        for (Index j = 0; j < i; ++j)
          L(i, j) = static_cast<double>(draw_.below(5) - 2),
               R(j, i) = static_cast<double>(draw_.below(5) - 2);
      }
      E_ = L * E_ * R;
    }
    if (draw_.one_in(3)) E_ *= 0.1;  // singular in decimals, hardly in doubles
    // static rows should determine the static states, or nothing can be simulated
    A_ += 2 * Matrix::Identity(n_, n_);
  }

  void draw_outputs() {
    C_ = draw_.matrix(p_, n_);
    if (draw_.one_in(10)) C_.setZero();
    if (p_ > 1 && draw_.one_in(4)) C_.row(1) = C_.row(0);
    D_ = draw_.one_in(2) ? Matrix(Matrix::Zero(p_, B_.cols())) : draw_.matrix(p_, B_.cols());
    V_ = Vector::Constant(p_, 0.1);
    switch (draw_.below(5)) {
      case 0:
        V_.setZero();
        break;
      case 1:
        V_[draw_.below(p_)] = 0;
        break;
      case 2:
        V_ *= 10;
        break;
      default:
        break;
    }
    without_noise_ = draw_.one_in(10);
    w_ = Vector::Constant(Bw_.cols(), draw_.one_in(8) ? 0 : 0.1);
    x0_ = Vector::Zero(n_);
    X0_ = Vector::Ones(n_);
    if (draw_.one_in(6)) X0_[draw_.below(n_)] = 0;
  }

  /// Other units of states, outputs, disturbances and equations: powers of ten or of two.
  void draw_units() {
    if (!draw_.one_in(3)) return;
    const bool tens = draw_.one_in(2);
    const auto units = [&](Index size) {
      Vector scale(size);
      for (double& s : scale)
        s = tens ? std::pow(10.0, static_cast<double>(draw_.below(13) - 6))
                 : std::ldexp(1.0, static_cast<int>(draw_.below(41)) - 20);
      return scale;
    };
    const Vector x = units(n_), y = units(p_), inverse = x.cwiseInverse();
    Vector rows = x;
    if (descriptor_) {
      rows = units(n_);
      E_ = rows.asDiagonal() * E_ * inverse.asDiagonal();
    }
    A_ = rows.asDiagonal() * A_ * inverse.asDiagonal();
    B_ = rows.asDiagonal() * B_;
    Bw_ = rows.asDiagonal() * Bw_;
    C_ = y.asDiagonal() * C_ * inverse.asDiagonal();
    D_ = y.asDiagonal() * D_;
    V_ = y.cwiseProduct(V_);
    X0_ = x.cwiseProduct(X0_);
  }

  Json system() const {
    Json system{
        {"type", descriptor_ ? "descriptor" : "lti"}, {"A", to_json(A_)}, {"C", to_json(C_)}};
    if (start_ == Start::bounded) system["X0"] = box(x0_, X0_);
    if (descriptor_) system["E"] = to_json(E_);
    if (B_.cols() > 0) system["B"] = to_json(B_), system["D"] = to_json(D_);
    system["Bw"] = to_json(Bw_);
    if (Bw_.cols() > 0) system["W"] = box(Vector::Zero(w_.size()), w_);
    if (without_noise_) {
      system["Dv"] = to_json(Matrix(p_, 0));
    } else {
      system["V"] = box(Vector::Zero(p_), V_);
    }
    return system;
  }

  Json data() {
    const std::vector<std::string> noise{"uniform", "vertex", "sine", "zero"};
    Json spec{{"steps", 10},
              {"seed", number_ + 1},
              {"noise", noise[static_cast<std::size_t>(draw_.below(4))]}};
    if (start_ == Start::unknown) {
      spec["steps"] = 3;
      spec["x0"] = box(x0_, std::pow(10.0, static_cast<double>(draw_.below(8))) * X0_);
    }
    if (start_ == Start::bounded_with_gaps) spec["dropouts"] = {{{"probability", 0.3}}};
    for (Index i = 0; i < B_.cols(); ++i) {
      spec["input"].push_back(
          {{"type", "sine"}, {"amplitude", 1.0}, {"omega", 0.3 + 0.2 * static_cast<double>(i)}});
    }
    return spec;
  }

  Json pipelines() {
    struct Choice {
      std::string type;
      Json options;
    };
    const std::vector<Choice> backends{
        {"interval", Json::object()},
        {"zonotope", Json::object()},
        {"zonotope", {{"reduction", "girard"}, {"strip", "volume"}}},
        {"zonotope", {{"reduction", "pca"}, {"strip", "bravo"}}},
        {"constrained_zonotope", Json::object()},
        {"constrained_zonotope", {{"precondition", "gauss_jordan"}, {"rescale", true}}},
        {"line_zonotope", Json::object()},
        {"line_zonotope", {{"reduction", "combastel"}, {"rescale", true}}}};
    Json list = Json::array();
    for (const Choice& choice : backends) {
      if (start_ == Start::unknown && choice.type != "line_zonotope")
        continue;  // others hold bounded sets only
      if (n_ > 4 && !choice.options.empty())
        continue;  // along directions every check is a linear program
      for (const std::string rounding : {"nominal", "outward"}) {
        Json backend{{"type", choice.type}, {"rounding", rounding}};
        backend.update(choice.options);
        for (const Json& observer : observers(choice.type)) {
          Json pipeline{
              {"name", observer["type"].get<std::string>() + " " + std::to_string(list.size())}};
          pipeline["backend"] = backend;
          pipeline["observer"] = observer;
          list.push_back(std::move(pipeline));
        }
      }
    }
    return list;
  }

  Json observers(const std::string& backend) {
    const bool constrained = backend == "constrained_zonotope" || backend == "line_zonotope";
    const Json generators = n_ + 3 + draw_.below(20);
    const Json constraints = 1 + draw_.below(8);
    Json list = Json::array();
    if (descriptor_) {
      Json observer{{"type", "descriptor"}, {"max_generators", generators}};
      if (constrained) observer["max_constraints"] = constraints;
      if (backend == "constrained_zonotope" || (!constrained && start_ == Start::bounded_with_gaps))
        observer["admissible_set"] = box(Vector::Zero(n_), 1e4 * X0_.cwiseMax(1e-6));
      list.push_back(std::move(observer));
      return list;
    }
    Json correction{{"type", "prediction_correction"}, {"max_generators", generators}};
    if (constrained) correction["max_constraints"] = constraints;
    list.push_back(std::move(correction));
    if (n_ > 4 || start_ == Start::unknown) return list;
    for (const char* type : {"luenberger", "zonotope_uncertain", "gain_correction"}) {
      list.push_back(
          {{"type", type}, {"gain", {{"type", "kalman"}}}, {"max_generators", generators}});
    }
    list.push_back({{"type", "interval_trajectory"}, {"gain", {{"type", "kalman"}}}});
    return list;
  }

  Draw draw_;
  std::uint64_t number_;
  Start start_;
  Index n_ = 1, p_ = 1;
  bool descriptor_ = false, without_noise_ = false;
  Matrix A_, B_, Bw_, C_, D_, E_;
  Vector V_, w_, x0_, X0_;
};

}  // namespace

Json random_study(std::uint64_t number, Start start) { return StudyMaker(number, start).make(); }

}  // namespace cordon::campaigns
