// SPDX-License-Identifier: GPL-3.0-or-later
// MAT-files as bytes and as files: written to memory, read in a process of its own.
#include "experiments/interchange/mat_file.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <malloc.h>
#include <optional>
#include <string_view>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "cordon/core/error.hpp"
#include "experiments/interchange/mat_wire.hpp"
#include "mat_libmatio.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CORDON_SANITIZED  // sanitizers reserve more addresses than any limit allows
#endif

namespace cordon::mat {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, int reason) {
  throw Error(Errc::io, what + ": " + std::strerror(reason));
}

/// A descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }
  void close() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }

 private:
  int descriptor_;
};

std::string bytes_of(int descriptor) {
  std::string bytes;
  std::string part(1 << 20, '\0');
  for (off_t at = 0;;) {
    const ssize_t got = ::pread(descriptor, part.data(), part.size(), at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("cannot make the MAT-file", errno);
    if (got == 0) return bytes;
    bytes.append(part, 0, static_cast<std::size_t>(got));
    at += got;
  }
}

void send(int descriptor, const std::string& bytes) {
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) _exit(2);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

void limit(int resource, rlim_t most) {
  const rlimit both{most, most};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

/// There are damaged files that libmatio reads for ever, or takes any memory for.
void limit_this_process(const char* path) {
  const int nowhere =
      ::open("/dev/null", O_RDWR);  // libraries below print what they think of damaged files
  if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO), ::dup2(nowhere, STDOUT_FILENO);
  limit(RLIMIT_CORE, 0);
  ::mallopt(
      M_PERTURB,
      0xFF);  // memory begins as zeros: what libmatio leaves unread shows nothing of this process
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  limit(RLIMIT_CPU, 3 + (error ? rlim_t{0} : static_cast<rlim_t>(bytes >> 22)));  // seconds
#ifndef CORDON_SANITIZED
  limit(RLIMIT_DATA, rlim_t{3} << 29);
#endif
}

/// What the child does: one byte, then the variables or the reason why there are none.
[[noreturn]] void read_in_child(const char* path, int out) {
  limit_this_process(path);
  std::string answer;
  try {
    answer = "+" + to_wire(read_variables(path));
  } catch (const std::exception& error) {
    answer = std::string("-") + error.what();
  }
  send(out, answer);
  _exit(0);
}

/// All that comes until the other end is closed; nothing if that is more than the limits of a file
/// can make.
std::optional<std::string> receive(int descriptor) {
  constexpr std::size_t most = std::size_t{1} << 30;
  std::string bytes;
  std::string part(1 << 16, '\0');
  for (;;) {
    const ssize_t got = ::read(descriptor, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("cannot read the MAT-file", errno);
    if (got == 0) return bytes;
    bytes.append(part, 0, static_cast<std::size_t>(got));
    if (bytes.size() > most) return std::nullopt;
  }
}

[[noreturn]] void refuse(const fs::path& file, const std::string& message,
                         const std::string& suggestion) {
  throw InputError(file.string(), {{"", message, suggestion}});
}

/// Only versions that say what they are: libmatio takes everything else for version 4.
void check_header(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) refuse(file, "there is no such file", "");
  if (!fs::is_regular_file(status)) refuse(file, "is not a regular file", "name a MAT-file");
  std::ifstream stream(file, std::ios::binary);
  std::string header(128, '\0');
  stream.read(header.data(), static_cast<std::streamsize>(header.size()));
  if (!stream)
    refuse(file, "is too short for a MAT-file", "save it in MATLAB with save(name, '-v7')");
  const std::string version = header.substr(124, 4);
  const std::string known[] = {{'\0', '\1', 'I', 'M'},
                               {'\1', '\0', 'M', 'I'},
                               {'\0', '\2', 'I', 'M'},
                               {'\2', '\0', 'M', 'I'}};
  if (std::find(std::begin(known), std::end(known), version) != std::end(known)) return;
  refuse(file, "is no MAT-file of version 5 or later",
         "save it in MATLAB with save(name, '-v7'), in Octave with save -v7");
}

}  // namespace

std::string to_bytes(const Variables& variables) {
  const Descriptor memory(::memfd_create("cordon-mat", MFD_CLOEXEC));
  if (memory.get() < 0) fail("cannot make the MAT-file", errno);
  const std::string path = "/proc/self/fd/" + std::to_string(memory.get());
  write_variables(path.c_str(), variables);
  return bytes_of(memory.get());
}

Variables read_file(const fs::path& file) {
  check_header(file);
  const std::string path = file.string();
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail("cannot read " + path, errno);
  Descriptor in(ends[0]), out(ends[1]);
  const pid_t child = ::fork();
  if (child < 0) fail("cannot read " + path, errno);
  if (child == 0) read_in_child(path.c_str(), out.get());
  out.close();
  const std::optional<std::string> answer = receive(in.get());
  if (!answer) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (ended && answer && answer->starts_with('-'))
    refuse(file, answer->substr(1), "save it again with save(name, '-v7')");
  auto variables = ended && answer && answer->starts_with('+')
                       ? from_wire(std::string_view(*answer).substr(1))
                       : std::nullopt;
  if (!variables)
    refuse(file, "is damaged: libmatio broke down on it", "save it again with save(name, '-v7')");
  return std::move(*variables);
}

}  // namespace cordon::mat
