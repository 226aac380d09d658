#include <fmt/chrono.h>

#include <chrono>
#include <ctime>
#include <filesystem>

#include "config/files.hpp"
#include "config/load.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/plant/load_world.hpp"
#include "tools/report/log_report.hpp"
#include "tools/report/trial_page.hpp"
#include "tools/trial/linux_trial.hpp"
#include "tools/trial/sim_trial.hpp"
#include "tools/trial/trial_text.hpp"

namespace sandhopper::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string board = "sim";
  int trials = 1;
  int strides = 3;
  double release_height_m = 0.0618;
  double compression_stiffness_N_per_m = 0.0;  // 0: as in robot.toml
  std::uint64_t seed = 1;
  std::string noise = "on";
  std::string output;
  std::string devices;
  bool report = true;
};

RobotConfig load_robot(Session& session, const Options& options) {
  auto robot = load_file<RobotConfig>(session.config_file("robot.toml"));
  robot.limits.strides = options.strides;
  if (options.compression_stiffness_N_per_m > 0.0)
    robot.controller.compression_stiffness_N_per_m = options.compression_stiffness_N_per_m;
  return robot;
}

fs::path make_folder(const Options& options) {
  fs::path folder = options.output;
  if (folder.empty()) {
    const std::time_t now = std::time(nullptr);
    folder = fs::path("trials") / fmt::format("{:%Y-%m-%d_%H-%M-%S}", fmt::localtime(now));
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Failure(ExitCode::usage, "cannot make " + folder.string() + ": " + error.message(),
                  "name a folder you may write with --output");
  return folder;
}

std::int64_t date_ns() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

TrialSetup trial_setup(const Options& options, int number) {
  return {.release_height_m = options.release_height_m,
          .seed = options.seed + static_cast<std::uint64_t>(number),
          .noise = options.noise == "on"};
}

struct Outcome {
  fs::path log;
  State last_state;
  Fault last_fault;
};

// Both boards give a log; everything said afterwards is read from it.
class Runner {
 public:
  // Reads all of the configuration before anything is made or started.
  Runner(Session& session, const Options& options)
      : session_(session), options_(options), robot_(load_robot(session, options)) {
    if (options.board == "sim") {
      world_ = load_world(session.config_directory(), robot_);
    } else {
      devices_ = options.devices.empty() ? session.config_file(board_file()) : options.devices;
      load_linux_board(devices_, robot_);
    }
    folder_ = make_folder(options);
  }

  const JointConfig& joint_config() const { return robot_.stiffness.joint; }

  Outcome run(int number) {
    const fs::path log = folder_ / fmt::format("trial_{:03}.mcap", number + 1);
    if (fs::exists(log))
      throw Failure(ExitCode::usage, log.string() + " exists and is not overwritten",
                    "name another folder with --output");
    return options_.board == "sim" ? simulate(number, log) : run_linux(number, log);
  }

 private:
  Outcome simulate(int number, const fs::path& log) {
    Progress progress(fmt::format("trial {}", number + 1), 4.0);
    const auto result = run_sim_trial({.robot = robot_,
                                       .world = world_,
                                       .trial = trial_setup(options_, number),
                                       .log = log,
                                       .realtime_offset_ns = date_ns(),  // its own time starts at zero
                                       .progress = [&](double time_s) { progress.at(time_s); }});
    return {log, result.last_state, result.last_fault};
  }

  Outcome run_linux(int number, const fs::path& log) {
    const auto result = run_linux_trial({.config_directory = session_.config_directory(),
                                         .devices = devices_,
                                         .robot = robot_,
                                         .trial = trial_setup(options_, number),
                                         .log = log,
                                         .say = [&](const std::string& line) { session_.say_line(line); }});
    return {log, result.last_state, result.last_fault};
  }

  Session& session_;
  const Options& options_;
  RobotConfig robot_;
  fs::path devices_;
  fs::path folder_;
  WorldConfig world_{};
};

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

ExitCode trial(Session& session, const Options& options) {
  Runner runner(session, options);
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
  }
  if (options.trials == 1)
    session.result.update(trials.front());
  else
    session.result["trials"] = trials;
  if (const auto pooled = pooled_text(strides, runner.joint_config()); !pooled.line.empty()) {
    session.say_line(pooled.line);
    session.result["pooled_stiffness_N_per_m"] = pooled.json;
  }
  return all_good ? ExitCode::ok : ExitCode::no;
}

Run set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
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
  app.add_flag("!--no-report", options->report, "write no report page");
  return [options](Session& session) { return trial(session, *options); };
}

const VerbRegistration kTrial({"trial", "run hop trials and say how stiff the ground is", set_up});

}  // namespace
}  // namespace sandhopper::cli
