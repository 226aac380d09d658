#include "tools/trial/trace/exchange.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "drivers/can/mit_protocol.hpp"
#include "tools/trial/trace/timing.hpp"

namespace sandhopper::trace {
namespace {

constexpr std::size_t kShareWindow = 50;  // commands, the same number as in MotorCheck

// Pairs commands and replies of a drive that answers each command.
class Pairing {
 public:
  Pairing(Exchange& exchange, std::int64_t longest_reply_ns) : e_(exchange), longest_ns_(longest_reply_ns) {}

  void command(const Frame& frame) {
    if (newest_.waiting && same_bytes(frame, newest_.frame) &&
        frame.time_ns - newest_.frame.time_ns < longest_ns_) {
      ++e_.commands_twice;
      return;
    }
    ++e_.commands;
    if (before_.waiting) missed();
    before_ = newest_;
    newest_ = {frame, true};
  }

  void reply(const Frame& frame) {
    // If the reply came too early to answer the newest command, it answers the previous one.
    const std::int64_t after_newest_ns = frame.time_ns - newest_.frame.time_ns;
    if (before_.waiting && (!newest_.waiting || after_newest_ns < kShortestReply_ns)) {
      answered(frame.time_ns - before_.frame.time_ns);
      before_.waiting = false;
      return;
    }
    if (!newest_.waiting) {
      // The first frame may answer a command from before the recording.
      const bool is_first = e_.commands == 0 && !e_.begins_with_reply;
      e_.begins_with_reply |= is_first;
      e_.unasked += !is_first;
      return;
    }
    if (before_.waiting) missed();
    before_.waiting = newest_.waiting = false;
    answered(after_newest_ns);
  }

  // A command at the very end may have been answered after the end of the recording.
  void end(std::int64_t last_ns) {
    if (before_.waiting) missed();
    if (newest_.waiting && last_ns - newest_.frame.time_ns > longest_ns_) missed();
  }

 private:
  struct Open {
    Frame frame{};
    bool waiting = false;
  };
  static bool same_bytes(const Frame& a, const Frame& b) { return a.id == b.id && a.data == b.data; }

  void missed() {
    ++e_.missed;
    e_.most_missed = std::max(e_.most_missed, ++in_a_row_);
    before_.waiting = false;
    see(false);
  }
  void answered(std::int64_t delay_ns) {
    in_a_row_ = 0;
    e_.latest_ns = std::max(e_.latest_ns, delay_ns);
    e_.late += delay_ns > longest_ns_;
    see(true);
  }
  void see(bool answered) {
    window_.push_back(answered);
    if (window_.size() > kShareWindow) window_.pop_front();
    if (window_.size() < kShareWindow) return;
    const auto count = static_cast<double>(std::ranges::count(window_, true));
    e_.worst_share = std::min(e_.worst_share, count / static_cast<double>(kShareWindow));
  }

  Exchange& e_;
  std::int64_t longest_ns_;
  Open newest_, before_;
  std::uint64_t in_a_row_ = 0;
  std::deque<bool> window_;
};

bool reply_length(const Frame& frame, Dialect dialect) {
  return dialect == Dialect::mit ? frame.length >= 6 && frame.length <= 8 : frame.length == 8;
}

void find_longest_gap(Exchange& e, const std::vector<Frame>& replies) {
  for (std::size_t i = 1; i < replies.size(); ++i) {
    const auto length_ns = replies[i].time_ns - replies[i - 1].time_ns;
    if (length_ns > e.longest_gap.length_ns)
      e.longest_gap = {length_ns, replies[i - 1].time_ns, replies[i].line};
  }
}

// Counts missing replies by the period, for a trace without commands or a drive that sends unasked.
void count_missing_by_period(Exchange& e, const std::vector<Frame>& replies) {
  for (std::size_t i = 1; i < replies.size() && e.period_ns > 0; ++i) {
    const auto step_ns = replies[i].time_ns - replies[i - 1].time_ns;
    const auto missing = std::llround(static_cast<double>(step_ns) / static_cast<double>(e.period_ns)) - 1;
    if (missing <= 0) continue;
    e.missed += static_cast<std::uint64_t>(missing);
    e.most_missed = std::max(e.most_missed, static_cast<std::uint64_t>(missing));
  }
}

std::vector<std::int64_t> times_of(const std::vector<Frame>& frames) {
  std::vector<std::int64_t> out;
  for (const auto& frame : frames) out.push_back(frame.time_ns);
  return out;
}

// Median step; the mean if most frames have the time of the frame before, in batches or with coarse times.
std::int64_t period_of(const std::vector<Frame>& frames) {
  const auto step_ns = steps(times_of(frames));
  const std::int64_t middle_ns = median(step_ns);
  if (middle_ns != 0 || step_ns.empty()) return middle_ns;
  const std::int64_t mean_ns =
      (frames.back().time_ns - frames.front().time_ns) / static_cast<std::int64_t>(step_ns.size());
  return std::max<std::int64_t>(mean_ns, 0);
}

}  // namespace

Exchange examine_exchange(const std::vector<Frame>& frames, const Roles& roles, Side side,
                          const CanConfig& config) {
  const auto& motor = config.motor[static_cast<std::size_t>(side)];
  Exchange e;
  Pairing pairing(e, longest_reply_ns(config));
  std::vector<Frame> commands, replies;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& frame = frames[i];
    const auto& part = roles.parts[i];
    if (part.side != side) continue;
    if (part.role == Role::ambiguous) ++e.ambiguous;
    if (part.role == Role::command) {
      e.set_zero += motor.dialect == Dialect::mit && frame.length == 8 && frame.data == kMitSetZero;
      commands.push_back(frame);
      pairing.command(frame);
    } else if (part.role == Role::reply && !reply_length(frame, motor.dialect)) {
      ++e.malformed;
    } else if (part.role == Role::reply) {
      replies.push_back(frame);
      pairing.reply(frame);
    }
  }
  if (!frames.empty()) pairing.end(frames.back().time_ns);
  e.replies = replies.size();
  const bool answers = motor.dialect != Dialect::servo && !commands.empty();
  e.period_ns = period_of(answers ? commands : replies);
  if (!answers) {
    e.missed = e.most_missed = e.late = e.unasked = 0;
    e.latest_ns = 0;
    e.begins_with_reply = false;
    e.worst_share = 1.0;
    count_missing_by_period(e, replies);
  }
  find_longest_gap(e, replies);
  return e;
}

}  // namespace sandhopper::trace
