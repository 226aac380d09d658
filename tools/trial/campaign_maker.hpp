#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>

#include "config/robot_config.hpp"
#include "tools/plant/world.hpp"

// Campaigns of simulated recordings, to try the analysis tools on.
namespace sandhopper {

struct CampaignMakerSetup {
  RobotConfig robot{};
  WorldConfig world{};
  std::filesystem::path folder;
  int trials = 15;
  std::uint64_t seed = 1;  // of the first trial; the next ones count up
  std::function<void(int done)> progress{};
};

// First strides of the simulated robot over five release heights and three compression stiffnesses, as CSV of
// the recording channels, with campaign.toml and a nominal.toml that holds what differs from the defaults.
void make_hop_campaign(const CampaignMakerSetup& setup);

// A foot moved into fresh beds by an actuator: slow to 1.1 m/s, plates of 60 and 80 mm, 45 mm deep, one
// dwell, and out again. Depth by camera at 240 Hz, acceleration by IMU, force by load cell; the speed is not
// recorded.
void make_intrusion_campaign(const CampaignMakerSetup& setup);

}  // namespace sandhopper
