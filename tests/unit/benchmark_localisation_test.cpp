#include <gtest/gtest.h>

#include "tools/benchmark/figures.hpp"

namespace sandhopper::benchmark {
namespace {

using Cells = std::set<Cell>;

const Cell kLoading{"force_N", "loading"}, kHold{"force_N", "hold"}, kUnloading{"force_N", "unloading"},
    kOther{"foot_force_N", "loading"};

// A campaign with one hidden effect for each set of cells.
Truth hidden_in(std::vector<std::optional<Cells>> cells, std::string plant = "intruder") {
  Truth t;
  t.name = "001";
  t.plant = std::move(plant);
  t.kind = "several";
  for (auto& one : cells) t.effects.push_back({"terrain.crust", 1.0, {}, std::move(one)});
  return t;
}

Diagnosis reporting(Cells where, std::string verdict = "missing_physics") {
  Diagnosis d;
  d.verdict = std::move(verdict);
  d.where = std::move(where);
  return d;
}

TEST(BenchmarkLocalisation, CountsReportedAndHiddenCells) {
  const auto truth = hidden_in({Cells{kLoading, kHold, kOther}});
  const auto found = judge(truth, reporting({kLoading, kUnloading})).localisation;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->true_positives, 1u);
  EXPECT_EQ(found->false_positives, 1u);
  EXPECT_EQ(found->missed, 2u);
  EXPECT_DOUBLE_EQ(*found->precision(), 1.0 / 2.0);
  EXPECT_DOUBLE_EQ(*found->recall(), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(*found->f1(), 2.0 / 5.0);  // harmonic mean of 1/2 and 1/3
  EXPECT_FALSE(judge(truth, reporting({})).localisation->precision());
  EXPECT_EQ(judge(truth, reporting({})).localisation->f1(), 0.0);
}

TEST(BenchmarkLocalisation, CellsOfAllHiddenEffectsCount) {
  const auto truth = hidden_in({Cells{kLoading, kHold}, Cells{}, Cells{kHold, kUnloading}});
  const auto found = judge(truth, reporting({kLoading, kHold, kUnloading})).localisation;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->true_positives, 3u);
  EXPECT_EQ(found->f1(), 1.0);
}

TEST(BenchmarkLocalisation, IsNotScoredWithoutAHiddenCellOrAnAlarm) {
  const auto truth = hidden_in({Cells{kLoading}});
  EXPECT_TRUE(judge(truth, reporting({kLoading}, "unknown_physics")).localisation);
  EXPECT_FALSE(judge(truth, reporting({kLoading}, "consistent")).localisation);
  EXPECT_FALSE(judge(truth, reporting({kLoading}, "insufficient_data")).localisation);
  EXPECT_FALSE(judge(truth, std::nullopt).localisation);
  EXPECT_FALSE(judge(hidden_in({}), reporting({kLoading})).localisation);
  EXPECT_FALSE(judge(hidden_in({Cells{}}), reporting({kLoading})).localisation);
  // One effect without stated cells: any reported cell may be its cell.
  EXPECT_FALSE(judge(hidden_in({Cells{kLoading}, std::nullopt}), reporting({kLoading})).localisation);
}

TEST(BenchmarkLocalisation, ScoreAddsTheCellsOfAllCampaignsByPlant) {
  const auto bed = hidden_in({Cells{kLoading, kHold}}), other = hidden_in({Cells{kOther}}, "hopper"),
             unsaid = hidden_in({std::nullopt}, "rotary_axis");
  const auto s = score({judge(bed, reporting({kLoading, kHold})), judge(bed, reporting({kLoading})),
                        judge(other, reporting({kHold})), judge(unsaid, reporting({kHold}))});
  EXPECT_EQ(s.localisation.campaigns, 3u);
  EXPECT_DOUBLE_EQ(*s.localisation.precision(), 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(*s.localisation.recall(), 3.0 / 5.0);
  EXPECT_FALSE(s.localisation.met());
  ASSERT_EQ(s.localisation_by_plant.size(), 2u);
  EXPECT_DOUBLE_EQ(*s.localisation_by_plant.at("intruder").f1(), 6.0 / 7.0);
  EXPECT_TRUE(s.localisation_by_plant.at("intruder").met());
  EXPECT_EQ(s.localisation_by_plant.at("hopper").f1(), 0.0);

  const auto json = to_json(s);
  EXPECT_EQ(json["localisation"]["f1"], 6.0 / 9.0);
  EXPECT_EQ(json["localisation"]["must"], 0.75);
  EXPECT_EQ(json["localisation"]["met"], false);
  EXPECT_EQ(json["localisation"]["by_plant"]["intruder"]["missed"], 1);
  EXPECT_EQ(json["cases"][1]["localisation"]["recall"], 0.5);
  EXPECT_TRUE(json["cases"][3]["localisation"].is_null());
}

// F1 = 2 TP / (2 TP + FP + missed): 6/8 is the limit, 6/9 is below it.
TEST(BenchmarkLocalisation, MeetsTheLimitAtThreeQuarters) {
  EXPECT_TRUE((Localisation{1, 3, 1, 1}.met()));
  EXPECT_FALSE((Localisation{1, 3, 2, 1}.met()));
}

}  // namespace
}  // namespace sandhopper::benchmark
