#include "tools/cli/trial_runner.hpp"

#include <fmt/chrono.h>

#include <chrono>
#include <ctime>
#include <memory>

#include "config/consistency.hpp"
#include "config/dump.hpp"
#include "config/files.hpp"
#include "config/load.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/output_folder.hpp"
#include "tools/cli/progress.hpp"
#include "tools/plant/load_world.hpp"
#include "tools/trial/linux_trial.hpp"
#include "tools/trial/live/daemon_link.hpp"
#include "tools/trial/live/live_terminal.hpp"
#include "tools/trial/live/simulated_link.hpp"
#include "tools/trial/sim_trial.hpp"

namespace sandhopper::cli {
namespace {

namespace fs = std::filesystem;

RobotConfig load_robot(Session& session, const TrialOptions& options) {
  const auto file = session.config_file("robot.toml");
  auto robot = load_robot_file(file);
  robot.limits.strides = options.strides;
  if (options.compression_stiffness_N_per_m > 0.0)
    robot.controller.compression_stiffness_N_per_m = options.compression_stiffness_N_per_m;
  refuse(contradictions(robot), {fmt::format("{} with the options of the command line", file), {}});
  return robot;
}

fs::path make_folder(const TrialOptions& options) {
  if (!options.output.empty()) return made(options.output);
  const std::time_t now = std::time(nullptr);
  return made(not_there_yet(fs::path("trials") / fmt::format("{:%Y-%m-%d_%H-%M-%S}", fmt::localtime(now))));
}

std::int64_t date_ns() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

// Several trials without --series are a batch that must run without an operator.
bool wants_view(const Session& session, const TrialOptions& options) {
  return !options.plain && !session.json && (options.trials == 1 || options.series > 0) &&
         LiveTerminal::available();
}

}  // namespace

TrialRunner::TrialRunner(Session& session, const TrialOptions& options)
    : session_(session),
      options_(options),
      live_(wants_view(session, options)),
      robot_(load_robot(session, options)) {
  if (options.board == "sim") {
    world_ = load_world(session.config_directory(), robot_);
  } else {
    devices_ = options.devices.empty() ? session.config_file(board_file()) : options.devices;
    load_linux_board(devices_, robot_);
  }
  folder_ = make_folder(options);
}

TrialSetup TrialRunner::setup_of(int number) const {
  const auto height_m =
      sheet_ && sheet_->release_height_m ? *sheet_->release_height_m : options_.release_height_m;
  return {.release_height_m = height_m,
          .seed = options_.seed + static_cast<std::uint64_t>(number),
          .noise = options_.noise == "on"};
}

SimTrialSetup TrialRunner::simulated_setup(int number, const fs::path& log) const {
  return {.robot = robot_,
          .world = world_,
          .trial = setup_of(number),
          .sheet = sheet_,
          .log = log,
          .realtime_offset_ns = date_ns()};  // simulated time starts at 0
}

LinuxTrialSetup TrialRunner::linux_setup(int number, const fs::path& log) {
  return {.config_directory = session_.config_directory(),
          .devices = devices_,
          .robot = robot_,
          .trial = setup_of(number),
          .sheet = sheet_,
          .log = log,
          .say = [this](const std::string& line) { session_.say_line(line); }};
}

TrialRunner::Outcome TrialRunner::run(int number, int trials, const std::optional<TrialSheet>& sheet) {
  trials_ = trials;
  sheet_ = sheet;
  const fs::path log = folder_ / fmt::format("trial_{:03}.mcap", number + 1);
  if (fs::exists(log))
    throw Failure(ExitCode::usage, log.string() + " exists and is not overwritten",
                  "name another folder with --output");
  if (live_) return run_live(number, log);
  return options_.board == "sim" ? simulate(number, log) : run_linux(number, log);
}

TrialRunner::Outcome TrialRunner::simulate(int number, const fs::path& log) {
  Progress progress(fmt::format("trial {}", number + 1), 4.0);
  auto setup = simulated_setup(number, log);
  setup.progress = [&](double time_s) { progress.at(time_s); };
  const auto result = run_sim_trial(setup);
  return {log, result.last_state, result.last_fault};
}

TrialRunner::Outcome TrialRunner::run_linux(int number, const fs::path& log) {
  const auto result = run_linux_trial(linux_setup(number, log));
  return {log, result.last_state, result.last_fault};
}

TrialModel TrialRunner::model_of(int number, const fs::path& log) const {
  TrialModel model;
  model.title = fmt::format("hop trial {} of {}", number + 1, trials_);
  if (options_.board == "sim")
    model.place = fmt::format("simulated board, {:g} x real time", options_.speed);
  else
    model.place = on_virtual_bench() ? "virtual bench" : "robot";
  model.log = log.string();
  if (sheet_) model.sheet = entries_of(*sheet_);
  model.config = cycle_config(robot_);
  model.robot = to_node(robot_);
  model.close_after_s = options_.close_after_s;
  return model;
}

TrialRunner::Outcome TrialRunner::run_live(int number, const fs::path& log) {
  SignalWatch signals;
  std::unique_ptr<CycleLink> link;
  if (options_.board == "sim") {
    link = std::make_unique<SimulatedLink>(simulated_setup(number, log), options_.speed, kLiveStatus_Hz);
  } else {
    if (on_virtual_bench()) reset_virtual_bench(setup_of(number));
    auto command = daemon_command(linux_setup(number, log));
    command.insert(command.end(), {"--status-Hz", std::to_string(kLiveStatus_Hz)});
    link = std::make_unique<DaemonLink>(std::move(command));
  }
  const auto end = run_live_trial(*link, model_of(number, log), signals);
  session_.say("  {}", end.ending);
  return {log, end.last_state, end.last_fault, end.connection_lost};
}

}  // namespace sandhopper::cli
