// SPDX-License-Identifier: GPL-3.0-or-later
// Laws run in a child process, whose messages become reports.
#include "conform_worker.hpp"

#include <chrono>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "conform_child.hpp"
#include "conform_component.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;
using conformance::Result;
using Clock = std::chrono::steady_clock;

Json as_json(const Result& r) {
  return {{"law", r.law},
          {"status", static_cast<int>(r.status)},
          {"reason", r.reason},
          {"cases", r.cases},
          {"unsupported", r.unsupported},
          {"inapplicable", r.inapplicable},
          {"questions", r.questions},
          {"unknown", r.unknown},
          {"witness", r.witness},
          {"replay", r.replay}};
}

Result result_from(const Json& json) {
  Result r;
  r.law = json.at("law");
  r.status = static_cast<conformance::Status>(json.at("status").get<int>());
  r.reason = json.at("reason");
  r.cases = json.at("cases");
  r.unsupported = json.at("unsupported");
  r.inapplicable = json.at("inapplicable");
  r.questions = json.at("questions");
  r.unknown = json.at("unknown");
  r.witness = json.at("witness");
  r.replay = json.at("replay");
  return r;
}

using Tell = std::function<void(const Json& message)>;

/// A backend of the library alone: a registry for each, so that between two laws nothing of the
/// plugin is left.
void offer_backend(const Tell& tell, const ConformRequest& request, conformance::Subject& subject) {
  Registry registry;
  load_only(registry, request.library);
  const std::string& name = request.candidate.component;
  subject.params =
      params_from(request.candidate.params, registry.info("backend", name)->schema, true);
  tell({{"unbounded", registry.make<BackendEntry>(name, subject.params)->info().unbounded}});
  subject.make = [&request](const Params& params) {
    Registry own;
    load_only(own, request.library);
    return own.make<BackendEntry>(request.candidate.component, params);
  };
}

/// A component of another kind, with what there is on the search path beside it.
void offer_component(const ConformRequest& request, conformance::Subject& subject) {
  const auto registry = std::make_shared<Registry>();
  load_only(*registry, request.library);
  registry->load(request.others);
  subject.params = params_from(
      request.candidate.params,
      registry->info(request.candidate.kind, request.candidate.component)->schema, false);
  subject.registry = registry;
}

/// The laws from `first` on; results, progress and what goes wrong are told as messages.
void check_laws(const Tell& tell, const ConformRequest& request,
                const std::vector<std::string>& laws, std::size_t first) {
  conformance::Subject subject;
  ParamSchema schema;
  subject.kind = request.candidate.kind;
  subject.component = request.candidate.component;
  subject.library = request.library;
  subject.command = request.command;
  try {
    Registry registry;
    load_only(registry, request.library);
    schema = registry.info(subject.kind, subject.component)->schema;
    if (subject.kind == BackendEntry::kind) {
      offer_backend(tell, request, subject);
    } else {
      offer_component(request, subject);
    }
  } catch (...) {
    tell({{"broken", current_text()}});
    return;
  }
  subject.schema = &schema;
  const auto progress = [&](const conformance::Law&, Index number, Index) {
    tell({{"case", number}});
  };
  for (std::size_t k = first; k < laws.size(); ++k) {
    tell({{"start", k}});
    try {
      tell({{"result", as_json(conformance::check(subject, laws[k], request.options, progress))}});
    } catch (...) {
      tell({{"broken", current_text()}});
    }
  }
}

/// A law that did not come to its end.
LawReport lost(const ConformRequest& request, const std::string& law, Index number, bool unbounded,
               LawReport::State state, const std::string& how) {
  LawReport report;
  report.state = state;
  Result& r = report.result;
  r.law = law;
  r.status = conformance::Status::failed;
  if (number < 0) {
    r.reason = how + " while the " + request.candidate.kind + " was made";
  } else {
    r.reason = how + fmt::format(" in case {}", number);
    r.cases = number + 1;
    BackendInfo info;
    info.unbounded = unbounded;
    r.witness = conformance::describe_case(law, request.options, info, number);
  }
  r.replay = fmt::format("{} --law {} --seed {} --cases {}", request.command, law,
                         request.options.seed, request.options.cases);
  return report;
}

std::vector<std::string> wanted_laws(const ConformRequest& request) {
  std::vector<std::string> laws;
  for (const conformance::Law& law : conformance::laws()) {
    if (law.kind == request.candidate.kind && conformance::matches(request.options.laws, law.name))
      laws.push_back(law.name);
  }
  return laws;
}

/// Makes reports of the messages about laws.
class Reports {
 public:
  Reports(const ConformRequest& request, const LawProgress& progress)
      : request_(request), laws_(wanted_laws(request)), progress_(progress) {
    progress_(0, laws_.size());
  }

  const std::vector<std::string>& laws() const { return laws_; }
  std::size_t size() const { return reports_.size(); }
  bool complete() const { return reports_.size() == laws_.size(); }
  std::vector<LawReport> take() { return std::move(reports_); }

  void begin() { number_ = -1, begin_ = Clock::now(); }
  void take_in(const Json& message) {
    if (message.contains("unbounded")) unbounded_ = message.at("unbounded");
    if (message.contains("start")) begin();
    if (message.contains("case")) number_ = message.at("case");
    if (message.contains("result")) {
      LawReport report{{}, result_from(message.at("result")), 0};
      report.state = static_cast<LawReport::State>(report.result.status);
      add(std::move(report));
    }
    if (message.contains("broken"))
      lose(LawReport::State::crashed, "an exception: " + message.at("broken").get<std::string>());
  }
  /// The law that is being checked does not come to its end.
  void lose(LawReport::State state, const std::string& how) {
    if (!complete()) add(lost(request_, laws_[reports_.size()], number_, unbounded_, state, how));
  }

 private:
  void add(LawReport report) {
    report.seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    reports_.push_back(std::move(report));
    progress_(reports_.size(), laws_.size());
  }

  const ConformRequest& request_;
  const std::vector<std::string> laws_;
  const LawProgress& progress_;
  std::vector<LawReport> reports_;
  Index number_ = -1;
  bool unbounded_ = false;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace

std::string_view to_string(LawReport::State state) noexcept {
  switch (state) {
    case LawReport::State::passed:
      return "passed";
    case LawReport::State::failed:
      return "failed";
    case LawReport::State::skipped:
      return "skipped";
    case LawReport::State::crashed:
      return "crashed";
    case LawReport::State::timed_out:
      return "timed_out";
  }
  return "";
}

std::vector<LawReport> check_in_child(const ConformRequest& request, const LawProgress& progress) {
  Reports reports(request, progress);
  while (!reports.complete()) {
    reports.begin();
    Child child([&](int fd) {
      check_laws([&](const Json& message) { send(fd, message); }, request, reports.laws(),
                 reports.size());
    });
    for (bool alive = true; alive && !reports.complete();) {
      Json message;
      switch (child.wait(request.timeout_s, message)) {
        case Child::Event::message:
          reports.take_in(message);
          break;
        case Child::Event::ended: {
          const std::string how = child.finish();
          reports.lose(LawReport::State::crashed,
                       "the process ended by " + (how.empty() ? "exit code 0" : how));
          alive = false;
          break;
        }
        case Child::Event::timeout:
          child.kill_now();
          reports.lose(LawReport::State::timed_out,
                       fmt::format("no answer within {} s", request.timeout_s));
          alive = false;
          break;
      }
    }
  }
  return reports.take();
}

std::vector<LawReport> check_in_process(const ConformRequest& request,
                                        const LawProgress& progress) {
  Reports reports(request, progress);
  check_laws([&](const Json& message) { reports.take_in(message); }, request, reports.laws(), 0);
  while (!reports.complete())
    reports.lose(LawReport::State::crashed, "the component could not be made again");
  return reports.take();
}

}  // namespace cordon::apps
