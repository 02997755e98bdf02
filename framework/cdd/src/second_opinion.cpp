// SPDX-License-Identifier: GPL-3.0-or-later
#include "cdd/second_opinion.hpp"

#include <algorithm>
#include <tuple>

#include "cordon/core/error.hpp"

namespace cordon::cdd {

namespace {

using polytope::Form;
using rational::Rational;
using rational::RationalVector;
using Rows = std::vector<RationalVector>;

bool comes_before(const RationalVector& a, const RationalVector& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Equal for equal polyhedra. The constant of a row comes last here.
struct Canonical {
  Rows linear, others;  ///< in reduced row echelon form; sorted
};

Canonical canonical(const Description& in, Form form) {
  std::vector<RationalVector> linear, others;
  for (std::size_t i = 0; i < in.rows.size(); ++i) {
    RationalVector row = in.rows[i];
    std::rotate(row.begin(), row.begin() + 1, row.end());
    (in.linear[i] ? linear : others).push_back(std::move(row));
  }
  rational::RationalMatrix echelon(static_cast<Index>(linear.size()), in.dim + 1);
  for (Index i = 0; i < echelon.rows(); ++i) {
    for (Index j = 0; j <= in.dim; ++j) echelon(i, j) = linear[as_size(i)][as_size(j)];
  }
  const std::vector<Index> pivots = rational::reduce_rows(echelon, in.dim + 1);
  Canonical out;
  for (std::size_t k = 0; k < pivots.size(); ++k)
    out.linear.push_back(echelon.row(static_cast<Index>(k)));
  for (RationalVector& row : others) {
    for (std::size_t k = 0; k < pivots.size(); ++k) {
      const Rational factor = row[as_size(pivots[k])];
      if (sgn(factor) == 0) continue;
      for (std::size_t j = 0; j < row.size(); ++j) row[j] -= factor * out.linear[k][j];
    }
    rational::make_primitive(row);
    // Modulo the equations, the hyperplane at infinity may look like an inequality.
    const bool says_nothing =
        form == Form::inequalities && sgn(row.back()) >= 0 &&
        std::all_of(row.begin(), row.end() - 1, [](const Rational& x) { return sgn(x) == 0; });
    if (!says_nothing) out.others.push_back(std::move(row));
  }
  std::sort(out.others.begin(), out.others.end(), comes_before);
  return out;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t most = 200;
  return text.size() <= most ? text : text.substr(0, most) + "…";
}

std::string text_of(const RationalVector& row) {
  std::string text = "(";
  for (std::size_t j = 0; j < row.size(); ++j)
    text += (j == 0 ? "" : ", ") + row[(j + row.size() - 1) % row.size()].get_str();
  return shortened(text + ")");
}

std::string difference(const Rows& ours, const Rows& theirs, const std::string& what) {
  if (ours == theirs) return "";
  for (const auto& [one, other, who] : {std::tuple(&ours, &theirs, "the own engine"),
                                        std::tuple(&theirs, &ours, "the other engine")}) {
    for (const RationalVector& row : *one) {
      if (std::find(other->begin(), other->end(), row) == other->end())
        return "only " + std::string(who) + " has the " + what + " " + text_of(row);
    }
  }
  return "one engine repeats a " + what;
}

std::string text_of(ExactProgram::Status status, const Rational& value) {
  switch (status) {
    case ExactProgram::Status::optimal:
      return shortened("the optimum " + value.get_str());
    case ExactProgram::Status::infeasible:
      return "that there is no solution";
    case ExactProgram::Status::unbounded:
      return "that there is no bound";
  }
  return "";
}

double bits_of(const Rational& x) {
  return static_cast<double>(mpz_sizeinbase(x.get_num_mpz_t(), 2) +
                             mpz_sizeinbase(x.get_den_mpz_t(), 2));
}

/// Numbers are counted as 128 digits more, for what is done with short ones.
double bits_of(const Description& all) {
  double sum = 0;
  for (const RationalVector& row : all.rows) {
    for (const Rational& x : row) sum += 128 + bits_of(x);
  }
  return sum;
}

double most_bits_of(MatrixIn A) {
  double most = 1;
  for (Index j = 0; j < A.cols(); ++j) {
    for (Index i = 0; i < A.rows(); ++i) most = std::max(most, bits_of(rational::exact(A(i, j))));
  }
  return most;
}

std::string size_of(const Description& question, const char* rows) {
  return "the conversion of " + std::to_string(question.rows.size()) + " " + rows +
         " in dimension " + std::to_string(question.dim);
}

}  // namespace

std::string difference(const Description& ours, const Description& theirs, Form form) {
  const Canonical a = canonical(ours, form), b = canonical(theirs, form);
  const std::string linear = difference(a.linear, b.linear, "line or equation");
  return linear.empty() ? difference(a.others, b.others, "row") : linear;
}

double conversion_work(const Description& question, const Description& answer) {
  return static_cast<double>(question.rows.size()) * static_cast<double>(question.dim + 1) *
         (bits_of(question) + bits_of(answer));
}

double program_work(const ExactProgram& question) {
  const auto equations = static_cast<double>(question.b.size()),
             boxed = static_cast<double>(question.A.cols()),
             columns = static_cast<double>(question.S.cols()) + boxed + 1;
  return (2 * equations + 2 * boxed + 1) * columns * columns * (equations + 2) *
         std::max(most_bits_of(question.S), most_bits_of(question.A));
}

void SecondOpinion::ask(Count& count, bool too_large, const std::string& question,
                        const std::function<std::string()>& compare) {
  if (stop_ && stop_->load()) return;
  if (too_large) {
    ++count.too_large;
    return;
  }
  const auto told = [&](const std::string& what) {
    return (place_.empty() ? "" : place_ + ": ") + question + ": " + what;
  };
  try {
    const std::string differs = compare();
    if (differs.empty()) {
      ++count.agree;
    } else if (count.disagree++; first_disagreement_.empty()) {
      first_disagreement_ = told(differs);
    }
  } catch (const Error& error) {
    ++count.unanswered;
    if (first_unanswered_.empty()) first_unanswered_ = told(error.what());
  }
}

void SecondOpinion::converted_to_generators(const Description& inequalities,
                                            const Description& answer) {
  ask(conversions_, conversion_work(inequalities, answer) > most_conversion_work,
      size_of(inequalities, "inequalities"),
      [&] { return difference(answer, other_.generators_of(inequalities), Form::generators); });
}

void SecondOpinion::converted_to_inequalities(const Description& generators,
                                              const Description& answer) {
  ask(conversions_, conversion_work(generators, answer) > most_conversion_work,
      size_of(generators, "generators"),
      [&] { return difference(answer, other_.inequalities_of(generators), Form::inequalities); });
}

void SecondOpinion::maximized(const ExactProgram& program, const ExactProgram::Result& answer) {
  const std::string question = "the linear program with " + std::to_string(program.b.size()) +
                               " equations, " + std::to_string(program.S.cols()) + " free and " +
                               std::to_string(program.A.cols()) + " boxed variables";
  ask(programs_, program_work(program) > most_program_work, question, [&]() -> std::string {
    const ExactEngine::Optimum other = other_.maximum(program);
    if (other.status == answer.status && other.value == answer.value) return "";
    return "the own engine finds " + text_of(answer.status, answer.value) + ", the other engine " +
           text_of(other.status, other.value);
  });
}

}  // namespace cordon::cdd
