#pragma once
#include <functional>
#include <type_traits>
#include <utility>
#include <variant>

// The state that a law sees at its port. Times are those of the trial.
namespace sandhopper::diagnose {

// A body in a medium; up is positive.
struct BodyState {
  double time_s = 0.0;  // since the release
  double height_m = 0.0;
  double velocity_mps = 0.0;
  double depth_m = 0.0;         // depth of its lowest point under the surface
  double start_height_m = 0.0;  // at the release
};

// The body on its rail; up is positive.
struct RailState {
  double time_s = 0.0;
  double height_m = 0.0;
  double velocity_mps = 0.0;
  double leg_force_N = 0.0;
};

// An axis, or the joint of a leg.
struct AxisState {
  double time_s = 0.0;
  double angle_rad = 0.0;
  double velocity_radps = 0.0;
  double torque_Nm = 0.0;   // drive torque; for a leg the sum of both motors
  double turned_rad = 0.0;  // angle at the last reversal of the motion
};

// A foot in the bed; down is positive.
struct GroundState {
  double time_s = 0.0;
  double depth_m = 0.0;
  double speed_mps = 0.0;
  double virgin = 0.0;          // 1 on the virgin curve (new depth, going down), else 0
  double quasi_static_N = 0.0;  // at this depth, with the laws of ground_factor and ground_static
  // Force of the bed here before the ground_force laws, at zero foot acceleration
  double bearing_N = 0.0;
  double deepest_m = 0.0;  // deepest point so far
  double pushes = 0.0;     // since the bed was prepared
  double wait_s = 0.0;
  double bed_depth_m = 0.0;    // depth of the container; 0: unknown
  double since_touch_s = 0.0;  // since the foot last went below the surface
};

// The plate or foot that a bed meets.
struct FootState {
  double radius_m = 0.0;
};

// The motion of a load cell.
struct CellState {
  double foot_accel_mps2 = 0.0;
};

// A drive and its command, both motors.
struct DriveState {
  double rate_radps = 0.0;
  double command_Nm = 0.0;
};

// Quantity that a sensor reads; for the channel "actuator" the torque of the motor current.
struct SensorState {
  double time_s = 0.0;
  double value = 0.0;
  double rate = 0.0;
  double temperature_C = 25.0;  // temperature of the motors
};

using PortState =
    std::variant<BodyState, RailState, AxisState, GroundState, FootState, CellState, DriveState, SensorState>;

// `time_s` of a state; 0 if the state has none.
inline double time_of(const PortState& state) {
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.time_s; })
          return s.time_s;
        else
          return 0.0;
      },
      state);
}

// Value that an effect adds at a port, in the port's unit (ports.hpp).
using Law = std::function<double(const PortState&)>;

namespace detail {
template <class F, class State>
State state_of(double (F::*)(const State&) const);
}  // namespace detail

// Wraps a function of one state type as a Law. Calling it at a port with another state type throws
// std::bad_variant_access. A function of PortState stays as it is.
template <class F>
Law law_of(F f) {
  if constexpr (std::is_invocable_r_v<double, F, const PortState&>) {
    return f;
  } else {
    using State = decltype(detail::state_of(&F::operator()));
    return [f = std::move(f)](const PortState& state) { return f(std::get<State>(state)); };
  }
}

}  // namespace sandhopper::diagnose
