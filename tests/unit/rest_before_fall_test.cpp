#include "tools/campaign/rest_before_fall.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/unit/read_campaign.hpp"
#include "tools/diagnose/plants/falling_body/falling_trial.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kRow_s = 1.0 / 120.0;

struct Video {
  std::vector<double> t_s, height_m;
};

// A ball of 0.9 kg that falls 2.4 m in air after a rest, on video of 3 mm noise.
Video filmed(int rows_of_rest, double drag_per_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.003);
  Video video;
  double height = 2.4, speed = 0.0;
  for (int i = 0; height > 0.1; ++i) {
    video.t_s.push_back(i * kRow_s);
    video.height_m.push_back(height + noise(random));
    if (i < rows_of_rest) continue;
    const double accel = 9.81 - drag_per_m * speed * speed;
    height -= speed * kRow_s + 0.5 * accel * kRow_s * kRow_s;
    speed += accel * kRow_s;
  }
  return video;
}

Told read_video(const Video& video, const std::string& trial) {
  std::string csv = "t_s,height_m\n";
  for (std::size_t i = 0; i < video.t_s.size(); ++i)
    csv += fmt::format("{:.4f},{:.4f}\n", video.t_s[i], video.height_m[i]);
  return read_campaign("plant = \"falling_body\"\n[every_trial]\nkind = \"drop\"\nmass_kg = 0.9\n" + trial,
                       csv);
}

TEST(RestBeforeFall, AFewFramesOfRestAreFoundToTheFrame) {
  for (unsigned seed = 1; seed < 30; ++seed)
    for (const int rows : {3, 5, 7, 30}) {
      const auto video = filmed(rows, 0.0, seed);
      const auto rest_s = rest_before_fall_s(video.t_s, video.height_m);
      ASSERT_TRUE(rest_s) << rows << " rows, seed " << seed;
      EXPECT_NEAR(*rest_s, rows * kRow_s, 2.0 * kRow_s) << seed;
    }
}

// A rest that four standard errors show is found, and two would find rests where there is none.
TEST(RestBeforeFall, ARestIsToldFromNoiseByFourStandardErrors) {
  const auto found_in = [](int rows_of_rest, double noise_m) {
    int found = 0;
    for (unsigned seed = 0; seed < 400; ++seed) {
      std::mt19937 random(seed);
      std::normal_distribution<double> noise(0.0, noise_m);
      Video video;
      for (int i = 0; i < rows_of_rest + 80; ++i) {
        const double falls_s = std::max(0, i - rows_of_rest) * kRow_s;
        video.t_s.push_back(i * kRow_s);
        video.height_m.push_back(2.4 - 4.905 * falls_s * falls_s + noise(random));
      }
      found += rest_before_fall_s(video.t_s, video.height_m).has_value();
    }
    return found;
  };
  EXPECT_EQ(found_in(0, 0.03), 0);
  EXPECT_GT(found_in(3, 0.01), 380);
}

// From fewer than ten rows of the first half of the way nothing is said.
TEST(RestBeforeFall, TenRowsOfTheFirstHalfAreEnoughAndNineAreNot) {
  const auto is_found = [](int rows) {
    Video video;
    for (int i = 0; i < rows; ++i) {
      const double falls_s = std::max(0, i - 3) * kRow_s;
      video.t_s.push_back(i * kRow_s);
      video.height_m.push_back(2.0 - 4.905 * falls_s * falls_s);
    }
    video.t_s.push_back(rows * kRow_s);  // the lowest height; the rows before are its first half
    video.height_m.push_back(2.0 - 2.2 * (2.0 - video.height_m.back()));
    return rest_before_fall_s(video.t_s, video.height_m).has_value();
  };
  EXPECT_FALSE(is_found(9));
  EXPECT_TRUE(is_found(10));
}

TEST(RestBeforeFall, AFallFromTheFirstRowOnHasNone) {
  for (unsigned seed = 1; seed < 30; ++seed)
    for (const double drag_per_m : {0.0, 0.1, 2.0}) {
      const auto video = filmed(0, drag_per_m, seed);
      EXPECT_FALSE(rest_before_fall_s(video.t_s, video.height_m)) << drag_per_m << " " << seed;
    }
  Video thrown;
  for (int i = 0; i < 90; ++i)
    thrown.t_s.push_back(i * kRow_s),
        thrown.height_m.push_back(1.0 + 3.0 * i * kRow_s - 4.905 * std::pow(i * kRow_s, 2));
  EXPECT_THAT(read_video(thrown, "").text, IsEmpty());
}

TEST(RestBeforeFall, IsNotedWithTheLineThatLeavesItOut) {
  const auto told = read_video(filmed(6, 0.0, 3), "release_height_m = 2.4\n");
  EXPECT_TRUE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("the body rests for 0.05"));
  EXPECT_THAT(told.text, HasSubstr("write select = { from_s = 0.05"));
  EXPECT_THAT(read_video(filmed(6, 0.0, 3), "release_height_m = 2.4\nselect = { from_s = 0.05 }\n").text,
              IsEmpty());
  EXPECT_THAT(read_video(filmed(0, 0.0, 3), "release_height_m = 2.4\n").text, IsEmpty());
}

// The simulated body is held until the release, whose instant is a nuisance.
TEST(RestBeforeFall, ADiagnosisHoldsTheBodyForSoLong) {
  for (const int rows : {0, 5}) {
    const auto video = filmed(rows, 0.0, 4);
    diagnose::Trial trial;
    trial.name = "a";
    trial.time_s = video.t_s;
    trial.channels["height_m"] = video.height_m;
    trial.setup["release_height_m"] = 2.4;
    diagnose::Belief belief;
    belief.numbers = {{"gravity_mps2", 9.81}, {"body.mass_kg", 0.9}, {"sensors.height_noise_m", 0.003}};
    const auto model = diagnose::make_falling_trial(trial, belief);
    EXPECT_EQ(std::ranges::any_of(model->trial_nuisances,
                                  [](const auto& nuisance) { return nuisance.name == "release_time_s"; }),
              rows > 0);
  }
}

}  // namespace
}  // namespace sandhopper
