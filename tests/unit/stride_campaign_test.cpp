#include "tools/experiment/stride_campaign.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace sandhopper {
namespace {

CampaignSetup first_strides(long strides) {
  CampaignSetup setup;
  setup.strides = strides;
  setup.threads = std::max(1U, std::thread::hardware_concurrency());
  return setup;
}

void print(const char* name, const StrideCampaign& campaign) {
  printf("%s\n", name);
  for (std::size_t w = 0; w < kWays; ++w) {
    const auto way = static_cast<Way>(w);
    printf("  %-10s mean %.3f  worst group of five %.3f  coverage %.3f\n", kWayNames[w].data(),
           campaign.mean_error(way), campaign.worst_cell_error(way), campaign.coverage(way));
  }
}

TEST(JointFitOverStrides, IsCloserToTheTrialsOwnBedThanWeightedLinesInEveryWindow) {
  const auto campaign = run_stride_campaign(first_strides(600));
  print("75 trials x 8 seeds", campaign);
  EXPECT_LE(campaign.mean_error(Way::joint), 0.030);
  EXPECT_GE(campaign.mean_error(Way::joint), 0.010);
  EXPECT_LE(campaign.worst_cell_error(Way::joint), 0.080);
  EXPECT_GE(campaign.coverage(Way::joint), 0.90);
  EXPECT_LE(campaign.coverage(Way::joint), 0.99);
  for (const auto way : {Way::observer_wls, Way::observer_wls_new_depth, Way::observer_wls_to_max_depth,
                         Way::observer_wls_through_origin, Way::observer_wls_compression})
    EXPECT_LT(campaign.mean_error(Way::joint), campaign.mean_error(way));
}

TEST(JointFitOverStrides, HoldsOnOtherBeds) {
  struct Other {
    const char* name;
    double BedParameters::*parameter;
    double value;
  };
  const std::vector<Other> others{{"k 1000", &BedParameters::stiffness_N_per_m, 1000.0},
                                  {"k 2000", &BedParameters::stiffness_N_per_m, 2000.0},
                                  {"k 3000", &BedParameters::stiffness_N_per_m, 3000.0},
                                  {"c_g 0.5", &BedParameters::added_mass_factor, 0.5},
                                  {"c_g 2", &BedParameters::added_mass_factor, 2.0},
                                  {"z0 0", &BedParameters::intercept_depth_m, 0.0},
                                  {"z0 10 mm", &BedParameters::intercept_depth_m, 0.010},
                                  {"k_u 10", &BedParameters::unloading_stiffness_ratio, 10.0},
                                  {"k_u 100", &BedParameters::unloading_stiffness_ratio, 100.0}};
  for (const auto& other : others) {
    auto setup = first_strides(150);
    setup.world.terrain.*other.parameter = other.value;
    const auto campaign = run_stride_campaign(setup);
    print(other.name, campaign);
    EXPECT_LE(campaign.mean_error(Way::joint), 0.060) << other.name;
    EXPECT_GE(campaign.coverage(Way::joint), 0.90) << other.name;
  }
}

TEST(StrideCampaign, InPartsAndMergedIsTheWhole) {
  const auto setup = first_strides(150);
  const auto whole = run_stride_campaign(setup);
  StrideCampaign merged;
  for (long part = 0; part < 4; ++part) {
    auto one = setup;
    one.part = part;
    one.parts = 4;
    nlohmann::ordered_json json;
    to_json(json, run_stride_campaign(one));
    StrideCampaign read;
    from_json(nlohmann::ordered_json::parse(json.dump()), read);
    merged.add(read);
  }
  for (std::size_t w = 0; w < kWays; ++w) {
    const auto way = static_cast<Way>(w);
    EXPECT_NEAR(merged.mean_error(way), whole.mean_error(way), 1e-9);
    EXPECT_NEAR(merged.coverage(way), whole.coverage(way), 1e-9);
    EXPECT_EQ(merged.worst_cell_error(way), whole.worst_cell_error(way));
  }
  EXPECT_EQ(merged.total().strides, 150.0);
}

}  // namespace
}  // namespace sandhopper
