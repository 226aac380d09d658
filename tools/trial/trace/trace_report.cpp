#include "tools/trial/trace/trace_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/can/drive_error.hpp"
#include "tools/trial/trace/frozen_replies.hpp"
#include "tools/trial/trace/misplaced.hpp"
#include "tools/trial/trace/position_jumps.hpp"
#include "tools/trial/trace/speed_ratio.hpp"
#include "tools/trial/trace/temperature.hpp"
#include "tools/trial/trace/timing.hpp"
#include "tools/trial/trace/torque_ratio.hpp"

namespace sandhopper::trace {
namespace {

can_frame can_frame_of(const Frame& frame) {
  can_frame out{};
  out.can_id = frame.id;
  out.can_dlc = frame.length;
  std::copy_n(frame.data.begin(), frame.length, out.data);
  return out;
}

void append(Findings& findings, const Findings& more) {
  findings.insert(findings.end(), more.begin(), more.end());
}

// Median time between commands of the motor with the most commands; without commands that between replies.
std::int64_t period_of(const TraceReport& report, const CanConfig& config) {
  const Exchange* most = &report.motors[0];
  for (std::size_t m = 1; m < static_cast<std::size_t>(config.motor_count); ++m)
    if (report.motors[m].commands + report.motors[m].replies > most->commands + most->replies)
      most = &report.motors[m];
  return most->period_ns;
}

void decode(const std::vector<Frame>& frames, const Roles& roles, const CanConfig& config,
            TraceReport& report) {
  CanTraceDecoder decoder(config);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& part = roles.parts[i];
    if (part.role == Role::doubled) ++report.doubled_others;
    if (part.role != Role::command && part.role != Role::reply) continue;
    const auto direction = part.role == Role::command ? FrameDirection::sent : FrameDirection::received;
    const auto frame = can_frame_of(frames[i]);
    const auto reading = decoder.decode(frame, frames[i].time_ns, direction);
    if (!reading) continue;
    report.decoded.push_back({frames[i].time_ns, frames[i].line, frame, *reading});
    if (const auto code = reading->sample.error_code; code != 0)
      ++report.drive_errors[static_cast<std::size_t>(reading->side)][code];
  }
}

// Copies of replies are already counted with their motor.
void count_doubled(const std::vector<Frame>& frames, const Roles& roles, TraceReport& report) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (roles.parts[i].role != Role::doubled) continue;
    for (std::size_t j = i; j-- > 0;) {
      if (roles.parts[j].role == Role::doubled || frames[j].id != frames[i].id ||
          frames[j].data != frames[i].data)
        continue;
      if (roles.parts[j].role == Role::reply) {
        ++report.motors[static_cast<std::size_t>(roles.parts[j].side)].doubled;
        --report.doubled_others;
      }
      break;
    }
  }
}

Findings file_findings(const Trace& trace) {
  Findings out;
  if (trace.unreadable.count > 0)
    out.push_back({"unreadable_lines",
                   fmt::format("{} lines are no frame; line {}: {}", trace.unreadable.count,
                               trace.unreadable.first_line, trace.unreadable.first),
                   "each may be a lost frame: see what wrote them", false});
  if (trace.spreadsheet_numbers.count > 0)
    out.push_back(
        {"spreadsheet_numbers",
         fmt::format("in {} lines a spreadsheet turned the data into a number, and digits are lost; "
                     "line {}: \"{}\"",
                     trace.spreadsheet_numbers.count, trace.spreadsheet_numbers.first_line,
                     trace.spreadsheet_numbers.first),
         "take the file from the recorder, not from the spreadsheet, or import its columns as text "
         "there; replies without their data count as missing here",
         false});
  if (trace.zero_bytes > 0)
    out.push_back(
        {"zero_bytes",
         fmt::format("{} bytes are zero, as after a power cut while it was recorded", trace.zero_bytes),
         "frames are lost there: replay the parts before and after as traces of their own", false});
  if (trace.passed_over.count > 0)
    out.push_back(
        {"other_lines",
         fmt::format("{} lines begin with no time and are passed over; line {}: \"{}\"",
                     trace.passed_over.count, trace.passed_over.first_line, trace.passed_over.first)});
  if (trace.last_line_torn)
    out.push_back({"torn_end", "the last line is torn, as after a power cut, and left out"});
  if (trace.lost_by_recorder > 0)
    out.push_back({"lost_by_recorder",
                   fmt::format("{} frames were lost while recording, by the trace's own comments",
                               trace.lost_by_recorder),
                   "replies counted as missed may be among them", false});
  if (trace.losses.count > 0)
    out.push_back(
        {"lost_by_recorder",
         fmt::format(
             "the recorder lost frames{}; line {}: \"{}\"{}",
             trace.frames_in_losses > 0 ? fmt::format(", {} by its own words", trace.frames_in_losses) : "",
             trace.losses.first_line, trace.losses.first,
             trace.losses.count > 1 ? fmt::format(" and {} more such lines", trace.losses.count - 1) : ""),
         "record only the motors' identifiers, to a disk that keeps up, with a longer buffer: candump -L -r "
         "1048576 can0",
         false});
  return out;
}

Findings drive_error_findings(const TraceReport& report, const CanConfig& config) {
  Findings out;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m)
    for (const auto& [code, count] : report.drive_errors[m]) {
      const auto& side_of = [&](const TimedReading& r) {
        return static_cast<std::size_t>(r.reading.side) == m && r.reading.sample.error_code == code;
      };
      const auto first = std::ranges::find_if(report.decoded, side_of);
      const auto& motor = config.motor[m];
      if (code == kErrorPositionNearRangeEnd) {
        if (has_exchanged_bytes(report.decoded, static_cast<Side>(m), motor)) continue;
        out.push_back(
            {"near_range_end",
             fmt::format("motor {}: {} replies are beyond {:.0f} % of position_range_rad = {:g}, first "
                         "in line {}",
                         motor.name, count, 100.0 * kUsablePositionShare, motor.position_range_rad,
                         first->line),
             "set the drive's zero nearer to the middle of its travel", false});
        continue;
      }
      out.push_back(
          {"drive_fault",
           fmt::format("motor {}: its drive reports {} (code {}) in {} of {} replies, first in line {}",
                       motor.name, drive_error_name(code), code, count, report.motors[m].replies,
                       first->line),
           "remove the cause and power-cycle the drive", false});
    }
  return out;
}

std::string identifier(std::uint32_t id) {
  if ((id & CAN_EFF_FLAG) != 0) return fmt::format("{:08X}", id & CAN_EFF_MASK);
  return fmt::format("{:03X}{}", id & CAN_SFF_MASK, (id & CAN_RTR_FLAG) != 0 ? " (remote)" : "");
}

Findings other_findings(const TraceReport& report) {
  Findings out;
  if (!report.dialects.other.empty()) {
    constexpr std::size_t kShown = 8;
    std::string text;
    std::uint64_t frames = 0;
    std::size_t shown = 0;
    for (const auto& [id, count] : report.dialects.other) {
      frames += count;
      if (shown++ < kShown) text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", identifier(id), count);
    }
    if (shown > kShown) text += fmt::format(" and {} more", shown - kShown);
    out.push_back({"other_identifiers", fmt::format("{} frames of other identifiers: {}", frames, text)});
  }
  if (report.doubled_others > 0)
    out.push_back(
        {"doubled_frames",
         fmt::format("{} frames that are no replies stand twice and count once", report.doubled_others),
         "record one interface once: candump -L can0"});
  return out;
}

Findings silent_motor_findings(const TraceReport& report, const CanConfig& config) {
  Findings out;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    const auto& e = report.motors[m];
    const auto& motor = config.motor[m];
    if (e.replies > 0 || e.ambiguous > 0) continue;
    if (e.commands > 0)
      out.push_back({"no_replies",
                     fmt::format("motor {} (can_id {}): {} commands and no reply", motor.name, motor.can_id,
                                 e.commands),
                     "compare its master_id with the trace's identifiers; see that its drive is on", false});
    else
      out.push_back({"no_frames", fmt::format("motor {} (can_id {}): no frame", motor.name, motor.can_id)});
  }
  return out;
}

// Finding for two buses in one trace with the same drive numbers.
Findings interface_findings(const Trace& trace, const Roles& roles) {
  std::array<std::vector<std::uint64_t>, kMotorCount> replies;
  for (auto& counts : replies) counts.resize(trace.interfaces.size());
  for (std::size_t i = 0; i < trace.frames.size(); ++i)
    if (roles.parts[i].role == Role::reply)
      ++replies[static_cast<std::size_t>(roles.parts[i].side)][trace.frames[i].interface];
  Findings out;
  for (const auto& counts : replies) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < counts.size(); ++i)
      if (counts[i] > 0) names.push_back(trace.interfaces[i]);
    if (names.size() < 2) continue;
    out.push_back({"several_interfaces",
                   fmt::format("replies of one motor come on {}", fmt::join(names, " and ")),
                   fmt::format("take one of them: --bus {}", names.front()), false});
    break;
  }
  return out;
}

}  // namespace

TraceReport examine_trace(Trace trace, const CanConfig& config, const TraceLimits& limits) {
  TraceReport report;
  auto& frames = trace.frames;
  report.frames = frames.size();
  report.fd_frames = trace.fd_frames;
  report.bus = count_bus_errors(frames);
  const auto in_file_order = frames;
  put_in_order(frames, examine_clock(in_file_order, INT64_MAX));
  const Roles roles = find_roles(frames, config);
  std::vector<std::uint64_t> replies;
  for (std::size_t m = 0; m < kMotorCount; ++m) {
    report.motors[m] = examine_exchange(frames, roles, static_cast<Side>(m), config);
    replies.push_back(report.motors[m].replies);
  }
  const auto period_ns = period_of(report, config);
  report.clock = examine_clock(in_file_order, period_ns > 0 ? limits.cycle_gap * period_ns : INT64_MAX);
  report.dialects = examine_dialects(frames, roles, config);
  decode(frames, roles, config, report);
  count_doubled(frames, roles, report);

  report.findings = file_findings(trace);
  append(report.findings, misplaced_findings(report, trace, config));
  if (const auto digits = trace.digits.findings(trace.file); !digits.empty()) {
    append(report.findings, digits);
    return report;  // without right times nothing can be paired
  }
  if (trace.spreadsheet_numbers.count > 0) return report;  // other findings would be its consequences
  append(report.findings, clock_findings(report.clock, trace, period_ns));
  if (report.clock.differences) return report;  // without times nothing can be paired
  append(report.findings, interface_findings(trace, roles));
  append(report.findings, dialect_findings(report.dialects, config, replies));
  append(report.findings, bus_error_findings(report.bus));
  append(report.findings, drive_error_findings(report, config));
  append(report.findings, temperature_findings(report, config, limits.motor_temperature_C));
  append(report.findings, position_jump_findings(report, config));
  append(report.findings, frozen_findings(report, config));
  append(report.findings, speed_findings(report, config));
  append(report.findings, torque_findings(report, frames, roles, config));
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m)
    append(report.findings,
           exchange_findings(report.motors[m], config.motor[m], roles.evidence[m], limits.replies));
  append(report.findings, silent_motor_findings(report, config));
  append(report.findings, other_findings(report));
  return report;
}

}  // namespace sandhopper::trace
