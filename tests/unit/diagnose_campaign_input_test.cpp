#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/campaign_folder.hpp"
#include "tools/diagnose/plants/rotary_axis/free_axis.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"

namespace sandhopper::diagnose {
namespace {

// A number that the plant needs and nobody states is a placeholder, which is said before any verdict.
TEST(DiagnoseCampaignInput, TellsPlaceholdersThatItComputesWith) {
  CampaignFolder folder;
  const std::string head = "plant = \"rotary_axis\"\n[[trial]]\nfile = \"1.csv\"\n";
  folder.write("1.csv", "t_s,position_rad\n0.0,0.1\n0.1,0.2\n0.2,0.3\n0.3,0.4\n");
  const auto told = [&] {
    const auto input = read_campaign(load_campaign(folder.path()));
    EXPECT_EQ(input.recordings.trials.size(), 1u);
    const auto found = std::ranges::find(input.findings, "axis.inertia_kg_m2", &Finding::channel);
    return found == input.findings.end() ? "" : found->what;
  };
  folder.write("campaign.toml", head);
  EXPECT_NE(told().find("is stated nowhere, and 1 kg m^2 is no more than a placeholder"), std::string::npos);
  folder.write("campaign.toml", "model = \"nominal.toml\"\n" + head);
  folder.write("nominal.toml", "[axis]\ninertia_kg_m2 = 1.0\n");
  EXPECT_EQ(told(), "");
}

// A problem of a file that two trials share is reported once; the same problem of another file is reported as
// well.
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

// The release time within a camera's row is kept in any time base; trials with separate clocks have lost it.
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

// A load cell at its limit for half of its samples is kept: what it read below is true. One that shows one
// value is kept if it does in all trials; in a single trial it failed.
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
  EXPECT_EQ(forces_in({live, limited, live}), 3);
}

// The torque of a free axis is usually not recorded. It is 0 there, and the answer states this. The torque of
// a driven trial must be recorded.
TEST(DiagnoseCampaignInput, AnAxisThatRunsFreeNeedsNoTorque) {
  const auto torques = [](const char* second, bool with_torque) {
    CampaignFolder folder;
    folder.write("campaign.toml",
                 fmt::format("name = \"x\"\nplant = \"rotary_axis\"\n[[trial]]\nfile = \"1.csv\"\n"
                             "motor_enabled = false\n[[trial]]\nfile = \"2.csv\"\n{}",
                             second));
    std::string text = "t_s,position_rad\n", with = "t_s,position_rad,torque_Nm\n";
    for (int i = 0; i < 30; ++i) {
      text += fmt::format("{:.2f},{:.4f}\n", 0.01 * i, 0.5 - 0.001 * i * i);
      with += fmt::format("{:.2f},{:.4f},{:.2f}\n", 0.01 * i, 0.5 - 0.001 * i * i, 0.1 + 0.01 * i);
    }
    folder.write("1.csv", text);
    folder.write("2.csv", with_torque ? with : text);
    const auto input = read_campaign(load_campaign(folder.path()));
    std::vector<double> first;  // of each trial; NaN: none
    for (const auto& trial : input.recordings.trials) {
      const auto* torque = trial.find("torque_Nm");
      first.push_back(torque == nullptr ? std::nan("") : torque->front());
    }
    const bool said = std::ranges::any_of(input.findings, [](const Finding& f) {
      return f.channel == "torque_Nm" && f.what.find("0 N m") != std::string::npos;
    });
    return std::pair(first, said);
  };
  const auto [free, free_said] = torques("", false);
  EXPECT_EQ(free, (std::vector{0.0, 0.0}));
  EXPECT_TRUE(free_said);
  const auto [driven, driven_said] = torques("motor_enabled = true\n", false);
  EXPECT_EQ(driven[0], 0.0);
  EXPECT_TRUE(std::isnan(driven[1]));
  EXPECT_TRUE(driven_said);
  const auto [mixed, mixed_said] = torques("", true);
  EXPECT_EQ(mixed, (std::vector{0.0, 0.1}));
  EXPECT_TRUE(mixed_said);
}

// A pendulum with a noisy encoder is held at 2 rad for `held_s` and released, or pushed off at `speed_radps`;
// 1 s at 200 Hz.
Trial pendulum(double held_s, double speed_radps, double noise_rad = 1e-4) {
  Trial trial;
  double angle = 2.0, speed = speed_radps;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.005 * i;
    trial.time_s.push_back(t);
    trial.channels["position_rad"].push_back(angle + noise_rad * ((i * 7) % 5 - 2));
    if (t < held_s) continue;
    speed += 0.005 * -20.0 * std::sin(angle);
    angle += 0.005 * speed;
  }
  return trial;
}

TEST(DiagnoseCampaignInput, APendulumInTheHandIsNotFreeYet) {
  std::vector<Trial> trials{pendulum(0.3, 0.0), pendulum(0.0, 0.0), pendulum(0.0, -3.0),
                            pendulum(0.0, 0.0, 0.01), pendulum(0.0, 0.0, 0.05)};
  const auto free = take_free_axes(trials, {false, false, false, false, false});
  EXPECT_EQ(free.without_torque, 5u);
  EXPECT_EQ(free.held, 1u);
  const auto& torque = *trials[0].find("torque_Nm");
  const auto known = std::ranges::find_if(torque, [](double v) { return !std::isnan(v); });
  const double free_s = trials[0].time_s[static_cast<std::size_t>(known - torque.begin())];
  EXPECT_GE(free_s, 0.3);
  EXPECT_LT(free_s, 0.4);
  for (const std::size_t i : {1u, 2u, 3u, 4u})
    EXPECT_TRUE(std::ranges::all_of(*trials[i].find("torque_Nm"), [](double v) { return v == 0.0; })) << i;
}

// A window of a swing that begins shortly before the pendulum turns: nothing holds it there.
TEST(DiagnoseCampaignInput, APendulumThatTurnsIsNotHeld) {
  for (const double before_s : {0.02, 0.05, 0.1, 0.2}) {
    Trial trial;
    for (int i = 0; i < 400; ++i) {
      const double t = 0.005 * i;
      trial.time_s.push_back(t);
      trial.channels["position_rad"].push_back(0.8 * std::cos(4.0 * (t - before_s)) +
                                               2e-4 * ((i * 7) % 5 - 2));
    }
    EXPECT_FALSE(let_go_s(trial)) << before_s;
  }
  EXPECT_TRUE(let_go_s(pendulum(0.3, 0.0)));
}

TEST(DiagnoseCampaignInput, ACureThatIsDoneIsNotAskedFor) {
  std::vector<Trial> trials{pendulum(0.0, 0.0), pendulum(0.0, 0.0)};
  for (auto& trial : trials) trial.channels.erase("torque_Nm");
  auto unsaid = trials;
  EXPECT_EQ(take_free_axes(trials, {false, false}).unstated, 0u);
  EXPECT_EQ(take_free_axes(unsaid, {false, std::nullopt}).unstated, 1u);
}

}  // namespace
}  // namespace sandhopper::diagnose
