#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recorder.hpp"

// Calibrations on the simulated board, whose devices differ from the configuration.
namespace sandhopper::calibrate {

inline std::vector<Recording> record_on_sim(const RobotConfig& believed_robot, LinuxBoardConfig believed,
                                            const SimulatedDevices& devices, const std::vector<Step>& steps) {
  believed.can.motor = believed_robot.motor;
  const auto recorder = make_sim_recorder({.robot = believed_robot, .board = believed}, devices);
  std::vector<Recording> out;
  for (const auto& step : steps) {
    out.push_back(recorder->record(step, {}));
    out.back().name = "recording " + std::to_string(out.size());
  }
  return out;
}

inline const CalibratedValue& value_of(const Outcome& outcome, const std::string& key) {
  static const CalibratedValue none{};
  for (const auto& target : outcome.targets)
    for (const auto& value : target.values)
      if (value.key == key) return value;
  ADD_FAILURE() << "no value " << key;
  return none;
}

inline std::string reasons(const Outcome& outcome) {
  std::string out;
  for (const auto& refusal : outcome.refusals) out += (out.empty() ? "" : " ") + refusal.reason;
  return out;
}

// Number of stated 95 % intervals that contain the true value.
struct Coverage {
  int held = 0;
  int all = 0;
  void see(const CalibratedValue& value, double truth) {
    held += std::abs(value.after - truth) <= value.ci95;
    ++all;
  }
};

}  // namespace sandhopper::calibrate
