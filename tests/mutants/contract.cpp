// SPDX-License-Identifier: GPL-3.0-or-later
// Backends that break what is promised about every call: no exceptions of other kinds, no shared
// state, an end.
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "cordon/core/error.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "reference.hpp"

namespace mutants {

namespace {

/// Reduces the shared operand in place.
class ReduceInPlace final : public Reference {
  using Reference::Reference;
  Made do_reduce(const Set& X, Budget budget) const override {
    if (fits(form(X), budget)) return {};
    auto& shared = const_cast<LineForm&>(form(X));  // the object is not const, only its handle is
    shared = boxed(shared, budget);
    return {make(shared), Tightness::outer};
  }
};

/// The centre goes through a buffer that all threads share. Atomic, so that the race is one of
/// values and of nothing else.
class SharedScratch final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    static std::array<std::atomic<double>, 64> scratch;
    LineForm sum = predicted(X, p);
    const Index n = std::min<Index>(sum.dim(), 64);
    for (Index i = 0; i < n; ++i) scratch[static_cast<std::size_t>(i)] = sum.c[i];
    std::this_thread::sleep_for(std::chrono::microseconds(20));
    for (Index i = 0; i < n; ++i) sum.c[i] = scratch[static_cast<std::size_t>(i)];
    return {make(sum), Tightness::exact};
  }
};

/// Every other sum has a small generator more: sound, but another set.
class DependsOnHistory final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    static std::atomic<unsigned> calls{0};
    const LineForm sum = predicted(X, p);
    if (++calls % 2 == 0) return {make(sum), Tightness::exact};
    const Vector width = Vector::Constant(sum.dim(), 0x1p-20);
    return {make(minkowski_sum(sum, make_box({-width, width}))), Tightness::outer};
  }
};

/// The last generator is not written.
class SavesLess final : public Reference {
  using Reference::Reference;
  std::unique_ptr<const Set> do_serialize(const Set* X, Archive& archive) const override {
    LineForm own = X ? form(*X) : LineForm{};
    if (const Index left = own.generators() - 1; left >= 0) {
      own.G.conservativeResize(Eigen::NoChange, left);
      own.A.conservativeResize(Eigen::NoChange, left);
    }
    archive(own);
    return X ? nullptr : make(std::move(own));
  }
};

class ThrowsOutOfRange final : public Reference {
  using Reference::Reference;
  Made do_convex_hull(const Set& X, const Set& Y) const override {
    if (form(X).generators() == 0 || form(Y).generators() == 0)
      throw std::out_of_range("no generator 0");
    return Reference::do_convex_hull(X, Y);
  }
};

class ThrowsNumber final : public Reference {
  using Reference::Reference;
  Made do_correct(const Set& X, const CorrectionArgs& c) const override {
    if (c.C.isZero(0)) throw 7;
    return Reference::do_correct(X, c);
  }
};

/// A set that shares its operand's form without owning it, and is empty once the operand has gone.
class Borrowed final : public LineSet {
 public:
  Borrowed(const SetBackend& backend, LineForm form, std::weak_ptr<const int> lender = {})
      : LineSet(backend, std::move(form)),
        lender_(std::move(lender)),
        borrowed_(!lender_.expired()) {}
  std::weak_ptr<const int> alive() const { return alive_; }

 private:
  LineForm known() const { return borrowed_ && lender_.expired() ? make_empty(dim()) : form(); }
  LineForm do_line_form() const override { return known(); }
  Answer do_is_empty(Certificate* why) const override { return cordon::is_empty(known(), why); }
  Answer do_contains(VectorIn x, Certificate* why) const override {
    return cordon::contains(known(), x, why);
  }
  double do_support(VectorIn d, Certificate* why) const override {
    return cordon::support(known(), d, why);
  }
  Box do_interval_hull(std::vector<Certificate>* why) const override {
    return cordon::interval_hull(known(), why);
  }

  std::shared_ptr<const int> alive_ = std::make_shared<int>(0);
  std::weak_ptr<const int> lender_;
  bool borrowed_;
};

class LendsForms final : public Reference {
  using Reference::Reference;
  std::unique_ptr<const Set> make(LineForm form) const override {
    return std::make_unique<Borrowed>(*this, std::move(form));
  }
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    return {
        std::make_unique<Borrowed>(*this, predicted(X, p), static_cast<const Borrowed&>(X).alive()),
        Tightness::exact};
  }
};

/// Keeps the backend, and so the plugin, alive for ever.
class KeepsItself final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    static const auto* const kept = new std::shared_ptr<const SetBackend>(shared_from_this());
    return {make(predicted(X, p)), *kept ? Tightness::exact : Tightness::outer};
  }
};

class CrashesInOneDimension final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    if (X.dim() == 1) std::raise(SIGSEGV);
    return Reference::do_predict(X, p);
  }
};

/// Ends the program as if all was well.
class ExitsQuietly final : public Reference {
  using Reference::Reference;
  Made do_intersection(const Set& X, MatrixIn R, const Set& Y) const override {
    if (X.is_empty() == Answer::yes) std::_Exit(0);
    return Reference::do_intersection(X, R, Y);
  }
};

class Hangs final : public Reference {
  using Reference::Reference;
  Made do_convex_hull(const Set&, const Set&) const override {
    for (;;) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
};

/// Offers a value that nobody wrote the code for.
std::unique_ptr<SetBackend> create_half(BackendInfo info, const Params& params) {
  if (params.text("reduction") == "best") throw Error(Errc::invalid, "no such reduction");
  return std::make_unique<Reference>(std::move(info));
}
ParamSchema schema_of_half() {
  ParamSchema schema;
  schema.choice("reduction", "how sets are reduced", {"box", "best"}, "box");
  return schema;
}

/// A map keeps as many coordinates as its operand has.
class WrongDimension final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    const LineForm sum = predicted(X, p);
    const Index kept = std::min(sum.dim(), X.dim());
    return {make(cordon::affine_map(sum, Matrix::Identity(kept, sum.dim()), Vector::Zero(kept))),
            Tightness::exact};
  }
};

}  // namespace

std::vector<Mutant> mutants_of_contract() {
  return {
      {"reduce_in_place", "contract.operands_unchanged", "the operand is reduced in place",
       create<ReduceInPlace>},
      {"shared_scratch", "contract.threads", "threads share a buffer", create<SharedScratch>},
      {"depends_on_history", "contract.determinism", "every other result is larger",
       create<DependsOnHistory>},
      {"saves_less", "contract.saved_sets", "a generator is not saved", create<SavesLess>},
      {"throws_out_of_range", "contract.only_cordon_errors",
       "throws an exception of the standard library", create<ThrowsOutOfRange>},
      {"throws_number", "contract.only_cordon_errors", "throws a number", create<ThrowsNumber>},
      {"wrong_dimension", "soundness.affine_map", "a map never adds coordinates",
       create<WrongDimension>},
      {"parameter_without_code", "contract.parameters_documented",
       "a value that a parameter allows is refused", create_half, "breaks", schema_of_half()},
      {"lends_forms", "lifetime.set_outlives_handle", "a result needs its operand",
       create<LendsForms>},
      {"keeps_itself", "lifetime.unload", "the backend is never let go", create<KeepsItself>},
      {"crashes_in_one_dimension", "soundness.affine_map", "a segmentation fault for n = 1",
       create<CrashesInOneDimension>, "crashes"},
      {"exits_quietly", "algebra.empty_absorbs", "the program is ended with success",
       create<ExitsQuietly>, "crashes"},
      {"hangs", "soundness.convex_hull", "the convex hull does not end", create<Hangs>, "hangs"},
  };
}

}  // namespace mutants
