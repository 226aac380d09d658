#include "tools/trial/linux_trial.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "config/dump.hpp"
#include "config/files.hpp"
#include "config/program.hpp"
#include "tools/trial/child_process.hpp"
#include "tools/trial/text_file.hpp"
#include "tools/virtual_bench/control_client.hpp"

namespace sandhopper {
namespace {

template <NamedEnum E>
E enum_named(const std::string& name) {
  for (std::size_t i = 0; i < EnumNames<E>::value.size(); ++i)
    if (EnumNames<E>::value[i] == name) return static_cast<E>(i);
  throw std::runtime_error("hopperd said '" + name + "', which this build does not know");
}

// Writes this trial's robot configuration next to the log, so that hopperd uses the requested values.
std::filesystem::path write_robot_file(const LinuxTrialSetup& setup) {
  auto path = std::filesystem::path(setup.log).replace_extension(".robot.toml");
  write_text(path, to_toml(setup.robot));
  return path;
}

class Operator {
 public:
  Operator(const LinuxTrialSetup& setup, ChildProcess& daemon) : setup_(setup), daemon_(daemon) {}

  LinuxTrialResult run() {
    std::string line;
    while (daemon_.read_line(line)) hear(line);
    const int status = daemon_.wait();
    if (!ended_)
      throw std::runtime_error(
          error_.empty() ? fmt::format("hopperd ended with status {} and said nothing", status) : error_);
    return result_;
  }

 private:
  void hear(const std::string& line) {
    const auto message = nlohmann::json::parse(line, nullptr, false);
    if (message.is_discarded()) {
      setup_.say(line);
      return;
    }
    if (message.contains("warning")) setup_.say("warning: " + message["warning"].get<std::string>());
    if (message.contains("error")) error_ = message["error"].get<std::string>();
    if (message.contains("freeze_frame"))
      setup_.say(fmt::format("  what was measured around it: hop explain {}",
                             message["freeze_frame"].get<std::string>()));
    if (message.contains("ready")) prepare();
    if (message.contains("event")) hear_event(message);
    if (message.contains("end")) {
      ended_ = true;
      const auto& end = message["end"];
      result_ = {enum_named<State>(end["state"]), enum_named<Fault>(end["fault"])};
      setup_.say(fmt::format(
          "  {} cycles, {} overruns, {} records lost; woke late by {} us (median), {} us (99.9 %)",
          end["cycles"].get<long>(), end["overruns"].get<long>(), end["lost_records"].get<long>(),
          end["latency_us"]["p50"].get<double>(), end["latency_us"]["p99_9"].get<double>()));
    }
  }

  void prepare() {
    if (on_virtual_bench())
      reset_virtual_bench(setup_.trial);
    else
      setup_.say(fmt::format("hang the robot with its sole {:.1f} mm over the sand; press Enter",
                             1e3 * setup_.trial.release_height_m));
    if (!on_virtual_bench()) std::getchar();
    daemon_.write_line("arm");
  }

  void hear_event(const nlohmann::json& message) {
    const auto kind = message["event"].get<std::string>();
    if (kind == "armed") daemon_.write_line("release");
    if (kind == "arming_refused")
      setup_.say("  arming refused: " + message.value("text", message["reason"].get<std::string>()));
    if (kind == "stopped" || kind == "fault_raised" || kind == "arming_refused") daemon_.write_line("quit");
  }

  const LinuxTrialSetup& setup_;
  ChildProcess& daemon_;
  LinuxTrialResult result_;
  std::string error_;
  bool ended_ = false;
};

}  // namespace

bool on_virtual_bench() { return std::string_view(board_file()) == "bench.toml"; }

void reset_virtual_bench(const TrialSetup& trial) {
  bench::tell_bench(fmt::format("reset seed={} height={} noise={}", trial.seed, trial.release_height_m,
                                trial.noise ? "on" : "off"));
}

std::vector<std::string> daemon_command(const LinuxTrialSetup& setup) {
  const auto program = find_program("hopperd");
  std::vector<std::string> command{program.string(),
                                   "--config",
                                   setup.config_directory.string(),
                                   "--robot",
                                   write_robot_file(setup).string(),
                                   "--devices",
                                   setup.devices.string(),
                                   "--log",
                                   setup.log.string()};
  if (setup.sheet) {
    const auto sheet = std::filesystem::path(setup.log).replace_extension(".sheet.toml");
    write_text(sheet, to_toml(*setup.sheet));
    command.insert(command.end(), {"--sheet", sheet.string()});
  }
  return command;
}

LinuxTrialResult run_linux_trial(const LinuxTrialSetup& setup) {
  ChildProcess daemon(daemon_command(setup));
  return Operator(setup, daemon).run();
}

}  // namespace sandhopper
