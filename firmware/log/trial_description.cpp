#include "firmware/log/trial_description.hpp"

#include "config/dump.hpp"
#include "firmware/version.hpp"

namespace sandhopper {

void describe_trial(TrialLogger& logger, const RobotConfig& robot, std::string_view board) {
  logger.attach(kRobotAttachment, "application/toml", to_toml(to_node(robot)));
  logger.add_metadata("sandhopper", {{"version", std::string(kVersion)},
                                     {"board", std::string(board)},
                                     {"compiler", __VERSION__},
                                     {"rows", "one /frame and one /output per cycle"}});
}

void describe_start(TrialLogger& logger, const StartState& start) {
  logger.attach(kStartAttachment, "application/toml", to_toml(to_node(start)));
}

void describe_devices(TrialLogger& logger, const LinuxBoardConfig& devices) {
  logger.attach(kBoardAttachment, "application/toml", to_toml(to_node(devices)));
}

}  // namespace sandhopper
