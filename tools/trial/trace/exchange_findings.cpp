#include <fmt/format.h>

#include "tools/trial/trace/exchange.hpp"

namespace sandhopper::trace {
namespace {

double milliseconds(std::int64_t ns) { return 1e-6 * static_cast<double>(ns); }

std::string gap_text(const Exchange& e) {
  if (e.longest_gap.length_ns == 0) return "";
  return fmt::format("; the longest time between two replies is {:.3g} ms, before line {}",
                     milliseconds(e.longest_gap.length_ns), e.longest_gap.line);
}

void find_missed(const Exchange& e, const std::string& who, const ReplyLimits& limits, Findings& out) {
  if (e.missed == 0) return;
  const bool too_many = e.most_missed >= static_cast<std::uint64_t>(limits.misses);
  const bool too_often = e.worst_share < limits.share;
  Finding finding{.kind = "missed_replies", .text = {}};
  if (e.commands > 0)
    finding.text = fmt::format("{}: {} of {} commands unanswered, at most {} in a row", who, e.missed,
                               e.commands, e.most_missed);
  else
    finding.text = fmt::format("{}: {} replies are missing between its {}, at most {} in a row", who,
                               e.missed, e.replies, e.most_missed);
  finding.text += gap_text(e);
  if (too_many)
    finding.text += fmt::format("; limits.motor_reply_misses = {} is a fault of the robot", limits.misses);
  if (too_often)
    finding.text += fmt::format(
        "; {:.0f} % of 50 commands answered, supervision.motor_reply_share asks for "
        "{:.0f} %",
        100.0 * e.worst_share, 100.0 * limits.share);
  finding.trusted = !too_many && !too_often;
  finding.cure =
      "check wiring, termination and supply of the drive; see whether the recorder lost frames "
      "(ip -statistics link show can0)";
  out.push_back(finding);
}

void find_unasked(const Exchange& e, const std::string& who, Findings& out) {
  if (e.doubled > 0)
    out.push_back({"doubled_replies",
                   fmt::format("{}: {} replies stand twice, same bytes at the same time, and count once", who,
                               e.doubled),
                   "record one interface once: candump -L can0"});
  if (e.commands > 0 && e.unasked > 0)
    out.push_back(
        {"unasked_replies", fmt::format("{}: {} of {} replies came unasked", who, e.unasked, e.replies),
         "give two drives with the same can_id different ones; see that the trace has the commands", false});
}

// If the trace begins with a reply and most replies are late, each may have been stamped before its own
// command and be taken for the answer to the command before.
void find_late(const Exchange& e, const std::string& who, Findings& out) {
  if (e.late == 0) return;
  Finding finding{
      "late_replies",
      fmt::format("{}: {} replies came later than the bus alone can delay them, the latest {:.3g} ms "
                  "after its command",
                  who, e.late, milliseconds(e.latest_ns))};
  if (e.begins_with_reply && 2 * e.late > e.replies) {
    finding.text += "; as the trace begins with a reply, they may be stamped before their own commands";
    finding.cure = "record commands and replies on one interface with its own stamps: candump -L -H can0";
    finding.trusted = false;
  }
  out.push_back(finding);
}

}  // namespace

Findings exchange_findings(const Exchange& e, const CubeMarsConfig& motor, Evidence evidence,
                           const ReplyLimits& limits) {
  Findings out;
  const std::string who = fmt::format("motor {} (can_id {})", motor.name, motor.can_id);
  if (evidence == Evidence::none && e.ambiguous > 0)
    out.push_back({"ambiguous_frames",
                   fmt::format("{}: {} frames on {:03X} may be commands or replies; none is decoded", who,
                               e.ambiguous, motor.can_id),
                   "record with the direction of each frame, on the computer that sends them: candump -L -x",
                   false});
  find_missed(e, who, limits, out);
  find_late(e, who, out);
  find_unasked(e, who, out);
  if (e.commands_twice > 0)
    out.push_back({"doubled_commands",
                   fmt::format("{}: {} commands stand twice before any reply, as sent and as echo, and count "
                               "once",
                               who, e.commands_twice)});
  if (e.set_zero > 0)
    out.push_back({"zero_set",
                   fmt::format("{}: its zero was set {} times; positions before and after cannot be compared",
                               who, e.set_zero),
                   "replay the part after the last set-zero frame", false});
  if (e.malformed > 0)
    out.push_back(
        {"malformed_replies",
         fmt::format("{}: {} replies have a length that no reply of its dialect has", who, e.malformed),
         "compare dialect and reply in robot.toml with the drive", false});
  return out;
}

}  // namespace sandhopper::trace
