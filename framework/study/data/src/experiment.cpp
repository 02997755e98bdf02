// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/experiment.hpp"

#include "cordon/core/error.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "study/data/formula_source.hpp"
#include "study/data/simulate.hpp"

namespace cordon::detail {

namespace {

Signal table(VectorIn values) {
  Signal signal;
  signal.type = Signal::Type::table;
  signal.values = values;
  return signal;
}

/// Seed, noise and start of the study, if its data are simulated; the inputs are u.
SimulateSpec spec_of(const Study& study, MatrixIn u, std::uint64_t seed_offset) {
  SimulateSpec spec;
  if (const auto* simulate = std::get_if<SimulateSpec>(&study.data)) {
    spec.seed = simulate->seed;
    spec.noise = simulate->noise;
    spec.x0 = simulate->x0;
    spec.x0_set = simulate->x0_set;
  }
  spec.seed += seed_offset;
  spec.steps = u.rows() - 1;
  for (Index i = 0; i < u.cols(); ++i) spec.input.push_back(table(u.col(i)));
  return spec;
}

/// Simulated data of one mode, whose records name it.
class Experiment final : public DataSource {
 public:
  Experiment(const Study& study, const Mode& mode, Index index, SimulateSpec spec)
      : name_(mode.name), index_(index) {
    own_start_ = !spec.x0 && !spec.x0_set;
    if (own_start_ && is_bounded(mode.model.X0) == Answer::yes) spec.x0_set = mode.model.X0;
    if (!own_start_) take_parameters(mode.model, spec);
    placed([&] {
      if (mode.model.is_linear()) {
        source_ = std::make_unique<SimulatedSource>(mode.model, spec, study.file.string());
      } else {
        source_ = std::make_unique<FormulaSource>(mode.model, spec, study.file.string(), false);
      }
    });
  }

  std::optional<Record> next() override {
    std::optional<Record> record;
    placed([&] { record = source_->next(); });
    if (record) record->mode = index_;
    return record;
  }
  std::optional<std::int64_t> size() const override { return source_->size(); }

 private:
  /// The start that a study gives holds for all modes; parameters that are states are the mode's.
  static void take_parameters(const Model& model, SimulateSpec& spec) {
    const Index count = model.nonlinear ? model.nonlinear->parameters : 0;
    if (count == 0) return;
    const LineForm& X0 = model.X0;  // with the box of the parameters, in generators of their own
    if (spec.x0) spec.x0->tail(count) = X0.c.tail(count);
    if (!spec.x0_set) return;
    const Index others = X0.dim() - count;
    spec.x0_set = cartesian_product(
        affine_map(*spec.x0_set, Matrix::Identity(others, X0.dim()), Vector::Zero(others)),
        make_zonotope(X0.c.tail(count), X0.G.bottomRows(count)));
  }

  /// Problems of the simulation are problems of the mode, but for those of a start that the study
  /// gives.
  template <class Work>
  void placed(Work&& work) const {
    try {
      work();
    } catch (const InputError& error) {
      std::vector<Diagnostic> problems = error.diagnostics();
      for (Diagnostic& problem : problems) {
        problem.message = "an experiment with mode \"" + name_ + "\": " + problem.message;
        const bool start = problem.pointer.starts_with("/data/simulate/x0") && !own_start_;
        if (!start)
          problem.pointer = index_ == 0 ? "/system" : "/system/modes/" + std::to_string(index_ - 1);
      }
      throw InputError(error.file(), std::move(problems));
    }
  }

  std::string name_;
  Index index_;
  bool own_start_ = false;  ///< in the X0 of the mode
  std::unique_ptr<DataSource> source_;
};

}  // namespace

std::unique_ptr<DataSource> open_experiment(const Study& study, const ModeBank& bank, Index mode,
                                            MatrixIn u, std::uint64_t seed_offset) {
  if (mode < 0 || mode >= bank.size())
    throw Error(Errc::dimension, "an experiment: there is no such mode");
  if (u.rows() == 0 || u.cols() != bank[mode].model.inputs())
    throw Error(Errc::dimension, "an experiment: the inputs have another size than the model");
  if (!u.allFinite())
    throw Error(Errc::not_finite, "an experiment: the inputs have a NaN or infinite number");
  return std::make_unique<Experiment>(study, bank[mode], mode, spec_of(study, u, seed_offset));
}

}  // namespace cordon::detail
