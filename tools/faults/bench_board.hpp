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

// What a test puts in the way of frames: before the transmit guard and between it and the bus.
struct BenchStages {
  using Stage = std::function<std::unique_ptr<CanPort>(std::unique_ptr<CanPort>)>;
  Stage before_guard{};
  Stage behind_guard{};
};

// The world behind the cycle's seam with the robot's own motor driver on an emulated bus, and a place for a
// fault in every device. All in the world's time.
class BenchBoard : public Board {
 public:
  BenchBoard(World& world, const RobotConfig& robot, std::uint64_t seed, const BenchStages& stages = {});

  void read(SensorFrame& frame) noexcept override;
  void note_fault(Fault latched) noexcept override { latched_ = latched; }
  void write(const Command& command) noexcept override;

  // Breaks a device; no kind repairs it.
  void set(Device device, std::optional<Kind> kind);

  // The driver of a new session on the same bus, as hopperd begins it. Throws DeviceError when it refuses.
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
  GuardedPort* guard_ = nullptr;  // the drives own it, and
  MiscodingPort* miscoding_ = nullptr;
  bool is_miscoded_ = false;
  std::unique_ptr<CubeMarsDrives> drives_;
  SensorFault<ImuSample> imu_body_;
  SensorFault<ImuSample> imu_foot_;
  SensorFault<TofSample> tof_;
  SensorFault<LoadCellSample> load_cell_;
  bool stop_level_ = false;
  bool stop_edge_ = false;
  bool emergency_stop_ = true;  // as last read
  Fault latched_ = Fault::none;
};

CanConfig can_of(const RobotConfig& robot);

}  // namespace sandhopper::faults
