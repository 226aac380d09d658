#pragma once
#include <memory>

#include "config/robot_config.hpp"
#include "drivers/can/cubemars_drives.hpp"
#include "firmware/board.hpp"
#include "tools/faults/emulated_bus.hpp"
#include "tools/faults/sensor_faults.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper::faults {

// The world behind the cycle's seam with the robot's own motor driver on an emulated bus, and a place for a
// fault in every device. All in the world's time.
class BenchBoard : public Board {
 public:
  BenchBoard(World& world, const RobotConfig& robot, std::uint64_t seed);

  void read(SensorFrame& frame) noexcept override;
  void write(const Command& command) noexcept override;

  // Breaks a device; no kind repairs it.
  void set(Device device, std::optional<Kind> kind);

  // The driver of a new session on the same bus, as hopperd begins it. Throws DeviceError when it refuses.
  void restart_driver();

  EmulatedBus& bus() { return *bus_; }
  CubeMarsDrives& drives() { return *drives_; }

 private:
  std::unique_ptr<CubeMarsDrives> make_driver();

  World& world_;
  CanConfig can_;
  std::unique_ptr<EmulatedBus> bus_;
  std::unique_ptr<CubeMarsDrives> drives_;
  SensorFault<ImuSample> imu_body_;
  SensorFault<ImuSample> imu_foot_;
  SensorFault<TofSample> tof_;
  SensorFault<LoadCellSample> load_cell_;
  bool stop_level_ = false;
  bool stop_edge_ = false;
};

CanConfig can_of(const RobotConfig& robot);

}  // namespace sandhopper::faults
