// SPDX-License-Identifier: GPL-3.0-or-later
// Which means of a summary may be held against each other.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cordon/study/statistics.hpp"

namespace cordon::detail {

/// Index of a column, or the number of columns.
std::size_t column_of(const ResultTable& table, std::string_view name);

/// Is there a finite number of this column at every point of the row? A mean over some of them
/// would flatter a pipeline that has failed, or found nothing, elsewhere. But for times, numbers
/// are not comparable either once an estimate is proven empty, the truth has left what the pipeline
/// assumes of it, or a guarantee is violated: what is averaged ends there.
bool is_comparable(const ResultTable& table, const SummaryRow& row, std::size_t column);

/// The rows of each combination.
std::vector<std::span<SummaryRow>> combinations(Summary& summary);
std::vector<std::span<const SummaryRow>> combinations(const Summary& summary);

/// Do two means of a column differ by no more than rounding may: by 1e-9 of the larger, or, of
/// shares and gaps, by 1e-9?
bool are_alike(const ResultTable& table, std::size_t column, double a, double b);

/// Per row of one combination: has it the best mean of this column, or one alike? None is best if
/// all that are comparable are alike.
std::vector<bool> best_of(const ResultTable& table, std::span<const SummaryRow> rows,
                          std::size_t column);

}  // namespace cordon::detail
