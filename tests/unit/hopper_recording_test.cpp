#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "campaign_folder.hpp"
#include "tools/campaign/mass_below_cell.hpp"
#include "tools/terrain/measured_stride.hpp"
#include "tools/trial/campaign_maker.hpp"

// Recordings of a hopper whose channels contradict each other, and sound ones that look similar.
namespace sandhopper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct HopTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;  // NaN: empty cell

  std::size_t column(const std::string& name) const {
    const auto found = std::ranges::find(names, name);
    EXPECT_NE(found, names.end()) << name;
    return static_cast<std::size_t>(found - names.begin());
  }
  HopTable& change(const std::string& name, const std::function<double(double)>& to) {
    for (auto& row : rows) row[column(name)] = to(row[column(name)]);
    return *this;
  }
  HopTable& exchange(const std::string& a, const std::string& b) {
    for (auto& row : rows) std::swap(row[column(a)], row[column(b)]);
    return *this;
  }
  HopTable& delay(const std::string& name, std::size_t by_rows) {
    const auto at = column(name);
    for (std::size_t i = rows.size(); i-- > 0;) rows[i][at] = i < by_rows ? NAN : rows[i - by_rows][at];
    return *this;
  }
  std::string csv() const {
    std::string text = fmt::format("{}\n", fmt::join(names, ","));
    for (const auto& row : rows)
      for (std::size_t i = 0; i < row.size(); ++i)
        text += (std::isnan(row[i]) ? std::string() : fmt::format("{}", row[i])) +
                (i + 1 < row.size() ? "," : "\n");
    return text;
  }
};

HopTable read_hop(const std::filesystem::path& file) {
  HopTable table;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells(1);
    for (const char c : line)
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    if (table.names.empty()) {
      table.names = cells;
      continue;
    }
    auto& row = table.rows.emplace_back();
    for (const auto& cell : cells) row.push_back(cell.empty() ? NAN : std::stod(cell));
  }
  return table;
}

HopTable hop_of(const WorldConfig& world = {}) {
  CampaignFolder folder;
  CampaignMakerSetup setup;
  setup.world = world;
  setup.folder = folder.path();
  setup.trials = 1;
  make_hop_campaign(setup);
  return read_hop(folder.path() / "trials/0001.csv");
}

// A campaign of this hop with the belief in `nominal`, and its recording.
std::pair<Campaign, TrialRecording> loaded(const HopTable& table, const std::string& nominal = "",
                                           const std::string& columns = "") {
  CampaignFolder folder;
  folder.write("hop.csv", table.csv())
      .write("nominal.toml", nominal)
      .write("campaign.toml", "plant = \"hopper\"\nmodel = \"nominal.toml\"\n" + columns +
                                  "\n[[trial]]\nfile = \"hop.csv\"\nkind = \"hop\"\n"
                                  "release_height_m = 0.0025\ncompression_stiffness_N_per_m = 250\n");
  auto campaign = load_campaign(folder.path());
  auto recording = read_trial(campaign, campaign.trials.at(0));
  return {std::move(campaign), std::move(recording)};
}

// The findings that make the trial or a channel unusable.
std::string doubts(const HopTable& table, const std::string& nominal = "", const std::string& columns = "") {
  std::string text;
  for (const auto& finding : loaded(table, nominal, columns).second.findings)
    if (finding.severity != FindingSeverity::note) text += to_string(finding) + "\n";
  return text;
}

const HopTable& sound_hop() {
  static const HopTable table = hop_of();
  return table;
}
HopTable hop() { return sound_hop(); }

constexpr auto kCell = "load_cell_force_N";

TEST(HopperRecording, ASoundHopIsNotDoubted) { EXPECT_EQ(doubts(hop()), ""); }

TEST(HopperRecording, ACellThatCountsTensionGetsItsLine) {
  const auto turned = hop().change(kCell, [](double value) { return -value; });
  EXPECT_THAT(doubts(turned), AllOf(HasSubstr("it counts tension"), HasSubstr("scale = -1 }")));
  EXPECT_EQ(doubts(turned, "",
                   "[columns]\nload_cell_force_N = { column = \"load_cell_force_N\", unit = \"N\", "
                   "scale = -1 }\n"),
            "")
      << "the line of the message is the cure";
}

TEST(HopperRecording, ACellInAnotherUnitIsNamedWithTheUnit) {
  const auto in = [](double newtons) {
    return doubts(hop().change(kCell, [=](double value) { return value / newtons; }));
  };
  EXPECT_THAT(in(4.4482216), AllOf(HasSubstr("in lbf"), HasSubstr("scale = 4.4482216 }")));
  EXPECT_THAT(in(9.80665), HasSubstr("in kgf"));
  EXPECT_THAT(in(0.00980665), HasSubstr("in gf"));
  EXPECT_THAT(in(-1000.0), AllOf(HasSubstr("in kN"), HasSubstr("it counts tension")));
  EXPECT_THAT(in(30.0), HasSubstr("the scale of the cell is wrong"));
}

TEST(HopperRecording, WithoutAccelerometersTheLegShowsTheUnitOfTheCell) {
  const auto without = [](double newtons) {
    return hop()
        .change(kCell, [=](double value) { return value / newtons; })
        .change("imu_body_accel_z_mps2", [](double) { return NAN; });
  };
  EXPECT_THAT(doubts(without(4.4482216)), AllOf(HasSubstr("torques over L'"), HasSubstr("in lbf")));
  EXPECT_EQ(doubts(without(1.0)), "");
}

TEST(HopperRecording, ALateCellIsNamedWithItsDelay) {
  EXPECT_THAT(doubts(hop().delay(kCell, 30)), AllOf(HasSubstr("is 0.03"), HasSubstr("s late against")));
  EXPECT_EQ(doubts(hop().delay(kCell, 5)), "") << "a filter of the cell";
  EXPECT_EQ(doubts(hop().delay(kCell, 30), "[sensors]\nload_cell_latency_s = 0.03\n"), "") << "a stated one";
}

// Largest difference of the measured strides' forces in rows with a sample in both.
double force_apart_N(const HopTable& a, const HopTable& b, const std::string& nominal_of_b) {
  const auto stride = [](const auto& campaign_and_recording) {
    const auto& [campaign, recording] = campaign_and_recording;
    std::string missing;
    return measured_stride(campaign.trials.at(0), recording, StiffnessConfig{}, missing);
  };
  const auto first = stride(loaded(a)), second = stride(loaded(b, nominal_of_b));
  if (!first || !second) return INFINITY;
  const auto &p = first->stride.samples, &q = second->stride.samples;
  double most = p.size() == q.size() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < std::min(p.size(), q.size()); ++i)
    most = std::max(most, std::abs(p[i].estimate.load_cell_force_N - q[i].estimate.load_cell_force_N));
  return most;
}

TEST(HopperRecording, AStatedLatencyOfTheCellIsTakenOutOfTheMeasuredStride) {
  const auto late = hop().delay(kCell, 30);
  EXPECT_LT(force_apart_N(hop(), late, "[sensors]\nload_cell_latency_s = 0.03\n"), 1e-9);
  EXPECT_GT(force_apart_N(hop(), late, ""), 10.0);
}

TEST(HopperRecording, ExchangedAccelerometersGetTheirLines) {
  const auto swapped = hop().exchange("imu_body_accel_z_mps2", "imu_foot_accel_z_mps2");
  EXPECT_THAT(doubts(swapped), AllOf(HasSubstr("the two columns are exchanged"),
                                     HasSubstr("imu_body_accel_z_mps2 = { column = \"imu_foot_accel")));
}

TEST(HopperRecording, ATimeTwiceAsLongIsNamedWithItsScale) {
  for (const bool has_mocap : {true, false}) {
    auto slow = hop().change("t_s", [](double value) { return 2.0 * value; });
    if (!has_mocap) slow.change("mocap_body_z_m", [](double) { return NAN; });
    const auto text = doubts(slow);
    EXPECT_THAT(text, AllOf(HasSubstr(has_mocap ? "mocap_body_z_m: moves" : "tof_height_m: moves"),
                            HasSubstr("the time is 2 times too long"),
                            HasSubstr("t_s = { column = \"t_s\", scale = 0.5 }")));
  }
}

TEST(HopperRecording, AFootHeightWithAnotherZeroGetsItsOffset) {
  for (const double by_m : {0.3, -0.3}) {
    const auto text = doubts(hop().change("mocap_foot_z_m", [=](double value) { return value + by_m; }));
    EXPECT_THAT(text, AllOf(HasSubstr("when the load cell first carries load"),
                            HasSubstr(by_m > 0.0 ? "offset = -0.29" : "offset = 0.30")));
  }
}

TEST(HopperRecording, AnInvertedFlagOfStanceGetsItsLine) {
  auto inverted = hop().change("phase", [](double value) {
    return std::isnan(value) ? NAN : value > 0.0 ? 0.0 : 1.0;
  });
  EXPECT_THAT(doubts(inverted), AllOf(HasSubstr("the flag is inverted"),
                                      HasSubstr("phase = { column = \"phase\", scale = -1, offset = 1 }"),
                                      Not(HasSubstr("motor_left_current_A"))));
  EXPECT_EQ(doubts(inverted, "", "[columns]\nphase = { column = \"phase\", scale = -1, offset = 1 }\n"), "")
      << "the line of the message is the cure";
  inverted.names[inverted.column(kCell)] = "unused";
  EXPECT_THAT(doubts(inverted), HasSubstr("the flag is inverted"))
      << "the body's accelerometer shows it, too";
}

TEST(HopperRecording, SpecificForcesWithoutGravityGetTheirOffset) {
  for (const std::string channel : {"imu_body_accel_z_mps2", "imu_foot_accel_z_mps2"}) {
    const auto without = hop().change(channel, [](double value) { return value - 9.81; });
    EXPECT_THAT(doubts(without), AllOf(HasSubstr("gravity was subtracted"), HasSubstr("offset = 9.81 }")));
    EXPECT_EQ(
        doubts(without, "",
               fmt::format("[columns]\n{0} = {{ column = \"{0}\", unit = \"m/s^2\", scale = 1, offset = 9.81 "
                           "}}\n",
                           channel)),
        "")
        << channel;
  }
}

TEST(HopperRecording, HeightsOnALateClockAreNamedWithTheirDelay) {
  const auto late = hop().delay("mocap_body_z_m", 30).delay("mocap_foot_z_m", 30);
  EXPECT_THAT(doubts(late), AllOf(HasSubstr("0.030 s later"), HasSubstr("by 30 rows towards earlier rows")));
  EXPECT_EQ(doubts(hop().delay("mocap_body_z_m", 5).delay("mocap_foot_z_m", 5)), "")
      << "less than 1/20 of a stance";
}

// A cell above a mass, tared at rest.
HopTable with_mass_below_cell(double mass_kg) {
  auto table = hop();
  const auto cell = table.column(kCell), accel = table.column("imu_foot_accel_z_mps2");
  double last = 9.81;
  for (auto& row : table.rows) {
    if (!std::isnan(row[accel])) last = row[accel];
    row[cell] -= mass_kg * (last - 9.81);
  }
  return table;
}

std::string notes(const HopTable& table, const std::string& nominal = "") {
  std::string text;
  for (const auto& finding : loaded(table, nominal).second.findings) text += to_string(finding) + "\n";
  return text;
}

TEST(HopperRecording, AMassBelowTheCellIsNotedAndTakenOut) {
  const auto heavy = with_mass_below_cell(0.3);
  const auto text = notes(heavy);
  const auto at = text.find("mass_kg = ");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_NEAR(std::stod(text.substr(at + 10)), 0.3, 0.03);
  EXPECT_THAT(notes(hop()), Not(HasSubstr("hang below the cell")));
  const std::string stated = "[effects]\n\"load_cell.inertia[load_cell_force_N]\" = { mass_kg = 0.3 }\n";
  EXPECT_THAT(notes(heavy, stated), Not(HasSubstr("hang below the cell")));
  auto [campaign, recording] = loaded(heavy, stated);
  const auto sound = loaded(hop()).second;
  const auto apart_N = [&] {
    double sum = 0.0;
    const auto a = recording.channel(kCell), b = sound.channel(kCell);
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!std::isnan(a[i])) sum += std::abs(a[i] - b[i]);
    return sum / static_cast<double>(a.size());
  };
  const double before_N = apart_N();
  add_mass_below_cell(recording, campaign.trials.at(0).belief);
  EXPECT_LT(apart_N(), 0.1 * before_N);
}

TEST(HopperRecording, EffectiveCurrentsAreNoted) {
  auto rms = hop();
  for (const char* side : {"left", "right"})
    rms.change(fmt::format("motor_{}_current_A", side), [](double value) { return value / std::sqrt(2.0); });
  EXPECT_THAT(notes(rms), AllOf(HasSubstr("effective (rms)"), HasSubstr("scale = 1.414 for both")));
  EXPECT_THAT(notes(hop()), Not(HasSubstr("times the force of the load cell")));
}

TEST(HopperRecording, OtherPhysicsIsNotDoubted) {
  WorldConfig world;
  world.motor.torque_constant_Nm_per_A *= 1.3;
  EXPECT_EQ(doubts(hop_of(world)), "") << "torque constants 30 % above the believed ones";
  world.motor.torque_constant_Nm_per_A *= 0.7 / 1.3;
  EXPECT_EQ(doubts(hop_of(world)), "") << "torque constants 30 % below the believed ones";
  world = {};
  world.terrain.stiffness_N_per_m = 1e5;
  EXPECT_EQ(doubts(hop_of(world)), "") << "rigid ground";
  world = {};
  world.motor.torque_limit_Nm = 0.0;
  EXPECT_EQ(doubts(hop_of(world)), "") << "motors off";
}

TEST(HopperRecording, AHoldAndDeadChannelsAreNotDoubted) {
  auto held = hop();
  held.rows.resize(300);  // The robot is let go after 0.3 s.
  EXPECT_EQ(doubts(held), "");
  for (const char* dead : {kCell, "imu_body_accel_z_mps2", "imu_foot_accel_z_mps2"}) {
    const auto noise = [row = 0.0](double) mutable {
      row += 1.0;
      return 0.01 * std::sin(1000.0 * row * row);
    };
    EXPECT_EQ(doubts(hop().change(dead, noise)), "") << dead;
  }
}

TEST(HopperRecording, ACellWithAWrongMassOfTheBodyIsNotDoubted) {
  EXPECT_EQ(doubts(hop(), "[robot]\nbody_mass_kg = 8.0\n"), "") << "the leg agrees with the cell";
}

}  // namespace
}  // namespace sandhopper
