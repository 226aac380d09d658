#include <filesystem>

#include "tools/cli/series_prompts.hpp"
#include "tools/cli/trial_runner.hpp"
#include "tools/cli/verb.hpp"
#include "tools/report/log_report.hpp"
#include "tools/report/trial_page.hpp"
#include "tools/trial/series_campaign.hpp"
#include "tools/trial/series_ground.hpp"
#include "tools/trial/trial_text.hpp"

namespace sandhopper::cli {
namespace {

namespace fs = std::filesystem;

using Outcome = TrialRunner::Outcome;

void tell(Session& session, const Outcome& outcome, const ReportData& data, const fs::path& page) {
  for (const auto& line : stride_lines(data)) session.say_line(line);
  if (outcome.last_fault != Fault::none) {
    const auto& entry = entry_of(outcome.last_fault);
    session.say("  FAULT {} {}: {}\n  cure: {}", static_cast<int>(outcome.last_fault),
                name_of(outcome.last_fault), entry.meaning, entry.cure);
  }
  for (const auto& note : data.notes) session.say("  note: {}", note);
  session.say("  log    {}", outcome.log.string());
  if (!page.empty()) session.say("  report {}", page.string());
}

nlohmann::ordered_json as_json(const Outcome& outcome, const ReportData& data, const fs::path& page) {
  auto strides = nlohmann::ordered_json::array();
  for (const auto& stride : data.strides) strides.push_back(stride_json(stride));
  return {{"strides", strides},
          {"log", outcome.log.string()},
          {"report", page.string()},
          {"last_state", std::string(name_of(outcome.last_state))},
          {"fault", std::string(name_of(outcome.last_fault))},
          {"notes", data.notes}};
}

// Results of the trials so far.
struct Tally {
  bool all_good = true;
  nlohmann::ordered_json trials = nlohmann::ordered_json::array();
  std::vector<ReportStride> strides;
  std::vector<SeriesTrial> series;
  std::string last_line;  // sentence about the ground from the newest trial
};

std::string why_unusable(const Outcome& outcome, const ReportData& data) {
  if (outcome.last_fault != Fault::none)
    return fmt::format("it ended in the fault {}", name_of(outcome.last_fault));
  return data.strides.empty() ? "no stride" : "";
}

void take(Session& session, const TrialOptions& options, const Outcome& outcome, Tally& tally) {
  const ReportData data = report_data_from_log(outcome.log);
  fs::path page;
  if (options.report) {
    page = fs::path(outcome.log).replace_extension(".html");
    write_trial_report(data, page);
  }
  session.say("trial {} of {}: {} strides", tally.trials.size() + 1, options.trials, data.strides.size());
  tell(session, outcome, data, page);
  tally.last_line = trial_line(data);
  tally.trials.push_back(as_json(outcome, data, page));
  tally.strides.insert(tally.strides.end(), data.strides.begin(), data.strides.end());
  tally.all_good = tally.all_good && why_unusable(outcome, data).empty();
  tally.series.push_back({outcome.log, {}, why_unusable(outcome, data)});
}

void tell_all(Session& session, const TrialOptions& options, const JointConfig& joint, const Tally& tally) {
  if (options.trials == 1 && tally.trials.size() == 1)
    session.result.update(tally.trials.front());
  else
    session.result["trials"] = tally.trials;
  if (const auto& said = tally.last_line; tally.trials.size() == 1 && !said.empty()) {
    session.say_line(said);
    session.result["ground"] = said;
  }
  if (const auto pooled = pooled_text(tally.strides, joint); !pooled.line.empty()) {
    session.say_line(pooled.line);
    session.result["pooled_stiffness_N_per_m"] = pooled.json;
  }
}

void tell_campaign(Session& session, const fs::path& folder) {
  session.say("campaign {}: look at it with 'hop terrain {}' and 'hop diagnose {}'", folder.string(),
              folder.string(), folder.string());
  session.result["campaign"] = folder.string();
}

ExitCode trial(Session& session, TrialOptions options) {
  if (options.series > 0) options.trials = options.series;
  auto sheet = gather_sheet(session, options);
  TrialRunner runner(session, options);
  Tally tally;
  SeriesGround ground(runner.robot());
  for (int number = 0; number < options.trials; ++number) {
    if (const auto next = ground.next(); next && options.series > 0) session.say_line(to_text(*next));
    if (options.series > 0 && can_ask(session) && !prepare_next(session, number, options.trials, *sheet)) {
      session.say("\nThe series was ended before trial {}: {} of {} trials are recorded.", number + 1, number,
                  options.trials);
      break;
    }
    const Outcome outcome = runner.run(number, options.trials, sheet);
    take(session, options, outcome, tally);
    if (sheet) tally.series.back().sheet = *sheet;
    if (options.series > 0 && !outcome.connection_lost) ground.add(outcome.log);
    if (options.series > 0) write_series_campaign(runner.folder(), runner.robot(), tally.series);
    if (outcome.connection_lost) break;
  }
  tell_all(session, options, runner.robot().stiffness.joint, tally);
  if (options.series > 0 && !tally.trials.empty()) tell_campaign(session, runner.folder());
  return tally.all_good && !tally.trials.empty() ? ExitCode::ok : ExitCode::no;
}

void add_sheet_options(Arguments& arguments, TrialOptions& options, const Option& trials) {
  arguments
      .add_option("--series", options.series,
                  "so many trials with the operator: before each, what to do to the bed, its release height "
                  "and notes; "
                  "the folder becomes a campaign for hop terrain and hop diagnose")
      .in_range(1, 1000)
      .excludes(trials);
  arguments.add_option(
      "--sheet", options.sheet,
      "trial sheet for the logs, a TOML file with who, bed, bed_preparation, release_height_m, payload_kg, "
      "notes; the options below go before it");
  arguments.add_option("--who", options.who, "trial sheet: who runs the trials");
  arguments.add_option("--bed", options.bed, "trial sheet: the bed's material");
  arguments.add_option("--bed-preparation", options.bed_preparation,
                       "trial sheet: what is done to the bed before each trial");
  arguments
      .add_option("--payload-kg", options.payload_kg, "trial sheet: mass on the body besides robot.toml's")
      .in_range(0.0, 20.0);
  arguments.add_option("--notes", options.notes, "trial sheet: notes");
}

void add_live_options(Arguments& arguments, TrialOptions& options) {
  arguments.add_flag(
      "--plain", options.plain,
      "no live view: the trial arms and releases by itself and is told in lines of text, as it is "
      "where standard output is no terminal");
  arguments.add_option("--speed", options.speed, "of the simulated board in the live view; 1: real time")
      .in_range(0.05, 10.0)
      .show_default();
  arguments
      .add_option(
          "--close-after-s", options.close_after_s,
          "the live view closes so long after the trial if no key is pressed, since the log still grows, by "
          "about 1 MB a second; 0: only q closes it")
      .in_range(0.0, 86400.0)
      .show_default();
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<TrialOptions>();
  arguments
      .add_option("--board", options->board,
                  "sim: simulated robot in the process; linux: hopperd on this machine's devices")
      .one_of({"sim", "linux"})
      .show_default();
  const auto trials = arguments.add_option("--trials", options->trials, "how many, each with a fresh bed")
                          .in_range(1, 100000)
                          .show_default();
  arguments.add_option("--strides", options->strides, "strides per trial, then a soft stop")
      .in_range(1, 10000)
      .show_default();
  auto height = arguments
                    .add_option("--release-height-m", options->release_height_m,
                                "height of the sole when released; 0.0618 gives 1 m/s")
                    .in_range(0.0005, 1.0)
                    .show_default();
  arguments
      .add_option("--compression-stiffness-N-per-m", options->compression_stiffness_N_per_m,
                  "instead of robot.toml's, e.g. 250, 375, 500")
      .in_range(10.0, 5000.0);
  arguments.add_option("--seed", options->seed, "of the first simulated trial; the next ones count up")
      .show_default();
  arguments.add_option("--noise", options->noise, "off: simulated sensors without noise, bias and spread")
      .one_of({"on", "off"})
      .show_default();
  arguments.add_option("--output", options->output, "folder for logs and reports; default trials/DATE_TIME");
  arguments.add_option("--devices", options->devices,
                       "device file for --board linux; default linux.toml, inside tools/bench bench.toml");
  add_sheet_options(arguments, *options, trials);
  add_live_options(arguments, *options);
  arguments.add_off_flag("--no-report", options->report, "write no report page");
  arguments.footer(
      "Below each stride: the ground's force, secant and tangent stiffness at each depth with 95 % "
      "intervals, and "
      "the shape that\nthe stride does not contradict (a line, a power law, a crust, layers). A stiffness of "
      "a line "
      "that is contradicted is not\nvalid. The last line says at which depths the ground is known.");
  return [options, height](Session& session) {
    options->release_height_given = height.given();
    return trial(session, *options);
  };
}

const VerbRegistration kTrial("trial", set_up);

}  // namespace
}  // namespace sandhopper::cli
