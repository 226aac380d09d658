#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "read_campaign.hpp"

// Checks that use the samples alone: zero and unit of the depth, lost frames, samples interpolated onto a
// finer grid.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto read = read_campaign;
const std::string kBed = "plant = \"intruder\"\n";

// White noise of deviation 1, the same in every run.
double white(int i) {
  const double a = std::fmod(std::abs(std::sin(12.9898 * (i + 1)) * 43758.5453), 1.0);
  const double b = std::fmod(std::abs(std::sin(78.233 * (i + 1)) * 12543.1234), 1.0);
  return std::sqrt(-2.0 * std::log(a + 1e-12)) * std::cos(2.0 * std::numbers::pi * b);
}

struct Stroke {
  double surface_m = 0.0;  // depth at which the bed begins
  double exponent = 1.0;
  double start_m = -0.02;  // depth in the first row
  double unit = 1.0;       // depth is written in this unit
  const char* name = "foot_z_m";
};

// Down to 36 mm in 400 rows; a bed with 54 N there, and 0.1 N of noise.
std::string stroke(const Stroke& s) {
  std::string text = fmt::format("t_s,{},force_N\n", s.name);
  for (int i = 0; i < 400; ++i) {
    const double depth_m = s.start_m + (0.036 - s.start_m) * i / 399.0;
    const double in_bed = std::max(0.0, depth_m - s.surface_m) / (0.036 - s.surface_m);
    text += fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.005 * i, -s.unit * (depth_m + 2e-5 * white(2 * i)),
                        54.0 * std::pow(in_bed, s.exponent) + 0.1 * white(2 * i + 1));
  }
  return text;
}

// Taken, and without these words.
void expect_silent(const Told& told, const char* words) {
  EXPECT_TRUE(told.recording.usable()) << told.text;
  EXPECT_THAT(told.text, Not(HasSubstr(words)));
}

TEST(SurfaceOnset, ABedThatPushesBelowDepthZeroIsSaidWithItsOffset) {
  const auto told = read(kBed, stroke({.surface_m = 0.006})).text;
  EXPECT_THAT(told, HasSubstr("the force begins at a depth of"));
  const auto offset = told.find("offset = ");
  ASSERT_NE(offset, std::string::npos) << told;
  const double moved_m = std::stod(told.substr(offset + 9));
  EXPECT_NEAR(moved_m, 0.006, 5e-4);
  const auto line =
      told.substr(told.find("write ") + 6, told.find(" into [columns]") - told.find("write ") - 6);
  expect_silent(read(kBed + "[columns]\n" + line + "\n", stroke({.surface_m = 0.006})), "depth 0");
}

TEST(SurfaceOnset, ABedThatPushesAboveDepthZeroIsSaidWithItsOffset) {
  const auto told = read(kBed, stroke({.surface_m = -0.006})).text;
  EXPECT_THAT(told, Not(HasSubstr("if it was not tared")));
  EXPECT_THAT(told, HasSubstr("above depth 0, where nothing should touch the foot"));
  const auto line =
      told.substr(told.find("write ") + 6, told.find(" into [columns]") - told.find("write ") - 6);
  expect_silent(read(kBed + "[columns]\n" + line + "\n", stroke({.surface_m = -0.006})), "depth 0");
}

// A plate, a wedge, a cone, a plate in Bekker's softest soil; a foot that is a little out of level; a hole.
TEST(SurfaceOnset, ALawOfAnyFootAndASmallDifferenceAreNot) {
  for (const double exponent : {0.3, 0.5, 1.0, 2.0, 3.0})
    expect_silent(read(kBed, stroke({.exponent = exponent})), "depth 0");
  for (const double surface_m : {-0.001, 0.001})
    expect_silent(read(kBed, stroke({.surface_m = surface_m})), "depth 0");
  const std::string in_hole = kBed + "[every_trial]\nhops_since_bed_preparation = 2\n";
  expect_silent(read(in_hole, stroke({.surface_m = 0.006})), "depth 0");
}

// Drift of the cell, or a mass below it while the foot accelerates: the force stays level above the bed.
TEST(SurfaceOnset, AForceThatDoesNotGrowAboveTheBedIsNoBed) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 400; ++i) {
    const double depth_m = -0.02 + 0.056 * i / 399.0;
    const double level_N = i > 35 ? 1.0 : 0.0;
    text += fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.005 * i, -depth_m,
                        std::max(0.0, 1500.0 * depth_m) + level_N + 0.1 * white(i));
  }
  EXPECT_THAT(read(kBed, text).text, Not(HasSubstr("above depth 0, where nothing")));
}

Told read_depth(const std::string& columns, const std::string& model, const std::string& csv) {
  CampaignFolder folder;
  folder.write("nominal.toml", model)
      .write("campaign.toml",
             kBed + "model = \"nominal.toml\"\n[columns]\n" + columns + "\n[[trial]]\nfile = \"a.csv\"\n")
      .write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  Told told{read_trial(campaign, campaign.trials.at(0)), ""};
  for (const auto& finding : told.recording.findings) told.text += to_string(finding) + "\n";
  return told;
}

TEST(DepthUnit, CentimetresWithoutAUnitAreInDoubtAndMetresAreNot) {
  const std::string believed = "[foot]\nradius_m = 0.04\n[terrain]\nstiffness_N_per_m = 1500\n";
  const auto cm = stroke({.unit = 100.0, .name = "depth"}), m = stroke({.name = "depth"});
  const auto told = read_depth("foot_z_m = \"depth\"", believed, cm);
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("states the unit of \"depth\", and metres are unlikely"));
  EXPECT_THAT(told.text, HasSubstr("where the believed stiffness gives 5.4e+03 N: centimetres fit better"));
  EXPECT_THAT(told.text, HasSubstr("foot_z_m = { column = \"depth\", unit = \"cm\", scale = 0.01 }"));
  for (const auto* stated : {"foot_z_m = { column = \"depth\", unit = \"cm\", scale = 0.01 }",
                             "foot_z_m = { column = \"depth\", unit = \"cm\" }",
                             "foot_z_m = { column = \"depth\", unit = \"m\", scale = 1 }"})
    EXPECT_TRUE(read_depth(stated, believed, cm).recording.usable()) << stated;
  EXPECT_TRUE(read_depth("foot_z_m = \"depth\"", believed, m).recording.usable());
  // No stiffness is believed: the foot's size, and what grains bear.
  const std::string foot = "[foot]\nradius_m = 0.1\n", thin = "[foot]\nradius_m = 0.01\n";
  EXPECT_THAT(read_depth("foot_z_m = \"depth\"", foot, cm).text, HasSubstr("even grains of 100 kg/m3 bear"));
  EXPECT_THAT(read_depth("foot_z_m = \"depth\"", thin, cm).text, HasSubstr("diameters of a foot of 0.02 m"));
  EXPECT_TRUE(read_depth("foot_z_m = \"depth\"", foot, m).recording.usable());
}

// A ball that falls 3.5 m before a camera with 100 frames a second, which loses every `lost`th frame.
std::string fall(int lost, bool true_times, double noise_m = 0.002) {
  std::string text = "t_s,height_m\n";
  for (int i = 0, row = 0; i < 84; ++i) {
    if (lost > 0 && i % lost == 4) continue;
    const double t = 0.01 * i;
    text +=
        fmt::format("{:.2f},{:.5f}\n", 0.01 * (true_times ? i : row), 3.5 - 4.9 * t * t + noise_m * white(i));
    ++row;
  }
  return text;
}
const std::string kBody = "plant = \"falling_body\"\n";

TEST(LostFrames, ATimeMadeFromTheRowNumberIsInDoubt) {
  const auto told = read(kBody, fall(10, false));
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("frames or more are missing, and the time was made from the row number"));
  EXPECT_THAT(told.text, HasSubstr("2 times the step of the rows beside it"));
  const auto at = told.text.find("select = {");
  ASSERT_NE(at, std::string::npos);
  const auto select = told.text.substr(at, told.text.find('}', at) - at + 1);
  CampaignFolder folder;
  folder.write("campaign.toml", kBody + "[[trial]]\nfile = \"a.csv\"\n" + select + "\n")
      .write("a.csv", fall(10, false));
  const auto campaign = load_campaign(folder.path());
  EXPECT_TRUE(read_trial(campaign, campaign.trials.at(0)).usable()) << select;
}

TEST(LostFrames, TrueTimesNoLossAndOtherJumpsAreNot) {
  EXPECT_TRUE(read(kBody, fall(10, true)).recording.usable());
  EXPECT_TRUE(read(kBody, fall(0, false)).recording.usable());
  EXPECT_TRUE(read(kBody, fall(0, false, 0.02)).recording.usable());
  // An encoder with few steps a turn; a foot that sticks and slips; samples that come late.
  const std::string axis = "plant = \"rotary_axis\"\n";
  std::string coarse = "t_s,position_rad\n", late = coarse, slips = "t_s,foot_z_m\n";
  double slipped = 0.0;
  for (int i = 0; i < 300; ++i) {
    coarse += fmt::format("{:.3f},{:.5f}\n", 0.01 * i, 0.02 * std::floor(1.25 * i));
    late += fmt::format("{:.3f},{:.5f}\n", 0.01 * i, 0.02 * (i + (i % 40 == 20 ? 1 : 0)));
    if (i % 40 == 20) slipped += 0.001 * (2.0 + std::fmod(0.37 * i, 3.0));
    slips += fmt::format("{:.3f},{:.6f}\n", 0.01 * i, -0.001 * i - slipped);
  }
  EXPECT_THAT(read(axis, coarse).text, Not(HasSubstr("frames")));
  EXPECT_THAT(read(axis, late).text, Not(HasSubstr("frames")));
  EXPECT_THAT(read(kBed, slips).text, Not(HasSubstr("frames")));
}

// A pendulum with an encoder of 0.3 mrad noise, sampled every `every` s and put onto rows of 5 ms.
std::string swing(double every_s) {
  const auto sample = [](int k, double t) { return 0.5 * std::cos(6.0 * t) + 3e-4 * white(k); };
  std::string text = "t_s,position_rad\n";
  for (int i = 0; i < 600; ++i) {
    const double t = 0.005 * i, at = std::floor(t / every_s + 1e-9);
    const int k = static_cast<int>(at);
    const double share = t / every_s - at, from = sample(k, at * every_s),
                 to = sample(k + 1, (at + 1.0) * every_s);
    text += fmt::format("{:.3f},{:.6f}\n", t, from + share * (to - from));
  }
  return text;
}

std::size_t samples_in(const TrialRecording& recording) {
  const auto values = recording.channel("position_rad");
  return static_cast<std::size_t>(std::ranges::count_if(values, [](double v) { return !std::isnan(v); }));
}

TEST(Interpolated, StraightLinesBetweenTrueSamplesAreTakenForNoSamples) {
  const std::string axis = "plant = \"rotary_axis\"\n";
  const auto ten = read(axis, swing(0.05));
  EXPECT_THAT(ten.text, HasSubstr("bends only every 10 rows and is straight between"));
  EXPECT_THAT(ten.text, HasSubstr("sampled every 50 ms (20 Hz)"));
  EXPECT_EQ(samples_in(ten.recording), 60U);
  EXPECT_THAT(read(axis, swing(0.01)).text, HasSubstr("bends only every 2 rows"));
  // A camera's 30 frames a second on a grid of 200 Hz: knots between the rows.
  const auto camera = read(axis, swing(1.0 / 30.0));
  EXPECT_THAT(camera.text, HasSubstr("(30 Hz)"));
  EXPECT_NEAR(static_cast<double>(samples_in(camera.recording)), 90.0, 2.0);
}

TEST(Interpolated, TrueSamplesEvenSpeedsAndTrianglesAreKept) {
  const std::string axis = "plant = \"rotary_axis\"\n";
  EXPECT_EQ(samples_in(read(axis, swing(0.005)).recording), 600U);
  std::string even = "t_s,position_rad\n", triangle = even, coarse = even;
  for (int i = 0; i < 600; ++i) {
    even += fmt::format("{:.3f},{:.6f}\n", 0.005 * i, 0.002 * i);
    triangle += fmt::format("{:.3f},{:.6f}\n", 0.005 * i, 0.002 * std::abs(i % 40 - 20));
    coarse += fmt::format("{:.3f},{:.6f}\n", 0.005 * i, 0.01 * std::floor(50.0 * std::cos(0.01 * i)));
  }
  for (const auto& text : {even, triangle, coarse}) EXPECT_EQ(samples_in(read(axis, text).recording), 600U);
}

// Turns between two rows; a ramp, a rest and the ramp back; a value that is held for ten rows.
TEST(Interpolated, MotionsAtOneSpeedAndHeldValuesAreKept) {
  std::string between = "t_s,position_rad\n", rests = between, held = between;
  for (int i = 0; i < 600; ++i) {
    between += fmt::format("{:.3f},{:.6f}\n", 0.005 * i, 0.002 * std::abs(std::fmod(i, 41.0) - 20.5));
    const int at = i % 80;
    const double ramp = at < 20 ? at : at < 40 ? 20 : at < 60 ? 60 - at : 0;
    rests += fmt::format("{:.3f},{:.6f}\n", 0.005 * i, 0.002 * ramp);
    held += fmt::format("{:.3f},{:.6f}\n", 0.005 * i, 0.3 * std::cos(0.1 * (i / 10)));
  }
  for (const auto& text : {between, rests, held})
    EXPECT_EQ(samples_in(read("plant = \"rotary_axis\"\n", text).recording), 600U);
}

}  // namespace
}  // namespace sandhopper
