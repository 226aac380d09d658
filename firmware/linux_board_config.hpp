#pragma once
#include "config/calibration_record.hpp"
#include "drivers/adc/load_cell_config.hpp"
#include "drivers/can/can_config.hpp"
#include "drivers/gpio/line_config.hpp"
#include "drivers/imu/imu_config.hpp"
#include "drivers/tof/tof_config.hpp"
#include "firmware/controller_config.hpp"

namespace sandhopper {

// Every device node of the robot. Defaults are those of a Raspberry-Pi-like board; the virtual bench has its
// own file.
struct LinuxBoardConfig {
  CanConfig can{};
  ImuConfig imu_body{.device = "/dev/spidev0.0", .data_ready = {.chip = "", .line = "IMU_BODY_DRDY"}};
  ImuConfig imu_foot{.device = "/dev/spidev0.1", .data_ready = {.chip = "", .line = "IMU_FOOT_DRDY"}};
  LoadCellConfig load_cell{.ready = {.chip = "", .line = "ADC_RDY", .active_low = true}};
  TofConfig tof{};
  // Active means stop. Normally closed switch to the supply with a pull-down: a cut wire stops.
  LineConfig estop{.chip = "", .line = "ESTOP", .active_low = true, .bias = Bias::pull_down};
  // Active holds the body, inactive releases it. Line empty: no catch.
  LineConfig body_catch{.chip = "", .line = "CATCH"};
  // Active closes a relay in the drives' supply (DriveEnable). Line empty: no relay.
  LineConfig drive_enable{.chip = "", .line = "", .bias = Bias::as_is};
  std::optional<BoardCalibrations> calibration{};
  // Not a key of this table, like the motors of `can`: the robot's limits, which the transmit guard checks.
  LimitsConfig limits{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("can", self.can);
    visit("imu_body", self.imu_body);
    visit("imu_foot", self.imu_foot);
    visit("load_cell", self.load_cell);
    visit("tof", self.tof);
    visit("estop", self.estop);
    visit("catch", self.body_catch);
    visit("drive_enable", self.drive_enable);
    visit("calibration", self.calibration);
  }

  template <class Problem>
  void check(Problem&& problem) const {
    if (!estop.fitted()) problem("estop", "an e-stop line must be given");
    if (imu_body.device == imu_foot.device) problem("imu_foot", "both IMUs have the same device");
  }
};

}  // namespace sandhopper
