#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recorder.hpp"
#include "tools/cli/arguments.hpp"

namespace sandhopper::cli {

// Input of every calibration.
struct CalibrationInput {
  RobotConfig robot;
  LinuxBoardConfig board;  // with the robot's motors in can.motor
};

// A calibration, `hop calibrate NAME`. `set_up` adds its options and returns its actions.
struct Calibration {
  struct Actions {
    // Recordings to make, in this order; --from needs as many files. Throws Failure(usage) if the options
    // contradict each other.
    std::function<std::vector<calibrate::Step>(const CalibrationInput&)> steps;
    // Computes the calibration from the recordings, in the order of `steps`.
    std::function<calibrate::Outcome(const std::vector<calibrate::Recording>&, const CalibrationInput&)> fit;
    std::function<void(CalibrationInput&)> prepare{};  // changes the assumed configuration before recording
  };
  std::string name;
  std::string summary;
  std::function<Actions(Arguments&)> set_up;
};

// Options common to several calibrations: the duration of each recording, and the local gravity.
void add_seconds(Arguments& arguments, double& seconds);
void add_gravity(Arguments& arguments, double& gravity_mps2, const std::string& help);

// Registers a calibration; define one constant of this type in tools/cli/calibrate_NAME.cpp.
class CalibrationRegistration {
 public:
  explicit CalibrationRegistration(Calibration calibration);
};
std::vector<Calibration> known_calibrations();  // in alphabetical order

}  // namespace sandhopper::cli
