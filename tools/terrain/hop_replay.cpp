#include "tools/terrain/hop_replay.hpp"

#include <cmath>

#include "firmware/gait.hpp"
#include "firmware/stride_recorder.hpp"

namespace sandhopper {
namespace {

constexpr double kNearlyAtRest_mps = 0.05;
constexpr double kUnknownSpeed_mps = 0.5;  // initial speed uncertainty of a recording that begins in the air

class Replay {
 public:
  Replay(const HopFrames& hop, const CycleConfig& cycle, const Leg& leg)
      : hop_(hop),
        cycle_(prepared(hop, cycle)),
        leg_(leg),
        estimator_(cycle_, leg_),
        phase_end_(last_recorded(hop.phase)) {}

  std::vector<RecordedStride> run() {
    estimator_.start(hop_.calibration, hop_.frames[hop_.release_row]);
    Estimate estimate;
    State state = State::armed;
    strides_.emplace_back();
    for (std::size_t row = hop_.release_row; row < hop_.frames.size(); ++row) {
      estimator_.hold_force_at_zero(row == hop_.release_row);
      estimator_.update(hop_.frames[row], estimate);
      const State next = state_after(state, row, estimate);
      if (next == State::idle) break;
      strides_.back().samples.push_back({estimate, next, NAN, NAN, NAN, NAN, NAN});
      if (state == State::extension && next == State::flight) {
        strides_.back().complete = true;
        strides_.emplace_back();
      }
      state = next;
    }
    if (strides_.back().samples.empty()) strides_.pop_back();
    return std::move(strides_);
  }

 private:
  static CycleConfig prepared(const HopFrames& hop, CycleConfig cycle) {
    if (!hop.rest_seen)
      cycle.estimator.kalman.initial_speed_noise_mps =
          hop.speed_known ? kNearlyAtRest_mps : kUnknownSpeed_mps;
    return cycle;
  }

  // State of the next row; idle means that the hop is over.
  State state_after(State state, std::size_t row, const Estimate& estimate) const {
    if (state == State::armed) return State::flight;
    if (!hop_.phase.empty()) return recorded_state(state, row);
    const LegObservation leg{.leg_length_m = estimate.leg_length_m,
                             .leg_rate_mps = estimate.leg_rate_mps,
                             .foot_z_m = estimate.foot_z_m,
                             .body_velocity_mps = estimate.body_velocity_mps,
                             .surface_z_m = 0.0};
    const auto transition = next_phase(state, leg, cycle_.controller);
    return transition ? transition->to : state;
  }

  State recorded_state(State state, std::size_t row) const {
    if (std::isnan(hop_.phase[row])) return row >= phase_end_ ? State::idle : state;
    switch (static_cast<int>(std::lround(hop_.phase[row]))) {
      case 1:
        return State::compression;
      case 2:
        return State::extension;
      default:
        return State::flight;
    }
  }

  static std::size_t last_recorded(const std::vector<double>& phase) {
    std::size_t row = phase.size();
    while (row > 0 && std::isnan(phase[row - 1])) --row;
    return row;
  }

  const HopFrames& hop_;
  CycleConfig cycle_;
  const Leg& leg_;
  RobotEstimator estimator_;
  std::size_t phase_end_;  // first row after the hop
  std::vector<RecordedStride> strides_;
};

}  // namespace

CycleConfig cycle_config_for(const CampaignTrial& trial) {
  const auto& belief = std::get<HopperBelief>(trial.belief);
  CycleConfig cycle;
  cycle.robot = belief.robot.leg;
  cycle.torque_constant_Nm_per_A.fill(belief.motor.torque_constant_Nm_per_A);
  auto& law = cycle.controller;
  const auto& believed = belief.controller;
  law.extension_stiffness_N_per_m = believed.extension_stiffness_N_per_m;
  law.compression_length_m = believed.compression_length_m;
  law.extension_length_m = believed.extension_length_m;
  law.touchdown_deflection_m = believed.touchdown_deflection_m;
  law.touchdown_rate_mps = believed.touchdown_rate_mps;
  law.compression_end_min_deflection_m = believed.compression_end_min_deflection_m;
  law.liftoff_margin_m = believed.liftoff_margin_m;
  law.compression_stiffness_N_per_m =
      trial.number("compression_stiffness_N_per_m").value_or(law.compression_stiffness_N_per_m);
  return cycle;
}

std::vector<RecordedStride> replay_hop(const HopFrames& hop, const CycleConfig& cycle, const Leg& leg) {
  return Replay(hop, cycle, leg).run();
}

}  // namespace sandhopper
