// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/pdf.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::report {

namespace {

constexpr const char* converter = "rsvg-convert";

[[noreturn]] void refuse(const std::string& reason) { throw Error(Errc::io, "no PDF: " + reason); }

/// Runs the converter and waits for its end; returns its exit code.
int run(const std::string& from, const std::string& to) {
  std::array<std::string, 5> words{converter, "--format=pdf", "--unlimited", "--output=" + to,
                                   from};
  std::array<char*, 6> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
  pid_t child = 0;
  const int failed = posix_spawnp(&child, converter, nullptr, nullptr, arguments.data(), environ);
  if (failed == ENOENT) {
    refuse(
        fmt::format("the program {} is missing; install librsvg (Debian: apt-get install "
                    "librsvg2-bin), or write --svg",
                    converter));
  }
  if (failed != 0) refuse(fmt::format("{}: {}", converter, std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) refuse(fmt::format("{}: {}", converter, std::strerror(errno)));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

PdfConverter::PdfConverter() {
  std::string name = (std::filesystem::temp_directory_path() / "cordon_pdf_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) refuse(fmt::format("{}: {}", name, std::strerror(errno)));
  directory_ = name;
}

PdfConverter::~PdfConverter() {
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

std::string PdfConverter::pdf_of(const std::string& svg) const {
  const std::string from = (directory_ / "figure.svg").string(),
                    to = (directory_ / "figure.pdf").string();
  std::ofstream out(from, std::ios::binary);
  out << svg;
  out.close();
  if (!out) refuse("cannot write " + from);
  std::filesystem::remove(to);
  if (const int code = run(from, to); code != 0)
    refuse(fmt::format("{} ended with code {}", converter, code));
  std::ifstream in(to, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  if (!in || bytes.empty()) refuse(fmt::format("{} wrote nothing", converter));
  return bytes;
}

}  // namespace cordon::report
