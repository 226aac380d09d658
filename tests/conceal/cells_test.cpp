// Cells of an answer: channel and phase in which a hidden effect exceeds the noise of the sensor.
#include "tools/conceal/cells.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "tools/conceal/write_campaign.hpp"

namespace sandhopper::conceal {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;
using testing::SizeIs;

Request request_for(const std::string& plant, const std::string& effect, double size) {
  Request request;
  request.seed = 21;
  request.plant = plant;
  request.effect = effect;
  request.size = size;
  return request;
}

Case one_hidden(const std::string& plant, const std::string& effect, double size) {
  return make_case(request_for(plant, effect, size), 1);
}

// The phases of one channel.
std::set<std::string> phases_of(const EffectCells& cells, const std::string& channel) {
  std::set<std::string> phases;
  for (const auto& cell : cells.value())
    if (cell.channel == channel) phases.insert(cell.phase);
  return phases;
}

std::set<std::string> channels_of(const EffectCells& cells) {
  std::set<std::string> channels;
  for (const auto& cell : cells.value()) channels.insert(cell.channel);
  return channels;
}

double believed(const Bench& bench, const std::string& table, const std::string& key) {
  for (const auto& [name, keys] : bench.belief().tables)
    if (name == table) return keys.at(key).get<double>();
  return std::nan("");
}

struct Offset {
  std::string plant, effect, parameter, channel, noise;
  std::vector<std::string> phases;
};

class ConcealedOffset : public testing::TestWithParam<Offset> {};

// The difference that a constant offset makes is the offset in every row. The ratio is therefore the offset
// over the standard deviation of one sample. It would be smaller if the repeat had another bed or release.
TEST_P(ConcealedOffset, ExceedsTheNoiseEverywhereInItsChannelAndNowhereElse) {
  const auto& expected = GetParam();
  const auto c = one_hidden(expected.plant, expected.effect, 1.5);
  const auto cells = cells_of_effects(c);
  ASSERT_THAT(cells, ElementsAre(Optional(SizeIs(expected.phases.size()))));
  EXPECT_THAT(phases_of(cells[0], expected.channel), testing::UnorderedElementsAreArray(expected.phases));
  const double offset = c.effects[0]["parameters"][expected.parameter].get<double>();
  const double ratio = std::abs(offset) / believed(*c.bench, "sensors", expected.noise);
  for (const auto& cell : *cells[0]) {
    EXPECT_NEAR(cell.ratio, ratio, 0.1 * ratio) << cell.phase;
    EXPECT_NEAR(cell.max_trial_ratio, ratio, 0.1 * ratio) << cell.phase;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ConcealedOffset,
                         testing::Values(Offset{"falling_body",
                                                "sensor.bias",
                                                "bias",
                                                "accel_mps2",
                                                "accel_noise_mps2",
                                                {"early", "middle", "late"}},
                                         Offset{"intruder",
                                                "load_cell.offset",
                                                "offset_N",
                                                "force_N",
                                                "load_cell_noise_N",
                                                {"above_surface", "loading", "hold", "unloading"}},
                                         Offset{"hopper",
                                                "tof.bias",
                                                "bias_m",
                                                "tof_height_m",
                                                "tof_noise_m",
                                                {"flight", "touchdown", "compression", "switch", "extension",
                                                 "liftoff"}}),
                         [](const auto& info) { return info.param.plant; });

// A force cell that is clipped during every hold shows nothing of the law of depth there.
TEST(ConcealedCells, EachEffectIsComparedBesideTheOtherHiddenOnes) {
  auto c = one_hidden("intruder", "terrain.depth_power_law", 1.0);
  EXPECT_THAT(phases_of(cells_of_effects(c)[0], "force_N"), testing::Contains("hold"));
  c.hidden.push_back({{"sensor.saturation", "", ""}, 6.0, Random(1)});
  c.bench = build(c, c.hidden);
  const auto cells = cells_of_effects(c);
  ASSERT_THAT(cells, SizeIs(2));
  EXPECT_THAT(phases_of(cells[0], "force_N"), testing::Not(testing::Contains("hold")));
  EXPECT_THAT(phases_of(cells[0], "force_N"), testing::Contains("loading"));
  EXPECT_THAT(phases_of(cells[1], "force_N"), testing::Contains("hold"));
}

TEST(ConcealedCells, SuctionActsOnTheWayUpOnly) {
  const auto c = one_hidden("intruder", "terrain.suction", 1.0);
  EXPECT_THAT(phases_of(cells_of_effects(c)[0], "force_N"), ElementsAre("unloading"));
}

TEST(ConcealedCells, InputsOfTheSimulationAreNoCells) {
  const auto c = one_hidden("rotary_axis", "axis.coulomb", 1.0);
  EXPECT_THAT(channels_of(cells_of_effects(c)[0]), ElementsAre("position_rad", "velocity_radps"));
}

TEST(ConcealedCells, DeadChannelsAreNoCells) {
  auto c = one_hidden("rotary_axis", "axis.coulomb", 1.0);
  c.dead_channel = "velocity_radps";
  EXPECT_THAT(channels_of(cells_of_effects(c)[0]), ElementsAre("position_rad"));
}

TEST(ConcealedCells, AnEffectBelowTheNoiseHasNone) {
  EXPECT_THAT(cells_of_effects(one_hidden("intruder", "load_cell.offset", 0.02)),
              ElementsAre(Optional(IsEmpty())));
}

TEST(ConcealedCells, FaultsOfDataAreNotLocalised) {
  for (const char* effect : {"data.stuck", "data.dropout"})
    EXPECT_FALSE(cells_of_effects(one_hidden("falling_body", effect, 2.0)).at(0)) << effect;
}

// The bias is on the foot's position, which the simulation takes from the recording.
TEST(ConcealedCells, FaultsOfInputsAreNotLocalised) {
  EXPECT_FALSE(cells_of_effects(one_hidden("intruder", "sensor.bias", 2.0)).at(0));
}

TEST(ConcealedCells, StandInTheAnswer) {
  const auto request = request_for("intruder", "terrain.suction", 1.0);
  const auto cells = answer(make_case(request, 1), request, 1)["effects"][0]["cells"];
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_EQ(cells[0]["channel"], "force_N");
  EXPECT_EQ(cells[0]["phase"], "unloading");
  EXPECT_GT(cells[0]["max_trial_ratio"].get<double>(), 1.0);
  EXPECT_GE(cells[0]["max_trial_ratio"], cells[0]["ratio"]);
  const auto stuck = request_for("intruder", "data.stuck", 2.0);
  EXPECT_TRUE(answer(make_case(stuck, 1), stuck, 1)["effects"][0]["cells"].is_null());
}

}  // namespace
}  // namespace sandhopper::conceal
