// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions of C are opened, or it is said why not.
#include <doctest/doctest.h>

#include "c_api/opened.hpp"

using namespace c_test;

TEST_CASE("the library tells its versions") {
  CHECK(cordon_abi_version() == CORDON_C_ABI_VERSION);
  CHECK(std::string(cordon_version()).find('.') != std::string::npos);
}

TEST_CASE("codes mean what those of the framework mean") {
  CHECK(CORDON_DIMENSION == static_cast<int>(Errc::dimension) + 1);
  CHECK(CORDON_NOT_ENCLOSED == static_cast<int>(Errc::not_enclosed) + 1);
  CHECK(CORDON_INTERNAL == static_cast<int>(Errc::internal) + 1);
  CHECK(CORDON_UNKNOWN == static_cast<int>(Answer::unknown));
  CHECK(CORDON_UNKNOWN_FAULT == static_cast<int>(Decision::unknown_fault));
  CHECK(CORDON_REPEATED == static_cast<int>(Taken::How::repeated));
}

TEST_CASE("a session tells its sizes and names") {
  const Opened bank("bank");
  REQUIRE(bank != nullptr);
  CHECK(cordon_states(bank) == 2);
  CHECK(cordon_inputs(bank) == 1);
  CHECK(cordon_outputs(bank) == 2);
  CHECK(cordon_modes(bank) == 2);
  CHECK(std::string(cordon_pipeline_name(bank)) == "bank");
  CHECK(std::string(cordon_state_name(bank, 1)) == "x_2");
  CHECK(std::string(cordon_input_name(bank, 0)) == "u_1");
  CHECK(std::string(cordon_output_name(bank, 1)) == "y_2");
  CHECK(std::string(cordon_mode_name(bank, 0)) == "healthy");
  CHECK(std::string(cordon_mode_name(bank, 1)) == "leak");
  CHECK(cordon_warning_count(bank) == 0);
  CHECK(cordon_modes(Opened("interval")) == 0);
}

TEST_CASE("indices out of range are refused") {
  const Opened session("interval");
  for (const int i : {-1, 2, 1 << 30}) {
    CHECK(std::string(cordon_state_name(session, i)).empty());
    CHECK(cordon_last_code() == CORDON_INVALID);
    CHECK(says("cordon_state_name: there is no state"));
  }
  CHECK(std::string(cordon_mode_name(session, 0)).empty());
  CHECK(std::string(cordon_warning(session, 0)).empty());
  CHECK(std::string(cordon_problem_place(7)).empty());
  CHECK(std::string(cordon_problem_message(-1)).empty());
  CHECK(std::string(cordon_problem_suggestion(7)).empty());
  CHECK(cordon_problem_line(7) == CORDON_REFUSED);
}

TEST_CASE("all problems of a study are told, each with its place") {
  std::string text = study_text();
  text.replace(text.find("[0, 0.7]"), 8, "[0, null]");
  text.replace(text.find("\"zonotope\"}"), 11, "\"zonotop\"}");
  CHECK(cordon_open_text(text.c_str(), "/plants", "bank", nullptr) == nullptr);
  CHECK(cordon_last_code() == CORDON_INVALID);
  CHECK(says("cordon_open_text: /plants/study.json: "));
  REQUIRE(cordon_problem_count() >= 1);
  std::string places;
  for (int i = 0; i < cordon_problem_count(); ++i) {
    places += std::string(cordon_problem_place(i)) + " ";
    CHECK(cordon_problem_line(i) >= 1);
    CHECK_FALSE(std::string(cordon_problem_message(i)).empty());
  }
  CHECK(places.find("/system/A/1/1") != std::string::npos);
  CHECK(places.find("/pipelines/0/backend/type") != std::string::npos);
  CHECK(std::string(cordon_problem_suggestion(cordon_problem_count() - 1)).find("zonotope") !=
        std::string::npos);
}

TEST_CASE("what cannot be opened is refused") {
  CHECK(cordon_open("/nowhere/study.json", nullptr, nullptr) == nullptr);
  CHECK(cordon_last_code() != CORDON_OK);
  CHECK(says("/nowhere/study.json"));
  CHECK(cordon_open(nullptr, nullptr, nullptr) == nullptr);
  CHECK(cordon_last_code() == CORDON_NULL);
  CHECK(last_error() == "cordon_open: study_file is NULL");
  CHECK(cordon_open_text(nullptr, nullptr, nullptr, nullptr) == nullptr);
  CHECK(cordon_last_code() == CORDON_NULL);
  CHECK(cordon_open_text("{", nullptr, nullptr, nullptr) == nullptr);
  CHECK(cordon_last_code() == CORDON_INVALID);
  const Opened banc("banc");
  CHECK(banc == nullptr);
  CHECK(says("did you mean \"bank\"?"));
  const Opened none("");
  CHECK(none == nullptr);
  CHECK(says("there are 4 pipelines"));
}

TEST_CASE(
    "plugins that a study names are not loaded from directories that the program did not name") {
  const std::string folder = CORDON_BINARY_DIR "/tests/c_api/no_plugins";
  std::filesystem::create_directories(folder);
  std::string text = study_text();
  text.insert(text.find("\"system\""), "\"plugins\": [\"" + folder + "\"], ");
  CHECK(cordon_open_text(text.c_str(), nullptr, "bank", nullptr) == nullptr);
  CHECK(says("no_plugins"));
  cordon_session* const session =
      cordon_open_text(text.c_str(), nullptr, "bank", (":/nowhere:" + folder).c_str());
  CAPTURE(last_error());
  CHECK(session != nullptr);
  cordon_close(session);
}

TEST_CASE("NULL in place of a session is refused everywhere") {
  cordon_session* const no = nullptr;
  const double number = 0;
  double bound = 0;
  int flag = 0;
  std::size_t size = 0;
  const int codes[] = {cordon_step(no, &number, 1, &number, 1),
                       cordon_take(no, 0, &number, 1, &number, 1),
                       cordon_take_at(no, 0, 0, &number, 1, &number, 1),
                       cordon_reset(no),
                       cordon_result_bounds(no, 0, &bound, &bound, 1),
                       cordon_result_candidates(no, 0, &flag, 1),
                       cordon_acknowledge(no),
                       cordon_save(no, nullptr, 0, &size),
                       cordon_restore(no, &number, sizeof number)};
  for (const int code : codes) CHECK(code == CORDON_NULL);
  const std::int64_t numbers[] = {cordon_warning_count(no),
                                  cordon_states(no),
                                  cordon_inputs(no),
                                  cordon_outputs(no),
                                  cordon_modes(no),
                                  cordon_take_how(no),
                                  cordon_last_k(no),
                                  cordon_has_ended(no),
                                  cordon_result_count(no),
                                  cordon_result_k(no, 0),
                                  cordon_result_bounds_k(no, 0),
                                  cordon_result_consistent(no, 0),
                                  cordon_result_decision(no, 0),
                                  cordon_result_restarted(no, 0),
                                  cordon_result_mode(no, 0),
                                  cordon_event_count(no, 0),
                                  cordon_event_mode(no, 0, 0),
                                  cordon_change_count(no),
                                  cordon_change_what(no, 0),
                                  cordon_change_cause(no, 0),
                                  cordon_change_k(no, 0),
                                  cordon_alarm_count(no),
                                  cordon_alarm_cause(no, 0),
                                  cordon_alarm_raised_at(no, 0),
                                  cordon_alarm_is_active(no, 0),
                                  cordon_alarm_is_acknowledged(no, 0)};
  for (const std::int64_t refused : numbers) CHECK(refused == CORDON_REFUSED);
  const char* const texts[] = {
      cordon_warning(no, 0),       cordon_pipeline_name(no),  cordon_state_name(no, 0),
      cordon_input_name(no, 0),    cordon_output_name(no, 0), cordon_mode_name(no, 0),
      cordon_take_said(no),        cordon_result_json(no, 0), cordon_event_what(no, 0, 0),
      cordon_event_json(no, 0, 0), cordon_change_text(no, 0), cordon_change_json(no, 0),
      cordon_alarm_text(no, 0)};
  for (const char* const text : texts) CHECK(std::string(text).empty());
  CHECK(cordon_last_code() == CORDON_NULL);
  CHECK(last_error() == "cordon_alarm_text: the session is NULL");
  cordon_close(no);
}
