#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "campaign_folder.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/diagnose/answer/diagnosis_json.hpp"
#include "tools/diagnose/answer/page/diagnosis_page.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"
#include "tools/diagnose/rounded_belief.hpp"

// Numbers of the belief on which the answer depends.
namespace sandhopper::diagnose {
namespace {

// A free pendulum: I q'' + c q' + m g l sin q = 0, released from rest at four angles, measured with white
// noise.
void write_swings(CampaignFolder& folder, double noise_rad, double inertia_kg_m2 = 0.012,
                  double dry_Nm = 0.0) {
  std::mt19937_64 random(20);
  std::normal_distribution<double> noise(0.0, noise_rad);
  std::string campaign = "plant = \"rotary_axis\"\nmodel = \"nominal.toml\"\n";
  for (int trial = 0; trial < 4; ++trial) {
    double q = 0.4 + 0.2 * trial, v = 0.0;
    constexpr double kStep_s = 1e-4;
    std::string text = "t_s,position_rad\n";
    for (int i = 0; i < 20000; ++i) {
      if (i % 50 == 0) text += fmt::format("{:.4f},{:.7f}\n", kStep_s * i, q + noise(random));
      v += kStep_s * (-0.8 * std::sin(q) - 0.004 * v - dry_Nm * std::tanh(v / 0.02)) / inertia_kg_m2;
      q += kStep_s * v;
    }
    folder.write(fmt::format("r{}.csv", trial), text);
    campaign += fmt::format("[[trial]]\nfile = \"r{}.csv\"\nmotor_enabled = false\n", trial);
  }
  folder.write("campaign.toml", campaign)
      .write("nominal.toml",
             "[axis]\ninertia_kg_m2 = 0.012\ngravity_torque_Nm = 0.8\nviscous_friction_Nm_s = 0.004\n");
}

Diagnosis diagnosed(const CampaignFolder& folder) {
  const auto campaign = load_campaign(folder.path());
  EngineOptions options;
  for (const auto& n : used_numbers(campaign).numbers)
    options.belief.push_back({n.key, n.low, n.high, n.unit, n.source_text, usual_error(n), 0.0});
  return diagnose(read_campaign(campaign).recordings, options);
}

const BelievedNumber& number(const Diagnosis& diagnosis, std::string_view key) {
  const auto found = std::ranges::find(diagnosis.belief, key, &BelievedNumber::key);
  if (found == diagnosis.belief.end()) throw std::out_of_range(std::string(key));
  return *found;
}

TEST(DiagnoseBelief, TheErrorThatShowsGrowsWithTheNoise) {
  CampaignFolder quiet, noisy;
  write_swings(quiet, 1e-3);
  write_swings(noisy, 4e-3);
  const auto a = diagnosed(quiet), b = diagnosed(noisy);
  EXPECT_EQ(a.verdict, Verdict::consistent);
  for (const auto* key : {"axis.inertia_kg_m2", "axis.gravity_torque_Nm", "axis.viscous_friction_Nm_s"}) {
    const double ratio = number(b, key).error_that_shows / number(a, key).error_that_shows;
    EXPECT_GT(ratio, 2.5) << key;
    EXPECT_LT(ratio, 6.0) << key << ": four times the noise";
  }
}

TEST(DiagnoseBelief, WhatOnlyTheirRatioTellsIsKnownAlikeToItsShare) {
  CampaignFolder folder;
  write_swings(folder, 1e-3);
  const auto diagnosis = diagnosed(folder);
  // The motion depends only on m g l / I and c / I.
  const auto &inertia = number(diagnosis, "axis.inertia_kg_m2"),
             &gravity = number(diagnosis, "axis.gravity_torque_Nm"),
             &friction = number(diagnosis, "axis.viscous_friction_Nm_s");
  EXPECT_NEAR(inertia.error_that_shows / 0.012, gravity.error_that_shows / 0.8,
              0.2 * gravity.error_that_shows / 0.8);
  EXPECT_GT(friction.error_that_shows / 0.004, 3.0 * gravity.error_that_shows / 0.8)
      << "friction shows least";
  EXPECT_TRUE(inertia.matters()) << "0.012 may be 0.0125, and a far smaller error would show";
  // The gear of an axis without a motor, and gravity if the gravity torque is stated, have no effect.
  EXPECT_TRUE(std::isinf(number(diagnosis, "gravity_mps2").error_that_shows));
  EXPECT_FALSE(number(diagnosis, "gravity_mps2").matters());
}

TEST(DiagnoseBelief, JsonAndPageHoldTheTable) {
  CampaignFolder folder;
  write_swings(folder, 1e-3);
  const auto diagnosis = diagnosed(folder);
  const auto json = to_json(diagnosis);
  ASSERT_EQ(json["belief"].size(), diagnosis.belief.size());
  const auto study = diagnosis_study(diagnosis, {"swings", "rotary_axis", {}});
  const auto section = std::ranges::find(study.sections, "What was believed", &StudySection::title);
  ASSERT_NE(section, study.sections.end());
  EXPECT_EQ(std::get<StudyTable>(section->items.at(0)).rows.size(), diagnosis.belief.size());
}

TEST(DiagnoseBelief, TheUsualErrorIsHalfTheLastDigit) {
  const auto error_of = [](double value, UsedNumber::Source source, const char* key) {
    return usual_error(UsedNumber{.key = key, .value = value, .low = value, .high = value, .source = source});
  };
  using enum UsedNumber::Source;
  EXPECT_DOUBLE_EQ(error_of(0.012, model_file, "axis.inertia_kg_m2"), 0.0005);
  EXPECT_DOUBLE_EQ(error_of(2.35, trial_setup, "body.mass_kg"), 0.005);
  EXPECT_DOUBLE_EQ(error_of(1500.0, model_file, "terrain.stiffness_N_per_m"), 0.5);
  EXPECT_DOUBLE_EQ(error_of(2e-5, model_file, "x"), 0.5e-5);
  EXPECT_DOUBLE_EQ(error_of(30.0, plant_default, "terrain.unloading_stiffness_ratio"), 30.0);
  EXPECT_DOUBLE_EQ(error_of(9.81, plant_default, "gravity_mps2"), 0.027);
}

// The true inertia is 0.0122 kg m2: it was written as 0.012. Without a clock, a gravity or an inertia beside
// it, dry friction is all that is missing. 0.016 is no rounding of 0.012.
TEST(DiagnoseBelief, WhatIsWithinTheLastDigitOfABeliefIsNotMissing) {
  struct Case {
    double inertia_kg_m2;
    const char* written;
    bool is_rounding;
  };
  for (const auto& [inertia_kg_m2, written, is_rounding] :
       {Case{0.0122, "0.012", true}, Case{0.016, "0.012", false}}) {
    CampaignFolder folder;
    write_swings(folder, 1e-3, inertia_kg_m2, 0.02);
    folder.write("nominal.toml", fmt::format("[axis]\ninertia_kg_m2 = {}\ngravity_torque_Nm = 0.80000\n"
                                             "viscous_friction_Nm_s = 0.0040000\n",
                                             written));
    const auto campaign = load_campaign(folder.path());
    const auto used = used_numbers(campaign);
    EngineOptions options;
    for (const auto& n : used.numbers)
      options.belief.push_back({n.key, n.low, n.high, n.unit, n.source_text, usual_error(n), 0.0});
    const auto d =
        diagnose_as_written(read_campaign(campaign).recordings, options, rounding_of(used, campaign));
    const bool is_noted = std::ranges::any_of(d.notes, [](const std::string& note) {
      return note.starts_with("axis.inertia_kg_m2 = 0.012 is known to the last digit that is written");
    });
    EXPECT_EQ(is_noted, is_rounding) << inertia_kg_m2 << " " << written;
    EXPECT_TRUE(std::ranges::any_of(d.effects, [](const auto& e) { return e.id == "axis.coulomb"; }))
        << written;
    EXPECT_EQ(d.effects.size(), is_rounding ? 1U : 2U) << inertia_kg_m2 << " " << written;
  }
}

// diameter_m = 0.2101 became an area with an "error" of 5e-17 m2; 270 g times 0.001 one of 5e-17 kg.
TEST(DiagnoseBelief, TheUsualErrorGoesThroughTheConversionThatWasDone) {
  const auto errors_of = [](const std::string& plant, const std::string& nominal, const std::string& trial) {
    CampaignFolder folder;
    folder.write("nominal.toml", nominal)
        .write("campaign.toml",
               "plant = \"" + plant + "\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n" + trial);
    std::map<std::string, double> errors;
    for (const auto& n : used_numbers(load_campaign(folder.path())).numbers) errors[n.key] = usual_error(n);
    return errors;
  };
  const double diameter_m = 0.2101, area_m2 = 0.25 * M_PI * diameter_m * diameter_m;
  const auto ball =
      errors_of("falling_body", "[body]\nmass_kg = 0.270\n", "kind = \"drop\"\ndiameter_m = 0.2101\n");
  EXPECT_NEAR(ball.at("body.frontal_area_m2"), 2.0 * area_m2 * 5e-5 / diameter_m, 1e-12);
  EXPECT_DOUBLE_EQ(ball.at("body.mass_kg"), 0.0005) << "0.270 has three digits";
  // pi / 4 x 0.06^2 to all digits: an area that was stated as such is that of no diameter.
  const auto stated = errors_of("falling_body", "[body]\nmass_kg = 0.27\nfrontal_area_m2 = 0.00282743\n",
                                "kind = \"drop\"\n");
  EXPECT_DOUBLE_EQ(stated.at("body.frontal_area_m2"), 0.5e-8);
  EXPECT_DOUBLE_EQ(stated.at("body.mass_kg"), 0.005);
  const auto plate = errors_of("intruder", "[terrain]\nstiffness_N_per_m = 4e3\n",
                               "kind = \"press\"\nplate_diameter_m = 0.05\n");
  EXPECT_DOUBLE_EQ(plate.at("foot.radius_m"), 0.0025);
  EXPECT_DOUBLE_EQ(plate.at("terrain.stiffness_N_per_m"), 500.0);
}

TEST(DiagnoseBelief, TheUsualErrorOfAComputedNumberIsThatOfTheStatedOne) {
  const auto error_of = [](double value, const char* key) {
    return usual_error(UsedNumber{
        .key = key, .value = value, .low = value, .high = value, .source = UsedNumber::Source::trial_setup});
  };
  EXPECT_DOUBLE_EQ(error_of(0.0347, "body.frontal_area_m2"), 5e-5);
  EXPECT_DOUBLE_EQ(error_of(0.30000000000000004, "body.mass_kg"), 0.05);
}

}  // namespace
}  // namespace sandhopper::diagnose
