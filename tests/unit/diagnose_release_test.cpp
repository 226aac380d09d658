#include <gtest/gtest.h>

#include <string>

#include "tests/unit/campaign_folder.hpp"
#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/plants/falling_body/falling_body_recording.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"

// Release of a fall: its time, and how well its height and speed are known.
namespace sandhopper::diagnose {
namespace {

// A body that hangs for five samples and falls from 0.052 s on. One that is in the fall when the recording
// begins, and one that only sways, have no release.
TEST(DiagnoseRelease, TheLossOfWeightIsTheRelease) {
  const auto felt = [](std::size_t hangs, std::size_t falls) {
    Samples accels;
    for (std::size_t i = 0; i < 40; ++i) {
      accels.time_s.push_back(0.0104 * static_cast<double>(i));
      accels.value.push_back(i < hangs || i >= hangs + falls ? 9.7 : 0.2);
    }
    return loss_of_weight_s(accels, 9.81);
  };
  ASSERT_TRUE(felt(5, 35).has_value());
  EXPECT_NEAR(*felt(5, 35), 0.0468, 1e-9);
  EXPECT_FALSE(felt(0, 40).has_value());
  EXPECT_FALSE(felt(5, 2).has_value());
  EXPECT_FALSE(felt(30, 10).has_value());
}

// Bodies that are let go at rest, and two that are launched. The spread of the launches is a share of their
// speed, so it says nothing of those at rest.
TEST(DiagnoseRelease, ASpreadOfTheReleaseSpeedIsOfThoseThatHaveOne) {
  auto recordings = drops([](double, double, double) { return 0.0; }, 1, 2);
  const auto sd_mps = [&](double stated_mps) {
    recordings.trials.front().setup["release_speed_mps"] = stated_mps;
    return prepare(recordings).problem.trials.front()->trial_nuisances.at(1).sd;
  };
  const auto state = [&](const std::string& key, double value) {
    recordings.belief.numbers[key] = value;
    for (auto& belief : recordings.beliefs) belief.numbers[key] = value;
  };
  state("spread.release_speed_mps", 0.0);
  state("spread.release_speed_relative", 0.01);
  EXPECT_GT(sd_mps(0.0), 0.0);
  EXPECT_LT(sd_mps(0.0), 1e-6);
  EXPECT_NEAR(sd_mps(3.0), 0.03, 1e-6);
  state("spread.release_speed_mps", 0.04);
  EXPECT_NEAR(sd_mps(3.0), 0.05, 1e-6);
}

// A stated spread counts, also if it is 0. Without one the plant's own counts.
TEST(DiagnoseRelease, AStatedSpreadIsUsedAsItIs) {
  const auto sd_mps = [](const std::string& spread) {
    CampaignFolder folder;
    std::string text = "t_s,height_m\n";
    for (int i = 0; i < 40; ++i)
      text += std::to_string(0.01 * i) + "," + std::to_string(2.0 - 4.905e-4 * i * i) + "\n";
    folder.write("1.csv", text).write("nominal.toml", "[body]\nmass_kg = 1.0\n[spread]\n" + spread);
    folder.write("campaign.toml",
                 "plant = \"falling_body\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"1.csv\"\n"
                 "release_height_m = 2.0\n");
    const auto prepared = prepare(read_campaign(load_campaign(folder.path())).recordings);
    return prepared.problem.trials.at(0)->trial_nuisances.at(1).sd;
  };
  EXPECT_GT(sd_mps(""), 1e-3);
  EXPECT_LT(sd_mps("release_speed_mps = 0.0\n"), 1e-6);
  EXPECT_EQ(sd_mps("release_speed_mps = 0.0001\n"), 1e-4);
  EXPECT_LT(sd_mps("release_speed_relative = 0.01\n"), 1e-6);
}

}  // namespace
}  // namespace sandhopper::diagnose
