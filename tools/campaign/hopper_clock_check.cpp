#include "tools/campaign/hopper_clock_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "estimation/leg.hpp"
#include "tools/campaign/hopper_signals.hpp"
#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kMocapBody = "mocap_body_z_m", kMocapFoot = "mocap_foot_z_m";

// Length of the leg by the mean angle of its motors.
std::vector<double> leg_by_joints(const TrialRecording& recording, const Leg& leg) {
  std::vector<double> out(recording.rows(), NAN);
  const auto *left = recording.find("motor_left_position_rad"),
             *right = recording.find("motor_right_position_rad");
  if (left == nullptr && right == nullptr) return out;
  const auto &a = left != nullptr ? *left : *right, &b = right != nullptr ? *right : *left;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = leg.kinematics(0.5 * (a[i] + b[i])).length_m;
  return out;
}

std::vector<double> leg_by_heights(const std::vector<double>& body, const std::vector<double>& foot) {
  std::vector<double> out(body.size());
  std::ranges::transform(body, foot, out.begin(), std::minus<>());
  return out;
}

// Rows of one stance by the recorded phases; without them a tenth of the recording, which is short of a
// stance for any hop of one or two strides.
double rows_of_a_stance(const TrialRecording& recording) {
  const auto* phase = recording.find("phase");
  double rows = 0.0, touchdowns = 0.0;
  for (std::size_t i = 0; phase != nullptr && i < phase->size(); ++i) {
    if (!((*phase)[i] > 0.0)) continue;
    rows += 1.0;
    if (i == 0 || !((*phase)[i - 1] > 0.0)) touchdowns += 1.0;
  }
  return touchdowns > 0.0 ? rows / touchdowns : 0.1 * static_cast<double>(recording.rows());
}

void check_clock_of_heights(TrialRecording& recording, const Leg& leg, const RecordingPlaces& places) {
  constexpr double kShare = 1.0 / 20.0;  // of a stance, as in hopper_force_check
  const auto *body = recording.find(kMocapBody), *foot = recording.find(kMocapFoot);
  if (body == nullptr || foot == nullptr || recording.rows() < 2) return;
  const auto joints = leg_by_joints(recording, leg), heights = leg_by_heights(*body, *foot);
  const auto lag = best_lag(joints, heights, 0);
  const auto rows = static_cast<double>(lag.rows);
  // One quantity, measured twice: at the true lag hardly anything is left of their difference.
  constexpr double kLeft = 0.1;  // as in gravity_check
  const bool is_shifted = lag.at_best > kBelongTogether && 1.0 - lag.at_best < kLeft * (1.0 - lag.at_zero);
  if (!is_shifted || std::abs(rows) <= kShare * rows_of_a_stance(recording)) return;
  const double row_s =
      (recording.t_s.back() - recording.t_s.front()) / static_cast<double>(recording.rows() - 1);
  doubt_column(
      recording, places,
      places.is_stated(kMocapBody) && places.is_stated(kMocapFoot) && places.is_stated("t_s"), kMocapBody,
      fmt::format("minus {} is the leg's length by the joints {:.3f} s {} (correlation {:.2f} there, "
                  "{:.2f} in the same row): the heights have another clock than the motors",
                  kMocapFoot, std::abs(rows) * row_s, rows > 0.0 ? "later" : "earlier",
                  std::sqrt(lag.at_best), std::sqrt(lag.at_zero)),
      fmt::format("move both columns by {:.0f} rows towards {} rows in the file, or give the two recorders "
                  "one clock",
                  std::abs(rows), rows > 0.0 ? "earlier" : "later"));
}

}  // namespace

void check_hopper_clock(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                        const RecordingPlaces& places) {
  const auto* belief = belief_of_hop(recording, campaign, trial);
  if (belief == nullptr || any_unusable(recording.findings)) return;
  try {
    check_clock_of_heights(recording, Leg(belief->robot.leg), places);
  } catch (const std::invalid_argument&) {
    // Lengths that form no leg: the diagnosis says so.
  }
}

}  // namespace sandhopper
