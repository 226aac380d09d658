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
  std::string prompt;  // what the person does before it
  Fixture fixture{};   // who does it on the simulated board and on the virtual bench
  double seconds = 3.0;
  std::string during{};  // what the person does meanwhile; empty: nothing
  // Torques of both motors at a time of the recording [N m]; none: the drives stay off.
  std::function<std::array<double, kMotorCount>(double time_s)> torque_Nm{};
};

struct RecorderSetup {
  const RobotConfig& robot;
  const LinuxBoardConfig& board;  // with the robot's motors
  std::function<void(double share)> progress{};
};

// Makes recordings and leaves each as a log, too, for a later `--from`; an empty path: none.
class Recorder {
 public:
  virtual ~Recorder() = default;
  // Throws DeviceError, and std::runtime_error where a recording had to be ended (e-stop, a motor that runs
  // away).
  virtual Recording record(const Step& step, const std::filesystem::path& log) = 0;
};

// The robot's or the virtual bench's devices, through the drivers that hopperd uses, with its lock, its
// torque watchdog and its guard while there is torque. On the bench the fixture does what the prompt says.
std::unique_ptr<Recorder> make_linux_recorder(const RecorderSetup& setup);

// The simulated board. `real`: what the simulated devices are, where `setup` says what they are believed to
// be; the difference is what a calibration finds. `world` is made for the robot of `real`.
struct SimulatedDevices {
  WorldConfig world;
  RobotConfig real_robot;
  LinuxBoardConfig real_board;  // with real_robot's motors
  TrialSetup trial{};
};
std::unique_ptr<Recorder> make_sim_recorder(const RecorderSetup& setup, const SimulatedDevices& devices);

}  // namespace sandhopper::calibrate
