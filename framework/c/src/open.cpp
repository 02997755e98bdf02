// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions of a study, and what they are called.
#include <algorithm>
#include <filesystem>
#include <mutex>
#include <string_view>

#include "session.hpp"

using namespace cordon;

namespace {

std::vector<std::string> names_of(const Labels::Names& names, const char* symbol, Index count) {
  std::vector<std::string> all;
  for (Index i = 0; i < count; ++i) all.push_back(label_of(names, symbol, i));
  return all;
}

SearchPath search_path(const char* plugins) {
  std::vector<std::filesystem::path> extra;
  for (std::string_view rest = plugins ? plugins : ""; !rest.empty();) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    extra.emplace_back(rest.substr(0, colon));
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  return default_search_path(extra);
}

/// `read` reads the study with a registry and a path.
template <class Read>
cordon_session* opened(const char* function, const char* pipeline, const char* plugins,
                       Read&& read) {
  static std::mutex one_at_a_time;  // loading opens libraries, and tries them in child processes
  cordon_session* session = nullptr;
  c::done(function, [&] {
    const std::lock_guard lock(one_at_a_time);
    Registry registry;
    const Study study = read(registry, search_path(plugins));
    session = new cordon_session(study, registry, pipeline ? pipeline : "");
  });
  return session;
}

/// A name of a list of the session.
template <class List>
const char* name(const char* function, const cordon_session* session, int i, const char* what,
                 List&& list) {
  return c::got(function, "",
                [&] { return c::entry(list(c::session_of(session)), i, what).c_str(); });
}

template <class List>
int count(const char* function, const cordon_session* session, List&& list) {
  return c::got(function, c::refused, [&] { return c::count_of(list(c::session_of(session))); });
}

const auto of_states = [](const cordon_session& s) -> auto& { return s.names.states; };
const auto of_inputs = [](const cordon_session& s) -> auto& { return s.names.inputs; };
const auto of_outputs = [](const cordon_session& s) -> auto& { return s.names.outputs; };
const auto of_modes = [](const cordon_session& s) -> auto& { return s.online.session().modes(); };
const auto of_warnings = [](const cordon_session& s) -> auto& { return s.warnings; };

}  // namespace

cordon_session::cordon_session(const Study& study, const Registry& registry,
                               const std::string& pipeline)
    : online(study, registry, pipeline), warnings(study.warnings) {
  const Model& model = online.session().model();
  names = {names_of(study.labels.states, "x", model.states()),
           names_of(study.labels.inputs, "u", model.inputs()),
           names_of(study.labels.outputs, "y", model.outputs())};
}

extern "C" {

cordon_session* cordon_open(const char* study_file, const char* pipeline, const char* plugins) {
  return opened(__func__, pipeline, plugins, [&](Registry& registry, const SearchPath& path) {
    return read_study(&c::required(study_file, "study_file"), registry, path, StudyPlugins::refuse,
                      StudyData::optional);
  });
}

cordon_session* cordon_open_text(const char* study_text, const char* folder, const char* pipeline,
                                 const char* plugins) {
  return opened(__func__, pipeline, plugins, [&](Registry& registry, const SearchPath& path) {
    const std::filesystem::path file = std::filesystem::path(folder ? folder : ".") / "study.json";
    return read_study_text(&c::required(study_text, "study_text"), file.lexically_normal(),
                           registry, path, StudyPlugins::refuse, StudyData::optional);
  });
}

void cordon_close(cordon_session* session) {
  c::done(__func__, [&] { delete session; });
}

int cordon_warning_count(const cordon_session* session) {
  return count(__func__, session, of_warnings);
}
const char* cordon_warning(const cordon_session* session, int i) {
  return name(__func__, session, i, "warning", of_warnings);
}

int cordon_states(const cordon_session* session) { return count(__func__, session, of_states); }
int cordon_inputs(const cordon_session* session) { return count(__func__, session, of_inputs); }
int cordon_outputs(const cordon_session* session) { return count(__func__, session, of_outputs); }
int cordon_modes(const cordon_session* session) { return count(__func__, session, of_modes); }

const char* cordon_pipeline_name(const cordon_session* session) {
  return c::got(__func__, "",
                [&] { return c::session_of(session).online.session().name().c_str(); });
}
const char* cordon_state_name(const cordon_session* session, int i) {
  return name(__func__, session, i, "state", of_states);
}
const char* cordon_input_name(const cordon_session* session, int i) {
  return name(__func__, session, i, "input", of_inputs);
}
const char* cordon_output_name(const cordon_session* session, int i) {
  return name(__func__, session, i, "output", of_outputs);
}
const char* cordon_mode_name(const cordon_session* session, int i) {
  return name(__func__, session, i, "mode", of_modes);
}

}  // extern "C"
