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
  std::string unusable;  // why the trial is no recording of a hop; empty: it is
};

// Makes the folder of a series a campaign that `hop terrain` and `hop diagnose` read: campaign.toml with each
// trial's sheet as its set-up, nominal.toml with the robot as configured. Overwrites both: it is called after
// each trial, so that a series that breaks off is a campaign, too. Throws std::runtime_error when they cannot
// be written.
void write_series_campaign(const std::filesystem::path& folder, const RobotConfig& robot,
                           const std::vector<SeriesTrial>& trials);

}  // namespace sandhopper
