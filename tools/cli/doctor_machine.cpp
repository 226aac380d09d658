#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <thread>

#include "firmware/machine_settings.hpp"
#include "tools/cli/doctor.hpp"

namespace sandhopper::cli {
namespace {

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

Finding kernel() {
  utsname name{};
  ::uname(&name);
  const auto found = fmt::format("{} {}", name.release, name.version);
  if (found.find("PREEMPT_RT") != std::string::npos || first_line("/sys/kernel/realtime") == "1")
    return {Health::ok, "kernel", found, ""};
  return {Health::warn, "kernel", found + ": no PREEMPT_RT, wake-ups can be milliseconds late",
          "install the real-time kernel: apt-get install linux-image-rt-amd64 (or -arm64), then reboot"};
}

// Requests the priority in a new thread, so that this thread keeps its scheduling.
Finding priority(int wanted) {
  if (wanted == 0) return {Health::warn, "SCHED_FIFO", "not asked for", "set real_time.priority to 80"};
  int error = 0;
  std::thread([&error, wanted] {
    const sched_param parameters{wanted};
    error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
  }).join();
  if (error == 0) return {Health::ok, "SCHED_FIFO", fmt::format("priority {} granted", wanted), ""};
  return {Health::fail, "SCHED_FIFO", fmt::format("priority {} refused: {}", wanted, std::strerror(error)),
          "run as root, or write '* - rtprio 95' to /etc/security/limits.d/sandhopper.conf and log in again"};
}

Finding throttling() {
  constexpr double kLeastShare = 0.9;  // real-time share of the period; below it the kernel may stop the
                                       // cycle of a busy but healthy computer
  const std::string restore = "sysctl kernel.sched_rt_runtime_us=950000";
  const auto limit = real_time_limit("/");
  if (!limit) return {Health::ok, "throttling", "none in this kernel", ""};
  const auto found = fmt::format("{} of {} us for real-time threads", limit->runtime_us, limit->period_us);
  if (limit->runtime_us == 0) return {Health::fail, "throttling", found + ": none of them runs", restore};
  if (limit->runtime_us < 0)
    return {Health::warn, "throttling",
            "no limit: before kernel 6.12 a real-time thread that never sleeps cannot be ended",
            restore + "; see which file of /etc/sysctl.d or program sets -1"};
  if (static_cast<double>(limit->runtime_us) < kLeastShare * static_cast<double>(limit->period_us))
    return {Health::warn, "throttling", found + ": the kernel may stop the cycle", restore};
  return {Health::ok, "throttling", found, ""};
}

Finding locked_memory() {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  auto* const memory = ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  const bool locked = memory != MAP_FAILED && ::mlock(memory, kBytes) == 0;
  const int error = errno;
  if (memory != MAP_FAILED) ::munmap(memory, kBytes);
  if (locked) return {Health::ok, "memory lock", "64 MiB granted", ""};
  return {Health::fail, "memory lock", fmt::format("64 MiB refused: {}", std::strerror(error)),
          "run as root, or write '* - memlock unlimited' to /etc/security/limits.d/sandhopper.conf and log "
          "in again"};
}

Finding governor() {
  std::string slow;
  bool scaled = false;
  for (unsigned cpu = 0; cpu < std::thread::hardware_concurrency(); ++cpu) {
    const auto name = first_line(fmt::format("/sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor", cpu));
    scaled |= !name.empty();
    if (!name.empty() && name != "performance")
      slow += fmt::format("{}CPU {} {}", slow.empty() ? "" : ", ", cpu, name);
  }
  if (!scaled) return {Health::ok, "CPU governor", "no frequency scaling", ""};
  if (slow.empty()) return {Health::ok, "CPU governor", "performance", ""};
  return {
      Health::warn, "CPU governor", slow + ": the clock rate follows the load, late",
      "systemctl enable sandhopper-real-time; systemctl restart sandhopper-real-time; without the package: "
      "echo performance | tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"};
}

Finding processor(int cpu) {
  const auto online = first_line("/sys/devices/system/cpu/online");
  const auto isolated = first_line("/sys/devices/system/cpu/isolated");
  const auto found = fmt::format("online {}, isolated {}, cycle on {}", online,
                                 isolated.empty() ? "none" : isolated, cpu < 0 ? "any" : std::to_string(cpu));
  if (cpu >= 0 && !cpu_list_holds(online, cpu))
    return {Health::fail, "processors", found, "set real_time.cpu to one that is online, or -1 for any"};
  if (cpu >= 0) {
    const auto isolation = cpu_isolation("/", cpu);
    std::string lacks;
    if (!isolation.scheduler) lacks += " isolcpus (other programs run there)";
    if (!isolation.tick) lacks += " nohz_full (the kernel's timer tick runs there)";
    if (!isolation.callbacks) lacks += " rcu_nocbs (the kernel frees memory there)";
    if (!lacks.empty())
      return {
          Health::warn, "processors", found + ", which lacks" + lacks,
          fmt::format("add isolcpus={0} nohz_full={0} rcu_nocbs={0} to the kernel's command line and reboot, "
                      "or set real_time.cpu to -1",
                      cpu)};
  }
  if (cpu < 0 && !isolated.empty())
    return {Health::warn, "processors", found + ": nothing runs on the isolated one",
            fmt::format("set real_time.cpu in robot.toml to {}", std::atoi(isolated.c_str()))};
  return {Health::ok, "processors", found, ""};
}

Finding idle_states(bool wanted) {
  constexpr const char* kNode = "/dev/cpu_dma_latency";
  if (!wanted) return {Health::ok, "idle states", "may be deep: real_time.hold_cpu_awake is false", ""};
  if (::access(kNode, F_OK) != 0) return {Health::ok, "idle states", "none in this kernel", ""};
  if (::access(kNode, W_OK) == 0) return {Health::ok, "idle states", "can be held shallow", ""};
  return {Health::warn, "idle states", fmt::format("{}: {}", kNode, std::strerror(errno)),
          "run as root, or give the node to your group with a udev rule"};
}

Finding monotonic_clock() {
  timespec resolution{};
  ::clock_getres(CLOCK_MONOTONIC, &resolution);
  const auto source = first_line("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  const auto found =
      fmt::format("resolution {} ns, source {}", resolution.tv_nsec, source.empty() ? "?" : source);
  if (source == "time-travel-clock") return {Health::ok, "clock", "virtual time of the bench", ""};
  if (resolution.tv_sec != 0 || resolution.tv_nsec > 1000)
    return {Health::fail, "clock", found,
            "boot a kernel with CONFIG_HIGH_RES_TIMERS and without highres=off"};
  if (source == "hpet" || source == "acpi_pm" || source == "jiffies")
    return {Health::warn, "clock", found + ": slow to read",
            "see why the kernel left the faster one: dmesg | grep -i clocksource"};
  return {Health::ok, "clock", found, ""};
}

Finding date() {
  timex state{};
  const bool synchronised = ::adjtimex(&state) != TIME_ERROR;
  if (synchronised) return {Health::ok, "date", "synchronised", ""};
  return {Health::warn, "date", "not synchronised: logs carry this machine's idea of the date",
          "timedatectl set-ntp true, or set the date by hand"};
}

Finding disk_space() {
  struct statvfs disk {};
  if (::statvfs(".", &disk) != 0)
    return {Health::warn, "disk", std::strerror(errno), "change to a folder that is there"};
  const double free_GB = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize) * 1e-9;
  const auto found = fmt::format("{:.1f} GB free here", free_GB);
  if (::access(".", W_OK) != 0)
    return {Health::warn, "disk", found + ", but this folder cannot be written",
            "change to a folder of your own"};
  if (free_GB > 1.0) return {Health::ok, "disk", found, ""};
  return {Health::warn, "disk", found, "a minute of log takes up to 100 MB: make room"};
}

}  // namespace

std::vector<Finding> examine_storage() { return {date(), disk_space()}; }

std::vector<Finding> examine_machine(const RobotConfig& robot) {
  const auto& wanted = robot.real_time;
  return {kernel(),
          priority(wanted.priority == 0 ? 0 : std::max(wanted.priority, robot.watchdog.priority)),
          throttling(),
          locked_memory(),
          governor(),
          processor(wanted.cpu),
          idle_states(wanted.hold_cpu_awake),
          monotonic_clock(),
          date(),
          disk_space()};
}

}  // namespace sandhopper::cli
