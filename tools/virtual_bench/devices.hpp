#pragma once
#include <memory>
#include <string>
#include <vector>

#include "firmware/linux_board_config.hpp"
#include "tools/virtual_bench/ads1115.hpp"
#include "tools/virtual_bench/afbr_companion.hpp"
#include "tools/virtual_bench/bench_world.hpp"
#include "tools/virtual_bench/can_bus.hpp"
#include "tools/virtual_bench/control_socket.hpp"
#include "tools/virtual_bench/drive_node.hpp"
#include "tools/virtual_bench/event_loop.hpp"
#include "tools/virtual_bench/i2c_node.hpp"
#include "tools/virtual_bench/ism330dhcx.hpp"
#include "tools/virtual_bench/simulated_gpio.hpp"
#include "tools/virtual_bench/spi_node.hpp"

namespace sandhopper::bench {

struct DeviceOptions {
  std::string control_path;
  double drive_timeout_s = 0.0;  // without a frame a drive drops its command; 0: as its dialect's emulation
};

// Every emulated device of one robot, wired to the lines, buses and the one world.
class Devices {
 public:
  // Throws std::exception with what cannot be made.
  Devices(EventLoop& loop, BenchWorld& world, const LinuxBoardConfig& board, const DeviceOptions& options);

 private:
  void connect_sensors();
  void connect_drives(double drive_timeout_s);
  void connect_control();
  void press_emergency_stop(bool pressed);
  void look_at_catch();

  EventLoop& loop_;
  BenchWorld& world_;
  LinuxBoardConfig board_;
  SimulatedGpio gpio_;
  Ism330dhcx imu_body_;
  Ism330dhcx imu_foot_;
  Ads1115 load_cell_;
  AfbrCompanion tof_;
  SpiNode imu_body_node_;
  SpiNode imu_foot_node_;
  I2cNode load_cell_node_;
  CanBus can_;
  std::vector<std::unique_ptr<DriveNode>> drives_;
  ControlSocket control_;
  bool catch_holds_ = false;  // seen to hold since the last reset; only then can it let go
};

}  // namespace sandhopper::bench
