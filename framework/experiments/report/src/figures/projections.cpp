// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "experiments/report/plane_set.hpp"
#include "figures/figures.hpp"
#include "study/results/recorded_run.hpp"
#include "study/results/recorded_view.hpp"

namespace cordon::report {

namespace {

constexpr std::size_t most_times = 60, most_events = 20, most_vertices = 64;
constexpr std::size_t page_polygons = 1800, page_vertices = 40'000;
/// What support values may cost together: each takes about (constraints + 1)(generators + 1) units,
/// of which a second has some four million.
constexpr double page_work = 1.6e7;
/// A set is cut by the window if it is so much larger than others, which would be dots.
constexpr double much_larger = 20;
constexpr double margin = 0.08;

using Pair = std::pair<Index, Index>;

/// Evenly from the first to the last, and those at which something happens.
std::set<std::int64_t> times_of(const Curves& curves, std::size_t count) {
  std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = -1;
  std::set<std::int64_t> events;
  for (const StepCurves& steps : curves.pipelines) {
    if (steps.first < 0) continue;
    first = std::min(first, steps.first);
    last = std::max(last, steps.last);
    events.insert(steps.empty_from.begin(), steps.empty_from.end());
  }
  std::set<std::int64_t> times;
  if (last < 0) return times;
  for (const PlantEvent& event : curves.events) events.insert(event.k);
  const double span = static_cast<double>(last - first),
               parts = static_cast<double>(std::max<std::size_t>(count, 2) - 1);
  for (std::size_t i = 0; i < std::max<std::size_t>(count, 2); ++i) {
    times.insert(first +
                 static_cast<std::int64_t>(std::llround(span * static_cast<double>(i) / parts)));
  }
  std::size_t added = 0;
  for (const std::int64_t k : events) {
    if (k < first || k > last || added == most_events) continue;
    added += times.insert(k).second ? 1 : 0;
  }
  return times;
}

/// Of an interval; 0 if it is rounding.
double size_of(double low, double high) {
  const double size = high - low;
  return size > 1e-12 * std::max(std::abs(low), std::abs(high)) ? size : 0;
}

struct Extent {
  double left = infinity, right = -left, bottom = left, top = -left;

  void add_x(double low, double high) {
    left = std::min(left, low);
    right = std::max(right, high);
  }
  void add_y(double low, double high) {
    bottom = std::min(bottom, low);
    top = std::max(top, high);
  }
  void add(double x, double y) {
    add_x(x, x);
    add_y(y, y);
  }
  void add(const Extent& other) {
    add(other.left, other.bottom);
    add(other.right, other.top);
  }
  bool is_empty() const { return !(left <= right); }
  double width() const { return size_of(left, right); }
  double height() const { return size_of(bottom, top); }
};

/// The sets of one pair of coordinates at one time.
struct Drawn {
  std::vector<std::pair<int, PlaneSet>> sets;  ///< with their pipelines
  std::optional<std::pair<double, double>> truth;
};

/// Beyond it, windows around a set may have edges that are no numbers.
constexpr double largest_drawn = 1e150;

bool is_drawn(double x, double y) {
  return std::abs(x) <= largest_drawn && std::abs(y) <= largest_drawn;
}

bool is_drawn(const PlaneSet& set) {
  return is_drawn(set.lower, set.upper) &&
         std::all_of(set.vertices.begin(), set.vertices.end(),
                     [](const PlanePoint& p) { return is_drawn(p.x, p.y); });
}

/// Without bounded sets: around what a strip has nearest to the origin.
Extent around_strips(const Drawn& drawn) {
  Extent extent;
  for (const auto& [pipeline, set] : drawn.sets) {
    if (set.kind != PlaneSet::Kind::strip || !std::isfinite(set.upper - set.lower)) continue;
    const double at = std::clamp(0.0, set.lower, set.upper),
                 half = std::max(set.upper - set.lower, 1e-3 * std::abs(at));
    extent.add(at * set.normal.x - half, at * set.normal.y - half);
    extent.add(at * set.normal.x + half, at * set.normal.y + half);
  }
  return extent;
}

/// One coordinate, which says nothing about the size of the other: their units may differ.
void widen(double& low, double& high) {
  const double middle = (low + high) / 2, scale = std::max(std::abs(low), std::abs(high));
  // Without a size: as much as shows where it lies.
  const double least = scale > 0 ? std::max(1e-3 * scale, std::numeric_limits<double>::min()) : 1;
  const double half = (size_of(low, high) > 0 ? (high - low) / 2 : least) * (1 + 2 * margin);
  low = middle - half;
  high = middle + half;
}

/// Of the sizes of sets in one coordinate: above it a set is much larger than half of those that
/// have a size.
double limit_of(std::vector<double> sizes) {
  std::erase_if(sizes, [](double size) { return !(size > 0); });
  if (sizes.empty()) return 0;
  std::sort(sizes.begin(), sizes.end());
  return much_larger * sizes[(sizes.size() - 1) / 2];
}

/// The window: in each coordinate all bounded sets that are not much larger than half of them, and
/// the truth.
SetFrame frame_of(std::int64_t k, const Drawn& drawn) {
  std::vector<Extent> extents;
  std::vector<double> widths, heights;
  for (const auto& [pipeline, set] : drawn.sets) {
    if (set.kind != PlaneSet::Kind::bounded) continue;
    Extent extent;
    for (const PlanePoint& p : set.vertices) extent.add(p.x, p.y);
    if (extent.is_empty()) continue;
    extents.push_back(extent);
    widths.push_back(extent.width());
    heights.push_back(extent.height());
  }
  const double width_limit = limit_of(widths), height_limit = limit_of(heights);
  Extent all;
  for (const Extent& extent : extents) {
    if (extent.width() <= width_limit) all.add_x(extent.left, extent.right);
    if (extent.height() <= height_limit) all.add_y(extent.bottom, extent.top);
  }
  if (drawn.truth) all.add(drawn.truth->first, drawn.truth->second);
  if (extents.empty()) {
    if (const Extent strips = around_strips(drawn); !strips.is_empty()) all.add(strips);
  }
  if (all.is_empty()) all.add(0, 0);
  SetFrame frame{k, all.left, all.right, all.bottom, all.top, {}, drawn.truth};
  widen(frame.left, frame.right);
  widen(frame.bottom, frame.top);
  for (const auto& [pipeline, set] : drawn.sets) {
    Polygon polygon;
    polygon.pipeline = pipeline;
    if (cut(set, frame, polygon)) frame.sets.push_back(std::move(polygon));
  }
  return frame;
}

class Projector {
 public:
  Projector(const RunFiles& files, const Curves& curves)
      : files_(files), pairs_(detail::drawn_planes(static_cast<Index>(curves.all_states))) {
    const auto observers = static_cast<std::size_t>(
        std::count_if(curves.pipelines.begin(), curves.pipelines.end(),
                      [](const StepCurves& steps) { return steps.first >= 0; }));
    const std::size_t polygons_per_time = std::max<std::size_t>(observers * pairs_.size(), 1);
    times_ =
        times_of(curves, std::clamp<std::size_t>(page_polygons / polygons_per_time, 6, most_times));
    const std::size_t polygons = std::max<std::size_t>(times_.size() * polygons_per_time, 1);
    if (files.detail() == Detail::page) {
      limits_.vertices = std::clamp<std::size_t>(page_vertices / polygons, 8, most_vertices);
      limits_.directions = 2 * limits_.vertices;
      work_ = page_work / static_cast<double>(polygons);
    }
    states_ = static_cast<Index>(curves.all_states);
  }

  void read() {
    verification::SetReader reader(files_.files());
    while (const auto row = reader.next([&](Index k) { return times_.contains(k); })) {
      const int pipeline = files_.pipeline(row->pipeline, "sets.jsonl");
      if (row->set.dim() != states_) {
        throw InputError(
            (files_.directory() / "sets.jsonl").string(),
            {{"/dim", fmt::format("is {}, steps.csv has {} states", row->set.dim(), states_),
              "run the study again",
              static_cast<int>(std::min<std::int64_t>(row->line, 1'000'000'000))}});
      }
      if (times_.contains(row->k)) add(*row, pipeline);
    }
    for (const auto& [k, x] : truth_at(files_, times_)) {
      if (static_cast<Index>(x.size()) != states_) continue;
      for (std::size_t q = 0; q < pairs_.size(); ++q) {
        const double a = x[static_cast<std::size_t>(pairs_[q].first)],
                     b = x[static_cast<std::size_t>(pairs_[q].second)];
        if (is_drawn(a, b)) drawn(k)[q].truth = {a, b};
      }
    }
  }

  void draw(Report& report) const {
    if (failed_ > 0)
      report.notes.push_back(fmt::format("{} sets have numbers too large to be drawn.", failed_));
    std::string caption =
        "The sets of all pipelines, seen in two coordinates. Polygons contain the sets, and touch "
        "them unless they have too many "
        "vertices to be drawn; "
        "dotted edges lie on the edge of the picture, where the set goes on.";
    if (outer_)
      caption +=
          " Of some sets an enclosure is drawn, since their representation has no exact exchange "
          "form: a polygon that touches them in sixteen directions.";
    if (any_empty())
      caption +=
          " At some times pipelines are missing: their sets are proven empty, which is said below.";
    for (std::size_t q = 0; q < pairs_.size(); ++q) {
      const auto [i, j] = pairs_[q];
      const Labels::Names& names = files_.labels().states;
      Projection projection{label_of(names, "x", i), label_of(names, "x", j), {}};
      for (const auto& [k, pictures] : pictures_) {
        if (pictures[q].sets.empty()) continue;
        projection.frames.push_back(frame_of(k, pictures[q]));
        if (files_.labels().sampling_time > 0)
          projection.frames.back().time = time_text(files_.labels(), k);
      }
      if (projection.frames.empty()) continue;
      report.figures.push_back(
          {fmt::format("sets_{}_{}", i + 1, j + 1), section::sets,
           names.empty()
               ? fmt::format("Sets in states {} and {}", i + 1, j + 1)
               : fmt::format("Sets in {} and {}", label_of(names, "x", i), label_of(names, "x", j)),
           caption, std::move(projection)});
    }
  }

  bool is_needed() const { return !pairs_.empty() && !times_.empty(); }

 private:
  bool any_empty() const {
    return std::any_of(pictures_.begin(), pictures_.end(), [](const auto& at) {
      const auto& sets = at.second.front().sets;
      return std::any_of(sets.begin(), sets.end(),
                         [](const auto& set) { return set.second.kind == PlaneSet::Kind::empty; });
    });
  }

  std::vector<Drawn>& drawn(std::int64_t k) {
    std::vector<Drawn>& pictures = pictures_[k];
    pictures.resize(pairs_.size());
    return pictures;
  }

  void add(const verification::RecordedSet& row, int pipeline) {
    const double cost =
        static_cast<double>((row.set.constraints() + 1) * (row.set.generators() + 1));
    PlaneLimits limits = limits_;
    if (files_.detail() == Detail::page) {
      limits.directions =
          std::min(limits.directions, static_cast<std::size_t>(std::max(work_ / cost, 4.0)));
    }
    outer_ = outer_ || !row.exact_exchange;
    std::vector<Drawn>& pictures = drawn(row.k);
    for (std::size_t q = 0; q < pairs_.size(); ++q) {
      try {
        PlaneSet set = project({row.set, row.rows}, pairs_[q].first, pairs_[q].second, limits);
        if (is_drawn(set)) {
          pictures[q].sets.emplace_back(pipeline, std::move(set));
        } else {
          ++failed_;
        }
      } catch (const Error&) {
        ++failed_;
      }
    }
  }

  const RunFiles& files_;
  std::vector<Pair> pairs_;
  std::set<std::int64_t> times_;
  PlaneLimits limits_;
  double work_ = 0;  ///< for one polygon
  Index states_ = 0;
  std::map<std::int64_t, std::vector<Drawn>> pictures_;  ///< by time, then by pair
  std::size_t failed_ = 0;
  bool outer_ = false;
};

}  // namespace

void add_projections(const RunFiles& files, const Curves& curves, Report& report) {
  Projector projector(files, curves);
  if (!projector.is_needed()) return;
  projector.read();
  projector.draw(report);
}

}  // namespace cordon::report
