#include "firmware/log/mcap_reader.hpp"
#include "tools/cli/log_cure.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/replay_trace.hpp"
#include "tools/cli/verb.hpp"
#include "tools/trial/replay.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string log;
  ReplayTraceOptions can;
};

ExitCode replay(Session& session, const Options& options) {
  Progress progress("replaying", 1.0);
  ReplayResult result;
  try {
    result = replay_log(options.log, [&](double share) { progress.at(share); });
  } catch (const mcap::Error& error) {
    throw Failure(ExitCode::usage, error.what(),
                  cure_of(error, options.log, "name the .mcap file of a trial made by this build"));
  }
  const bool identical = !result.mismatch;
  session.say("{}: {} cycles, {} events, {} strides replayed in {:.3f} s, {:.0f} x real time", options.log,
              result.cycles, result.events, result.strides, result.seconds, result.x_real_time);
  if (result.truncated_at)
    session.say("the log is cut at byte {}; compared up to there", *result.truncated_at);
  if (result.gaps > 0)
    session.say("{} records are missing in the log; what follows a gap differs by that", result.gaps);
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

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  auto log = arguments.add_option("LOG", options->log, "a trial's .mcap file").existing_file();
  auto trace = arguments
                   .add_option("--can", options->can.trace,
                               "a candump -L trace instead of a log: decode its motor replies, and say what "
                               "else it contains")
                   .existing_file()
                   .excludes(log);
  arguments
      .add_option(
          "--interface", options->can.interface,
          "also play the trace's replies on this CAN interface (vcan0) into the robot's driver, and compare")
      .needs(trace);
  arguments.add_option("--bus", options->can.bus, "interface of the trace to take, where it has several")
      .needs(trace);
  arguments.add_option("--output", options->can.output, "write the decoded replies as CSV").needs(trace);
  arguments.footer(
      "With --can: exit status 1 where figures taken from the trace cannot be trusted. Error frames are in a "
      "trace only if\nthey were asked for: candump -L can0,0:0,#FFFFFFFF > my_trace.log\n"
      "In CI, a lab's own trace through the real driver on a virtual bus:\n"
      "  tools/bench --no-devices tools/hop replay --can my_trace.log --interface vcan0 --json");
  return [options](Session& session) {
    if (!options->can.trace.empty()) return replay_trace(session, options->can);
    if (options->log.empty())
      throw Failure(ExitCode::usage, "nothing to replay", "name a log, or a trace with --can");
    return replay(session, *options);
  };
}

const VerbRegistration kReplay("replay", set_up);

}  // namespace
}  // namespace sandhopper::cli
