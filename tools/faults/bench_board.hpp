#pragma once
#include <functional>
#include <memory>

#include "config/robot_config.hpp"
#include "drivers/can/cubemars_drives.hpp"
#include "drivers/transmit_guard/guarded_port.hpp"
#include "firmware/board.hpp"
#include "tools/faults/emulated_bus.hpp"
#include "tools/faults/forwarding_port.hpp"
#include "tools/faults/sensor_faults.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper::faults {

// Ports that a test inserts into the path of frames: between driver and transmit guard, and between guard and
// bus.
struct BenchStages {
  using Stage = std::function<std::unique_ptr<CanPort>(std::unique_ptr<CanPort>)>;
  Stage before_guard{};
  Stage behind_guard{};
};

// Board of the fault matrix: the simulated world, the robot's own motor driver on an emulated bus, and a
// fault injector in every device. All times are those of the world.
class BenchBoard : public Board {
 public:
  BenchBoard(World& world, const RobotConfig& robot, std::uint64_t seed, const BenchStages& stages = {});

  void read(SensorFrame& frame) noexcept override;
  void note_fault(Fault latched) noexcept override { latched_ = latched; }
  void write(const Command& command) noexcept override;

  // Plants a fault in a device; std::nullopt repairs it.
  void set(Device device, std::optional<Kind> kind);

  // Starts a new driver on the same bus, as a new session of hopperd does. Throws DeviceError if the driver
  // refuses to start.
  void restart_driver();

  EmulatedBus& bus() { return *bus_; }
  GuardedPort& guard() { return *guard_; }
  CubeMarsDrives& drives() { return *drives_; }

 private:
  std::unique_ptr<CubeMarsDrives> make_driver();

  World& world_;
  CanConfig can_;
  transmit::Limits limits_;
  BenchStages stages_;
  std::unique_ptr<EmulatedBus> bus_;
  GuardedPort* guard_ = nullptr;  // owned by drives_, as is miscoding_
  MiscodingPort* miscoding_ = nullptr;
  bool is_miscoded_ = false;
  std::unique_ptr<CubeMarsDrives> drives_;
  SensorFault<ImuSample> imu_body_;
  SensorFault<ImuSample> imu_foot_;
  SensorFault<TofSample> tof_;
  SensorFault<LoadCellSample> load_cell_;
  bool stop_level_ = false;
  bool stop_edge_ = false;
  bool emergency_stop_ = true;  // value of the last read()
  Fault latched_ = Fault::none;
};

// The CAN configuration of the robot: its motors, torque limit and number of motors.
CanConfig can_of(const RobotConfig& robot);

}  // namespace sandhopper::faults
