#include <filesystem>

#include "firmware/log/mcap_reader.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/trial/replay.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string log;
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
      {"events", result.events}, {"strides", result.strides}, {"gaps", result.gaps}};
  if (!identical)
    session.result["mismatch"] = {{"topic", result.mismatch->topic},
                                  {"record", result.mismatch->record},
                                  {"time_ns", result.mismatch->time_ns},
                                  {"difference", result.mismatch->field}};
  return identical ? ExitCode::ok : ExitCode::no;
}

Run set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("LOG", options->log, "a trial's .mcap file")->required()->check(CLI::ExistingFile);
  return [options](Session& session) { return replay(session, *options); };
}

const VerbRegistration kReplay({"replay", "run the cycle again on a log's frames and compare every output",
                                set_up});

}  // namespace
}  // namespace sandhopper::cli
