// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial.hpp"

#include <alloca.h>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <malloc.h>
#include <map>
#include <new>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>

namespace cordon::registry {

namespace {

using Clock = std::chrono::steady_clock;

constexpr rlim_t computing_s = 5;
constexpr std::chrono::seconds waiting(30);
constexpr rlim_t most_memory = rlim_t{1} << 30;  // beyond what the process has already
constexpr std::size_t most_said = 4096;          // bytes of its output
constexpr const char* suggestion = "repair or remove it; it is tried again when the file changes";

/// The settings that all floating-point operations of a process depend on.
struct Arithmetic {
  bool subnormals;
  int rounding, traps;
  friend bool operator==(const Arithmetic&, const Arithmetic&) = default;
};
Arithmetic arithmetic() {
  volatile double smallest = std::numeric_limits<double>::min(),
                  subnormal = std::numeric_limits<double>::denorm_min();
  volatile double half = smallest / 2,
                  twice = subnormal * 2;  // flushed as a result, or taken for zero as an operand
  return {half != 0 && twice != 0, std::fegetround(), fegetexcept()};
}

/// Written by the child, read by the parent.
struct Message {
  volatile bool finished, refused, same_arithmetic, subnormals;
  char reason[1024], fix[256];  ///< where refused
};

template <std::size_t size>
void put(char (&text)[size], const std::string& words) {
  const std::size_t count = std::min(words.size(), size - 1);
  std::memcpy(text, words.data(), count);
  text[count] = '\0';
}
/// The process that wrote it may have been damaged.
template <std::size_t size>
std::string words_of(const char (&text)[size]) {
  return {text, strnlen(text, size)};
}

/// Memory and a file without a name that both processes share.
class Shared {
 public:
  Shared() : output_(memfd_create("cordon", MFD_ALLOW_SEALING | MFD_CLOEXEC)) {
    void* const page =
        mmap(nullptr, sizeof(Message), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    message_ = page == MAP_FAILED ? nullptr : new (page) Message{};
    // a process that prints without end fills this much and no more
    good_ = message_ && output_ >= 0 && ftruncate(output_, most_said) == 0 &&
            fcntl(output_, F_ADD_SEALS, F_SEAL_GROW) == 0;
  }
  ~Shared() {
    if (message_) munmap(message_, sizeof(Message));
    if (output_ >= 0) close(output_);
  }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;

  bool is_good() const { return good_; }
  Message& message() const { return *message_; }
  int output() const { return output_; }
  /// The beginning of what was printed, in one line.
  std::string said() const {
    char bytes[most_said];
    const ssize_t count = pread(output_, bytes, sizeof bytes, 0);
    std::string text;
    for (ssize_t i = 0; i < count && bytes[i] != '\0' && text.size() < 240; ++i) {
      const auto byte = static_cast<unsigned char>(bytes[i]);
      if (byte > 0x20 && byte < 0x7f) text += bytes[i];
      if (byte <= 0x20 && !text.empty() && text.back() != ' ') text += ' ';
    }
    return text.empty() ? "" : fmt::format("; it said: {}", text);
  }

 private:
  int output_;
  Message* message_ = nullptr;
  bool good_ = false;
};

/// Pages of address space that this process has.
rlim_t address_space() {
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  unsigned long pages = 0;
  const bool read = file && std::fscanf(file, "%lu", &pages) == 1;
  if (file) std::fclose(file);
  return read ? static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) : 0;
}

void limit(decltype(RLIMIT_CPU) what, rlim_t soft, rlim_t hard) {
  rlimit now{};
  if (getrlimit(what, &now) != 0) return;
  const rlimit less{std::min(soft, now.rlim_max), std::min(hard, now.rlim_max)};
  setrlimit(what, &less);
}

/// Else the plugin would catch std::bad_alloc here, and take the memory from the process that
/// asks.
[[noreturn]] void out_of_memory() {
  constexpr char text[] = "out of memory: more than 1 GiB";
  [[maybe_unused]] const ssize_t count = write(STDERR_FILENO, text, sizeof text - 1);
  _exit(1);
}

/// Neither null nor an address.
constexpr unsigned char poison = 0xa5;

/// Uses what damaged code likes to write over: the environment, the heap, the stack, the tables for
/// exceptions. Whoever finds it damaged crashes here.
void use_everything() {
  std::size_t size = 0;
  for (char** variable = environ; variable && *variable; ++variable) {
    const std::string text = *variable;
    if (std::getenv(text.substr(0, text.find('=')).c_str())) size += text.size();
  }
  std::map<std::size_t, std::vector<std::string>> kept;
  for (std::size_t i = 0; i < 200; ++i) kept[(37 * i) % 101].emplace_back((53 * i) % 4099, 'x');
  try {
    throw std::runtime_error(std::to_string(size));
  } catch (const std::exception& error) {
    kept[0].emplace_back(error.what());
  }
}

[[noreturn]] void be_the_child(const Shared& shared, pid_t parent, const TrialBody& body) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  limit(RLIMIT_CORE, 0, 0);
  std::signal(SIGXCPU, SIG_DFL);
  limit(RLIMIT_CPU, computing_s, computing_s + 1);
  if (const rlim_t now = address_space(); now > 0)
    limit(RLIMIT_AS, now + most_memory, now + most_memory);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(shared.output(), STDOUT_FILENO);
  dup2(shared.output(), STDERR_FILENO);
  std::set_new_handler(out_of_memory);
  mallopt(M_PERTURB, poison);  // new memory is filled with its complement, freed one with it
  const Arithmetic before = arithmetic();
  const std::optional<Refusal> refusal = body();
  use_everything();
  const Arithmetic after = arithmetic();
  Message& message = shared.message();
  if (refusal) {
    put(message.reason, refusal->reason);
    put(message.fix, refusal->fix);
    message.refused = true;
  }
  message.same_arithmetic = before == after;
  message.subnormals = after.subnormals || !before.subnormals;
  message.finished = true;
  _exit(0);
}

/// False: killed after the time was over. `status` is that of waitpid.
bool wait_for(pid_t child, int& status) {
  const Clock::time_point end = Clock::now() + waiting;
  for (useconds_t nap = 100;; nap = std::min<useconds_t>(2 * nap, 5000)) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child || (ended < 0 && errno != EINTR))
      return true;  // also where children are not waited for: SIGCHLD ignored
    if (Clock::now() > end) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return false;
    }
    usleep(nap);
  }
}

std::string ending(int status) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    return fmt::format("it does not come back from being opened: stopped after {} s of computing",
                       computing_s);
  if (WIFSIGNALED(status))
    return fmt::format("it ends the process when it is opened: signal {} ({})", WTERMSIG(status),
                       strsignal(WTERMSIG(status)));
  return fmt::format("it ends the process when it is opened: exit code {}", WEXITSTATUS(status));
}

std::optional<Refusal> judge(const Message& message) {
  if (message.refused) return Refusal{words_of(message.reason), words_of(message.fix)};
  if (message.same_arithmetic) return {};
  const char* what =
      message.subnormals ? "its rounding or its traps" : "subnormal numbers become zero";
  return Refusal{
      fmt::format(
          "it changes the floating-point arithmetic of the whole process when it is opened: {}",
          what),
      message.subnormals
          ? "leave the floating-point environment alone"
          : "compile and link it without -ffast-math, -Ofast and -funsafe-math-optimizations"};
}

[[gnu::noinline]] void poison_stack() {
  volatile unsigned char below[std::size_t{1} << 17];
  for (volatile unsigned char& byte : below) byte = poison;
}

[[gnu::noinline]] void at_depth(std::size_t bytes, const std::function<void()>& work) {
  volatile unsigned char* const taken = static_cast<unsigned char*>(alloca(bytes));
  taken[0] = poison;
  poison_stack();
  work();
}

}  // namespace

void at_several_depths(const std::function<void()>& work) {
  std::vector<std::vector<char>> taken;
  for (const std::size_t bytes : {16u, 96u, 400u, 1'232u, 5'024u, 20'496u, 70'000u, 200'000u}) {
    at_depth(bytes, work);
    taken.emplace_back(bytes, 'x');
  }
}

Trial try_in_child(const TrialBody& body) {
  const Shared shared;
  std::fflush(nullptr);  // else the child might write again what waits in buffers
  const pid_t parent = getpid(), child = shared.is_good() ? fork() : -1;
  if (child < 0) {
    const std::string why = std::strerror(errno);
    return {
        Refusal{"it cannot be tried in a process of its own: " + why, "free memory and processes"},
        false};
  }
  if (child == 0) be_the_child(shared, parent, body);
  int status = 0;
  if (!wait_for(child, status)) {
    return {Refusal{fmt::format("it does not come back from being opened within {} s{}",
                                waiting.count(), shared.said()),
                    suggestion}};
  }
  const Message& message = shared.message();
  if (!message.finished) return {Refusal{ending(status) + shared.said(), suggestion}};
  return {judge(message), !message.refused};
}

}  // namespace cordon::registry
