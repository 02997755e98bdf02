// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/identify.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "cordon/experiments/report.hpp"
#include "cordon/study/data.hpp"
#include "identified_study.hpp"
#include "identify_options.hpp"
#include "interrupt.hpp"
#include "json_text.hpp"
#include "new_file.hpp"
#include "searched_bounds.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;
using Status = BoundFactors::Status;

constexpr std::size_t most_identified = 20'000;
constexpr double agrees = 1 + 1e-6;  ///< a factor up to this counts as 1: what the solver rounds
constexpr double shares_of_V[] = {0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 2};

std::vector<Sample> samples_of(const Study& study) {
  std::vector<Sample> samples;
  const auto source = open_data(study);
  while (auto record = source->next()) {
    if (samples.size() == most_identified) {
      throw Error(Errc::invalid, fmt::format("there are more than {} samples; identify bounds from "
                                             "a part of them",
                                             most_identified));
    }
    samples.push_back(std::move(record->sample));
  }
  return samples;
}

Model scaled_model(Model model, const Vector& disturbances, const Vector& noises) {
  model.W = with_factors(model.W, disturbances);
  model.V = with_factors(model.V, noises);
  return model;
}

/// The smallest factors of W for some of V.
struct TradeOff {
  double of_V;
  BoundFactors W;
};

struct Identified {
  std::size_t samples, trained;
  BoundFactors factors;
  /// The factor by which the bounds found would have to grow to explain all samples, if there were
  /// others.
  std::optional<BoundFactors> rest;
  std::optional<BoundFactors> wider;  ///< the same of the bounds with --margin
  std::vector<TradeOff> trade_off;
  std::optional<LeftOutSamples> left_out;  ///< for half of the factor
};

/// The first of them that bounds are taken from.
std::span<const Sample> trained_part(std::span<const Sample> samples, const std::string& share) {
  const double count = share_from(share, "--train") * static_cast<double>(samples.size());
  return samples.first(std::max<std::size_t>(1, static_cast<std::size_t>(count)));
}

/// What was scaled, with what --margin adds.
BoundFactors with_margin(BoundFactors factors, const IdentifyArguments& arguments) {
  const double margin = margin_of(arguments);
  const Scaled scaled = scale_from(arguments.scale);
  if (scaled != Scaled::noises) factors.disturbances *= 1 + margin;
  if (scaled != Scaled::disturbances) factors.noises *= 1 + margin;
  return factors;
}

/// By which factor the bounds would have to grow to explain all samples.
BoundFactors on_all(const Model& model, const BoundFactors& found,
                    const std::vector<Sample>& samples) {
  return identify_bounds(scaled_model(model, found.disturbances * agrees, found.noises * agrees),
                         samples);
}

Identified identified(const Study& study, const std::vector<Sample>& samples,
                      const IdentifyArguments& arguments) {
  const std::span<const Sample> first = trained_part(samples, arguments.train);
  const IdentifyOptions options{scale_from(arguments.scale)};
  Identified result{
      samples.size(), first.size(), identify_bounds(study.model, first, options), {}, {}, {}, {}};
  const BoundFactors& found = result.factors;
  if (found.status == Status::found && first.size() < samples.size()) {
    result.rest = on_all(study.model, found, samples);
    if (!arguments.margin.empty())
      result.wider = on_all(study.model, with_margin(found, arguments), samples);
  }
  if (arguments.leave_out > 0 && found.status == Status::found) {
    const std::atomic<bool>* const stop = stop_on_signals();
    result.left_out = leave_out(study.model, first, found.cost / 2, arguments.leave_out, options,
                                [stop] { return stop->load(); });
  }
  for (const double share : shares_of_V) {
    if (!arguments.trade_off && arguments.figure.empty()) break;
    const Model with_V = scaled_model(study.model, Vector::Ones(study.model.W.generators()),
                                      Vector::Constant(study.model.V.generators(), share));
    result.trade_off.push_back({share, identify_bounds(with_V, first, {Scaled::disturbances})});
  }
  return result;
}

std::string factor_text(const BoundFactors& factors) {
  if (factors.status == Status::found) return fmt::format("{:.6g}", factors.cost);
  return factors.status == Status::none ? "none" : "not found";
}

std::string bounds_text(const Study& study, const BoundFactors& found, const Paint& paint) {
  std::vector<std::vector<std::string>> rows{{"BOUND", "GIVEN", "EXPLAINS THE DATA"}};
  const auto add = [&](const char* letter, const Labels::Names& names, const LineForm& set,
                       const Vector& factors) {
    const LineForm scaled = with_factors(set, factors);
    const Vector given = set.G.cwiseAbs().rowwise().sum(),
                 needed = scaled.G.cwiseAbs().rowwise().sum();
    for (Index i = 0; i < set.dim(); ++i) {
      rows.push_back({label_of(names, letter, i),
                      fmt::format("{:.6g} ± {:.6g}", set.c[i], given[i]),
                      fmt::format("{:.6g} ± {:.6g}", set.c[i], needed[i])});
    }
  };
  add("w", study.labels.disturbances, study.model.W, found.disturbances);
  add("v", study.labels.noises, study.model.V, found.noises);
  return table(rows, paint);
}

std::string proof_text(const BoundFactors& found) {
  if (found.required_by.empty() && found.proven <= 0)
    return found.proven >= found.cost ? "" : "   nothing is proven";
  if (found.required_by.empty())
    return fmt::format("   proven: not below {:.6g}, whatever the outputs are", found.proven);
  return fmt::format("   proven: not below {:.6g}, by the outputs from k = {} to {}", found.proven,
                     found.required_by.front(), found.required_by.back());
}

std::string rest_text(const Identified& result, const std::string& margin) {
  if (!result.rest) return "";
  if (result.rest->status != Status::found)
    return "Whether they explain the rest of the samples was not found.\n";
  if (result.rest->cost <= agrees) return "They explain the rest of the samples, too.\n";
  std::string text = fmt::format(
      "They do not explain all samples. For these they would have to grow:\n"
      "Factor  {:.6g}{}\n",
      result.rest->cost, proof_text(*result.rest));
  if (result.wider && result.wider->status == Status::found)
    text += fmt::format("With {} more they {}.\n", margin,
                        result.wider->cost <= agrees ? "do" : "do not either");
  return text;
}

std::string left_out_text(const LeftOutSamples& left_out, const Paint& paint) {
  std::vector<std::vector<std::string>> rows{{"WITHOUT K =", "FACTOR", "PROVEN"}};
  for (const auto& [k, factors] : left_out.steps)
    rows.push_back(
        {std::to_string(k), factor_text(factors), fmt::format("{:.6g}", factors.proven)});
  std::string text = "\nOutputs to leave out for half of it\n" + table(rows, paint);
  if (!left_out.is_enough) text += "These are not enough.\n";
  const Index needed = left_out.at_least;
  if (left_out.is_enough && needed == std::ssize(left_out.steps)) {
    text += "No fewer do, which is proven.\n";
  } else if (needed > 0) {
    text +=
        fmt::format("At least {} must be left out, which is proven.\n", count(needed, "sample"));
  }
  return text;
}

std::string report_text(const Study& study, const Identified& result,
                        const IdentifyArguments& arguments) {
  const Paint paint(stdout);
  const BoundFactors& found = result.factors;
  std::string text = study.title.empty() ? "" : paint.bold(study.title) + "\n";
  text += fmt::format("{} of {}\n\n", count(static_cast<std::int64_t>(result.trained), "sample"),
                      result.samples);
  if (found.status == Status::none) {
    text +=
        "No factors explain the data: what is not scaled contradicts them, as the solver says.\n";
  } else if (found.status == Status::failed) {
    text += "The solver gave no answer.\n";
  } else {
    text += fmt::format("{}  {:.6g}{}\n\n", arguments.scale == "each" ? "Sum of factors" : "Factor",
                        found.cost, proof_text(found));
    text += bounds_text(study, found, paint);
    text += rest_text(result, arguments.margin);
    if (result.left_out) text += left_out_text(*result.left_out, paint);
  }
  if (result.trade_off.empty()) return text;
  std::vector<std::vector<std::string>> rows{{"FACTOR OF V", "OF W", "PROVEN"}};
  for (const auto& [of_V, W] : result.trade_off) {
    rows.push_back({fmt::format("{:g}", of_V), factor_text(W),
                    W.status == Status::found ? fmt::format("{:.6g}", W.proven) : ""});
  }
  return text + "\nTrade-off\n" + table(rows, paint);
}

/// The least factor of W over that of V.
std::string trade_off_svg(const Study& study, const Identified& result) {
  Curve curve{study.title, "factor of V", "least factor of W", {}, {}};
  for (const auto& [of_V, W] : result.trade_off) {
    curve.x.push_back(of_V);
    curve.y.push_back(W.status == Status::found ? W.cost
                                                : std::numeric_limits<double>::quiet_NaN());
  }
  return svg_of(curve);
}

Json to_json(const BoundFactors& factors) {
  if (factors.status != Status::found)
    return {{"status", factors.status == Status::none ? "none" : "failed"}};
  return {{"status", "found"},
          {"cost", factors.cost},
          {"proven", factors.proven},
          {"required_by", factors.required_by},
          {"W", std::vector<double>(factors.disturbances.begin(), factors.disturbances.end())},
          {"V", std::vector<double>(factors.noises.begin(), factors.noises.end())}};
}

std::string report_json(const Identified& result, const IdentifyArguments& arguments) {
  Json report{{"scale", arguments.scale},
              {"samples", result.samples},
              {"trained", result.trained},
              {"factors", to_json(result.factors)},
              {"all_samples", result.rest ? to_json(*result.rest) : Json(nullptr)}};
  if (result.wider) report["all_samples_with_margin"] = to_json(*result.wider);
  if (result.left_out) {
    Json& left_out = report["left_out"];
    left_out = {{"enough", result.left_out->is_enough},
                {"at_least", result.left_out->at_least},
                {"samples", Json::array()}};
    for (const auto& [k, factors] : result.left_out->steps)
      left_out["samples"].push_back({{"k", k}, {"factors", to_json(factors)}});
  }
  for (const auto& [of_V, W] : result.trade_off)
    report["trade_off"].push_back({{"V", of_V}, {"W", to_json(W)}});
  return json_text(report);
}

/// The study with these bounds, and what is to be added to those that were scaled.
void write_bounds(const Study& study, const BoundFactors& factors,
                  const IdentifyArguments& arguments, std::string remark) {
  if (!arguments.margin.empty()) remark += ", and " + arguments.margin + " is added to them";
  write_identified(study, with_margin(factors, arguments), remark, arguments.write);
  note(fmt::format("Wrote {}", arguments.write.string()));
}

/// With the estimates of a pipeline. `why`: no linear program finds the bounds; empty: it would.
Exit searched(const Study& study, const std::vector<Sample>& samples,
              const IdentifyArguments& arguments, const Registry& registry,
              const std::string& why) {
  const Scaled scaled = scale_from(arguments.scale);
  if (scaled == Scaled::each || arguments.leave_out > 0 || arguments.trade_off ||
      !arguments.figure.empty()) {
    throw Error(Errc::invalid,
                "--scale each, --leave-out, --trade-off and --figure need a linear program, and "
                "there is none: " +
                    (why.empty() ? "a pipeline was named" : why));
  }
  const std::vector<const PipelineSpec*> all = pipelines_called(study, arguments.pipeline);
  const auto with_observer =
      std::ranges::find_if(all, [](const PipelineSpec* one) { return one->estimation(); });
  if (with_observer == all.end()) {
    throw Error(Errc::invalid,
                "bounds are sought with the estimates of a pipeline, and there is "
                "none with an observer; " +
                    why);
  }
  const BoundSearch search{
      study,  **with_observer,     registry, trained_part(samples, arguments.train), samples,
      scaled, margin_of(arguments)};
  const std::atomic<bool>* const stop = stop_on_signals();
  const SearchedBounds found = search_bounds(search, [stop] { return stop->load(); });
  if (arguments.json) {
    print(json_of(found, search));
  } else {
    const Paint paint(stdout);
    print((study.title.empty() ? "" : paint.bold(study.title) + "\n") +
          fmt::format("{} of {}\n\n",
                      count(static_cast<std::int64_t>(search.samples.size()), "sample"),
                      samples.size()) +
          text_of(found, search));
  }
  if (found.kept == infinity) return Exit::unanswered;
  if (!arguments.write.empty()) {
    write_bounds(study, factors_of(found, search), arguments,
                 fmt::format("W and V leave estimates of {} of {} samples", search.samples.size(),
                             samples.size()));
  }
  return Exit::done;
}

Exit identify(const Program& program, const IdentifyArguments& arguments) {
  check(arguments);
  Registry registry;
  registry.load({program.plugins});
  const Study study =
      read_study(arguments.study, registry, default_search_path(), program.study_plugins());
  for (const std::string& warning : study.warnings) warn(warning);
  if (!study.modes.empty())
    warn("data are taken for those of \"" + study.nominal +
         "\": where a fault is in them, its bounds are no bounds of disturbances");
  if (!arguments.write.empty()) require_writable(study);
  const std::vector<Sample> samples = samples_of(study);
  if (samples.empty()) {
    throw Error(
        Errc::invalid,
        "the data hold no sample: bounds are identified from recorded or simulated outputs");
  }
  const std::string why = why_not_identified(study.model);
  if (!why.empty() || !arguments.pipeline.empty())
    return searched(study, samples, arguments, registry, why);
  const Identified result = identified(study, samples, arguments);
  print(arguments.json ? report_json(result, arguments) : report_text(study, result, arguments));
  if (!arguments.figure.empty()) {
    write_new_file(arguments.figure, trade_off_svg(study, result));
    note(fmt::format("Wrote {}", arguments.figure.string()));
  }
  if (result.factors.status != Status::found) return Exit::unanswered;
  if (!arguments.write.empty()) {
    write_bounds(study, result.factors, arguments,
                 fmt::format("W and V explain {} of {} samples", result.trained, result.samples));
  }
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(identify) {
  CLI::App* command = app.add_subcommand(
      "identify", "Find the smallest bounds of disturbances and noise that explain data");
  const auto arguments = std::make_shared<IdentifyArguments>();
  command->add_option("STUDY", arguments->study, "Study file (JSON)")->required()->option_text(" ");
  command
      ->add_option("--scale", arguments->scale,
                   "What is scaled: W and V by one factor (both), W, V, or each generator of both, "
                   "their sum being least")
      ->option_text("both|W|V|each");
  command
      ->add_option("--train", arguments->train,
                   "Take the bounds from this first part of the samples, and try them on all")
      ->option_text("70%");
  command
      ->add_option("--leave-out", arguments->leave_out,
                   "Look for samples without which half of the factor does, so many at most")
      ->check(CLI::Range(1, 1000))
      ->option_text("N");
  command->add_flag("--trade-off", arguments->trade_off,
                    "The least factor of W for several factors of V, too");
  command->add_option("--figure", arguments->figure, "Draw the trade-off into a new SVG file")
      ->option_text("FILE");
  command
      ->add_option("--write", arguments->write, "Write the study with these bounds to a new file")
      ->option_text("FILE");
  command
      ->add_option(
          "--margin", arguments->margin,
          "Write bounds that are wider by this share, for what the samples have not shown; with "
          "--train these are tried on all samples, too")
      ->option_text("20%");
  command
      ->add_option("--pipeline", arguments->pipeline,
                   "Search with the estimates of this pipeline. Without it the first one is taken "
                   "where the system is no linear one with known matrices")
      ->option_text("NAME");
  command->add_flag("--json", arguments->json, "Print JSON for programs instead of tables");
  command->footer(
      "Generators of W and V are scaled around their centres; the system, X0 and what is not "
      "scaled "
      "are taken as they\nare. \"proven\" is a bound in rational arithmetic: no smaller factor "
      "explains the outputs named. The exit code is 5\nwhere no factor was found.");
  command->callback([&program, arguments] { program.exit = identify(program, *arguments); });
}

}  // namespace cordon::apps
