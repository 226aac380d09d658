#pragma once
#include <array>
#include <functional>
#include <string_view>
#include <vector>

#include "firmware/controller_config.hpp"
#include "terrain/bed.hpp"
#include "tools/experiment/recorded_stride.hpp"

// The hop set: five touchdown speeds, three compression stiffnesses, five trials per cell, several seeds.
// Stiffness is estimated by three treatments in several sample windows and compared with the stiffness that
// an actuator measures on the same bed.
namespace sandhopper {

struct HopCell {
  double touchdown_speed_mps;
  double release_height_m;
  double compression_stiffness_N_per_m;
};
// The release heights give these speeds with 4 N of rail friction.
const std::vector<HopCell>& hop_cells();

// Stiffness from a slow intrusion to 50 mm: slope with a free intercept, and slope through the origin.
struct GroundTruthStiffness {
  double free_intercept_N_per_m;
  double through_origin_N_per_m;
};
GroundTruthStiffness slow_intrusion_stiffness(const BedParameters& bed, double foot_radius_m);

struct TreatmentCase {
  std::string_view name;
  SampleWindow window;
  bool free_intercept;
  bool true_state = false;  // observer's force, depth, speed and acceleration replaced by the true ones
};
// The cases A, A2, B, C, C2, D, E, T.
const std::vector<TreatmentCase>& treatment_cases();

enum class Treatment : std::size_t { quasi_static_ols, observer_ols, observer_wls };
inline constexpr std::size_t kTreatments = 3;

// Mean |k_est/k_GT - 1| over the cells per seed and treatment. Each cell is the mean of its trials.
struct CaseResult {
  TreatmentCase definition;
  std::vector<std::array<double, kTreatments>> error_by_seed;
  std::vector<std::vector<std::array<double, kTreatments>>> ratio;  // [seed][cell], mean of the trials
  std::array<double, kTreatments> mean_error() const;
  int seeds_in_order(Treatment worse, Treatment better) const;
};

// Root mean square errors in stance per touchdown speed.
struct EstimationError {
  double touchdown_speed_mps;
  double quasi_static_N;
  double observer_N;
  double load_cell_N;
  double depth_m;
  double foot_velocity_mps;
};

struct TreatmentStudy {
  GroundTruthStiffness truth;
  std::vector<CaseResult> cases;
  std::vector<EstimationError> errors;
  int strides = 0;
  int incomplete = 0;
};

struct StudySetup {
  CycleConfig cycle{};
  WorldConfig world{};
  int seeds = 8;
  int trials_per_cell = 5;
  unsigned threads = 2;
  // Treats all samples as if they had age zero: the filter assigns a height reading to the cycle that
  // receives it, and forces are paired with the depth in the same row.
  bool ignore_ages = false;
  std::function<void(int done, int total)> progress{};  // called from one thread at a time
};
TreatmentStudy run_treatment_study(const StudySetup& setup);

}  // namespace sandhopper
