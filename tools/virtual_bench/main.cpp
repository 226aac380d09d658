#include <sched.h>
#include <sys/prctl.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "config/directory.hpp"
#include "config/files.hpp"
#include "config/problem.hpp"
#include "tools/plant/load_world.hpp"
#include "tools/virtual_bench/control_client.hpp"
#include "tools/virtual_bench/devices.hpp"

// The emulated devices of the virtual bench, in one process that is started inside it by
// tools/virtual_bench/init.
namespace sandhopper::bench {
namespace {

struct Options {
  std::string config, world, ready, tell;
  DeviceOptions devices{.control_path = kControlPath};
  TrialSetup setup;
};

bool inside_bench() { return std::string_view(board_file()) == "bench.toml"; }

// Below the firmware's real-time threads and above all else: hardware does not wait for a busy program, and
// it sees what one cycle does in the order the cycle does it.
void become_hardware() {
  const sched_param lowest_real_time{.sched_priority = 1};
  ::sched_setscheduler(0, SCHED_FIFO, &lowest_real_time);
  ::prctl(PR_SET_TIMERSLACK, 1UL);
}

int run(const Options& options) {
  if (!options.tell.empty()) {
    const auto answer = tell_bench(options.tell, options.devices.control_path);
    if (!answer.empty()) std::puts(answer.c_str());
    return 0;
  }
  if (!inside_bench())
    throw std::runtime_error("this is not the virtual bench: tools/bench starts the devices");
  const auto directory = find_config_directory(options.config);
  const auto robot = load_robot(directory);
  const auto board = load_linux_board(directory / "bench.toml", robot);
  const auto world_config =
      options.world.empty() ? load_world(directory, robot) : load_world_file(options.world, robot);

  become_hardware();
  EventLoop loop;
  BenchWorld world(loop, world_config, options.setup);
  Devices devices(loop, world, board, options.devices);
  if (!options.ready.empty()) std::ofstream(options.ready) << "ready\n";
  loop.run();
  return 0;
}

int parse_and_run(int argc, char** argv) {
  Options options;
  std::string noise = "on";
  CLI::App app("Emulated devices of the virtual bench (tools/virtual_bench/README.md)");
  app.add_option("--config", options.config, "configuration directory");
  app.add_option("--world", options.world, "plant and sensors; default: world.toml of the configuration");
  app.add_option("--seed", options.setup.seed, "of the trial's random draws");
  app.add_option("--height", options.setup.release_height_m, "release height of the foot [m]");
  app.add_option("--noise", noise, "on or off")->check(CLI::IsMember({"on", "off"}));
  app.add_option("--control", options.devices.control_path, "path of the control socket");
  app.add_option(
         "--drive-timeout", options.devices.drive_timeout_s,
         "a drive drops its command after so many seconds without a frame; 0: 25 ms (MIT), 1 s (servo)")
      ->check(CLI::Range(0.0, 60.0));
  app.add_option("--ready", options.ready, "written to when all devices are there");
  app.add_option("--tell", options.tell, "sends one command to running devices and prints the answer");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  options.setup.noise = noise == "on";
  return run(options);
}

}  // namespace
}  // namespace sandhopper::bench

int main(int argc, char** argv) {
  try {
    return sandhopper::bench::parse_and_run(argc, argv);
  } catch (const sandhopper::ConfigError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench-devices: %s\n", error.what());
    return 3;
  }
}
