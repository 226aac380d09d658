#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "config/robot_config.hpp"
#include "firmware/board.hpp"
#include "firmware/linux_board_config.hpp"
#include "tools/calibrate/recording.hpp"
#include "tools/plant/fixture.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper::calibrate {

// One recording to be made.
struct Step {
  std::string prompt;  // instruction to the person, before the recording
  Fixture fixture{};   // acts for the person on the simulated board and on the virtual bench
  double seconds = 3.0;
  std::string during{};  // task of the person during the recording; empty: nothing
  // Torque of each motor at this time of the recording, N m; empty: the drives stay off.
  std::function<std::array<double, kMotorCount>(double time_s)> torque_Nm{};
};

// Assumed configuration of robot and board. `progress` gets the share of the recording that is done, 0 to 1.
struct RecorderSetup {
  const RobotConfig& robot;
  const LinuxBoardConfig& board;  // with the robot's motors in can.motor
  std::function<void(double share)> progress{};
};

// Makes recordings. Each recording is also written to `log`, for a later `--from`; an empty path: no log.
class Recorder {
 public:
  virtual ~Recorder() = default;
  // Throws DeviceError, or std::runtime_error if the recording was ended early (e-stop, a motor too fast).
  virtual Recording record(const Step& step, const std::filesystem::path& log) = 0;
};

// Records from the devices of the robot or of the virtual bench, with hopperd's drivers and its lock. While
// there is torque, hopperd's watchdog and guard process run. On the virtual bench the fixture carries out the
// prompt.
std::unique_ptr<Recorder> make_linux_recorder(const RecorderSetup& setup);

// Records from the simulated board. `real_*` are the true properties of the simulated devices, `setup` holds
// the assumed ones; a calibration finds the difference. `world` must be made for real_robot.
struct SimulatedDevices {
  WorldConfig world;
  RobotConfig real_robot;
  LinuxBoardConfig real_board;  // with the motors of real_robot
  TrialSetup trial{};
};
std::unique_ptr<Recorder> make_sim_recorder(const RecorderSetup& setup, const SimulatedDevices& devices);

}  // namespace sandhopper::calibrate
