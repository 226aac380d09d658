#include <fmt/format.h>

#include <algorithm>

#include "firmware/machine_settings.hpp"
#include "tools/cli/doctor.hpp"

namespace sandhopper::cli {
namespace {

// Default SCHED_FIFO priority of interrupt threads under PREEMPT_RT.
constexpr int kKernelsOwn = 50;

// The threads of the buses need a priority between these two.
struct Band {
  int above;  // highest of the threads that wait for the buses, and of other interrupts
  int below;  // that of the cycle
};

Band band(const RobotConfig& robot, const LinuxBoardConfig& board) {
  return {std::max({kKernelsOwn, board.imu_body.thread_priority, board.imu_foot.thread_priority,
                    board.load_cell.thread_priority, board.tof.thread_priority}),
          robot.real_time.priority};
}

Finding judge(const std::string& what, const std::vector<KernelThread>& threads,
              const std::vector<std::string>& names, const Band& band) {
  std::string found;
  bool right = true;
  for (const auto& thread : threads) {
    if (!serves(thread, names)) continue;
    const bool real_time = thread.policy == 1 || thread.policy == 2;
    right &= real_time && thread.priority > band.above && thread.priority < band.below;
    found += fmt::format("{}{} {}", found.empty() ? "" : ", ", thread.name,
                         real_time ? std::to_string(thread.priority) : "ordinary");
  }
  if (names.empty()) return {Health::ok, what, "no controller of this computer's", ""};
  if (found.empty()) return {Health::ok, what, "not served by a thread of its own", ""};
  if (right) return {Health::ok, what, found, ""};
  return {Health::warn, what,
          fmt::format("{}: should be above {} (threads that wait for it) and below {} (the cycle)", found,
                      band.above, band.below),
          "systemctl enable sandhopper-real-time; systemctl restart sandhopper-real-time (priority: "
          "/etc/sandhopper/real-time.conf)"};
}

}  // namespace

std::vector<Finding> examine_interrupts(const RobotConfig& robot, const LinuxBoardConfig& board) {
  const auto limits = band(robot, board);
  if (limits.below == 0) return {{Health::ok, "interrupts", "not looked at: real_time.priority is 0", ""}};
  if (limits.above + 1 >= limits.below)
    return {{Health::warn, "interrupts",
             fmt::format("no priority is free between {} (threads of the buses) and {} (the cycle)",
                         limits.above, limits.below),
             "raise real_time.priority in robot.toml, or lower thread_priority in linux.toml"}};
  const auto threads = kernel_threads("/");
  auto spi = interrupt_names_of_spi("/", board.imu_body.device);
  for (const auto& name : interrupt_names_of_spi("/", board.imu_foot.device)) spi.push_back(name);
  return {judge("interrupts of CAN", threads, interrupt_names_of_can("/", board.can.interface), limits),
          judge("interrupts of SPI", threads, spi, limits),
          judge("interrupts of I2C", threads, interrupt_names_of_i2c("/", board.load_cell.device), limits),
          // requested by hopperd while it runs
          judge("interrupts of GPIO lines", threads, {"sandhopper"}, limits)};
}

}  // namespace sandhopper::cli
