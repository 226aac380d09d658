#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Real-time settings of this computer, read from /proc and /sys. Tests replace "/" by `root`. The functions
// skip files that they cannot read and throw nothing.
namespace sandhopper {

struct KernelThread {
  int pid = 0;
  std::string name;  // "irq/41-spi1.0", "spi1"
  int policy = 0;    // as sched_getscheduler(2): SCHED_OTHER 0, SCHED_FIFO 1, SCHED_RR 2
  int priority = 0;  // 1 to 99; 0 with an ordinary policy
};

// Threads of the kernel itself.
std::vector<KernelThread> kernel_threads(const std::filesystem::path& root);

// Names under which the kernel registers the interrupts and message threads of a device: the device's own
// name, its controller's, its driver's. Empty if the device has none, such as a virtual bus.
std::vector<std::string> interrupt_names_of_can(const std::filesystem::path& root,
                                                const std::string& interface);
std::vector<std::string> interrupt_names_of_spi(const std::filesystem::path& root, const std::string& device);
std::vector<std::string> interrupt_names_of_i2c(const std::filesystem::path& root, const std::string& device);

// True if this thread serves one of `names`: irq/NUMBER-NAME, irq/NUMBER-s-NAME (a second handler), or NAME
// itself.
bool serves(const KernelThread& thread, const std::vector<std::string>& names);

// True if a list such as "0-2,6" contains the CPU. An empty or unreadable list contains none.
bool cpu_list_holds(std::string_view list, int cpu);

// Work that the kernel's command line keeps away from a processor.
struct CpuIsolation {
  bool scheduler = false;  // isolcpus: other programs
  bool tick = false;       // nohz_full: the periodic timer interrupt, while one thread runs
  bool callbacks = false;  // rcu_nocbs: deferred freeing of the kernel's memory
};
CpuIsolation cpu_isolation(const std::filesystem::path& root, int cpu);

// Share of a processor that real-time threads may use, kernel.sched_rt_*_us.
struct RealTimeLimit {
  long runtime_us = 0;  // -1: no limit; 0: no real-time thread runs
  long period_us = 0;
};
std::optional<RealTimeLimit> real_time_limit(const std::filesystem::path& root);

}  // namespace sandhopper
