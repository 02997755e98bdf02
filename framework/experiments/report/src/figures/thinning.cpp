// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/thinning.hpp"

#include <algorithm>
#include <cmath>

namespace cordon::report {

void Thinner::add(double x, double lower, double upper) {
  if (!std::isfinite(x)) return;
  if (std::isnan(lower) || std::isnan(upper))
    lower = upper = std::numeric_limits<double>::quiet_NaN();
  if (buckets_.empty()) origin_ = x;
  if (!std::isnan(lower)) {
    has_values_ = true;
    for (const double value : {lower, upper}) {
      if (!std::isfinite(value)) continue;
      smallest_ = std::min(smallest_, value);
      largest_ = std::max(largest_, value);
    }
  }
  if (!buckets_.empty()) x = std::max(x, buckets_.back().last);
  Bucket bucket{
      limit_ == 0 ? static_cast<double>(buckets_.size()) : std::floor((x - origin_) / width_),
      x,
      x,
      lower,
      upper,
      x,
      x};
  if (!buckets_.empty() && buckets_.back().number == bucket.number) {
    join(buckets_.back(), bucket);
    return;
  }
  buckets_.push_back(bucket);
  // a bucket of more than one x takes two points
  while (limit_ > 0 &&
         buckets_.size() > std::max<std::size_t>(is_thinned() ? limit_ / 2 : limit_, 2))
    widen();
}

void Thinner::widen() {
  width_ *= 2;
  std::vector<Bucket> wider;
  for (Bucket bucket : buckets_) {
    bucket.number = std::floor((bucket.first - origin_) / width_);
    if (!wider.empty() && wider.back().number == bucket.number) {
      join(wider.back(), bucket);
    } else {
      wider.push_back(bucket);
    }
  }
  buckets_ = std::move(wider);
}

void Thinner::join(Bucket& into, const Bucket& next) {
  into.last = next.last;
  if (std::isnan(next.lower)) return;
  if (std::isnan(into.lower) || next.lower < into.lower) {
    into.lower = next.lower;
    into.x_lower = next.x_lower;
  }
  if (std::isnan(into.upper) || next.upper > into.upper) {
    into.upper = next.upper;
    into.x_upper = next.x_upper;
  }
}

Series Thinner::band(std::string name, int pipeline) const {
  Series series{Series::Kind::band, std::move(name), pipeline, {}, {}};
  const auto point = [&](double x, const Bucket& bucket) {
    series.x.push_back(x);
    series.y.push_back(bucket.lower);
    series.upper.push_back(bucket.upper);
  };
  for (const Bucket& bucket : buckets_) {
    point(bucket.first, bucket);
    if (bucket.last > bucket.first) point(bucket.last, bucket);
  }
  return series;
}

Series Thinner::line(std::string name, int pipeline, Series::Kind kind) const {
  Series series{kind, std::move(name), pipeline, {}, {}};
  const auto point = [&](double x, double y) {
    series.x.push_back(x);
    series.y.push_back(y);
  };
  for (const Bucket& bucket : buckets_) {
    if (std::isnan(bucket.lower)) {
      point(bucket.first, bucket.lower);
      continue;
    }
    const bool falls = bucket.x_upper < bucket.x_lower;
    falls ? point(bucket.x_upper, bucket.upper) : point(bucket.x_lower, bucket.lower);
    if (bucket.x_lower == bucket.x_upper) continue;
    falls ? point(bucket.x_lower, bucket.lower) : point(bucket.x_upper, bucket.upper);
  }
  return series;
}

}  // namespace cordon::report
