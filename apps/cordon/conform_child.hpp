// SPDX-License-Identifier: GPL-3.0-or-later
// A child process that tells its parent what it finds, one line of JSON per message: a plugin may
// crash or hang in it.
#pragma once

#include <functional>
#include <string>
#include <sys/types.h>

#include <nlohmann/json.hpp>

namespace cordon::apps {

/// Writes a message to the pipe; ends the process where nobody reads it any more.
void send(int fd, const nlohmann::ordered_json& message);

/// A child process that sends messages. Destroying it ends the process.
class Child {
 public:
  explicit Child(const std::function<void(int fd)>& body);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  enum class Event { message, ended, timeout };
  Event wait(double timeout_s, nlohmann::ordered_json& message);

  /// Ends the process and says how it ended; "" if it ended by itself with code 0.
  std::string finish();
  void kill_now();

 private:
  pid_t pid_ = -1;
  int fd_ = -1;
  std::string buffer_;
};

/// The text of an exception; call in a catch block.
std::string current_text();

}  // namespace cordon::apps
