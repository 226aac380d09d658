#pragma once
#include <cstdint>
#include <string>

#include "config/robot_config.hpp"
#include "firmware/state/kept_state.hpp"
#include "firmware/state/start_state.hpp"

namespace sandhopper {

// Clocks from which a state's age is calculated.
struct StateClock {
  std::string boot_id;
  std::int64_t boottime_ns = 0;
  std::int64_t realtime_ns = 0;
  bool synchronised = false;  // CLOCK_REALTIME was set by a time server or a battery-backed clock
};
StateClock state_clock();

// State restored at a start. If the stored temperatures cannot be trusted the motors are assumed hot.
struct Recollection {
  StartState start{};
  bool trusted = false;   // the temperatures are restored, not assumed
  std::string text;       // origin of the temperatures, or the reason for assuming them
  std::string positions;  // a warning; empty: none
};

// Temperatures are those of the state, cooled over its age:
//   a state of this boot: age by CLOCK_BOOTTIME;
//   a state of an earlier boot: age by CLOCK_REALTIME if both boots' clocks were synchronised, otherwise the
//   time since this boot, which is shorter.
// A run that did not end in order may have heated its motors for one period of the state at the torque limit;
// this is added. hot_C() is assumed if no state can be read, if the date went backwards, or if this boot's
// state is missing although the lasting state is of this boot.
Recollection recollect(const StateRead& boot, const StateRead& lasting, const StateClock& now,
                       const RobotConfig& robot);

// Temperature at four fifths of the way from ambient to the winding's limit: 93 degrees C as shipped. The
// robot can hop with little reserve and cools from there.
double hot_C(const SupervisionConfig& config) noexcept;

// Cools the motor's two temperatures [deg C] for `age_s` without current, by implicit steps. They are stable
// for every age and give temperatures above the exact solution, never below.
void cool(const SupervisionConfig& config, double age_s, double& winding_C, double& housing_C) noexcept;

}  // namespace sandhopper
