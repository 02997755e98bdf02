// SPDX-License-Identifier: GPL-3.0-or-later
#include "stream_checkpoint.hpp"

#include "cordon/interfaces/archive.hpp"
#include "study/text/atomic_directory.hpp"
#include "study/text/json_text.hpp"
#include "study/text/publish.hpp"
#include "study/text/sealed.hpp"

namespace cordon::apps {

namespace {

constexpr const char* name_of_file = "cordon checkpoint 2";

void serialize(CheckpointState& state, Archive& archive) {
  archive(state.session, state.lines, state.log_bytes, state.log_lost);
  if (state.lines < 0 || state.log_bytes < 0 || state.log_lost < 0)
    archive.refuse("a negative length");
}

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path file) : file_(std::move(file)) {
  if (std::filesystem::is_symlink(file_)) file_ = std::filesystem::weakly_canonical(file_);
  if (detail::is_there(file_) && !std::filesystem::is_regular_file(file_))
    throw InputError(file_.string(), {{"", "is no regular file", "name a file"}});
  if (!file_.empty()) lock_.emplace(beside(".lock"), file_);
}

bool Checkpoint::uses(const std::filesystem::path& other) const {
  const auto whole = [](const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal();
  };
  return whole(other) == whole(file_) || whole(other) == whole(beside(".new")) ||
         whole(other) == whole(beside(".lock"));
}

std::optional<CheckpointState> Checkpoint::read() const {
  if (!detail::is_there(file_)) return std::nullopt;
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

void Checkpoint::write(CheckpointState state) const {
  Archive archive(nullptr);
  serialize(state, archive);
  const std::filesystem::path fresh = beside(".new");
  std::error_code ignored;
  std::filesystem::remove(fresh, ignored);
  try {
    detail::OutputFile out(fresh);
    out.write(detail::sealed(name_of_file, archive.bytes()));
    out.close();
  } catch (const Error&) {
    std::filesystem::remove(fresh, ignored);
    throw;
  }
  std::error_code failure;
  std::filesystem::rename(fresh, file_, failure);
  if (failure) throw Error(Errc::io, file_.string() + ": " + failure.message());
  detail::sync_names(std::filesystem::absolute(file_).parent_path());
}

}  // namespace cordon::apps
