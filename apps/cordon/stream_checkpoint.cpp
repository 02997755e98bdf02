// SPDX-License-Identifier: GPL-3.0-or-later
#include "stream_checkpoint.hpp"

#include "cordon/interfaces/archive.hpp"
#include "study/text/atomic_directory.hpp"
#include "study/text/fingerprint.hpp"
#include "study/text/json_text.hpp"

namespace cordon::apps {

namespace {

constexpr const char* head = "cordon checkpoint 1\n";

void serialize(CheckpointState& state, Archive& archive) {
  archive(state.session, state.alarms, state.lines, state.log_bytes);
  if (state.lines < 0 || state.log_bytes < 0) archive.refuse("a negative length");
}

}  // namespace

void CheckpointState::restore(Alarms& into) const {
  Archive archive(nullptr, alarms);
  into.serialize(archive);
  archive.expect_end();
}

std::optional<CheckpointState> Checkpoint::read() const {
  if (!detail::is_there(file_)) return std::nullopt;
  const std::string text = json::read_file(file_.string());
  const auto refuse = [&](const std::string& why) {
    throw InputError(file_.string(),
                     {{"", why, "name another file, or remove this one to begin anew"}});
  };
  const std::string start = head;
  const std::size_t end = text.find('\n', start.size());
  if (!text.starts_with(start) || end == std::string::npos)
    refuse("is no checkpoint of this version");
  std::string bytes = text.substr(end + 1);
  if (detail::fingerprint(bytes) != text.substr(start.size(), end - start.size()))
    refuse("is damaged: its check sum does not fit");
  CheckpointState state;
  Archive archive(nullptr, std::move(bytes));
  serialize(state, archive);
  archive.expect_end();
  return state;
}

void Checkpoint::write(const std::string& session, Alarms& alarms, std::int64_t lines,
                       std::int64_t log_bytes) const {
  Archive of_alarms(nullptr);
  alarms.serialize(of_alarms);
  CheckpointState state{session, of_alarms.bytes(), lines, log_bytes};
  Archive archive(nullptr);
  serialize(state, archive);
  const std::filesystem::path beside = file_.string() + ".new";
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  try {
    detail::OutputFile out(beside);
    out.write(head + detail::fingerprint(archive.bytes()) + "\n");
    out.write(archive.bytes());
    out.close();
  } catch (const Error&) {
    std::filesystem::remove(beside, ignored);
    throw;
  }
  std::error_code failure;
  std::filesystem::rename(beside, file_, failure);
  if (failure) throw Error(Errc::io, file_.string() + ": " + failure.message());
}

}  // namespace cordon::apps
