#include "tools/cli/replay_trace.hpp"

#include <cmath>
#include <fstream>

#include "config/load.hpp"
#include "config/robot_config.hpp"
#include "drivers/can/drive_error.hpp"
#include "firmware/log/candump.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/trial/can_replay.hpp"
#include "tools/trial/trace/foreign_format.hpp"

namespace sandhopper::cli {
namespace {

using nlohmann::ordered_json;

void write_readings(const CanReplayResult& result, const std::string& path) {
  std::ofstream out(path);
  out << "t_s,motor,position_rad,velocity_radps,current_A,temperature_C,error_code\n";
  for (const auto& decoded : result.trace.decoded) {
    const auto& s = decoded.reading.sample;
    out << fmt::format(
        "{}.{:09},{},{},{},{},{},{}\n", decoded.trace_ns / 1'000'000'000, decoded.trace_ns % 1'000'000'000,
        decoded.reading.side == Side::left ? "left" : "right", s.position_rad, s.velocity_radps, s.current_A,
        std::isnan(s.temperature_C) ? std::string{} : fmt::format("{}", s.temperature_C), s.error_code);
  }
  if (!out.flush())
    throw Failure(ExitCode::fault, "cannot write " + path, "check the folder and the free space");
}

CanReplaySetup setup_of(Session& session, const ReplayTraceOptions& options) {
  const auto robot = load_file<RobotConfig>(session.config_file("robot.toml"));
  CanReplaySetup setup;
  setup.config.motor = robot.motor;
  setup.config.motor_count = robot.robot.motor_count;
  setup.limits = {{robot.limits.motor_reply_misses, robot.supervision.motor_reply_share},
                  robot.supervision.cycle_gap,
                  robot.limits.motor_temperature_C};
  setup.bus = options.bus;
  if (!options.interface.empty()) setup.interface = options.interface;
  return setup;
}

Failure no_trace(const std::string& file, const std::string& what) {
  if (const auto format = trace::recognise_format(file))
    return {ExitCode::usage, fmt::format("{} is {}, not candump -L text", file, format->what), format->cure};
  return {ExitCode::usage, what, "name a trace as `candump -L` writes it"};
}

CanReplayResult run(const ReplayTraceOptions& options, const CanReplaySetup& setup) {
  if (const auto format = trace::recognise_format(options.trace)) throw no_trace(options.trace, "");
  Progress progress("reading frames", 0.0);
  try {
    auto result = replay_can(options.trace, setup,
                             [&](std::uint64_t frames) { progress.at(static_cast<double>(frames)); });
    if (result.trace.frames + result.trace.fd_frames > 0) return result;
  } catch (const CandumpError& error) {
    throw no_trace(options.trace, fmt::format("{}: {}", options.trace, error.what()));
  }
  throw no_trace(options.trace, options.trace + " holds no CAN frame" +
                                    (options.bus.empty() ? "" : " of interface " + options.bus));
}

ordered_json motor_json(const trace::TraceReport& report, std::size_t m, const std::string& name) {
  const auto& e = report.motors[m];
  auto faults = ordered_json::object();
  for (const auto& [code, count] : report.drive_errors[m])
    faults[code == kErrorPositionNearRangeEnd ? "position near range end"
                                              : std::string(drive_error_name(code))] = count;
  return {{"name", name},
          {"commands", e.commands},
          {"replies", e.replies},
          {"missed", e.missed},
          {"most_missed_in_a_row", e.most_missed},
          {"late", e.late},
          {"latest_reply_s", 1e-9 * static_cast<double>(e.latest_ns)},
          {"longest_gap_s", 1e-9 * static_cast<double>(e.longest_gap.length_ns)},
          {"longest_gap_line", e.longest_gap.line},
          {"unasked", e.unasked},
          {"doubled", e.doubled},
          {"malformed", e.malformed},
          {"ambiguous", e.ambiguous},
          {"drive_faults", faults}};
}

ordered_json as_json(const CanReplayResult& result, const CanConfig& config) {
  const auto& report = result.trace;
  std::uint64_t rejected = 0;
  auto motors = ordered_json::array();
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    motors.push_back(motor_json(report, m, config.motor[m].name));
    rejected += report.motors[m].malformed;
  }
  auto findings = ordered_json::array();
  for (const auto& f : report.findings)
    findings.push_back({{"kind", f.kind}, {"text", f.text}, {"cure", f.cure}, {"trusted", f.trusted}});
  ordered_json json{{"identical", result.identical()},
                    {"trusted", report.trusted()},
                    {"frames", report.frames},
                    {"decoded", report.decoded.size()},
                    {"rejected", rejected},
                    {"motors", motors},
                    {"error_frames", report.bus.frames},
                    {"error_kinds", report.bus.kinds},
                    {"swapped", report.clock.swapped},
                    {"clock_steps_back", report.clock.steps_back.size()},
                    {"pauses", report.clock.pauses.size()},
                    {"findings", findings}};
  if (result.driven) {
    json["driven"] = result.driven->size();
    json["different"] = result.different;
  }
  return json;
}

void tell(Session& session, const CanReplayResult& result, const ReplayTraceOptions& options,
          const CanConfig& config) {
  const auto& report = result.trace;
  session.say("{}: {} frames, {} motor replies decoded", options.trace, report.frames, report.decoded.size());
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    const auto& e = report.motors[m];
    if (e.commands + e.replies == 0) continue;
    session.say("  motor {}: {} commands, {} replies; the longest time between two replies is {:.3f} ms",
                config.motor[m].name, e.commands, e.replies,
                1e-6 * static_cast<double>(e.longest_gap.length_ns));
  }
  for (const auto& finding : report.findings) {
    session.say("  {}{}", finding.trusted ? "" : "NOT TO BE TRUSTED: ", finding.text);
    if (!finding.cure.empty()) session.say("    -> {}", finding.cure);
  }
  if (result.driven)
    session.say("driver on {}: {} replies, {} lost, {} different, {} dropped by the kernel",
                options.interface, result.driven->size(), report.decoded.size() - result.driven->size(),
                result.different, result.overflows);
}

}  // namespace

ExitCode replay_trace(Session& session, const ReplayTraceOptions& options) {
  const auto setup = setup_of(session, options);
  const auto result = run(options, setup);
  if (!options.output.empty()) write_readings(result, options.output);
  tell(session, result, options, setup.config);
  session.result = as_json(result, setup.config);
  if (result.trace.decoded.empty() && result.trace.trusted())
    throw Failure(ExitCode::no, "no frame of the trace is a reply of the configured motors",
                  "compare the trace's identifiers and byte 0 with can_id and master_id in robot.toml");
  return result.identical() && result.trace.trusted() ? ExitCode::ok : ExitCode::no;
}

}  // namespace sandhopper::cli
