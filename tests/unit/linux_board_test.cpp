#include "firmware/linux_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "drivers/device_error.hpp"
#include "firmware/acquisition_thread.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;

LinuxBoardConfig nowhere() {
  LinuxBoardConfig config;
  config.can.interface = "nocan0";
  config.imu_body.device = "/dev/no_spi_body";
  config.imu_foot.device = "/dev/no_spi_foot";
  config.load_cell.device = "/dev/no_i2c";
  config.tof.device = "/dev/no_tof";
  config.estop.line = "NO_ESTOP";
  config.body_catch.line = "NO_CATCH";
  return config;
}

TEST(LinuxBoard, OneStartNamesEveryDeviceThatIsNotRight) {
  try {
    const LinuxBoard board(nowhere());
    FAIL() << "started without devices";
  } catch (const DeviceError& error) {
    for (const auto* text : {"NO_ESTOP", "NO_CATCH", "/dev/no_spi_body", "/dev/no_spi_foot", "/dev/no_i2c",
                             "/dev/no_tof", "nocan0", "No such file or directory", "nothing was energised"})
      EXPECT_THAT(error.what(), HasSubstr(text));
  }
}

TEST(LinuxBoard, ExaminationReportsDeviceByDevice) {
  for (const auto& [device, problem] : examine_devices(nowhere())) EXPECT_NE(problem, "") << device;
  auto config = nowhere();
  config.body_catch.line = "";
  const auto reports = examine_devices(config);
  EXPECT_EQ(std::ranges::count(reports, "catch", &DeviceReport::device), 0) << "a catch that is not fitted";
}

TEST(AcquisitionThread, StepsUntilDestroyed) {
  std::atomic<int> steps = 0;
  {
    const AcquisitionThread thread({"test", 0}, [&] {
      ++steps;
      std::this_thread::yield();
    });
    while (steps < 3) std::this_thread::yield();
  }
  const int at_end = steps;
  std::this_thread::yield();
  EXPECT_EQ(steps, at_end);
}

}  // namespace
}  // namespace sandhopper
