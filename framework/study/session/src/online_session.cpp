// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/study/online.hpp"
#include "interfaces/sample_check.hpp"
#include "sample_clock.hpp"
#include "study/text/sealed.hpp"

namespace cordon {

namespace {

constexpr Index latest = (Index{1} << 53) - 1;  // later times are no numbers in JSON

std::string time_of(Index k) { return "k = " + std::to_string(k); }

/// Outputs of `given` that `known` lacks.
std::vector<Index> news_in(const Sample& given, const Sample& known) {
  std::vector<Index> news;
  for (const Index i : present_outputs(given)) {
    if (std::isnan(known.y[i])) news.push_back(i);
  }
  return news;
}

/// Has `given` another value of an output than `known`?
bool contradicts(const Sample& given, const Sample& known) {
  for (const Index i : present_outputs(given)) {
    if (!std::isnan(known.y[i]) && given.y[i] != known.y[i]) return true;
  }
  return false;
}

/// To tell the states of sessions with other rules.
std::string text_of(const OnlineSpec& rules) {
  return std::to_string(static_cast<int>(rules.jumps)) + " " + std::to_string(rules.longest_gap) +
         " " + std::to_string(static_cast<int>(rules.late)) + " " + std::to_string(rules.lag) +
         " " + std::to_string(static_cast<int>(rules.repeated)) + " " +
         fmt::format("{} {}", rules.clock_tolerance, rules.clock_drift);
}

Vector no_outputs(Index count) {
  return Vector::Constant(count, std::numeric_limits<double>::quiet_NaN());
}

constexpr const char* saved_online_session = "cordon online session 2";

}  // namespace

std::string_view to_string(Taken::How how) noexcept {
  switch (how) {
    case Taken::How::taken:
      return "taken";
    case Taken::How::filled:
      return "filled";
    case Taken::How::corrected:
      return "corrected";
    case Taken::How::late:
      return "late";
    case Taken::How::repeated:
      return "repeated";
  }
  return "taken";
}

/// The session, and the samples that late ones may still change.
class OnlineSession::Intake {
 public:
  Intake(const Study& study, const Registry& registry, const std::string& pipeline)
      : rules_(study.online),
        session_(study, registry, pipeline),
        alarms_(study, session_),
        clock_(study.labels.sampling_time, {rules_.clock_tolerance, rules_.clock_drift}) {
    if (corrects()) before_ = session_.save();
  }

  Taken take(const GivenSample& given) {
    if (has_ended())
      throw Error(Errc::plugin,
                  "an earlier step has ended with an error; begin "
                  "anew, or go on from a state that was saved");
    const std::optional<Index> last = session_.last();
    const Index next = last ? *last + 1 : given.k.value_or(0);
    const Index k = clock_.number_of(given.t, given.k, next, !last);
    const Sample sample = detail::sample_of(k, given.u, given.y);
    if (sample.k < 0 || sample.k > latest)
      throw Error(Errc::invalid, time_of(sample.k) + ": times are 0 to 2^53 - 1");
    detail::check_sample(sample, std::nullopt, session_.model());
    if (sample.k > next) expect_fillable(sample.k, next);
    if (sample.k < next) return again(sample, given.t);
    Taken taken = changing([&] {
      return sample.k == next ? on_time(sample, given.t) : after_gap(sample, given.t, next);
    });
    if (given.t) clock_.took(*given.t, k, given.k.has_value());
    return taken;
  }

  bool has_ended() const { return ended_ || session_.has_ended(); }

  std::vector<AlarmChange> start() {
    ended_ = true;
    session_.start();
    passed_.clear();
    held_before_.reset();
    clock_.forget();
    if (corrects()) before_ = session_.save();
    std::vector<AlarmChange> changes = alarms_.begin_anew();
    ended_ = false;
    return changes;
  }

  std::string save() {
    if (has_ended())
      throw Error(Errc::invalid, "a step has ended with an error: there is no state");
    Archive archive(nullptr);
    serialize(archive);
    return detail::sealed(saved_online_session, archive.bytes());
  }

  void restore(const std::string& saved) {
    Archive archive(nullptr, detail::unsealed(saved_online_session, saved));
    const Alarms alarms_before = alarms_;
    const TakenCounts counts_before = counts_;
    try {
      ended_ = true;
      serialize(archive);
      archive.expect_end();
      ended_ = false;
    } catch (...) {
      start();
      alarms_ = alarms_before;
      counts_ = counts_before;
      throw;
    }
  }

  OnlineSpec rules_;
  Session session_;
  TakenCounts counts_;
  Alarms alarms_;

 private:
  struct Passed {
    Sample sample;
    bool is_filled = false;   ///< its input is that of the sample before, and may have been another
    std::string before = {};  ///< the session before it; "" where nothing can be corrected
    std::vector<Alarm> alarms = {};  ///< before it, likewise
    std::optional<double> t = {};
    void serialize(Archive& archive) { archive(sample, is_filled, before, alarms, t); }
  };

  bool corrects() const { return rules_.late == LateRule::correct; }

  /// The last time up to k whose input was not sent, and is taken for that of the time before.
  std::optional<Index> held(Index k) const {
    for (auto at = passed_.rbegin(); at != passed_.rend(); ++at) {
      if (at->is_filled && at->sample.k <= k) return at->sample.k;
    }
    return held_before_;
  }

  /// Null: it is longer ago than can be corrected.
  Passed* passed_at(Index k) {
    const Index first = passed_.front().sample.k;
    return k < first ? nullptr : &passed_[static_cast<std::size_t>(k - first)];
  }

  void retake_alarms(std::vector<TakenStep>& steps) {
    std::vector<Alarms::Again> again;
    for (const TakenStep& step : steps)
      again.push_back({&step, held(step.k), &passed_at(step.k)->alarms});
    steps.back().alarms = alarms_.retake(again);
  }

  /// Carries out what changes the session; if it ends half way, so does the session.
  template <class Change>
  Taken changing(Change&& change) {
    ended_ = true;
    Taken taken = change();
    if (taken.how == Taken::How::corrected) {
      retake_alarms(taken.steps);
    } else {
      for (TakenStep& step : taken.steps) {
        if (Passed* const passed = corrects() ? passed_at(step.k) : nullptr)
          passed->alarms = alarms_.standing();
        step.alarms = alarms_.step(step, held(step.k));
      }
    }
    ended_ = false;
    return taken;
  }

  void serialize(Archive& archive) {
    archive.section(text_of(rules_));
    std::string session = archive.is_reading() ? std::string() : session_.save();
    archive(session, before_, passed_, held_before_, counts_.taken, counts_.filled,
            counts_.corrected, counts_.late, counts_.repeated, counts_.filled_steps);
    alarms_.serialize(archive);
    clock_.serialize(archive);
    if (!archive.is_reading()) return;
    session_.restore(session);
    if (passed_.empty() == session_.last().has_value()) archive.refuse("no sample before");
    for (std::size_t i = 0; i < passed_.size(); ++i) {
      detail::check_sample(passed_[i].sample, std::nullopt, session_.model());
      const Index k = session_.last().value_or(-1) - static_cast<Index>(passed_.size() - 1 - i);
      if (passed_[i].sample.k != k) archive.refuse("samples that are not the last ones");
    }
  }

  Taken on_time(const Sample& sample, std::optional<double> t) {
    Taken taken;
    step(sample, taken, false, t);
    ++counts_.taken;
    return taken;
  }

  void step(const Sample& sample, Taken& taken, bool is_filled, std::optional<double> t) {
    taken.steps.push_back({session_.step(sample), sample, t});
    passed_.push_back(
        {.sample = sample, .is_filled = is_filled, .before = std::exchange(before_, {}), .t = t});
    if (passed_.size() > static_cast<std::size_t>(rules_.lag) + 1) {
      if (passed_.front().is_filled) held_before_ = passed_.front().sample.k;
      passed_.pop_front();
    }
    if (corrects()) before_ = session_.save();
  }

  std::string jump(Index k, Index next) const {
    return time_of(k) + " comes after " + time_of(next - 1) + ": ";
  }

  void expect_fillable(Index k, Index next) const {
    if (rules_.jumps == JumpRule::refuse)
      throw Error(Errc::invalid, jump(k, next) +
                                     "it is refused; with \"jumps\": \"fill\" in /online the times "
                                     "between are taken without outputs; otherwise begin anew");
    if (k - next > rules_.longest_gap)
      throw Error(Errc::invalid, jump(k, next) + "it is refused, as more than \"longest_gap\": " +
                                     std::to_string(rules_.longest_gap) +
                                     " times are missing: begin anew, or allow longer gaps");
  }

  Taken after_gap(const Sample& sample, std::optional<double> t, Index next) {
    const Index gap = sample.k - next;
    Taken taken{Taken::How::filled,
                jump(sample.k, next) + std::to_string(gap) +
                    (gap == 1 ? " time is" : " times are") +
                    " taken without outputs, and with the input of the sample before"};
    const Vector u = passed_.back().sample.u;
    for (Index k = next; k < sample.k; ++k)
      step(detail::sample_of(k, u, no_outputs(sample.y.size())), taken, true, {});
    step(sample, taken, false, t);
    ++counts_.filled;
    counts_.filled_steps += gap;
    return taken;
  }

  /// A time that has passed.
  Taken again(const Sample& sample, std::optional<double> t) {
    const Index first = passed_.empty() ? *session_.last() + 1 : passed_.front().sample.k;
    if (sample.k < first) {
      ++counts_.late;
      if (passed_.size() <= static_cast<std::size_t>(rules_.lag))
        return {Taken::How::late,
                time_of(sample.k) + " is before the first sample: it is left out",
                {}};
      return {Taken::How::late,
              time_of(sample.k) + " is longer ago than \"lag\": " + std::to_string(rules_.lag) +
                  ": it is left out",
              {}};
    }
    const auto at = static_cast<std::size_t>(sample.k - first);
    const Sample& known = passed_[at].sample;
    const bool other_input = sample.u != known.u;
    if (contradicts(sample, known) || (other_input && !passed_[at].is_filled))
      throw Error(Errc::invalid, time_of(sample.k) + " was taken with other values: it is refused");
    const std::vector<Index> news = news_in(sample, known);
    if (news.empty() && !other_input) return repeated(at);
    if (corrects()) return changing([&] { return corrected(at, sample, t, news); });
    ++counts_.late;
    if (other_input) {
      return {Taken::How::late,
              time_of(sample.k) +
                  " has passed: it is left out, although its input is not the one that was taken "
                  "for it, so that what is said is wrong: begin anew; with \"late\": \"correct\" "
                  "in /online it would correct the past",
              {}};
    }
    return {Taken::How::late,
            time_of(sample.k) +
                " has passed: it is left out; with \"late\": \"correct\" in /online its outputs "
                "would correct the past",
            {}};
  }

  Taken repeated(std::size_t at) {
    const Index k = passed_[at].sample.k;
    if (rules_.repeated == RepeatRule::refuse)
      throw Error(Errc::invalid, time_of(k) +
                                     " was taken already: it is refused; with "
                                     "\"repeated\": \"ignore\" in /online it is left out");
    passed_[at].is_filled = false;  // its input was the one that was sent
    ++counts_.repeated;
    return {Taken::How::repeated, time_of(k) + " was taken already: it is left out", {}};
  }

  Taken corrected(std::size_t at, const Sample& sample, std::optional<double> t,
                  const std::vector<Index>& news) {
    Taken taken{Taken::How::corrected,
                time_of(sample.k) +
                    " was taken without what has come now: it is taken again, and "
                    "what followed",
                {}};
    Sample merged = passed_[at].sample;
    for (const Index i : news) {
      merged.y[i] = sample.y[i];
      std::erase(merged.missing, i);
    }
    merged.u = sample.u;
    passed_[at].sample = std::move(merged);
    passed_[at].is_filled = false;
    if (!passed_[at].t) passed_[at].t = t;
    for (std::size_t i = at + 1; i < passed_.size() && passed_[i].is_filled; ++i)
      passed_[i].sample.u = sample.u;  // which they have held
    session_.restore(passed_[at].before);
    for (std::size_t i = at; i < passed_.size(); ++i) {
      if (i > at) passed_[i].before = session_.save();
      taken.steps.push_back({session_.step(passed_[i].sample), passed_[i].sample, passed_[i].t});
    }
    before_ = session_.save();
    ++counts_.corrected;
    return taken;
  }

  detail::SampleClock clock_;
  std::deque<Passed> passed_;         ///< the last samples
  std::string before_;                ///< the session as it is, where late outputs correct
  std::optional<Index> held_before_;  ///< as `held`, of the times before these samples
  bool ended_ = false;                ///< a change has ended half way
};

OnlineSession::OnlineSession(const Study& study, const Registry& registry,
                             const std::string& pipeline)
    : intake_(std::make_unique<Intake>(study, registry, pipeline)) {}
OnlineSession::~OnlineSession() = default;
OnlineSession::OnlineSession(OnlineSession&&) noexcept = default;
OnlineSession& OnlineSession::operator=(OnlineSession&&) noexcept = default;

const Session& OnlineSession::session() const { return intake_->session_; }
void OnlineSession::prove_hulls(bool wanted) { intake_->session_.prove_hulls(wanted); }
Taken OnlineSession::take(const GivenSample& sample) { return intake_->take(sample); }
bool OnlineSession::has_ended() const { return intake_->has_ended(); }
const TakenCounts& OnlineSession::counts() const { return intake_->counts_; }
const std::vector<Alarm>& OnlineSession::alarms() const { return intake_->alarms_.standing(); }
std::vector<AlarmChange> OnlineSession::acknowledge() { return intake_->alarms_.acknowledge(); }
std::vector<AlarmChange> OnlineSession::start() { return intake_->start(); }
std::string OnlineSession::save() { return intake_->save(); }
void OnlineSession::restore(const std::string& saved) { intake_->restore(saved); }

}  // namespace cordon
