#include "tools/campaign/unstated_unloading.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "campaign_folder.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"

// Plates dropped into a bed: rows after the deepest point, and a mass below the load cell.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A plate of 2.6 kg enters with 1 m/s from 5 mm above, stops after a quarter period, and rises again.
// `below_kg` hang below the cell, which was tared at rest.
struct Drop {
  std::string nominal = "[foot]\nradius_m = 0.03\n[terrain]\nstiffness_N_per_m = 2600.0\n";
  double rises_m = 2e-3;
  double below_kg = 0.0;
};

std::string told(const Drop& drop) {
  constexpr double kStep_s = 5e-4, kRate_radps = 31.6, kSpeed_mps = 1.0, kAir_s = 0.03;
  const double stop_s = kAir_s + 1.5708 / kRate_radps;
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 250; ++i) {
    const double t = kStep_s * i, in_s = t - kAir_s, noise = 0.3 * std::sin(7.0 * i * i);
    double depth_m = kSpeed_mps / kRate_radps * std::sin(kRate_radps * in_s), force_N = 2600.0 * depth_m;
    if (in_s < 0.0) depth_m = kSpeed_mps * in_s + 4.905 * in_s * in_s, force_N = 9.81 * drop.below_kg;
    if (t > stop_s)
      depth_m = kSpeed_mps / kRate_radps - drop.rises_m * (1.0 - std::exp(-(t - stop_s) / 0.01)),
      force_N = 25.5;
    text += fmt::format("{:.4f},{:.6f},{:.3f}\n", t, -depth_m - 2e-5 * noise, force_N + noise);
  }
  CampaignFolder folder;
  folder.write("a.csv", text)
      .write("nominal.toml", drop.nominal)
      .write("campaign.toml",
             "plant = \"intruder\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n");
  std::string all;
  for (const auto& finding : diagnose::read_campaign(load_campaign(folder.path())).findings)
    all += to_string(finding) + "\n";
  return all;
}

// The plate stops after 0.0797 s, at 31.6 mm. It is within four times its noise of 6 um there for 1 ms.
TEST(UnstatedUnloading, TellsRowsAndTheTimeAtWhichToEnd) {
  const auto all = told({});
  EXPECT_THAT(all, HasSubstr("terrain.unloading_stiffness_ratio: is stated nowhere, and 90 rows after the "
                             "deepest point of 1 trial are compared with its default 1"));
  EXPECT_THAT(all,
              HasSubstr("end each trial while its plate still goes down, with select = { to_s = … }: 0.07"));
}

TEST(UnstatedUnloading, IsSilentIfTheRatioIsStatedOrThePlateStays) {
  Drop stated;
  stated.nominal += "unloading_stiffness_ratio = 30.0\n";
  EXPECT_THAT(told(stated), Not(HasSubstr("unloading_stiffness_ratio")));
  EXPECT_THAT(told({.rises_m = 0.0}), Not(HasSubstr("unloading_stiffness_ratio")));
}

// A press of 45 mm at 1 mm/s that stops at 48 s, is held for 2 s and withdrawn. `depth_at`: the reading.
double told_end_s(const std::function<double(double depth_m, int row)>& depth_at) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 2600; ++i) {
    const double t = 0.02 * i, way_m = 1e-3 * std::min(t, 48.0) - 1e-3 * std::max(t - 50.0, 0.0) - 3e-3;
    text += fmt::format("{:.2f},{:.5f},{:.2f}\n", t, -depth_at(way_m, i), 1.2e4 * std::max(way_m, 0.0));
  }
  CampaignFolder folder;
  folder.write("a.csv", text)
      .write("nominal.toml", Drop{}.nominal)
      .write("campaign.toml",
             "plant = \"intruder\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n");
  const auto campaign = load_campaign(folder.path());
  UnstatedUnloading unloading(campaign);
  unloading.add(campaign.trials.at(0), read_trial(campaign, campaign.trials.at(0)));
  const auto note = unloading.finding();
  if (!note) return 0.0;
  return std::stod(note->cure.substr(note->cure.rfind("}: ") + 3));
}

// The deepest reading lies somewhere in the hold, and so do readings below it by more than its noise.
TEST(UnstatedUnloading, GivesATimeBeforeTheHold) {
  const auto noisy = told_end_s([](double depth_m, int row) {
    return depth_m + 4e-6 * (std::sin(7.0 * row * row) + std::sin(3.1 * row * row));
  });
  EXPECT_LE(noisy, 48.0);
  EXPECT_GT(noisy, 47.8);
  // Digits of 0.05 mm, of which a few readings in the hold are the next higher one.
  const auto coarse = told_end_s([](double depth_m, int row) {
    return 5e-5 * std::floor(depth_m / 5e-5 + 0.3 + (row % 61 == 0 ? 0.9 : 0.0));
  });
  EXPECT_LE(coarse, 48.0);
  EXPECT_GT(coarse, 47.8);
}

// 0.3 kg below the cell read 2.94 N in free fall, 2.89 N with the noise.
TEST(MassBelowTheCell, IsOfferedBesideTheOffset) {
  const auto all = told({.below_kg = 0.3});
  EXPECT_THAT(all, HasSubstr("if it was not tared. But the foot falls there, with 9.8"));
  EXPECT_THAT(all, HasSubstr("\"load_cell.inertia[force_N]\" = { mass_kg = 0.29 }"));
}

TEST(MassBelowTheCell, IsTakenFromTheReadingIfItIsStated) {
  const auto told_if = [](double stated_kg) {
    Drop drop{.below_kg = 0.3};
    drop.nominal +=
        fmt::format("[effects]\n\"load_cell.inertia[force_N]\" = {{ mass_kg = {} }}\n", stated_kg);
    return told(drop);
  };
  EXPECT_THAT(told_if(0.3), Not(HasSubstr("above the surface")));
  EXPECT_THAT(told_if(0.1), HasSubstr("reads 1.9"));
  EXPECT_THAT(told_if(0.1), HasSubstr("beyond the 0.1 kg below the cell"));
}

}  // namespace
}  // namespace sandhopper
