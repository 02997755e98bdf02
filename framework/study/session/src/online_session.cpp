// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/study/online.hpp"
#include "interfaces/sample_check.hpp"

namespace cordon {

namespace {

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

Sample without_outputs(Index k, const Vector& u, Index outputs) {
  Sample sample{k, u, Vector::Constant(outputs, std::numeric_limits<double>::quiet_NaN()), {}};
  for (Index i = 0; i < outputs; ++i) sample.missing.push_back(i);
  return sample;
}

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
      : rules_(study.online), session_(study, registry, pipeline) {
    if (corrects()) before_ = session_.save();
  }

  Taken take(const GivenSample& given) {
    const std::optional<Index> last = session_.last();
    const Index next = last ? *last + 1 : given.k.value_or(0);
    const Sample sample = sample_of(given, given.k.value_or(next));
    if (sample.k < 0) throw Error(Errc::invalid, time_of(sample.k) + ": times begin at 0");
    detail::check_sample(sample, std::nullopt, session_.model());
    if (sample.k == next) return on_time(sample);
    return sample.k > next ? after_gap(sample, next) : again(sample);
  }

  void start() {
    session_.start();
    passed_.clear();
    if (corrects()) before_ = session_.save();
  }

  void serialize(Archive& archive) {
    std::string session = archive.is_reading() ? std::string() : session_.save();
    archive.section("online session");
    archive(session, before_, passed_, counts_.taken, counts_.filled, counts_.corrected,
            counts_.late, counts_.repeated, counts_.filled_steps);
    if (!archive.is_reading()) return;
    for (const Passed& passed : passed_)
      detail::check_sample(passed.sample, std::nullopt, session_.model());
    session_.restore(session);
  }

  OnlineSpec rules_;
  Session session_;
  TakenCounts counts_;

 private:
  struct Passed {
    Sample sample;
    bool is_filled = false;   ///< its input is that of the sample before, and may have been another
    std::string before = {};  ///< the session before it; "" where nothing can be corrected
    void serialize(Archive& archive) { archive(sample, is_filled, before); }
  };

  bool corrects() const { return rules_.late == LateRule::correct; }

  Sample sample_of(const GivenSample& given, Index k) const {
    Sample sample{k, given.u, given.y, {}};
    for (Index i = 0; i < sample.y.size(); ++i) {
      if (std::isnan(sample.y[i])) sample.missing.push_back(i);
    }
    return sample;
  }

  Taken on_time(const Sample& sample) {
    Taken taken;
    step(sample, taken);
    ++counts_.taken;
    return taken;
  }

  void step(const Sample& sample, Taken& taken, bool is_filled = false) {
    taken.steps.push_back(session_.step(sample));
    taken.samples.push_back(sample);
    passed_.push_back({sample, is_filled, std::exchange(before_, {})});
    const auto most = static_cast<std::size_t>(std::max<std::int64_t>(rules_.lag, 1));
    if (passed_.size() > most) passed_.pop_front();
    if (corrects()) before_ = session_.save();
  }

  Taken after_gap(const Sample& sample, Index next) {
    const Index gap = sample.k - next;
    const std::string jump = time_of(sample.k) + " comes after " + time_of(next - 1) + ": ";
    if (rules_.jumps == JumpRule::refuse)
      throw Error(Errc::invalid,
                  jump +
                      "it is refused; with \"jumps\": \"fill\" in /online the times between "
                      "are taken without outputs");
    if (gap > rules_.longest_gap)
      throw Error(Errc::invalid, jump + "it is refused, as more than \"longest_gap\": " +
                                     std::to_string(rules_.longest_gap) + " times are missing");
    Taken taken{Taken::How::filled,
                jump + std::to_string(gap) + (gap == 1 ? " time is" : " times are") +
                    " taken without outputs, and with the input of the sample before"};
    const Vector u = passed_.back().sample.u;
    for (Index k = next; k < sample.k; ++k)
      step(without_outputs(k, u, sample.y.size()), taken, true);
    step(sample, taken);
    ++counts_.filled;
    counts_.filled_steps += gap;
    return taken;
  }

  /// A time that has passed.
  Taken again(const Sample& sample) {
    const Index first = passed_.empty() ? *session_.last() + 1 : passed_.front().sample.k;
    if (sample.k < first) {
      ++counts_.late;
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
    if (news.empty() && !other_input) return repeated(sample.k);
    if (corrects()) return corrected(at, sample, news);
    ++counts_.late;
    return {Taken::How::late,
            time_of(sample.k) +
                " has passed: it is left out; with \"late\": \"correct\" in /online its outputs "
                "would correct the past",
            {}};
  }

  Taken repeated(Index k) {
    if (rules_.repeated == RepeatRule::refuse)
      throw Error(Errc::invalid, time_of(k) +
                                     " was taken already: it is refused; with "
                                     "\"repeated\": \"ignore\" in /online it is left out");
    ++counts_.repeated;
    return {Taken::How::repeated, time_of(k) + " was taken already: it is left out", {}};
  }

  Taken corrected(std::size_t at, const Sample& sample, const std::vector<Index>& news) {
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
    session_.restore(passed_[at].before);
    for (std::size_t i = at; i < passed_.size(); ++i) {
      if (i > at) passed_[i].before = session_.save();
      taken.steps.push_back(session_.step(passed_[i].sample));
      taken.samples.push_back(passed_[i].sample);
    }
    before_ = session_.save();
    ++counts_.corrected;
    return taken;
  }

  std::deque<Passed> passed_;  ///< the last samples
  std::string before_;         ///< the session as it is, where late outputs correct
};

OnlineSession::OnlineSession(const Study& study, const Registry& registry,
                             const std::string& pipeline)
    : intake_(std::make_unique<Intake>(study, registry, pipeline)) {}
OnlineSession::~OnlineSession() = default;
OnlineSession::OnlineSession(OnlineSession&&) noexcept = default;
OnlineSession& OnlineSession::operator=(OnlineSession&&) noexcept = default;

Session& OnlineSession::session() { return intake_->session_; }
const Session& OnlineSession::session() const { return intake_->session_; }
Taken OnlineSession::take(const GivenSample& sample) { return intake_->take(sample); }
const TakenCounts& OnlineSession::counts() const { return intake_->counts_; }
void OnlineSession::start() { intake_->start(); }

std::string OnlineSession::save() {
  Archive archive(nullptr);
  intake_->serialize(archive);
  return archive.bytes();
}

void OnlineSession::restore(const std::string& saved) {
  try {
    Archive archive(nullptr, saved);
    intake_->serialize(archive);
    archive.expect_end();
  } catch (const Error&) {
    intake_->start();
    throw;
  }
}

}  // namespace cordon
