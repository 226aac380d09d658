#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// How this computer is set up for real time, read from /proc and /sys. `root` stands in for "/" in tests.
// These functions leave out files that they cannot read, and throw nothing.
namespace sandhopper {

struct KernelThread {
  int pid = 0;
  std::string name;  // "irq/41-spi1.0", "spi1"
  int policy = 0;    // as sched_getscheduler(2): SCHED_OTHER 0, SCHED_FIFO 1, SCHED_RR 2
  int priority = 0;  // 1 to 99; 0 with an ordinary policy
};

// The kernel's own threads.
std::vector<KernelThread> kernel_threads(const std::filesystem::path& root);

// Names under which the kernel registers the interrupts and message threads of a device: its own name, its
// controller's, its driver's. Empty where the device has none, as a virtual bus.
std::vector<std::string> interrupt_names_of_can(const std::filesystem::path& root,
                                                const std::string& interface);
std::vector<std::string> interrupt_names_of_spi(const std::filesystem::path& root, const std::string& device);
std::vector<std::string> interrupt_names_of_i2c(const std::filesystem::path& root, const std::string& device);

// Does this thread serve one of `names`: irq/NUMBER-NAME, irq/NUMBER-s-NAME (a second handler), or NAME
// itself?
bool serves(const KernelThread& thread, const std::vector<std::string>& names);

// "0-2,6" holds 1. An empty or unreadable list holds nothing.
bool cpu_list_holds(std::string_view list, int cpu);

// Work that the kernel was told not to do on a processor, by its command line.
struct CpuIsolation {
  bool scheduler = false;  // isolcpus: other programs
  bool tick = false;       // nohz_full: the periodic timer interrupt, while one thread runs
  bool callbacks = false;  // rcu_nocbs: deferred freeing of the kernel's memory
};
CpuIsolation cpu_isolation(const std::filesystem::path& root, int cpu);

// Share of a processor that real-time threads may take, kernel.sched_rt_*_us.
struct RealTimeLimit {
  long runtime_us = 0;  // -1: no limit; 0: no real-time thread runs
  long period_us = 0;
};
std::optional<RealTimeLimit> real_time_limit(const std::filesystem::path& root);

}  // namespace sandhopper
