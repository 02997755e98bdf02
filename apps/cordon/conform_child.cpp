// SPDX-License-Identifier: GPL-3.0-or-later
// Pipes and signals of a child process that sends messages.
#include "conform_child.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

}  // namespace

void send(int fd, const Json& message) {
  const std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(fd, text.data() + sent, text.size() - sent);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) _exit(1);  // the parent has gone
    sent += static_cast<std::size_t>(count);
  }
}

Child::Child(const std::function<void(int fd)>& body) {
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

Child::~Child() {
  close(fd_);
  if (pid_ > 0) finish();
}

Child::Event Child::wait(double timeout_s, Json& message) {
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

std::string Child::finish() {
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

void Child::kill_now() {
  kill(pid_, SIGKILL);
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
}

std::string current_text() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

}  // namespace cordon::apps
