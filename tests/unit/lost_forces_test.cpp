#include "tools/campaign/lost_forces.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "tests/unit/read_campaign.hpp"
#include "tools/campaign/repeated_recordings.hpp"
#include "tools/terrain/campaign_analysis.hpp"

namespace sandhopper {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::string_view kHead = "plant = \"intruder\"\n[every_trial]\nplate_diameter_m = 0.08\n";

struct Row {
  int i;
  double depth_m, force_N;
};

// A plate that is pushed in by 30 mm with 1800 N/m, 100 rows a second; `change` changes a row.
std::string press(const std::function<void(Row&)>& change, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.2);
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 180; ++i) {
    Row row{i, 2e-4 * (i - 30), 0.0};
    row.force_N = 1800.0 * std::max(0.0, row.depth_m) + noise(random);
    change(row);
    text += fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.01 * i, -row.depth_m, row.force_N);
  }
  return text;
}

TEST(LostForces, ZerosBetweenForcesAreToldAndLeftOut) {
  const auto every_tenth = read_campaign(std::string(kHead), press([](Row& row) {
                                           if (row.i % 10 == 3) row.force_N = 0.0;
                                         }));
  EXPECT_THAT(every_tenth.text, HasSubstr("falls from a force to 0 and comes back"));
  auto recording = every_tenth.recording;
  leave_out_lost_forces(recording);
  const auto force = recording.channel("force_N");
  EXPECT_EQ(std::ranges::count(force, 0.0), 0);
  const auto block = read_campaign(std::string(kHead), press([](Row& row) {
                                     if (row.i >= 90 && row.i < 107) row.force_N = 0.0;
                                   }));
  EXPECT_THAT(block.text, HasSubstr("once in 17 rows, first in line 92"));
  recording = block.recording;
  leave_out_lost_forces(recording);
  EXPECT_TRUE(std::isnan(recording.channel("force_N")[95]));
}

TEST(LostForces, AForceThatStandsStillWhileTheFootMovesIsNone) {
  const auto held = read_campaign(std::string(kHead), press([](Row& row) {
                                    if (row.i >= 90 && row.i < 134) row.force_N = 21.9511;
                                  }));
  EXPECT_THAT(held.text, HasSubstr("stands still while the foot moves on"));
  auto recording = held.recording;
  leave_out_lost_forces(recording);
  EXPECT_FALSE(std::isnan(recording.channel("force_N")[90]));  // the sample that was repeated
  EXPECT_TRUE(std::isnan(recording.channel("force_N")[91]));
}

TEST(LostForces, SoundForcesStay) {
  const std::function<void(Row&)> sound[] = {
      [](Row&) {},
      [](Row& row) { row.force_N = std::max(0.0, row.force_N); },   // a display without a sign
      [](Row& row) { row.force_N = std::round(row.force_N); },      // a coarse cell
      [](Row& row) { row.force_N = std::min(row.force_N, 40.0); },  // a full cell
      [](Row& row) {
        if (row.i >= 90) row.depth_m = 0.012, row.force_N = 21.6;
      },              // a dwell without noise
      [](Row& row) {  // lifted out and pushed in again
        row.depth_m = 0.01 * std::sin(0.1 * row.i);
        row.force_N = std::max(0.0, 1800.0 * row.depth_m);
      }};
  for (std::size_t n = 0; n < std::size(sound); ++n) {
    const auto told = read_campaign(std::string(kHead), press(sound[n]));
    EXPECT_TRUE(lost_forces(told.recording).empty()) << n << told.text;
  }
}

TEST(LostForces, TerrainDoesNotUseThem) {
  CampaignFolder folder;
  folder.write("campaign.toml", std::string(kHead) + "[[trial]]\nfile = \"a.csv\"\n");
  folder.write("a.csv", press([](Row& row) {
                 if (row.i >= 90 && row.i < 107) row.force_N = 0.0;
               }));
  const auto results = analyse_campaign(load_campaign(folder.path()), {});
  const auto& series = results.results.at(0).series;
  ASSERT_TRUE(series.contains("press_loading_force_N"));
  const auto& depth_m = series.find("press_loading_depth_m")->second;
  const auto& force_N = series.find("press_loading_force_N")->second;
  for (std::size_t i = 0; i < depth_m.size(); ++i)
    EXPECT_GT(force_N[i], depth_m[i] > 0.01 ? 10.0 : -5.0) << depth_m[i];
}

class Repeated : public testing::Test {
 protected:
  // Findings of hop terrain in a campaign of these two files, and the number of usable trials.
  std::pair<std::string, std::size_t> found(const std::string& a, const std::string& b,
                                            const std::string& setup_of_b = "") {
    folder_.write("a.csv", a).write("b.csv", b);
    folder_.write(
        "campaign.toml",
        std::string(kHead) + "[[trial]]\nfile = \"a.csv\"\n[[trial]]\nfile = \"b.csv\"\n" + setup_of_b);
    std::string text;
    std::size_t usable = 0;
    for (const auto& result : analyse_campaign(load_campaign(folder_.path()), {}).results) {
      usable += result.usable;
      for (const auto& finding : result.findings) text += to_string(finding) + "\n";
    }
    return {text, usable};
  }
  CampaignFolder folder_;
};

TEST_F(Repeated, ACopiedRecordingIsCountedOnce) {
  const auto same = press([](Row&) {});
  const auto [text, usable] = found(same, same);
  EXPECT_EQ(usable, 1u);
  EXPECT_THAT(text, HasSubstr("has the same samples as trial 1 (a.csv)"));
  EXPECT_THAT(found(same, same, "plate_diameter_m = 0.05\n").first, HasSubstr("the set-ups differ"));
}

TEST_F(Repeated, TwoMeasurementsAndTwoEqualSimulationsAreNot) {
  EXPECT_EQ(found(press([](Row&) {}, 1), press([](Row&) {}, 2)).second, 2u);
  const auto smooth = press([](Row& row) { row.force_N = 5e4 * row.depth_m * std::abs(row.depth_m); });
  EXPECT_EQ(found(smooth, smooth).second, 2u);
}

}  // namespace
}  // namespace sandhopper
