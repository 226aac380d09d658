#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>

#include "config/robot_config.hpp"
#include "tools/plant/world.hpp"

// Makes campaigns of simulated recordings to test the analysis tools.
namespace sandhopper {

struct CampaignMakerSetup {
  RobotConfig robot{};
  WorldConfig world{};
  std::filesystem::path folder;
  int trials = 15;
  std::uint64_t seed = 1;  // seed of the first trial; the following trials count up
  std::function<void(int done)> progress{};
};

// First strides of the simulated robot for five release heights and three compression stiffnesses, as CSV
// with the recording channels, with campaign.toml and a nominal.toml that contains the differences from the
// defaults.
void make_hop_campaign(const CampaignMakerSetup& setup);

// A foot that an actuator moves into fresh beds: speeds up to 1.1 m/s, plates of 60 and 80 mm, 45 mm deep,
// one dwell, and out again. The depth is recorded by camera at 240 Hz, the acceleration by an IMU, the force
// by a load cell; the speed is not recorded.
void make_intrusion_campaign(const CampaignMakerSetup& setup);

}  // namespace sandhopper
