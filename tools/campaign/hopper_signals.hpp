#pragma once
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "estimation/leg.hpp"
#include "tools/campaign/belief.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/trial_recording.hpp"

// Forces that a hopper's channels give independently of each other, and how far two signals agree.
namespace sandhopper {

inline constexpr std::string_view kLoadCell = "load_cell_force_N", kBodyAccel = "imu_body_accel_z_mps2",
                                  kFootAccel = "imu_foot_accel_z_mps2";

// The belief about a hop whose checks need nothing that is not stated; nullptr for every other trial.
const HopperBelief* belief_of_hop(const TrialRecording& recording, const Campaign& campaign,
                                  const CampaignTrial& trial);

// Each has one value per row; NaN: not known there, or in no row if its channels are missing.
struct HopperForces {
  std::vector<double> leg_N;      // tau / L', the sum of the motors' torques on the body along the rail
  std::vector<double> foot_N;     // leg_N + m_f s_f: ground's force by the leg and the foot's specific force
  std::vector<double> inertia_N;  // m_b s_b + m_f s_f: ground's force by both specific forces
};
// Without the foot's accelerometer the foot moves as the body (inertia_N), or rests (foot_N).
HopperForces hopper_forces(const TrialRecording& recording, const Leg& leg, const HopperBelief& belief);

// First row whose magnitude is above half of the mean magnitude: the robot stands on the ground or its leg
// pushes. A hand or catch carries it before.
std::optional<std::size_t> first_loaded_row(const std::vector<double>& values);
std::vector<bool> loaded_rows(const std::vector<double>& values);

// Square of the correlation of a[i] with b[i + lag] from row `from` on; 0 if it is not defined.
double together(const std::vector<double>& a, const std::vector<double>& b, std::size_t from,
                std::ptrdiff_t lag = 0);

// Lag of b behind a, in rows, at which they agree best, up to 1/20 of the rows either way.
struct BestLag {
  std::ptrdiff_t rows = 0;
  double at_zero = 0.0, at_best = 0.0;  // as from `together`
  // b is late or early against a: the agreement without the lag is clearly less.
  bool is_shifted() const;
};
BestLag best_lag(const std::vector<double>& a, const std::vector<double>& b, std::size_t from);

// Squares of correlations as for speeds and rates (rate_check): signals that belong together, and a clearly
// better agreement.
inline constexpr double kBelongTogether = 0.8, kClearlyBetter = 0.1;

}  // namespace sandhopper
