#include <algorithm>
#include <array>

#include "config/files.hpp"
#include "tools/cli/doctor.hpp"
#include "tools/cli/verb.hpp"

namespace sandhopper::cli {
namespace {

constexpr std::array<std::string_view, 3> kHealthName{"ok", "warn", "FAIL"};
constexpr std::array<std::string_view, 3> kHealthKey{"ok", "warn", "fail"};

ExitCode report(Session& session, const std::vector<Finding>& findings) {
  session.result["checks"] = nlohmann::ordered_json::array();
  for (const auto& finding : findings) {
    const auto health = static_cast<std::size_t>(finding.health);
    session.say("{:<4}  {:<32}  {}", kHealthName[health], finding.what, finding.found);
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

Run set_up(CLI::App& app) {
  auto board = std::make_shared<std::string>("linux");
  app.add_option("--board", *board,
                 "linux: machine and device nodes; sim: only what the simulated robot needs")
      ->check(CLI::IsMember({"linux", "sim"}))
      ->capture_default_str();
  return [board](Session& session) {
    const auto& directory = session.config_directory();
    const auto robot = load_robot(directory);
    auto findings = examine_machine(robot.real_time);
    if (*board == "linux") {
      const auto devices = examine_devices(load_linux_board(directory / board_file(), robot));
      findings.insert(findings.end(), devices.begin(), devices.end());
    } else {
      // The simulated robot runs without real-time rights, only not in step with the clock.
      for (auto& finding : findings) finding.health = std::min(finding.health, Health::warn);
    }
    return report(session, findings);
  };
}

const VerbRegistration kDoctor({"doctor", "say whether this machine can run the robot, and what to do if not",
                                set_up});

}  // namespace
}  // namespace sandhopper::cli
