// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/host.hpp"

#include <array>
#include <ctime>
#include <fstream>
#include <sys/utsname.h>

namespace cordon::detail {

Host this_host() {
  Host host;
  struct utsname names;
  if (::uname(&names) == 0) {
    host.name = names.nodename;
    host.system = std::string(names.sysname) + " " + names.release + " " + names.machine;
  }
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) host.cpu = line.substr(colon + 2);
    break;
  }
  return host;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  std::array<char, 32> text{};
  if (::gmtime_r(&now, &parts) == nullptr) return "";
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return std::string(text.data(), length);
}

}  // namespace cordon::detail
