#include "drivers/gpio/gpio.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"
#include "tests/unit/allocation_guard.hpp"
#include "tools/virtual_bench/control_client.hpp"

// Tests of the GPIO driver on gpio-sim. Run them inside tools/bench. The chip's label is "bench"; its lines 6
// and 7 have no name and are not connected.
namespace sandhopper {
namespace {

LineConfig estop(const std::string& chip = "", const std::string& line = "ESTOP") {
  return {.chip = chip, .line = line, .active_low = true, .bias = Bias::pull_down};
}

char level_of_line_6() {
  char level = '?';
  std::ifstream("/sys/devices/platform/gpio-sim.0/gpiochip0/sim_gpio6/value") >> level;
  return level;
}

void press_and_release(int times) {
  for (int i = 0; i < times; ++i) {
    bench::tell_bench("estop press");
    bench::tell_bench("estop release");
  }
}

std::string error_of(const LineConfig& config) {
  try {
    const GpioInput line("test", config);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST(GpioOnBench, AChipIsFoundByLabelNamePathNumberOrItsLine) {
  for (const char* chip : {"", "bench", "gpiochip0", "/dev/gpiochip0", "0"}) {
    EXPECT_EQ(error_of(estop(chip)), "") << chip;
    EXPECT_EQ(user_of_gpio_line("test", estop(chip)), "") << chip;
  }
  EXPECT_EQ(error_of(estop("bench", "3")), "");
}

TEST(GpioOnBench, WhatIsNotThereIsNamed) {
  using ::testing::HasSubstr;
  EXPECT_THAT(error_of(estop("", "NOBODY")), HasSubstr("there is no such line"));
  EXPECT_THAT(error_of(estop("bench", "NOBODY")), HasSubstr("there is no such line"));
  EXPECT_THAT(error_of(estop("bench", "4000")), HasSubstr("there is no such line"));
  EXPECT_THAT(error_of(estop("bench", "99999999999999999999")), HasSubstr("there is no such line"));
  EXPECT_THAT(error_of(estop("", "3")), HasSubstr("no line is named"));
  for (const char* chip : {"nobody", "/dev/nobody", "/dev/null", "7"})
    EXPECT_THAT(error_of(estop(chip)), HasSubstr("cannot open the chip")) << chip;
}

TEST(GpioOnBench, ATakenLineHasAUserAndIsRefused) {
  {
    const GpioInput line("test", estop());
    EXPECT_EQ(user_of_gpio_line("test", estop()), "sandhopper");
    EXPECT_THAT(error_of(estop()), ::testing::HasSubstr("cannot take the line: Device or resource busy"));
  }
  EXPECT_EQ(user_of_gpio_line("test", estop()), "");
}

TEST(GpioOnBench, BiasAndActiveLowReachTheLine) {
  LineConfig line{.chip = "bench", .line = "7", .active_low = false, .bias = Bias::pull_up};
  EXPECT_TRUE(GpioInput("test", line).active());
  line.active_low = true;
  EXPECT_FALSE(GpioInput("test", line).active());
  line.bias = Bias::pull_down;
  EXPECT_TRUE(GpioInput("test", line).active());
  line.bias = Bias::as_is;
  EXPECT_TRUE(GpioInput("test", line).active()) << "the pull-down from before";
  line.bias = Bias::none;
  EXPECT_TRUE(GpioInput("test", line).active()) << "gpio-sim keeps the level of a line without a pull";
}

TEST(GpioOnBench, AnOutputStartsAsAskedAndFollows) {
  LineConfig line{.chip = "bench", .line = "6", .active_low = false, .bias = Bias::as_is};
  {
    GpioOutput output("test", line, true);
    EXPECT_EQ(level_of_line_6(), '1');
    EXPECT_TRUE(output.set(false));
    EXPECT_EQ(level_of_line_6(), '0');
  }
  line.active_low = true;
  GpioOutput output("test", line, false);
  EXPECT_EQ(level_of_line_6(), '1');
  EXPECT_TRUE(output.set(true));
  EXPECT_EQ(level_of_line_6(), '0');
}

TEST(GpioOnBench, EdgesAreThoseToActiveWithTheTimeOfTheNewest) {
  GpioEdges line("test", estop());
  EXPECT_FALSE(line.wait(0).has_value());
  press_and_release(2);
  const auto before_ns = monotonic_ns();
  bench::tell_bench("estop press");
  const auto after_ns = monotonic_ns();
  EXPECT_TRUE(line.active());
  sleep_ns(1'000'000);
  bench::tell_bench("estop release");
  EXPECT_FALSE(line.active());
  const auto edge = line.wait(0);
  ASSERT_TRUE(edge.has_value());
  EXPECT_EQ(edge->count, 3U);
  EXPECT_GE(edge->time_ns, before_ns);
  EXPECT_LE(edge->time_ns, after_ns);
  EXPECT_FALSE(line.wait(0).has_value());
}

TEST(GpioOnBench, AWaitWithoutAnEdgeLastsItsTime) {
  GpioEdges line("test", estop());
  const auto begin_ns = monotonic_ns();
  EXPECT_FALSE(line.wait(20'000'000).has_value());
  EXPECT_NEAR(static_cast<double>(monotonic_ns() - begin_ns) * 1e-6, 20.0, 1.0);
}

TEST(GpioOnBench, OfTwentyEdgesTheKernelKeepsSixteen) {
  GpioEdges line("test", estop());
  press_and_release(20);
  const auto edge = line.wait(0);
  ASSERT_TRUE(edge.has_value());
  EXPECT_EQ(edge->count, 16U);
}

TEST(GpioOnBench, NothingIsAllocatedOnceALineIsTaken) {
  GpioEdges edges("test", estop());
  GpioInput input("test", {.chip = "bench", .line = "7", .active_low = false, .bias = Bias::pull_up});
  GpioOutput output("test", {.chip = "bench", .line = "6", .active_low = false, .bias = Bias::as_is}, false);
  press_and_release(3);
  const AllocationGuard guard;
  const auto edge = edges.wait(1'000'000);
  const auto nothing = edges.wait(1'000'000);
  const bool ok = input.active() && output.set(true) && !edges.active();
  const auto allocations = guard.count();
  EXPECT_EQ(allocations, 0U);
  EXPECT_TRUE(edge.has_value() && !nothing.has_value() && ok);
}

}  // namespace
}  // namespace sandhopper
