#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recorder.hpp"
#include "tools/cli/arguments.hpp"

namespace sandhopper::cli {

// What every calibration is given.
struct CalibrationInput {
  RobotConfig robot;
  LinuxBoardConfig board;  // with the robot's motors
};

// One word after `hop calibrate`. `set_up` adds its options and returns what is done with them.
struct Calibration {
  struct Actions {
    // What is recorded, one step after the other; also how many files --from needs. Throws Failure(usage)
    // where the options do not fit together.
    std::function<std::vector<calibrate::Step>(const CalibrationInput&)> steps;
    std::function<calibrate::Outcome(const std::vector<calibrate::Recording>&, const CalibrationInput&)> fit;
    std::function<void(CalibrationInput&)> prepare{};  // changes what is believed before anything is recorded
  };
  std::string name;
  std::string summary;
  std::function<Actions(Arguments&)> set_up;
};

// Options that several calibrations have: how long each recording lasts, and gravity where it is made.
void add_seconds(Arguments& arguments, double& seconds);
void add_gravity(Arguments& arguments, double& gravity_mps2, const std::string& help);

// A constant of this type in a file tools/cli/calibrate_NAME.cpp makes the calibration known.
class CalibrationRegistration {
 public:
  explicit CalibrationRegistration(Calibration calibration);
};
std::vector<Calibration> known_calibrations();  // in alphabetical order

}  // namespace sandhopper::cli
