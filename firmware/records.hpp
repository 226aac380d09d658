#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"
#include "firmware/command.hpp"
#include "firmware/event.hpp"
#include "terrain/joint_fit.hpp"
#include "terrain/profile_sums.hpp"
#include "terrain/stiffness_fit.hpp"

// Results of a cycle and of a stride. With SensorFrame and Event they are the log's records.
namespace sandhopper {

enum class State : std::uint8_t { idle, armed, flight, compression, extension, soft_stop, fault };
template <>
struct EnumNames<State> {
  static constexpr std::array<std::string_view, 7> value{"idle",      "armed",     "flight", "compression",
                                                         "extension", "soft_stop", "fault"};
};

// Heights are over the undisturbed surface, z up. The filter's state belongs to the cycle's own time. Forces,
// and the depth and speed that go with them, belong to `force_time_ns`, the instant of the newest motor
// reply.
struct Estimate {
  double body_z_m = 0.0;
  double body_velocity_mps = 0.0;
  double foot_z_m = 0.0;
  double foot_velocity_mps = 0.0;
  std::array<double, 4> standard_deviation{};  // of the four above
  double body_accel_mps2 = 0.0;                // gravity and bias removed
  double foot_accel_mps2 = 0.0;
  double leg_length_m = 0.0;
  double leg_rate_mps = 0.0;
  double leg_angle_rad = 0.0;
  double leg_torque_Nm = 0.0;  // both motors together, from current
  std::int64_t force_time_ns = 0;
  double force_depth_m = 0.0;       // -foot height at force_time_ns
  double force_velocity_mps = 0.0;  // downward
  double contact_force_N = 0.0;     // from the momentum observer
  double direct_force_N = 0.0;      // from the foot's acceleration, unfiltered; detects the first contact
  double quasi_static_force_N = 0.0;
  double load_cell_force_N = 0.0;      // tare removed
  double weighting_accel_mps2 = 0.0;   // |zdd| for the sample weights: low-passed foot IMU
  double surface_z_m = 0.0;            // expected height of the ground: 0, later the crater's floor
  std::array<double, 3> innovation{};  // ToF [m], leg length [m], leg rate [m/s]; NaN when not fresh
  std::array<double, 3> normalised_innovation_squared{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("body_z_m", self.body_z_m);
    visit("body_velocity_mps", self.body_velocity_mps);
    visit("foot_z_m", self.foot_z_m);
    visit("foot_velocity_mps", self.foot_velocity_mps);
    visit("standard_deviation", self.standard_deviation);
    visit("body_accel_mps2", self.body_accel_mps2);
    visit("foot_accel_mps2", self.foot_accel_mps2);
    visit("leg_length_m", self.leg_length_m);
    visit("leg_rate_mps", self.leg_rate_mps);
    visit("leg_angle_rad", self.leg_angle_rad);
    visit("leg_torque_Nm", self.leg_torque_Nm);
    visit("force_time_ns", self.force_time_ns);
    visit("force_depth_m", self.force_depth_m);
    visit("force_velocity_mps", self.force_velocity_mps);
    visit("contact_force_N", self.contact_force_N);
    visit("direct_force_N", self.direct_force_N);
    visit("quasi_static_force_N", self.quasi_static_force_N);
    visit("load_cell_force_N", self.load_cell_force_N);
    visit("weighting_accel_mps2", self.weighting_accel_mps2);
    visit("surface_z_m", self.surface_z_m);
    visit("innovation", self.innovation);
    visit("normalised_innovation_squared", self.normalised_innovation_squared);
  }
};

// The cycle's whole result: command and estimate.
struct StepOutput {
  std::int64_t time_ns = 0;
  std::uint64_t cycle = 0;
  State state = State::idle;
  Fault fault = Fault::none;
  std::uint32_t stride = 0;  // touchdowns so far
  Command command{};
  Estimate estimate{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("cycle", self.cycle);
    visit("state", self.state);
    visit("fault", self.fault);
    visit("stride", self.stride);
    visit("command", self.command);
    visit("estimate", self.estimate);
  }
};

// Times (CLOCK_MONOTONIC) and extremes of one stance, as the cycle estimated them.
struct StrideSummary {
  std::uint32_t stride = 0;  // 1 for the first stride
  std::int64_t release_ns = 0;
  std::int64_t contact_ns = 0;    // the foot meets the ground
  std::int64_t touchdown_ns = 0;  // the controller detects it, some milliseconds later
  std::int64_t switch_ns = 0;
  std::int64_t liftoff_ns = 0;
  double touchdown_speed_mps = 0.0;  // foot, downward, at contact
  double peak_force_N = 0.0;         // momentum observer
  double peak_quasi_static_N = 0.0;
  double max_depth_m = 0.0;     // below the point where the first stride met the surface
  double crater_depth_m = 0.0;  // deepest point before this stride
  double liftoff_depth_m = 0.0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("stride", self.stride);
    visit("release_ns", self.release_ns);
    visit("contact_ns", self.contact_ns);
    visit("touchdown_ns", self.touchdown_ns);
    visit("switch_ns", self.switch_ns);
    visit("liftoff_ns", self.liftoff_ns);
    visit("touchdown_speed_mps", self.touchdown_speed_mps);
    visit("peak_force_N", self.peak_force_N);
    visit("peak_quasi_static_N", self.peak_quasi_static_N);
    visit("max_depth_m", self.max_depth_m);
    visit("crater_depth_m", self.crater_depth_m);
    visit("liftoff_depth_m", self.liftoff_depth_m);
  }
};

// Sums from which a stride's stiffness is solved. The cycle passes them to the solving thread.
struct StrideSums {
  StrideSummary summary{};
  RegressionSums quasi_static_ols{};
  RegressionSums observer_ols{};
  RegressionSums observer_wls{};
  JointSums joint{};
  ProfileSums profile{};
};

// A stride's result: its summary and the stiffness by the three treatments and by the joint fit.
struct StrideResult {
  StrideSummary summary{};
  StiffnessEstimate quasi_static_ols{};
  StiffnessEstimate observer_ols{};
  StiffnessEstimate observer_wls{};
  JointEstimate joint{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("summary", self.summary);
    visit("quasi_static_ols", self.quasi_static_ols);
    visit("observer_ols", self.observer_ols);
    visit("observer_wls", self.observer_wls);
    visit("joint", self.joint);
  }
};

}  // namespace sandhopper
