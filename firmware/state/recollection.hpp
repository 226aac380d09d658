#pragma once
#include <cstdint>
#include <string>

#include "config/robot_config.hpp"
#include "firmware/state/kept_state.hpp"
#include "firmware/state/start_state.hpp"

namespace sandhopper {

// The clocks a state's age is worked out from.
struct StateClock {
  std::string boot_id;
  std::int64_t boottime_ns = 0;
  std::int64_t realtime_ns = 0;
  bool synchronised = false;  // CLOCK_REALTIME: by a time server or a battery-backed clock
};
StateClock state_clock();

// State remembered at a start; assumed hot where the memory cannot be trusted.
struct Recollection {
  StartState start{};
  bool trusted = false;   // the temperatures
  std::string text;       // of the temperatures: from when, or why not and what is assumed
  std::string positions;  // a warning; empty: none
};

// Temperatures cool from the state's by its age:
//   a state of this boot: age by CLOCK_BOOTTIME;
//   a state of an earlier boot: age by CLOCK_REALTIME where both boots' clocks were synchronised, else the
//   time since this boot, which is shorter; a run that did not end in order may have heated its motors for
//   one period of the state at the torque limit: that is added.
// Hot, hot_C(), is assumed where no state can be read, where the date went backwards, and where the state of
// this boot is gone although the lasting one is of this boot.
Recollection recollect(const StateRead& boot, const StateRead& lasting, const StateClock& now,
                       const RobotConfig& robot);

// Four fifths of the way from ambient to the winding's limit: 93 degrees C as shipped. The robot can hop,
// with little reserve, and cools from there.
double hot_C(const SupervisionConfig& config) noexcept;

// The motors' two temperatures after `age_s` without current [deg C], by implicit steps: stable for every
// age, and warmer than the exact solution, never colder.
void cool(const SupervisionConfig& config, double age_s, double& winding_C, double& housing_C) noexcept;

}  // namespace sandhopper
