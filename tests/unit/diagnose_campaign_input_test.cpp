#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/campaign_folder.hpp"
#include "tools/diagnose/campaign_input.hpp"

namespace sandhopper::diagnose {
namespace {

// What ails a file that two trials share is told once, what ails another file as well.
TEST(DiagnoseCampaignInput, TellsWhatAilsASharedFileOnce) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "name = \"x\"\nplant = \"falling_body\"\n"
               "[every_trial]\nalso = { file = \"force.csv\", columns = { accel_mps2 = \"a\" } }\n"
               "[[trial]]\nfile = \"1.csv\"\n[[trial]]\nfile = \"2.csv\"\n[[trial]]\nfile = \"3.csv\"\n");
  folder.write("force.csv", "t_s,a\n0.0,0.0\n0.1,0.1\n0.2,0.2\n2.0,0.3\n2.1,0.4\n");
  for (const char* whole : {"1.csv", "2.csv"})
    folder.write(whole, "t_s,height_m\n0.0,1.0\n0.1,0.9\n0.2,0.8\n0.3,0.7\n");
  folder.write("3.csv", "t_s,height_m\n0.0,1.0\n0.1,0.9\n0.2,0.8\n2.0,0.7\n2.1,0.6\n");
  const auto input = read_campaign(load_campaign(folder.path()));
  EXPECT_EQ(input.recordings.trials.size(), 3u);
  const auto gaps_in = [&](const std::string& file) {
    return std::ranges::count_if(input.findings, [&](const Finding& f) {
      return f.kind == FindingKind::gap && f.file.ends_with(file);
    });
  };
  EXPECT_EQ(gaps_in("force.csv"), 1);
  EXPECT_EQ(gaps_in("3.csv"), 1);
}

// Where in its camera's row a body was let go is kept, in any time base; trials with clocks of their own have
// lost it.
TEST(DiagnoseCampaignInput, AFallBeginsBetweenTwoRows) {
  const auto first_rows_s = [](double first_s, double second_s) {
    CampaignFolder folder;
    folder.write("campaign.toml",
                 "name = \"x\"\nplant = \"falling_body\"\n[[trial]]\nfile = \"1.csv\"\n[[trial]]\nfile = "
                 "\"2.csv\"\n");
    const auto write = [&](const char* name, double start_s) {
      std::string text = "t_s,height_m\n";
      for (int i = 0; i < 20; ++i) text += fmt::format("{:.4f},{:.4f}\n", start_s + 0.01 * i, 1.0 - 0.03 * i);
      folder.write(name, text);
    };
    write("1.csv", first_s);
    write("2.csv", second_s);
    const auto input = read_campaign(load_campaign(folder.path()));
    return std::pair(input.recordings.trials[0].time_s.front(), input.recordings.trials[1].time_s.front());
  };
  const auto [early, late] = first_rows_s(0.002, 0.007);
  EXPECT_NEAR(early, 0.002, 1e-9);
  EXPECT_NEAR(late, 0.007, 1e-9);
  const auto [shifted_early, shifted_late] = first_rows_s(137.002, 137.007);
  EXPECT_NEAR(shifted_early, 0.0, 1e-9);
  EXPECT_NEAR(shifted_late, 0.005, 1e-9);
  const auto [own, other] = first_rows_s(137.002, 512.3);
  EXPECT_EQ(own, 0.0);
  EXPECT_EQ(other, 0.0);
}

std::string force_rows(const std::function<double(int)>& force_N) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 400; ++i)
    text += fmt::format("{:.3f},{:.6f},{:.3f}\n", 1e-3 * i, -1e-4 * i, force_N(i));
  return text;
}

// A load cell at its limit for half of its samples, or at one value, in all trials still shows what it shows;
// one that failed in a single trial does not.
TEST(DiagnoseCampaignInput, AChannelAtOneValueInAllTrialsIsKept) {
  const auto live = [](int i) { return 0.05 * i + 0.01 * ((i * 7919) % 13); };
  const auto limited = [&](int i) { return std::min(live(i), i > 395 ? live(i - 300) : 10.0); };
  const auto stuck = [](int) { return 3.25; };
  const auto forces_in = [&](const std::vector<std::function<double(int)>>& of_trials) {
    CampaignFolder folder;
    std::string campaign = "name = \"x\"\nplant = \"intruder\"\n";
    for (std::size_t t = 0; t < of_trials.size(); ++t) {
      campaign += fmt::format("[[trial]]\nfile = \"{}.csv\"\n", t);
      folder.write(fmt::format("{}.csv", t), force_rows(of_trials[t]));
    }
    folder.write("campaign.toml", campaign);
    const auto input = read_campaign(load_campaign(folder.path()));
    return std::ranges::count_if(input.recordings.trials,
                                 [](const Trial& trial) { return trial.channels.contains("force_N"); });
  };
  EXPECT_EQ(forces_in({limited, limited, limited}), 3);
  EXPECT_EQ(forces_in({stuck, stuck, stuck}), 3);
  EXPECT_EQ(forces_in({live, stuck, live}), 2);
}

}  // namespace
}  // namespace sandhopper::diagnose
