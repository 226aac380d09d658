#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "config/robot_config.hpp"
#include "firmware/log/trial_sheet.hpp"

namespace sandhopper {

struct SeriesTrial {
  std::filesystem::path log;
  TrialSheet sheet;
  std::string unusable;  // reason why the trial is no recording of a hop; empty: it is usable
};

// Makes the folder of a series a campaign for `hop terrain` and `hop diagnose`: campaign.toml with each
// trial's sheet as its set-up, and nominal.toml with the robot as configured. Overwrites both. It is called
// after each trial, so that an interrupted series is also a campaign. Throws std::runtime_error if they
// cannot be written.
void write_series_campaign(const std::filesystem::path& folder, const RobotConfig& robot,
                           const std::vector<SeriesTrial>& trials);

}  // namespace sandhopper
