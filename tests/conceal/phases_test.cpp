// Phases of the motion, which the cells of an answer refer to.
#include "tools/conceal/core/phases.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tools/conceal/hopper/world.hpp"
#include "tools/conceal/intruder/world.hpp"

namespace sandhopper::conceal {
namespace {

Table rows_at(std::vector<double> t_s) {
  Table table;
  table.add("t_s", 6).values = std::move(t_s);
  return table;
}

std::vector<double> every_millisecond(int rows) {
  std::vector<double> t_s;
  for (int i = 0; i < rows; ++i) t_s.push_back(1e-3 * i);
  return t_s;
}

// Each phase once per visit, in order.
std::vector<std::string> in_order(std::vector<std::string> phases) {
  phases.erase(std::unique(phases.begin(), phases.end()), phases.end());
  return phases;
}

TEST(ConcealedPhases, ThirdsAreOfTheTimeNotOfTheRows) {
  EXPECT_THAT(thirds_of_time(rows_at({1.0, 2.0, 3.0, 9.0, 10.0})),
              testing::ElementsAre("early", "early", "early", "late", "late"));
  EXPECT_THAT(thirds_of_time(rows_at({0.0, 1.1, 1.9, 2.1, 3.0})),
              testing::ElementsAre("early", "middle", "middle", "late", "late"));
}

// A hop recorded every millisecond: flight, compression from `touchdown` on, extension, flight.
std::vector<std::string> hop(int touchdown, int turn, int liftoff, int rows) {
  auto table = rows_at(every_millisecond(rows));
  auto& phase = table.add("phase", 0).values;
  for (int i = 0; i < rows; ++i)
    phase.push_back(i < touchdown ? 0.0 : i < turn ? 1.0 : i < liftoff ? 2.0 : 0.0);
  return hopper::phases({}, {}, Random(1), table);
}

TEST(ConcealedPhases, OfAHopperHaveShortOnesAroundEachChange) {
  const auto phases = hop(100, 200, 300, 400);
  EXPECT_THAT(in_order(phases), testing::ElementsAre("flight", "touchdown", "compression", "switch",
                                                     "extension", "liftoff", "flight"));
  const auto rows = [&](const std::string& name) {
    return static_cast<double>(std::ranges::count(phases, name));
  };
  EXPECT_NEAR(rows("touchdown"), 30, 1);
  EXPECT_NEAR(rows("switch"), 25, 1);
  EXPECT_NEAR(rows("liftoff"), 25, 1);
  EXPECT_EQ(phases[86], "touchdown");
  EXPECT_EQ(phases[84], "flight");
  EXPECT_EQ(phases[192], "switch");
  EXPECT_EQ(phases[188], "compression");
  EXPECT_EQ(phases[314], "liftoff");
  EXPECT_EQ(phases[316], "flight");
}

TEST(ConcealedPhases, OfAHopperBelongToTheEarlierOfTwoChanges) {
  const auto phases = hop(100, 110, 300, 400);
  EXPECT_EQ(phases[113], "touchdown");
  EXPECT_EQ(phases[117], "switch");
}

TEST(ConcealedPhases, OfAnIntruderFollowThePrescribedMotion) {
  intruder::World world;
  world.surface_height_spread_m = 0.0;
  conceal::Setup setup;
  setup.keys = {{"impact_speed_mps", 0.2}, {"depth_m", 0.04}, {"profile", "stop_and_withdraw"}};
  const auto rows = rows_at(every_millisecond(4000));
  const auto phases = intruder::phases(world, setup, Random(1), rows);
  EXPECT_THAT(in_order(phases),
              testing::ElementsAre("above_surface", "loading", "hold", "unloading", "above_surface"));
  // It is held for 80 ms, and slower than 1 mm/s for some milliseconds before and after that.
  EXPECT_NEAR(static_cast<double>(std::ranges::count(phases, "hold")), 84, 4);
  setup.keys["profile"] = "cycles";
  EXPECT_EQ(std::ranges::count(in_order(intruder::phases(world, setup, Random(1), rows)), "loading"), 3);
}

TEST(ConcealedPhases, OfAnIntruderBeginAtTheSurfaceOfTheTrial) {
  intruder::World world;
  world.surface_height_spread_m = 5e-3;
  conceal::Setup setup;
  setup.keys = {{"impact_speed_mps", 0.2}, {"depth_m", 0.04}};
  const auto depth = intruder::prescribed(world, setup).depth_m;
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    const auto phases = intruder::phases(world, setup, Random(seed), rows_at(every_millisecond(400)));
    const auto first = std::ranges::find(phases, "loading") - phases.begin();
    EXPECT_NEAR(depth.at(1e-3 * static_cast<double>(first)), -intruder::surface_m(world, Random(seed)), 2e-4);
  }
}

}  // namespace
}  // namespace sandhopper::conceal
