#include <cmath>
#include <filesystem>
#include <fstream>

#include "config/load.hpp"
#include "config/robot_config.hpp"
#include "firmware/log/candump.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/trial/can_replay.hpp"
#include "tools/trial/replay.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string log;
  std::string trace;
  std::string interface;
  std::string output;
};

ExitCode replay(Session& session, const Options& options) {
  Progress progress("replaying", 1.0);
  ReplayResult result;
  try {
    result = replay_log(options.log, [&](double share) { progress.at(share); });
  } catch (const mcap::Error& error) {
    throw Failure(ExitCode::usage, error.what(), "name the .mcap file of a trial made by this build");
  }
  const bool identical = !result.mismatch;
  session.say("{}: {} cycles, {} events, {} strides replayed in {:.3f} s, {:.0f} x real time", options.log,
              result.cycles, result.events, result.strides, result.seconds, result.x_real_time);
  if (result.truncated_at)
    session.say("the log is cut at byte {}; compared up to there", *result.truncated_at);
  if (result.gaps > 0)
    session.say("{} records were lost when it was logged; what follows a gap differs by that", result.gaps);
  if (identical)
    session.say("identical: every output, event and stride is the same to the bit");
  else
    session.say("DIFFERENT: {} record {} at {} ns: {}", result.mismatch->topic, result.mismatch->record,
                result.mismatch->time_ns, result.mismatch->field);
  session.result = {
      {"identical", identical},  {"cycles", result.cycles},   {"x_real_time", result.x_real_time},
      {"events", result.events}, {"strides", result.strides}, {"gaps", result.gaps},
      {"files", result.files}};
  if (!identical)
    session.result["mismatch"] = {{"topic", result.mismatch->topic},
                                  {"record", result.mismatch->record},
                                  {"time_ns", result.mismatch->time_ns},
                                  {"difference", result.mismatch->field}};
  return identical ? ExitCode::ok : ExitCode::no;
}

void write_readings(const CanReplayResult& result, const std::string& path) {
  std::ofstream out(path);
  out << "t_s,motor,position_rad,velocity_radps,current_A,temperature_C,error_code\n";
  for (const auto& [trace_ns, reading] : result.decoded) {
    const auto& s = reading.sample;
    out << fmt::format(
        "{}.{:09},{},{},{},{},{},{}\n", trace_ns / 1'000'000'000, trace_ns % 1'000'000'000,
        reading.side == Side::left ? "left" : "right", s.position_rad, s.velocity_radps, s.current_A,
        std::isnan(s.temperature_C) ? std::string{} : fmt::format("{}", s.temperature_C), s.error_code);
  }
  if (!out.flush())
    throw Failure(ExitCode::fault, "cannot write " + path, "check the folder and the free space");
}

ExitCode replay_trace(Session& session, const Options& options) {
  CanConfig config;
  config.motor = load_file<RobotConfig>(session.config_file("robot.toml")).motor;
  Progress progress("playing frames", 0.0);
  std::optional<std::string> interface;
  if (!options.interface.empty()) interface = options.interface;
  CanReplayResult result;
  try {
    result = replay_can(options.trace, config, interface,
                        [&](std::uint64_t frames) { progress.at(static_cast<double>(frames)); });
  } catch (const CandumpError& error) {
    throw Failure(ExitCode::usage, error.what(), "name a trace as `candump -L` writes it");
  }
  if (result.frames == 0)
    throw Failure(ExitCode::usage, options.trace + " holds no CAN frame",
                  "name a trace as `candump -L` writes it");
  if (!options.output.empty()) write_readings(result, options.output);
  session.say("{}: {} frames, {} motor replies decoded, {} that do not look like the configured dialect",
              options.trace, result.frames, result.decoded.size(), result.rejected);
  if (result.driven)
    session.say("driver on {}: {} replies, {} lost, {} different, {} dropped by the kernel",
                options.interface, result.driven->size(), result.decoded.size() - result.driven->size(),
                result.different, result.overflows);
  session.result = {{"identical", result.identical()},
                    {"frames", result.frames},
                    {"decoded", result.decoded.size()},
                    {"rejected", result.rejected}};
  if (result.driven) {
    session.result["driven"] = result.driven->size();
    session.result["different"] = result.different;
  }
  if (result.decoded.empty())
    throw Failure(ExitCode::no, "no frame of the trace is a reply of the configured motors",
                  "compare the trace's identifiers and byte 0 with can_id and master_id in robot.toml");
  return result.identical() ? ExitCode::ok : ExitCode::no;
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  auto log = arguments.add_option("LOG", options->log, "a trial's .mcap file").existing_file();
  auto trace = arguments
                   .add_option("--can", options->trace,
                               "a candump -L trace instead of a log: decode its motor replies")
                   .existing_file()
                   .excludes(log);
  arguments
      .add_option(
          "--interface", options->interface,
          "also play the trace's replies on this CAN interface (vcan0) into the robot's driver, and compare")
      .needs(trace);
  arguments.add_option("--output", options->output, "write the decoded replies as CSV").needs(trace);
  arguments.footer(
      "In CI, a lab's own trace through the real driver on a virtual bus:\n"
      "  tools/bench --no-devices tools/hop replay --can my_trace.log --interface vcan0 --json");
  return [options](Session& session) {
    if (!options->trace.empty()) return replay_trace(session, *options);
    if (options->log.empty())
      throw Failure(ExitCode::usage, "nothing to replay", "name a log, or a trace with --can");
    return replay(session, *options);
  };
}

const VerbRegistration kReplay("replay", set_up);

}  // namespace
}  // namespace sandhopper::cli
