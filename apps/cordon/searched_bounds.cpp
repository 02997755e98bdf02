// SPDX-License-Identifier: GPL-3.0-or-later
#include "searched_bounds.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "json_text.hpp"

namespace cordon::apps {

namespace {

constexpr double largest_factor = 1024, smallest_factor = 1e-6;
constexpr double fine = 1.01;  ///< factors nearer than this are not told apart

Model scaled_by(Model model, double factor, Scaled scaled) {
  if (scaled != Scaled::noises) model.W.G *= factor;
  if (scaled != Scaled::disturbances) model.V.G *= factor;
  return model;
}

/// k of the first estimate that is proven empty; -1: none is.
Index empty_from(const BoundSearch& search, std::span<const Sample> samples, double factor) {
  const ComponentSpec& backend = search.pipeline.backend;
  const ComponentSpec& observer = search.pipeline.estimation()->observer;
  const auto made = search.registry.make<ObserverEntry>(
      observer.type,
      {scaled_by(search.study.model, factor, search.scaled),
       search.registry.make<BackendEntry>(backend.type, backend.params)},
      observer.params);
  made->start();
  for (const Sample& sample : samples) {
    try {
      if (made->step(sample).consistent == Answer::no) return sample.k;
    } catch (const Error& error) {
      if (error.code() != Errc::not_enclosed) throw;
      return -1;
    }
  }
  return -1;
}

}  // namespace

SearchedBounds search_bounds(const BoundSearch& search, const std::function<bool()>& stop) {
  SearchedBounds found;
  const auto try_factor = [&](double factor) {
    const Index at = empty_from(search, search.samples, factor);
    if (at < 0) {
      found.kept = factor;
      return;
    }
    found.refuted = factor;
    found.empty_at = at;
  };
  try_factor(1);
  while (found.kept == infinity && found.refuted < largest_factor && !stop())
    try_factor(2 * found.refuted);
  while (found.refuted == 0 && found.kept > smallest_factor && !stop()) try_factor(found.kept / 2);
  while (found.refuted > 0 && found.kept < infinity && found.kept > fine * found.refuted && !stop())
    try_factor(0.5 * found.refuted + 0.5 * found.kept);
  if (found.kept < infinity && search.all.size() > search.samples.size())
    found.fails_at = empty_from(search, search.all, found.kept);
  if (found.fails_at >= 0 && search.margin > 0)
    found.wider_fails_at = empty_from(search, search.all, (1 + search.margin) * found.kept);
  return found;
}

BoundFactors factors_of(const SearchedBounds& found, const BoundSearch& search) {
  const auto of = [&](const LineForm& set, Scaled alone) {
    const bool is_scaled = search.scaled == Scaled::both || search.scaled == alone;
    return Vector(Vector::Constant(set.generators(), is_scaled ? found.kept : 1));
  };
  BoundFactors factors;
  factors.disturbances = of(search.study.model.W, Scaled::disturbances);
  factors.noises = of(search.study.model.V, Scaled::noises);
  return factors;
}

std::string text_of(const SearchedBounds& found, const BoundSearch& search) {
  std::string text =
      fmt::format("By the estimates of pipeline \"{}\", which enclose what is possible:\n",
                  search.pipeline.name);
  if (found.empty_at >= 0) {
    text += fmt::format("Factor  not below {:.4g}: then the estimate at k = {} is proven empty\n",
                        found.refuted, found.empty_at);
  }
  if (found.kept == infinity) return text + "No factor up to 1000 leaves estimates.\n";
  text += fmt::format(
      "        with {:.4g} none is: bounds may have to be larger than that, for "
      "estimates hold more than what is possible\n",
      found.kept);
  if (search.all.size() == search.samples.size()) return text;
  if (found.fails_at < 0) return text + "The rest of the samples leaves estimates, too.\n";
  text += fmt::format("The rest of the samples contradicts it at k = {}.\n", found.fails_at);
  if (search.margin == 0) return text;
  text += fmt::format("With {:.4g}% more ", 100 * search.margin);
  return text + (found.wider_fails_at < 0
                     ? std::string("it leaves estimates, too.\n")
                     : fmt::format("it does so at k = {}.\n", found.wider_fails_at));
}

std::string json_of(const SearchedBounds& found, const BoundSearch& search) {
  nlohmann::ordered_json report{{"pipeline", search.pipeline.name},
                                {"samples", search.all.size()},
                                {"trained", search.samples.size()},
                                {"refuted", found.refuted},
                                {"empty_at", found.empty_at}};
  report["kept"] = found.kept < infinity ? nlohmann::ordered_json(found.kept) : nullptr;
  report["fails_at"] = found.fails_at;
  if (search.margin > 0) report["wider_fails_at"] = found.wider_fails_at;
  return json_text(report);
}

}  // namespace cordon::apps
