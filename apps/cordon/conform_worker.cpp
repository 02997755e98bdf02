// SPDX-License-Identifier: GPL-3.0-or-later
#include "conform_worker.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;
using conformance::Result;
using Clock = std::chrono::steady_clock;

/// One line of JSON per message.
void send(int fd, const Json& message) {
  const std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(fd, text.data() + sent, text.size() - sent);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) _exit(1);  // the parent has gone
    sent += static_cast<std::size_t>(count);
  }
}

/// A child process that sends messages. Destroying it ends the process.
class Child {
 public:
  explicit Child(const std::function<void(int fd)>& body) {
    int ends[2];
    if (pipe(ends) != 0)
      throw Error(Errc::io, fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    std::fflush(nullptr);
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ < 0)
      throw Error(Errc::io, fmt::format("cannot start a process: {}", std::strerror(errno)));
    if (pid_ == 0) {
      close(ends[0]);
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) _exit(1);
      const rlimit none{0, 0};
      setrlimit(RLIMIT_CORE, &none);
      dup2(STDERR_FILENO, STDOUT_FILENO);  // what a plugin prints is no part of the report
      body(ends[1]);
      std::fflush(nullptr);
      _exit(0);
    }
    close(ends[1]);
    fd_ = ends[0];
  }
  ~Child() {
    close(fd_);
    if (pid_ > 0) finish();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  enum class Event { message, ended, timeout };
  Event wait(double timeout_s, Json& message) {
    const Clock::time_point end =
        Clock::now() + std::chrono::milliseconds(static_cast<std::int64_t>(1000 * timeout_s));
    for (;;) {
      if (const std::size_t line = buffer_.find('\n'); line != std::string::npos) {
        message = Json::parse(buffer_.substr(0, line));
        buffer_.erase(0, line + 1);
        return Event::message;
      }
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
      if (left <= 0) return Event::timeout;
      pollfd watched{fd_, POLLIN, 0};
      if (poll(&watched, 1, static_cast<int>(left)) <= 0) continue;
      char chunk[4096];
      const ssize_t count = read(fd_, chunk, sizeof chunk);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return Event::ended;
      buffer_.append(chunk, static_cast<std::size_t>(count));
    }
  }

  /// Ends the process and says how it ended; "" if it ended by itself with code 0.
  std::string finish() {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == 0) {
      // its end of the pipe is closed, so it is ending; a hanging one is killed
      for (int i = 0; i < 200 && waitpid(pid_, &status, WNOHANG) == 0; ++i) usleep(5000);
      if (kill(pid_, 0) == 0) {
        kill(pid_, SIGKILL);
        waitpid(pid_, &status, 0);
      }
    }
    pid_ = -1;
    if (WIFSIGNALED(status))
      return fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    if (WIFEXITED(status) && WEXITSTATUS(status) != 0)
      return fmt::format("exit code {}", WEXITSTATUS(status));
    return "";
  }
  void kill_now() {
    kill(pid_, SIGKILL);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
  }

 private:
  pid_t pid_ = -1;
  int fd_ = -1;
  std::string buffer_;
};

/// The text of an exception; call in a catch block.
std::string current_text() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

[[noreturn]] void wrong_param(const std::string& name, const std::string& expected) {
  throw Error(Errc::invalid, fmt::format("--params: \"{}\" must be {}", name, expected));
}

Vector vector_from(const Json& json, const std::string& name) {
  if (!json.is_array()) wrong_param(name, "an array of numbers");
  Vector x(static_cast<Index>(json.size()));
  for (std::size_t i = 0; i < json.size(); ++i) {
    if (!json[i].is_number()) wrong_param(name, "an array of numbers");
    x[static_cast<Index>(i)] = json[i].get<double>();
  }
  return x;
}

Params::Value value_from(const Json& json, const ParamSpec& spec) {
  switch (spec.kind) {
    case ParamKind::integer:
      if (!json.is_number_integer()) wrong_param(spec.name, "an integer");
      return json.get<std::int64_t>();
    case ParamKind::real:
      if (!json.is_number()) wrong_param(spec.name, "a number");
      return json.get<double>();
    case ParamKind::flag:
      if (!json.is_boolean()) wrong_param(spec.name, "true or false");
      return json.get<bool>();
    case ParamKind::choice:
    case ParamKind::text:
      if (!json.is_string()) wrong_param(spec.name, "a text");
      return json.get<std::string>();
    case ParamKind::vector:
      return vector_from(json, spec.name);
    case ParamKind::matrix: {
      if (!json.is_array() || json.empty()) wrong_param(spec.name, "an array of rows");
      const Vector first = vector_from(json[0], spec.name);
      Matrix A(static_cast<Index>(json.size()), first.size());
      for (std::size_t i = 0; i < json.size(); ++i) {
        const Vector row = vector_from(json[i], spec.name);
        if (row.size() != first.size())
          wrong_param(spec.name, "an array of rows of the same length");
        A.row(static_cast<Index>(i)) = row.transpose();
      }
      return A;
    }
    case ParamKind::set:
    case ParamKind::matrices:
    case ParamKind::component:
      break;
  }
  throw Error(Errc::invalid, fmt::format("--params: \"{}\" is a {}, which cannot be given here",
                                         spec.name, to_string(spec.kind)));
}

/// Throws InputError or Errc::invalid for parameters that do not fit the schema.
Params params_from(const std::string& text, const ParamSchema& schema) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    throw Error(Errc::invalid, fmt::format("--params is no JSON: {}", error.what()));
  }
  if (!json.is_object())
    throw Error(Errc::invalid,
                "--params must be a JSON object, such as '{\"rounding\": \"outward\"}'");
  Params params;
  for (const auto& [name, value] : json.items()) {
    const ParamSpec* spec = schema.find(name);
    if (!spec) {
      throw Error(Errc::invalid, fmt::format("--params: the backend has no parameter \"{}\"; {}",
                                             name, suggest(name, schema.names())));
    }
    params.set(name, value_from(value, *spec));
  }
  if (const auto problems = schema.complete(params); !problems.empty())
    throw InputError("--params", problems);
  return params;
}

/// Loads the one library; throws Errc::plugin with the reason if it is refused.
void load_only(Registry& registry, const std::filesystem::path& library) {
  const PluginReport& report = registry.load_file(library);
  if (report.state == PluginReport::State::loaded) return;
  throw Error(Errc::plugin,
              fmt::format("{} was refused: {}; {}", library.string(), report.reason, report.fix));
}

/// The ways of rounding that a backend offers, unless the parameters choose one.
std::vector<std::string> roundings(const ParamSchema& schema, const Json& params) {
  const ParamSpec* spec = schema.find("rounding");
  if (!spec || spec->kind != ParamKind::choice || params.contains("rounding")) return {};
  return spec->choices;
}

void discover_in_child(int fd, const std::filesystem::path& library, const std::string& backend,
                       const std::string& params) {
  try {
    Registry registry;
    load_only(registry, library);
    const PluginReport& report = registry.reports().back();
    Json message{
        {"plugin", report.name}, {"version", report.version}, {"candidates", Json::array()}};
    std::vector<std::string> names = registry.backends();
    if (!backend.empty()) {
      if (!registry.backend_info(backend)) {
        const std::string suggestion = names.empty() ? "it has none" : suggest(backend, names);
        throw Error(Errc::invalid, fmt::format("{} has no backend \"{}\"; {}", library.string(),
                                               backend, suggestion));
      }
      names = {backend};
    }
    for (const std::string& name : names) {
      const ParamSchema& schema = registry.backend_info(name)->schema;
      params_from(params, schema);
      const Json given = Json::parse(params);
      const auto choices = roundings(schema, given);
      if (choices.empty())
        message["candidates"].push_back({{"backend", name}, {"params", given.dump()}});
      for (const std::string& choice : choices) {
        Json chosen = given;
        chosen["rounding"] = choice;
        message["candidates"].push_back({{"backend", name}, {"params", chosen.dump()}});
      }
    }
    send(fd, message);
  } catch (const Error& error) {
    send(fd, {{"problem", error.what()}, {"invalid", error.code() != Errc::plugin}});
  } catch (...) {
    send(fd, {{"problem", current_text()}, {"invalid", false}});
  }
}

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

/// The laws from `first` on; results, progress and what goes wrong are told as messages.
void check_laws(const Tell& tell, const ConformRequest& request,
                const std::vector<std::string>& laws, std::size_t first) {
  conformance::Subject subject;
  ParamSchema schema;
  const std::string backend = request.candidate.backend;
  try {
    Registry registry;
    load_only(registry, request.library);
    schema = registry.backend_info(backend)->schema;
    subject.params = params_from(request.candidate.params, schema);
    tell({{"unbounded", registry.make_backend(backend, subject.params)->info().unbounded}});
  } catch (...) {
    tell({{"broken", current_text()}});
    return;
  }
  subject.schema = &schema;
  subject.library = request.library;
  subject.component = backend;
  subject.command = request.command;
  // a registry for each: between two laws nothing of the plugin is left
  subject.make = [&](const Params& params) {
    Registry registry;
    load_only(registry, request.library);
    return registry.make_backend(backend, params);
  };
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
    r.reason = how + " while the backend was made";
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

Discovery discover(const std::filesystem::path& library, const std::string& backend,
                   const std::string& params) {
  Child child([&](int fd) { discover_in_child(fd, library, backend, params); });
  Discovery found;
  Json message;
  switch (child.wait(60, message)) {
    case Child::Event::timeout:
      child.kill_now();
      found.problem =
          fmt::format("{} does not come back from being loaded within 60 s", library.string());
      return found;
    case Child::Event::ended: {
      const std::string how = child.finish();
      found.problem = fmt::format("{} ends the process while it is loaded: {}", library.string(),
                                  how.empty() ? "exit code 0" : how);
      return found;
    }
    case Child::Event::message:
      break;
  }
  if (message.contains("problem")) {
    found.problem = message.at("problem");
    found.invalid = message.at("invalid");
    return found;
  }
  found.plugin = message.at("plugin");
  found.version = message.at("version");
  for (const Json& entry : message.at("candidates"))
    found.candidates.push_back({entry.at("backend"), entry.at("params")});
  return found;
}

std::string problem_of_making(const std::filesystem::path& library, const Candidate& candidate) {
  Child child([&](int fd) {
    std::string problem;
    try {
      Registry registry;
      load_only(registry, library);
      registry.make_backend(
          candidate.backend,
          params_from(candidate.params, registry.backend_info(candidate.backend)->schema));
    } catch (...) {
      problem = current_text();
    }
    send(fd, {{"problem", problem}});
  });
  Json message;
  switch (child.wait(60, message)) {
    case Child::Event::message:
      return message.at("problem");
    case Child::Event::timeout:
      child.kill_now();
      return "making it does not end within 60 s";
    case Child::Event::ended:
      break;
  }
  const std::string how = child.finish();
  return "making it ends the process: " + (how.empty() ? "exit code 0" : how);
}

namespace {

std::vector<std::string> wanted_laws(const ConformRequest& request) {
  std::vector<std::string> laws;
  for (const conformance::Law& law : conformance::laws()) {
    if (conformance::matches(request.options.laws, law.name)) laws.push_back(law.name);
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
    reports.lose(LawReport::State::crashed, "the backend could not be made again");
  return reports.take();
}

}  // namespace cordon::apps
