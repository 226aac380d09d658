#include "tools/campaign/setup_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/unit/campaign_folder.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"

namespace sandhopper {
namespace {

TEST(SetupKeys, SayTheSameUnderOtherNames) {
  const struct {
    const char* written;
    const char* key;
    double scale;
    bool is_ordinal;
  } cases[] = {{"rest_s", "wait_s", 1.0, false},
               {"waiting_time_min", "wait_s", 60.0, false},
               {"time_since_preparation_ms", "wait_s", 1e-3, false},
               {"pause_h", "wait_s", 3600.0, false},
               {"fill_depth_m", "bed_depth_m", 1.0, false},
               {"sand_height_mm", "bed_depth_m", 1e-3, false},
               {"container_depth_cm", "bed_depth_m", 1e-2, false},
               {"intrusion_number", "pushes_since_preparation", 1.0, true},
               {"hop_index", "pushes_since_preparation", 1.0, true},
               {"intrusions_before", "pushes_since_preparation", 1.0, false}};
  for (const auto& c : cases) {
    const auto meaning = meaning_of_setup(c.written);
    ASSERT_TRUE(meaning) << c.written;
    EXPECT_EQ(meaning->key, c.key) << c.written;
    EXPECT_DOUBLE_EQ(meaning->scale, c.scale) << c.written;
    EXPECT_EQ(meaning->is_ordinal, c.is_ordinal) << c.written;
  }
}

TEST(SetupKeys, OfSomethingElseAreLeftAlone) {
  for (const char* key : {"wait_s", "bed_depth_m", "pushes_since_preparation", "target_depth_m",
                          "bed_surface_height_m", "release_height_m", "contact_settling_s", "step_hold_s",
                          "duration_s", "session", "intrusion_speed_mps", "compression_stiffness_N_per_m",
                          "switch_depth_m", "start_height_m", "drop_height_m"})
    EXPECT_FALSE(meaning_of_setup(key)) << key;
}

TEST(SetupKeys, ReachThePlantUnderTheirUsualNameAndAreTold) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "name = \"x\"\nplant = \"intruder\"\n"
               "[[trial]]\nfile = \"a.csv\"\nintrusion_number = 1\nrest_min = 2.0\nfill_depth_m = 0.1\n"
               "[[trial]]\nfile = \"b.csv\"\nintrusion_number = 3\nrest_min = 5.0\nfill_depth_m = 0.2\n");
  for (const char* file : {"a.csv", "b.csv"})
    folder.write(file, "t_s,foot_z_m,force_N\n0.0,0.0,0.0\n0.1,-0.01,1.0\n0.2,-0.02,2.0\n");
  const auto input = diagnose::read_campaign(load_campaign(folder.path()));
  const auto& trials = input.recordings.trials;
  ASSERT_EQ(trials.size(), 2u);
  EXPECT_DOUBLE_EQ(trials[0].setup_or("pushes_since_preparation", -1.0), 0.0);
  EXPECT_DOUBLE_EQ(trials[1].setup_or("pushes_since_preparation", -1.0), 2.0);
  EXPECT_DOUBLE_EQ(trials[1].setup_or("wait_s", -1.0), 300.0);
  EXPECT_DOUBLE_EQ(trials[1].setup_or("bed_depth_m", -1.0), 0.2);
  for (const char* key : {"intrusion_number", "rest_min", "fill_depth_m"})
    EXPECT_TRUE(std::ranges::any_of(input.findings, [&](const Finding& f) { return f.channel == key; }))
        << key;
}

// If a key has its usual name, no other key may be taken for it.
TEST(SetupKeys, GiveWayToTheUsualName) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "name = \"x\"\nplant = \"intruder\"\n"
               "[[trial]]\nfile = \"a.csv\"\nwait_s = 7.0\nrest_s = 90.0\n");
  folder.write("a.csv", "t_s,foot_z_m,force_N\n0.0,0.0,0.0\n0.1,-0.01,1.0\n");
  const auto input = diagnose::read_campaign(load_campaign(folder.path()));
  EXPECT_DOUBLE_EQ(input.recordings.trials.at(0).setup_or("wait_s", -1.0), 7.0);
}

}  // namespace
}  // namespace sandhopper
