#include <gtest/gtest.h>

#include "shared_campaign.hpp"
#include "tools/terrain/leg_identification.hpp"

namespace sandhopper {
namespace {

class HopperOnWood : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto campaign = shared_campaign("hopper_on_wood");
    if (!campaign) return;
    EXPECT_TRUE(campaign->findings.empty());
    std::vector<LegHop> hops;
    for (const auto& trial : campaign->trials) {
      const auto recording = read_trial(*campaign, trial);
      auto result = result_of(trial, recording);
      keep_leg_hop(trial, recording, result);
      if (holds_leg_hop(result)) hops.push_back(leg_hop_from(result));
    }
    leg_ = std::make_unique<LegIdentification>(identify_leg(hops, {}));
  }
  static void TearDownTestSuite() { leg_.reset(); }
  void SetUp() override {
    if (!leg_) GTEST_SKIP() << "the recordings are not there";
  }
  static double held_out_N(LegForceForm form) { return leg_->rms_N(form, LegWindow::settled, true); }

  static std::unique_ptr<LegIdentification> leg_;
};
std::unique_ptr<LegIdentification> HopperOnWood::leg_;

TEST_F(HopperOnWood, MasslessLegMissesTheHeldOutHopsByFourteenNewtons) {
  EXPECT_EQ(leg_->fit_hops, 8u);
  EXPECT_EQ(leg_->held_out_hops, 4u);
  EXPECT_NEAR(held_out_N(LegForceForm::quasi_static), 14.3, 0.5);
}

TEST_F(HopperOnWood, InertiaAndFrictionBringItBelowTwoNewtons) {
  EXPECT_NEAR(held_out_N(LegForceForm::joint_row_smooth), 1.32, 0.25);
  EXPECT_LE(held_out_N(LegForceForm::joint_row_smooth), 2.0);
  // The error of each fit hop, predicted from the others, must be neither much smaller nor much larger.
  EXPECT_NEAR(leg_->cross_validation_N.at(3).second, held_out_N(LegForceForm::joint_row_smooth), 0.3);
}

TEST_F(HopperOnWood, CausalObserverPaysWithItsDelay) {
  EXPECT_NEAR(held_out_N(LegForceForm::joint_row_observer), 4.0, 0.6);
  EXPECT_NEAR(leg_->observer_without_delay_N(true), 2.7, 0.5);
}

TEST_F(HopperOnWood, FiguresOfTheJointHaveIntervals) {
  const LegParameterValues expected{1.06, 4.0e-3, 0.128, 0.0140, 1.5e-3};
  const LegParameterValues band{0.02, 0.2e-3, 0.02, 0.003, 0.5e-3};
  for (std::size_t i = 0; i < kLegParameters; ++i) {
    EXPECT_NEAR(leg_->value[i], expected[i], band[i]) << i;
    EXPECT_LE(leg_->interval[i].ci95_low, leg_->value[i]) << i;
    EXPECT_GE(leg_->interval[i].ci95_high, leg_->value[i]) << i;
  }
  EXPECT_NEAR(leg_->mass_kg.value, 1.247, 0.015);
  EXPECT_NEAR(leg_->tare_N, 12.4, 0.1);
}

TEST(HopperOnWoodGround, IsRigidAtLeastSoMuchAndNoNumber) {
  const auto conclusions = shared_conclusions("hopper_on_wood");
  if (conclusions.is_null()) GTEST_SKIP() << "the recordings are not there";
  const auto& ground = conclusions.at("leg_force").at("ground");
  EXPECT_TRUE(ground.at("rigid").get<bool>());
  EXPECT_TRUE(ground.at("stiffness_N_per_m").is_null());
  EXPECT_GE(ground.at("landings").get<int>(), 10);
  EXPECT_NEAR(ground.at("at_least_N_per_m").get<double>(), 51.5e3, 5e3);
  EXPECT_FALSE(conclusions.contains("profile"));
}

}  // namespace
}  // namespace sandhopper
