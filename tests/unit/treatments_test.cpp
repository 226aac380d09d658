#include "tools/experiment/treatments.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace sandhopper {
namespace {

void print(const TreatmentStudy& study) {
  printf("k_GT: slow intrusion %.0f N/m with intercept, %.0f through origin; %d strides, %d incomplete\n",
         study.truth.free_intercept_N_per_m, study.truth.through_origin_N_per_m, study.strides,
         study.incomplete);
  printf("case   QS+OLS MO+OLS MO+WLS  seeds with QS>MO, MO>WLS\n");
  for (const auto& c : study.cases) {
    const auto e = c.mean_error();
    printf("  %-3s  %.3f  %.3f  %.3f   %d %d\n", std::string(c.definition.name).c_str(), e[0], e[1], e[2],
           c.seeds_in_order(Treatment::quasi_static_ols, Treatment::observer_ols),
           c.seeds_in_order(Treatment::observer_ols, Treatment::observer_wls));
  }
  printf("v [m/s]: QS / MO / load cell error [N]; foot depth [mm]; foot speed [m/s]\n");
  for (const auto& e : study.errors)
    printf("  %.2f: %.1f/%.1f/%.1f; %.1f; %.3f\n", e.touchdown_speed_mps, e.quasi_static_N, e.observer_N,
           e.load_cell_N, 1e3 * e.depth_m, e.foot_velocity_mps);
  const auto& a = study.cases.front();
  printf("case A by cell, k_est/k_GT, mean and sd over seeds of the mean of five\n");
  for (std::size_t cell = 0; cell < hop_cells().size(); ++cell) {
    printf("  v %.2f k_c %.0f:", hop_cells()[cell].touchdown_speed_mps,
           hop_cells()[cell].compression_stiffness_N_per_m);
    for (std::size_t t = 0; t < kTreatments; ++t) {
      double mean = 0, square = 0;
      const auto n = static_cast<double>(a.ratio.size());
      for (const auto& seed : a.ratio) mean += seed[cell][t] / n;
      for (const auto& seed : a.ratio) square += (seed[cell][t] - mean) * (seed[cell][t] - mean) / (n - 1);
      printf("  %.2f+-%.2f", mean, std::sqrt(square));
    }
    printf("\n");
  }
}

TEST(Treatments, StudyPrints) {
  StudySetup setup;
  setup.threads = std::max(1U, std::thread::hardware_concurrency());
  print(run_treatment_study(setup));
}

}  // namespace
}  // namespace sandhopper
