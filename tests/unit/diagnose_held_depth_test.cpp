#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/unit/campaign_folder.hpp"
#include "tools/diagnose/engine.hpp"
#include "tools/diagnose/plants/intruder/intruder_motion.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"

// Depths of a sensor that is slower than the rows of the table.
namespace sandhopper::diagnose {
namespace {

// A bed of 1500 N/m, pressed at 0.1 m/s; the depth is held over 4 rows, as some loggers do. Nothing is
// missing: neither the repeats nor the rows after the last depth may be taken for physics or for a lag.
TEST(DiagnoseHeldDepth, HeldDepthsAreNotTakenForALag) {
  CampaignFolder folder;
  std::string toml = "plant = \"intruder\"\nmodel = \"nominal.toml\"\n[every_trial]\nkind = \"intrusion\"\n";
  for (int trial = 0; trial < 3; ++trial) {
    std::string rows = "t_s,foot_z_m,force_N\n";
    for (int i = 0; i < 200; ++i) {
      const auto height_m = [&](int row) { return 0.005 + 0.001 * trial - 0.1 * 0.002 * row; };
      rows += fmt::format("{:.3f},{:.5f},{:.3f}\n", 0.002 * i, height_m(i / 4 * 4),
                          1500.0 * std::max(0.0, -height_m(i)));
    }
    folder.write(fmt::format("{}.csv", trial), rows);
    toml += fmt::format("[[trial]]\nfile = \"{}.csv\"\n", trial);
  }
  folder.write("campaign.toml", toml);
  folder.write("nominal.toml", "[foot]\nradius_m = 0.04\n[terrain]\nstiffness_N_per_m = 1500.0\n");
  const auto answer = diagnose(read_campaign(load_campaign(folder.path())).recordings);
  EXPECT_TRUE(answer.effects.empty()) << answer.effects[0].id;
}

// The grid of a motion reaches to the last sample, although rounded times make the last step a little short.
TEST(DiagnoseHeldDepth, TheGridOfAMotionHoldsTheLastDepth) {
  Samples z;
  for (int i = 0; i < 50; ++i) {
    z.time_s.push_back(std::stod(fmt::format("{:.3f}", 0.008 * i)));
    z.value.push_back(0.005 - 8e-4 * i);
  }
  z.time_s.back() -= 1e-12;
  const auto motion = intruder_motion(z, {}, {});
  EXPECT_NEAR(motion.depth_m.back(), -z.value.back(), 1e-5);
}

}  // namespace
}  // namespace sandhopper::diagnose
