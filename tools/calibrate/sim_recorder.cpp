#include "tools/calibrate/board_run.hpp"
#include "tools/calibrate/devices.hpp"
#include "tools/plant/sim_board.hpp"

namespace sandhopper::calibrate {
namespace {

// Clock of a simulation: sleep_until() returns at once.
class PlantTime : public TimeSource {
 public:
  std::int64_t now_ns() noexcept override { return now_ns_; }
  void sleep_until(std::int64_t time_ns) noexcept override { now_ns_ = time_ns; }

 private:
  std::int64_t now_ns_ = 0;
};

// A board with the true devices `real`, while the firmware assumes `believed`. All drives of the simulated
// world have the torque constant of the first motor.
class MisjudgedBoard : public Board {
 public:
  MisjudgedBoard(Board& inner, const LinuxBoardConfig& real, const LinuxBoardConfig& believed)
      : inner_(inner), real_(real), believed_(believed) {}

  void read(SensorFrame& frame) noexcept override {
    raw_.time_ns = frame.time_ns;
    inner_.read(raw_);
    frame.emergency_stop = raw_.emergency_stop;
    for (std::size_t i = 0; i < kMotorCount; ++i) {
      auto motor = raw_.motor[i];
      motor.current_A *= constant(real_, 0) / constant(real_, i);
      frame.motor[i] = converted(motor, real_.can.motor[i], believed_.can.motor[i]);
    }
    frame.imu_body = converted(raw_.imu_body, real_.imu_body, believed_.imu_body);
    frame.imu_foot = converted(raw_.imu_foot, real_.imu_foot, believed_.imu_foot);
    frame.tof = converted(raw_.tof, real_.tof, believed_.tof);
    frame.load_cell = converted(raw_.load_cell, real_.load_cell, believed_.load_cell);
  }

  // The firmware computes the current with the assumed torque constant and sign. The true ones give the
  // torque.
  void write(const Command& command) noexcept override {
    Command real = command;
    for (std::size_t i = 0; i < kMotorCount; ++i)
      real.motor[i].torque_Nm *=
          constant(real_, i) / constant(believed_, i) * real_.can.motor[i].sign * believed_.can.motor[i].sign;
    inner_.write(real);
  }

 private:
  static double constant(const LinuxBoardConfig& config, std::size_t motor) {
    return config.can.motor[motor].torque_constant_Nm_per_A;
  }

  Board& inner_;
  const LinuxBoardConfig& real_;
  const LinuxBoardConfig& believed_;
  SensorFrame raw_{};
};

class SimRecorder : public Recorder {
 public:
  SimRecorder(const RecorderSetup& setup, const SimulatedDevices& devices)
      : setup_(setup),
        devices_(devices),
        world_(devices_.world, devices_.trial, 0),
        board_(world_),
        misjudged_(board_, devices_.real_board, setup_.board) {}

  Recording record(const Step& step, const std::filesystem::path& log) override {
    world_.hold(step.fixture);
    return run_board({.setup = setup_, .board = misjudged_, .time = time_, .board_name = "sim"}, step, log);
  }

 private:
  RecorderSetup setup_;
  SimulatedDevices devices_;
  PlantTime time_;
  World world_;
  SimBoard board_;
  MisjudgedBoard misjudged_;
};

}  // namespace

std::unique_ptr<Recorder> make_sim_recorder(const RecorderSetup& setup, const SimulatedDevices& devices) {
  return std::make_unique<SimRecorder>(setup, devices);
}

}  // namespace sandhopper::calibrate
