// SPDX-License-Identifier: GPL-3.0-or-later
#include "stream_checkpoint.hpp"

#include "cordon/interfaces/archive.hpp"
#include "study/text/atomic_directory.hpp"
#include "study/text/json_text.hpp"
#include "study/text/sealed.hpp"

namespace cordon::apps {

namespace {

constexpr const char* name_of_file = "cordon checkpoint 1";

void serialize(CheckpointState& state, Archive& archive) {
  archive(state.session, state.lines, state.log_bytes);
  if (state.lines < 0 || state.log_bytes < 0) archive.refuse("a negative length");
}

}  // namespace

std::optional<CheckpointState> Checkpoint::read() {
  if (!detail::is_there(file_)) return std::nullopt;
  do {
    lock_.take(file_);
  } while (!lock_.holds(file_));  // replaced meanwhile
  const std::string text = json::read_file(file_.string());
  try {
    CheckpointState state;
    Archive archive(nullptr, detail::unsealed(name_of_file, text));
    serialize(state, archive);
    archive.expect_end();
    return state;
  } catch (const Error& error) {
    throw InputError(file_.string(),
                     {{"", error.what(), "name another file, or remove this one to begin anew"}});
  }
}

void Checkpoint::write(CheckpointState state) {
  if (detail::is_there(file_) && !lock_.holds(file_))
    throw Error(Errc::io, file_.string() + ": another stream has written it");
  Archive archive(nullptr);
  serialize(state, archive);
  const std::filesystem::path beside = file_.string() + ".new";
  FileLock next;
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  try {
    detail::OutputFile out(beside);
    out.write(detail::sealed(name_of_file, archive.bytes()));
    out.close();
    next.take(beside);
  } catch (const Error&) {
    std::filesystem::remove(beside, ignored);
    throw;
  }
  std::error_code failure;
  std::filesystem::rename(beside, file_, failure);
  if (failure) throw Error(Errc::io, file_.string() + ": " + failure.message());
  lock_.swap(next);
  detail::sync_names(std::filesystem::absolute(file_).parent_path());
}

}  // namespace cordon::apps
