#include "tools/campaign/position_loop.hpp"

#include <cmath>

#include "estimation/local_polynomial.hpp"

namespace sandhopper {
namespace {

struct Loop {
  double position_gain_Nm_per_rad = 0.0;
  double velocity_gain_Nm_s_per_rad = 0.0;
  double target_rad = 0.0;
};

std::optional<Loop> loop_of(const CampaignTrial& trial, const std::string& phase) {
  const auto gain = trial.number(phase + "_position_gain_Nm_per_rad");
  const auto target = trial.number(phase + "_target_rad");
  if (!gain || !target) return std::nullopt;
  return Loop{*gain, trial.number(phase + "_velocity_gain_Nm_s_per_rad").value_or(0.0), *target};
}

// Derivative of the angle by a local polynomial; NaN in rows without a sample.
std::vector<double> rate_of(const std::vector<double>& t_s, const std::vector<double>& angle_rad) {
  constexpr double kHalfWidth_s = 0.008;
  std::vector<double> rate;
  rate.reserve(t_s.size());
  for (const auto& fit : local_polynomial(t_s, angle_rad, kHalfWidth_s)) rate.push_back(fit.rate);
  return rate;
}

void add_to_side(TrialRecording& recording, const std::string& side, const std::optional<Loop>& stance,
                 const std::optional<Loop>& flight) {
  const auto* angle = recording.find("motor_" + side + "_position_rad");
  const auto* phase = recording.find("phase");
  if (angle == nullptr || phase == nullptr) return;
  const auto* measured = recording.find("motor_" + side + "_velocity_radps");
  const auto rate = measured != nullptr ? *measured : rate_of(recording.t_s, *angle);
  const std::string name = "command_" + side + "_torque_Nm";
  const auto* feed_forward = recording.find(name);
  std::vector<double> torque =
      feed_forward != nullptr ? *feed_forward : std::vector<double>(recording.rows(), 0.0);
  for (std::size_t row = 0; row < torque.size(); ++row) {
    const auto& loop = (*phase)[row] == 0.0 ? flight : stance;
    if (!loop) continue;
    torque[row] += loop->position_gain_Nm_per_rad * (loop->target_rad - (*angle)[row]);
    if (loop->velocity_gain_Nm_s_per_rad != 0.0) torque[row] -= loop->velocity_gain_Nm_s_per_rad * rate[row];
  }
  for (auto& channel : recording.channels)
    if (channel.name == name) {
      channel.values = std::move(torque);
      return;
    }
  recording.channels.push_back({name, std::move(torque)});
}

}  // namespace

void add_position_loop(TrialRecording& recording, const CampaignTrial& trial) {
  const auto stance = loop_of(trial, "stance"), flight = loop_of(trial, "flight");
  if (!stance && !flight) return;
  for (const auto* side : {"left", "right"}) add_to_side(recording, side, stance, flight);
}

}  // namespace sandhopper
