#include "firmware/machine_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

namespace sandhopper {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr long kKernels = 0x208040;  // flags of a real kernel thread, with PF_KTHREAD

// A folder that replaces "/": CAN on SPI1, IMUs on SPI0, load cell on I2C1, as on a Raspberry Pi 4.
class MachineSettings : public ::testing::Test {
 protected:
  MachineSettings() {
    auto name = (fs::temp_directory_path() / "machine_settings.XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    const std::string platform = "sys/devices/platform/soc/";
    link("sys/class/net/can0/device", platform + "fe215080.spi/spi_master/spi1/spi1.0");
    link("sys/devices/platform/soc/fe215080.spi/spi_master/spi1/spi1.0/driver",
         "sys/bus/spi/drivers/mcp251xfd");
    link("sys/class/spi_master/spi0/device", platform + "fe204000.spi");
    link("sys/class/spi_master/spi1/device", platform + "fe215080.spi");
    link("sys/class/i2c-adapter/i2c-1/device", platform + "fe804000.i2c");
    fs::create_directories(root_ / "sys/class/net/vcan0");
  }
  ~MachineSettings() override { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text << '\n';
  }
  void link(const std::string& path, const std::string& target) {
    fs::create_directories(root_ / target);
    fs::create_directories((root_ / path).parent_path());
    fs::create_symlink(root_ / target, root_ / path);
  }
  // proc(5): fields 3 to 41 follow the name; 9 is flags, 40 priority, 41 policy.
  void thread(int pid, const std::string& name, long flags, int priority, int policy) {
    std::string text = std::to_string(pid) + " (" + name + ") S 2 0 0 0 -1 " + std::to_string(flags);
    for (int field = 10; field <= 39; ++field) text += " 0";
    write("proc/" + std::to_string(pid) + "/stat",
          text + " " + std::to_string(priority) + " " + std::to_string(policy) + " 0 0 0");
  }

  fs::path root_;
};

TEST_F(MachineSettings, KernelThreadsHaveNamePolicyAndPriority) {
  thread(7, "irq/41-spi1.0", kKernels, 75, 1);
  thread(12, "kworker/0:1 (x)", kKernels, 0, 0);
  const auto threads = kernel_threads(root_);
  ASSERT_EQ(threads.size(), 2U);
  EXPECT_EQ(threads[0].name, "irq/41-spi1.0");
  EXPECT_EQ(threads[0].priority, 75);
  EXPECT_EQ(threads[0].policy, 1);
  EXPECT_EQ(threads[1].name, "kworker/0:1 (x)");
}

TEST_F(MachineSettings, AProgramThatNamesItselfLikeAnInterruptIsNone) {
  thread(900, "irq/41-can0", 0x400100, 99, 1);
  EXPECT_THAT(kernel_threads(root_), IsEmpty());
}

TEST_F(MachineSettings, DamagedOrMissingFilesOfProcAreLeftOut) {
  write("proc/8/stat", "8 (irq/1-x");
  write("proc/9/stat", "9 (irq/1-x) S 2");
  fs::create_directories(root_ / "proc/10");
  fs::create_directories(root_ / "proc/sys");
  EXPECT_THAT(kernel_threads(root_), IsEmpty());
  EXPECT_THAT(kernel_threads(root_ / "nowhere"), IsEmpty());
}

TEST_F(MachineSettings, ACanControllerOnSpiAlsoWaitsForItsBus) {
  EXPECT_THAT(interrupt_names_of_can(root_, "can0"),
              ElementsAre("can0", "spi1.0", "mcp251xfd", "spi1", "fe215080.spi"));
}

TEST_F(MachineSettings, AVirtualBusHasNoInterrupts) {
  EXPECT_THAT(interrupt_names_of_can(root_, "vcan0"), IsEmpty());
  EXPECT_THAT(interrupt_names_of_spi(root_, "/dev/spidev7.0"), IsEmpty());
}

TEST_F(MachineSettings, SpiAndI2cAreNamedAfterTheirController) {
  EXPECT_THAT(interrupt_names_of_spi(root_, "/dev/spidev0.1"), ElementsAre("spi0", "fe204000.spi"));
  EXPECT_THAT(interrupt_names_of_i2c(root_, "/dev/i2c-1"), ElementsAre("i2c-1", "fe804000.i2c"));
}

TEST(Serves, InterruptsSecondHandlersAndTheMessageThread) {
  const std::vector<std::string> names{"spi1", "spi1.0", "fe215080.spi"};
  EXPECT_TRUE(serves({1, "irq/41-spi1.0", 1, 50}, names));
  EXPECT_TRUE(serves({1, "irq/41-s-fe215080.spi", 1, 50}, names));
  EXPECT_TRUE(serves({1, "spi1", 1, 50}, names));
}

TEST(Serves, NotAnotherDeviceWhoseNameBeginsAlike) {
  EXPECT_FALSE(serves({1, "irq/41-spi1.01", 1, 50}, {"spi1.0"}));
  EXPECT_FALSE(serves({1, "irq/41-spi10.0", 1, 50}, {"spi1"}));
  EXPECT_FALSE(serves({1, "irq/41", 1, 50}, {"spi1"}));
  EXPECT_FALSE(serves({1, "spi10", 1, 50}, {"spi1"}));
}

TEST(CpuList, HoldsSinglesAndRanges) {
  EXPECT_TRUE(cpu_list_holds("0-2,6", 1));
  EXPECT_TRUE(cpu_list_holds("0-2,6", 6));
  EXPECT_FALSE(cpu_list_holds("0-2,6", 3));
  EXPECT_FALSE(cpu_list_holds("", 0));
  EXPECT_FALSE(cpu_list_holds("(null)", 0));  // content of nohz_full in a kernel without it
}

TEST_F(MachineSettings, IsolationIsReadForTheCyclesProcessor) {
  write("sys/devices/system/cpu/isolated", "3");
  write("sys/devices/system/cpu/nohz_full", "(null)");
  write("proc/cmdline", "ro isolcpus=3 rcu_nocbs=2-3 quiet");
  const auto isolation = cpu_isolation(root_, 3);
  EXPECT_TRUE(isolation.scheduler);
  EXPECT_FALSE(isolation.tick);
  EXPECT_TRUE(isolation.callbacks);
  EXPECT_FALSE(cpu_isolation(root_, 1).callbacks);
}

TEST_F(MachineSettings, NohzFullIncludesRcuNocbs) {
  write("sys/devices/system/cpu/nohz_full", "3");
  write("proc/cmdline", "ro nohz_full=3");
  EXPECT_TRUE(cpu_isolation(root_, 3).callbacks);
}

TEST_F(MachineSettings, RealTimeLimitIsReadAndMayBeMissing) {
  EXPECT_FALSE(real_time_limit(root_));
  write("proc/sys/kernel/sched_rt_runtime_us", "-1");
  write("proc/sys/kernel/sched_rt_period_us", "1000000");
  ASSERT_TRUE(real_time_limit(root_));
  EXPECT_EQ(real_time_limit(root_)->runtime_us, -1);
  EXPECT_EQ(real_time_limit(root_)->period_us, 1'000'000);
}

}  // namespace
}  // namespace sandhopper
