#include <filesystem>

#include "tools/cli/trial_runner.hpp"
#include "tools/cli/verb.hpp"
#include "tools/report/log_report.hpp"
#include "tools/report/trial_page.hpp"
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
          {"fault", std::string(name_of(outcome.last_fault))}};
}

ExitCode trial(Session& session, const TrialOptions& options) {
  TrialRunner runner(session, options);
  bool all_good = true;
  auto trials = nlohmann::ordered_json::array();
  std::vector<ReportStride> strides;
  for (int number = 0; number < options.trials; ++number) {
    const Outcome outcome = runner.run(number);
    const ReportData data = report_data_from_log(outcome.log);
    fs::path page;
    if (options.report) {
      page = fs::path(outcome.log).replace_extension(".html");
      write_trial_report(data, page);
    }
    session.say("trial {} of {}: {} strides", number + 1, options.trials, data.strides.size());
    tell(session, outcome, data, page);
    trials.push_back(as_json(outcome, data, page));
    strides.insert(strides.end(), data.strides.begin(), data.strides.end());
    all_good = all_good && outcome.last_fault == Fault::none && !data.strides.empty();
    if (outcome.connection_lost) break;
  }
  if (options.trials == 1)
    session.result.update(trials.front());
  else
    session.result["trials"] = trials;
  if (const auto pooled = pooled_text(strides, runner.robot().stiffness.joint); !pooled.line.empty()) {
    session.say_line(pooled.line);
    session.result["pooled_stiffness_N_per_m"] = pooled.json;
  }
  return all_good ? ExitCode::ok : ExitCode::no;
}

Run set_up(CLI::App& app) {
  auto options = std::make_shared<TrialOptions>();
  app.add_option("--board", options->board,
                 "sim: simulated robot in the process; linux: hopperd on this machine's devices")
      ->check(CLI::IsMember({"sim", "linux"}))
      ->capture_default_str();
  app.add_option("--trials", options->trials, "how many, each with a fresh bed")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--strides", options->strides, "strides per trial, then a soft stop")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--release-height-m", options->release_height_m,
                 "height of the sole when released; 0.0618 gives 1 m/s")
      ->check(CLI::Range(0.0005, 1.0))
      ->capture_default_str();
  app.add_option("--compression-stiffness-N-per-m", options->compression_stiffness_N_per_m,
                 "instead of robot.toml's, e.g. 250, 375, 500")
      ->check(CLI::Range(10.0, 5000.0));
  app.add_option("--seed", options->seed, "of the first simulated trial; the next ones count up")
      ->capture_default_str();
  app.add_option("--noise", options->noise, "off: simulated sensors without noise, bias and spread")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  app.add_option("--output", options->output, "folder for logs and reports; default trials/DATE_TIME");
  app.add_option("--devices", options->devices,
                 "device file for --board linux; default linux.toml, inside tools/bench bench.toml");
  app.add_flag("--plain", options->plain,
               "no live view: the trial arms and releases by itself and is told in lines of text, as it is "
               "where standard output is no terminal");
  app.add_option("--speed", options->speed, "of the simulated board in the live view; 1: real time")
      ->check(CLI::Range(0.05, 10.0))
      ->capture_default_str();
  app.add_flag("!--no-report", options->report, "write no report page");
  return [options](Session& session) { return trial(session, *options); };
}

const VerbRegistration kTrial({"trial", "run hop trials and say how stiff the ground is", set_up});

}  // namespace
}  // namespace sandhopper::cli
