#pragma once
#include <functional>
#include <type_traits>
#include <utility>
#include <variant>

// The state that a law sees at its port. Times are those of the trial.
namespace sandhopper::diagnose {

// A body in a medium; up is positive.
struct BodyState {
  double time_s = 0.0;  // since it was let go
  double height_m = 0.0;
  double velocity_mps = 0.0;
  double depth_m = 0.0;         // of its lowest point under the surface
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
  double torque_Nm = 0.0;   // of the drive; of a leg's both motors
  double turned_rad = 0.0;  // angle of the last turn
};

// A foot in the bed; down is positive.
struct GroundState {
  double time_s = 0.0;
  double depth_m = 0.0;
  double speed_mps = 0.0;
  double virgin = 0.0;          // 1 on the virgin curve (new depth, going down), else 0
  double quasi_static_N = 0.0;  // at this depth
  double bearing_N = 0.0;       // the same without any law
  double deepest_m = 0.0;
  double pushes = 0.0;  // since the bed was prepared
  double wait_s = 0.0;
  double bed_depth_m = 0.0;  // 0: not told
  double since_touch_s = 0.0;
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

// The true quantity that a sensor reads; of the channel "actuator" the torque of the current.
struct SensorState {
  double time_s = 0.0;
  double value = 0.0;
  double rate = 0.0;
  double temperature_C = 25.0;  // of the motors
};

using PortState =
    std::variant<BodyState, RailState, AxisState, GroundState, FootState, CellState, DriveState, SensorState>;

// Time of any state; 0 of one that has none.
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

using Law = std::function<double(const PortState&)>;

namespace detail {
template <class F, class State>
State state_of(double (F::*)(const State&) const);
}  // namespace detail

// A function of one kind of state as a law; it throws std::bad_variant_access at a port of another kind. A
// function of any state stays as it is.
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
