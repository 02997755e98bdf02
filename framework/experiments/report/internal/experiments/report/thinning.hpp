// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of any length in a fixed number of points.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "experiments/report/figure.hpp"

namespace cordon::report {

/// Takes the values of a curve one by one, by increasing x, and keeps at most about `limit` points:
/// neighbours share a bucket, and all buckets are made twice as wide when there are too many. A
/// bucket holds the smallest and the largest value of its x, so that a thinned band encloses the
/// band, between its points too. NaN is a gap; one is left if a whole bucket is missing.
class Thinner {
 public:
  explicit Thinner(std::size_t limit) : limit_(limit) {}  ///< 4 at least; 0: nothing is thinned

  void add(double x, double lower, double upper);
  void add(double x, double y) { add(x, y, y); }

  bool is_empty() const { return buckets_.empty(); }
  bool is_thinned() const { return width_ > 1; }
  bool has_values() const { return has_values_; }
  double smallest() const { return smallest_; }  ///< finite value; +∞: there is none
  double largest() const { return largest_; }

  Series band(std::string name, int pipeline) const;
  /// Of values without a width: smallest and largest of a bucket in their order.
  Series line(std::string name, int pipeline, Series::Kind kind = Series::Kind::line) const;

 private:
  struct Bucket {
    double number = 0;  ///< of the bucket at the present width
    double first = 0, last = 0;
    double lower = 0, upper = 0;  ///< NaN: a gap
    double x_lower = 0, x_upper = 0;
  };

  void widen();
  static void join(Bucket& into, const Bucket& next);

  std::size_t limit_;
  double origin_ = 0, width_ = 1;
  std::vector<Bucket> buckets_;
  bool has_values_ = false;
  double smallest_ = infinity, largest_ = -infinity;
};

}  // namespace cordon::report
