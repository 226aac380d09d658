#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "config/files.hpp"
#include "tools/cli/doctor.hpp"
#include "tools/cli/verb.hpp"

namespace sandhopper::cli {
namespace {

constexpr std::array<std::string_view, 3> kHealthName{"ok", "warn", "FAIL"};
constexpr std::array<std::string_view, 3> kHealthKey{"ok", "warn", "fail"};
constexpr std::array<std::string_view, 3> kColour{"\033[32m", "\033[33m", "\033[1;31m"};

// Colours the word on a terminal, unless NO_COLOR is set (no-color.org).
std::string coloured(const Session& session, std::size_t health) {
  const auto word = fmt::format("{:<4}", kHealthName[health]);
  if (::isatty(session.json ? STDERR_FILENO : STDOUT_FILENO) == 0 || std::getenv("NO_COLOR") != nullptr)
    return word;
  return fmt::format("{}{}\033[0m", kColour[health], word);
}

ExitCode report(Session& session, const std::vector<Finding>& findings) {
  session.result["checks"] = nlohmann::ordered_json::array();
  for (const auto& finding : findings) {
    const auto health = static_cast<std::size_t>(finding.health);
    session.say("{}  {:<32}  {}", coloured(session, health), finding.what, finding.found);
    if (!finding.cure.empty()) session.say("{:<4}  {:<32}  -> {}", "", "", finding.cure);
    session.result["checks"].push_back({{"name", finding.what},
                                        {"status", kHealthKey[health]},
                                        {"found", finding.found},
                                        {"cure", finding.cure}});
  }
  const auto failed = std::count_if(findings.begin(), findings.end(),
                                    [](const Finding& f) { return f.health == Health::fail; });
  session.result["ok"] = failed == 0;
  session.say("{}", failed == 0 ? "ready"
                                : fmt::format("not ready: {} of {} checks failed", failed, findings.size()));
  return failed == 0 ? ExitCode::ok : ExitCode::no;
}

void append(std::vector<Finding>& findings, const std::vector<Finding>& more) {
  findings.insert(findings.end(), more.begin(), more.end());
}

std::vector<Finding> examine_board(const RobotConfig& robot, const LinuxBoardConfig& board) {
  auto findings = examine_devices(board);
  append(findings, examine_interrupts(robot, board));
  append(findings, examine_bus(board.can.interface));
  append(findings, examine_identities(board, findings));
  append(findings, examine_calibrations(robot, board));
  return findings;
}

// Checks the rest of the machine even if the configuration cannot be read.
std::vector<Finding> examine(Session& session, const std::string& board) {
  const auto& directory = session.config_directory();
  RobotConfig robot;
  std::vector<Finding> configuration, devices;
  try {
    robot = load_robot(directory);
    configuration = {{Health::ok, "configuration", directory.string() + ": right", ""}};
    if (board == "linux") {
      devices = examine_board(robot, load_linux_board(directory / board_file(), robot));
      append(devices, examine_state(robot));
    }
  } catch (const ConfigError& error) {
    configuration = examine_problems(error);
  }
  auto findings = examine_machine(robot);
  // The simulated robot also runs without real-time rights, but then not in real time. So nothing here is a
  // failure.
  if (board == "sim")
    for (auto& finding : findings) finding.health = std::min(finding.health, Health::warn);
  append(findings, configuration);
  append(findings, devices);
  return findings;
}

// For a computer that only reads recordings: leaves out all checks that it does not need.
std::vector<Finding> examine_for_analysis(Session& session) {
  auto findings = examine_storage();
  const auto& directory = session.config_directory();
  try {
    load_robot(directory);
    findings.push_back({Health::ok, "configuration", directory.string() + ": right", ""});
  } catch (const ConfigError& error) {
    append(findings, examine_problems(error));
  }
  return findings;
}

Run set_up(Arguments& arguments) {
  auto purpose = std::make_shared<std::string>("robot");
  arguments
      .add_option("--for", *purpose,
                  "robot: the computer that runs it; analysis: one that only reads its recordings")
      .one_of({"robot", "analysis"})
      .show_default();
  auto board = std::make_shared<std::string>("linux");
  arguments
      .add_option("--board", *board,
                  "linux: machine and device nodes; sim: only what the simulated robot needs")
      .one_of({"linux", "sim"})
      .show_default();
  return [board, purpose](Session& session) {
    if (*purpose == "analysis") return report(session, examine_for_analysis(session));
    return report(session, examine(session, *board));
  };
}

const VerbRegistration kDoctor("doctor", set_up);

}  // namespace
}  // namespace sandhopper::cli
