// hopperd: the daemon that runs the cycle on the robot, on the virtual bench, or with the simulated robot in
// its own process (for latency measurements).
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "config/directory.hpp"
#include "config/dump.hpp"
#include "config/files.hpp"
#include "config/load.hpp"
#include "config/problem.hpp"
#include "drivers/can/cubemars_drives.hpp"
#include "drivers/can/torque_cut.hpp"
#include "drivers/clock.hpp"
#include "firmware/freeze/freeze_folders.hpp"
#include "firmware/freeze/freeze_recorder.hpp"
#include "firmware/hop_session.hpp"
#include "firmware/instance_lock.hpp"
#include "firmware/linux_board.hpp"
#include "firmware/log/can_log_tap.hpp"
#include "firmware/log/trial_description.hpp"
#include "firmware/log/trial_sheet.hpp"
#include "firmware/operator_channel.hpp"
#include "firmware/state/recollection.hpp"
#include "firmware/state/state_keeper.hpp"
#include "firmware/version.hpp"
#include "firmware/watchdog/guard_process.hpp"
#include "firmware/watchdog/keepalive.hpp"
#include "firmware/watchdog/shared.hpp"
#include "firmware/watchdog/torque_watchdog.hpp"
#include "tools/plant/load_world.hpp"
#include "tools/plant/sim_board.hpp"

namespace {

using namespace sandhopper;

struct Options {
  std::string config_directory;
  std::string robot_file;
  std::string device_file;
  std::string log_file = "hopperd.mcap";
  std::string board = "linux";
  std::optional<int> segment_MB;  // overrides the robot file
  std::optional<int> quota_MB;
  int status_Hz = 0;
  std::string sheet_file;
  bool no_log = false;
  std::string state_directory;
  bool motors_cold = false;
  bool leg_inspected = false;
};

void add_options(CLI::App& app, Options& options) {
  app.set_version_flag("--version", std::string(kVersion));
  app.add_option("--config", options.config_directory,
                 "configuration directory; default $SANDHOPPER_CONFIG, the source tree's, /etc/sandhopper");
  app.add_option("--robot", options.robot_file,
                 "robot file; default robot.toml of the configuration directory");
  app.add_option(
      "--devices", options.device_file,
      "device file; default linux.toml of the configuration directory, on the virtual bench bench.toml");
  app.add_option("--log", options.log_file, "MCAP log; CAN traffic goes beside it as candump text")
      ->capture_default_str();
  app.add_flag("--no-log", options.no_log, "write no log; a fault still leaves its freeze frame");
  app.add_option("--board", options.board,
                 "linux: this machine's devices; sim: simulated robot in the process")
      ->check(CLI::IsMember({"linux", "sim"}))
      ->capture_default_str();
  app.add_option("--segment-MB", options.segment_MB,
                 "begin a new file LOG.part0002.mcap, … when one holds this much; 0: one file; default "
                 "log.segment_MB of the robot file")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--quota-MB", options.quota_MB,
                 "remove the oldest files of this log when all together hold more; 0: keep all; default "
                 "log.quota_MB of the robot file")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--sheet", options.sheet_file,
                 "trial sheet (TOML: who, bed, bed_preparation, release_height_m, payload_kg, notes) to be "
                 "kept in the log");
  app.add_option("--state", options.state_directory,
                 "where the motors' temperatures and counts are kept between runs; default "
                 "$RUNTIME_DIRECTORY and $STATE_DIRECTORY (systemd), else /run/sandhopper and "
                 "/var/lib/sandhopper; not with --board sim");
  app.add_flag("--motors-cold", options.motors_cold,
               "the motors are at supervision.ambient_C, whatever is remembered or assumed");
  app.add_flag("--leg-inspected", options.leg_inspected, "count touchdowns from 0 again (hop_count_limit)");
  app.add_option("--status-Hz", options.status_Hz,
                 "how often to tell how the cycle stands, {\"status\": {…}}; 0: never")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  app.footer(
      "Operated by lines on standard input: arm, release, stop, disarm, quit; an unknown word stops softly. "
      "Answers on\nstandard output, one JSON object a line. End of input, SIGINT, SIGTERM and SIGHUP stop "
      "the "
      "robot softly, close the\nlog and quit; a second one switches the drives off at once.\n"
      "Exit status: 0 ended in order, 1 ended in a fault, 2 configuration or command line, 3 a device is "
      "missing,\nanother hopperd runs these motors, or the log's disk failed.");
}

// The robot's devices; their CAN traffic goes to the log.
struct RealRobot {
  RealRobot(const LinuxBoardConfig& config, const WatchdogConfig& watchdog, Heartbeat& heart,
            TrialLogger& logger, LastAct* last_act)
      : tap(logger, config.can.interface), board(config, &tap) {
    board.heed(heart);
    cut.emplace(config.can);
    guard.emplace(GuardProcess::Setup{.cut = *cut, .heart = heart, .config = watchdog, .last_act = last_act});
  }
  ~RealRobot() { shut_down(); }
  RealRobot(const RealRobot&) = delete;
  RealRobot& operator=(const RealRobot&) = delete;

  // Message for the operator. Empty if every drive has confirmed that it is off.
  std::string shut_down() {
    const auto motors = board.shut_down();
    if (motors.empty()) return {};
    guard->abandon();
    return fmt::format(
        "not confirmed off within {} ms: motor {}. Such a drive may still make its last torque until its own "
        "time-out. The guard process now sends the frames that take it away, and the relay drive_enable is "
        "open "
        "where there is one. Cut the supply with the e-stop before you go near the robot, then check the CAN "
        "bus (`hop doctor`)",
        CubeMarsDrives::kShutDown_ns / 1'000'000, motors);
  }
  CanLogTap tap;
  // Created after the board, whose errors name problems of the bus, and destroyed after the board has shut
  // the drives down.
  std::optional<TorqueCut> cut;
  std::optional<GuardProcess> guard;
  LinuxBoard board;
};

// The simulated robot needs its world to outlive the board.
struct SimulatedRobot {
  SimulatedRobot(const WorldConfig& config, std::int64_t start_ns)
      : world(config, {}, start_ns), board(world) {}
  World world;
  SimBoard board;
};

// Everything that runs besides the cycle and ends before the devices are closed.
struct Session {
  const RobotConfig& robot;
  Board& board;
  TrialLogger& logger;
  OperatorChannel& channel;
  Heartbeat& heart;
  std::function<void()> cut;
  std::function<bool()> guarded;  // true if the guard process lives or there is none
  FreezeRing* freeze;
  const StartState& start;
  StateKeeper* keeper;  // null: the state is not kept
};

SessionResult run_session(const Session& s) {
  const auto warn = [&](const std::string& text) {
    if (!text.empty()) s.channel.tell_text("warning", text);
  };
  const auto limits = to_node(s.robot);
  HopSession session(s.robot, s.board, s.logger,
                     {.event = [&](const Event& event) { s.channel.tell(event, limits); },
                      .stride = [&](const StrideResult& result) { s.channel.tell(result); },
                      .profile = [&](const StrengthProfile& profile,
                                     const GroundSummary& ground) { s.channel.tell(profile, ground); },
                      .ground_events = [&](const GroundEvents& found) { s.channel.tell(found); },
                      .request = [&](const RequestRecord& answer) { s.channel.tell(answer); }},
                     s.start);
  RequestBox requests;
  std::atomic<Quit> quit{Quit::no};
  std::atomic<bool> ended{false};
  SessionResult result;
  const TorqueWatchdog watchdog(s.robot.watchdog, s.heart, s.cut);
  bool guarded = true;
  const Keepalive keepalive(s.robot.watchdog, s.heart, [&] {
    if (!guarded || s.guarded()) return;
    guarded = false;
    warn(
        "the guard process has ended: nobody would cut the torque if hopperd were killed or stopped. A soft "
        "stop "
        "follows; start hopperd again");
    Quit none = Quit::no;
    quit.compare_exchange_strong(none, Quit::softly);
  });
  warn(watchdog.warning());
  warn(keepalive.warning());
  std::thread cycle([&] {
    result = session.run({.quit = quit,
                          .requests = requests,
                          .heart = s.heart,
                          .say = warn,
                          .status = &s.channel.status(),
                          .freeze = s.freeze,
                          .state = s.keeper == nullptr ? nullptr : &s.keeper->newest()});
    ended.store(true);
  });
  s.channel.tell_text("ready", "arm");
  s.channel.listen(requests, quit, ended);
  cycle.join();
  result.watchdog_trips = watchdog.trips();
  result.longest_stall_s = watchdog.longest_stall_s();
  return result;
}

// Options of the command line override the robot file. The same rules are checked for both together.
void override_log(LogConfig& log, const Options& options) {
  log.segment_MB = options.segment_MB.value_or(log.segment_MB);
  log.quota_MB = options.quota_MB.value_or(log.quota_MB);
  std::vector<ConfigProblem> problems;
  log.check([&](std::string_view key, const std::string& text) {
    problems.push_back({.file = "command line with the robot file",
                        .position = {.line = 0, .column = 0},
                        .key = std::string(key),
                        .text = fmt::format("'log.{}' does not fit: {}", key, text)});
  });
  if (!problems.empty()) throw ConfigError(problems);
}

TrialLogOptions log_options(const LogConfig& config, const Options& options, OperatorChannel& channel) {
  TrialLogOptions log;
  log.limits = config.limits();
  log.say = [&channel](const std::string& text) { channel.tell_text("warning", text); };
  log.start_ns = monotonic_ns();
  log.realtime_offset_ns = realtime_offset_ns();
  if (options.no_log) {
    log.limits = {};
    return log;
  }
  log.mcap_file = options.log_file;
  if (options.board == "linux")
    log.candump_file = std::filesystem::path(options.log_file).replace_extension(".candump");
  return log;
}

FreezeOptions freeze_options(const LogConfig& config, const TrialLogOptions& log,
                             const LogDescription& description, OperatorChannel& channel) {
  return {.folder = freeze::frame_folder(config.freeze_folder),
          .newest = static_cast<std::size_t>(config.freeze_files),
          .log_file = log.mcap_file.empty() ? "" : std::filesystem::absolute(log.mcap_file),
          .start_ns = log.start_ns,
          .realtime_offset_ns = log.realtime_offset_ns,
          .description = description,
          .warn = log.say,
          .told = [&channel](const auto& frame) { channel.tell_text("freeze_frame", frame.string()); }};
}

// Reads the robot's state from the last run and reports it to the operator.
StartState remembered_start(const Options& options, const StatePlaces& places, const RobotConfig& robot,
                            OperatorChannel& channel) {
  auto memory =
      recollect(read_state_file(places.boot), read_state_file(places.lasting), state_clock(), robot);
  if (options.motors_cold) {
    memory.start.temperatures_known = false;
    memory.trusted = true;
    memory.text = fmt::format("motors at {:g} C by the operator's word", robot.supervision.ambient_C);
  }
  if (options.leg_inspected) memory.start.touchdowns = 0;
  channel.tell_text(memory.trusted ? "memory" : "warning", memory.text);
  if (!memory.positions.empty()) channel.tell_text("warning", memory.positions);
  if (memory.start.fault != Fault::none)
    channel.tell_text("warning",
                      fmt::format("the last run did not end in order and left the fault {}: disarm "
                                  "when its cause is removed",
                                  name_of(memory.start.fault)));
  return memory.start;
}

int run(const Options& options, OperatorChannel& channel) {
  const auto directory = find_config_directory(options.config_directory);
  const auto file = [&](const std::string& given, const char* name) {
    return given.empty() ? (directory / name).string() : given;
  };
  // Load the whole configuration before opening the first file or device.
  const bool simulate = options.board == "sim";
  auto robot = load_robot_file(file(options.robot_file, "robot.toml"));
  override_log(robot.log, options);
  const auto world = simulate ? load_world(directory, robot) : WorldConfig{};
  const auto devices =
      simulate ? LinuxBoardConfig{} : load_linux_board(file(options.device_file, board_file()), robot);
  const auto sheet = options.sheet_file.empty()
                         ? std::optional<TrialSheet>()
                         : load_file<TrialSheet>(options.sheet_file, MissingKeys::use_default);
  // Lock before opening the log, because another hopperd may be writing it.
  const auto lock = simulate ? nullptr : std::make_unique<InstanceLock>(devices.can.interface);
  const auto places = state_places(options.state_directory);
  const auto start = simulate ? StartState{} : remembered_start(options, places, robot, channel);
  const auto log = log_options(robot.log, options, channel);
  TrialLogger logger(log);
  describe_trial(logger, robot, options.board);
  if (!simulate) {
    describe_devices(logger, devices);
    describe_start(logger, start);
  }
  if (sheet) add_sheet(logger, *sheet);
  const Shared<Heartbeat> heart;  // shared with the guard process
  FreezeRecorder freeze(freeze_options(robot.log, log, logger.description(), channel));
  std::unique_ptr<SimulatedRobot> simulated;
  std::unique_ptr<RealRobot> real;
  if (simulate)
    simulated = std::make_unique<SimulatedRobot>(world, monotonic_ns());
  else
    real = std::make_unique<RealRobot>(devices, robot.watchdog, *heart, logger, freeze.dump());
  std::function<void()> cut = [] {};
  std::function<bool()> guarded = [] { return true; };
  if (real) {
    cut = [&real] {
      real->cut->cut();
      real->board.cut_supply();
    };
    guarded = [&real] { return real->guard->alive(); };
  } else {
    robot.watchdog.device.clear();  // a simulation that hangs must not reset a computer
  }
  Board& board = simulated ? static_cast<Board&>(simulated->board) : real->board;
  std::optional<StateKeeper> keeper;
  if (!simulate)
    keeper.emplace(places, [&channel](const std::string& text) { channel.tell_text("warning", text); });
  freeze.start();
  auto result = run_session({robot, board, logger, channel, *heart, cut, guarded, freeze.ring(), start,
                             keeper ? &*keeper : nullptr});
  const auto still_on = real ? real->shut_down() : std::string();
  if (!still_on.empty()) channel.tell_text("error", still_on);
  if (keeper) keeper->close();
  real.reset();
  freeze.stop();
  logger.attach("wake_latency_us.json", "application/json", result.latency.as_json());
  logger.close();
  result.log_error = logger.error();
  channel.tell(result);
  // An incomplete log takes precedence over a fault, because its missing part may contain the fault.
  if (!result.log_error.empty() || !still_on.empty()) return 3;
  return result.last_fault != Fault::none ? 1 : 0;
}

int run_program(int argc, char** argv) {
  CLI::App app("Runs the hopper's 1 kHz cycle.", "hopperd");
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  OperatorChannel channel;
  channel.tell_status_at(options.status_Hz);
  try {
    return run(options, channel);
  } catch (const ConfigError& error) {
    channel.tell_text("error", error.what());
    return 2;
  } catch (const std::exception& error) {
    channel.tell_text("error", error.what());
    return 3;
  }
}

}  // namespace

int main(int argc, char** argv) try { return run_program(argc, argv); } catch (...) {
  return 3;
}
