#include "firmware/machine_settings.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

namespace sandhopper {
namespace {

namespace fs = std::filesystem;

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::optional<long> number(std::string_view text) {
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end == text.data()) return std::nullopt;
  return value;
}

// Parses proc(5), PID/stat: "41 (irq/24-can0) S 2 0 …". The name may contain spaces and brackets.
std::optional<KernelThread> parse_stat(std::string_view line) {
  constexpr long kKernelThread = 0x00200000;                       // PF_KTHREAD of the kernel's sched.h
  constexpr std::size_t kFlags = 6, kPriority = 37, kPolicy = 38;  // fields 9, 40, 41, counted from the third
  const auto open = line.find('(');
  const auto close = line.rfind(')');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return std::nullopt;
  std::istringstream rest{std::string(line.substr(close + 1))};
  const std::vector<std::string> fields{std::istream_iterator<std::string>(rest), {}};
  if (fields.size() <= kPolicy) return std::nullopt;
  const auto pid = number(line), flags = number(fields[kFlags]), priority = number(fields[kPriority]),
             policy = number(fields[kPolicy]);
  if (!pid || !flags || !priority || !policy || (*flags & kKernelThread) == 0) return std::nullopt;
  return KernelThread{static_cast<int>(*pid), std::string(line.substr(open + 1, close - open - 1)),
                      static_cast<int>(*policy), static_cast<int>(*priority)};
}

// File name of the target of a sysfs link; empty if there is no such link.
std::string target_name(const fs::path& link) {
  std::error_code error;
  const auto target = fs::canonical(link, error);
  return error ? std::string() : target.filename().string();
}

void add(std::vector<std::string>& names, const std::string& name) {
  if (!name.empty()) names.push_back(name);
}

// Names of a bus controller: its number ("spi1", also the name of the thread that sends its queue) and its
// device ("fe204000.spi").
std::vector<std::string> controller_names(const fs::path& class_folder, const std::string& controller) {
  const auto device = target_name(class_folder / controller / "device");
  if (device.empty()) return {};
  return {controller, device};
}

// Bus number: "1" for "spi1.0", "/dev/spidev1.0" and "/dev/i2c-1".
std::string bus_number(const std::string& name) {
  const auto begin = name.find_last_not_of("0123456789.") + 1;
  return name.substr(begin, name.find('.', begin) - begin);
}

}  // namespace

std::vector<KernelThread> kernel_threads(const fs::path& root) {
  std::vector<KernelThread> threads;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root / "proc", error)) {
    if (!number(entry.path().filename().string())) continue;
    if (auto thread = parse_stat(first_line(entry.path() / "stat"))) threads.push_back(std::move(*thread));
  }
  std::ranges::sort(threads, {}, &KernelThread::pid);
  return threads;
}

std::vector<std::string> interrupt_names_of_can(const fs::path& root, const std::string& interface) {
  const auto device = root / "sys/class/net" / interface / "device";
  const auto name = target_name(device);
  if (name.empty()) return {};
  std::vector<std::string> names{interface, name};
  add(names, target_name(device / "driver"));
  // A CAN controller on SPI has the device name "spi1.0". Its frames also wait for the bus's interrupts.
  if (name.starts_with("spi")) {
    for (const auto& bus : controller_names(root / "sys/class/spi_master", "spi" + bus_number(name)))
      names.push_back(bus);
  }
  return names;
}

std::vector<std::string> interrupt_names_of_spi(const fs::path& root, const std::string& device) {
  return controller_names(root / "sys/class/spi_master", "spi" + bus_number(device));
}

std::vector<std::string> interrupt_names_of_i2c(const fs::path& root, const std::string& device) {
  return controller_names(root / "sys/class/i2c-adapter", "i2c-" + bus_number(device));
}

bool serves(const KernelThread& thread, const std::vector<std::string>& names) {
  std::string_view served = thread.name;
  if (served.starts_with("irq/")) {
    const auto dash = served.find('-');
    if (dash == std::string_view::npos) return false;
    served.remove_prefix(dash + 1);
    if (served.starts_with("s-")) served.remove_prefix(2);
  }
  return std::ranges::find(names, served) != names.end();
}

bool cpu_list_holds(std::string_view list, int cpu) {
  while (!list.empty()) {
    const auto part = list.substr(0, list.find(','));
    list.remove_prefix(std::min(list.size(), part.size() + 1));
    const auto dash = part.find('-');
    const auto low = number(part);
    const auto high = dash == std::string_view::npos ? low : number(part.substr(dash + 1));
    if (low && high && cpu >= *low && cpu <= *high) return true;
  }
  return false;
}

CpuIsolation cpu_isolation(const fs::path& root, int cpu) {
  const auto folder = root / "sys/devices/system/cpu";
  CpuIsolation isolation{cpu_list_holds(first_line(folder / "isolated"), cpu),
                         cpu_list_holds(first_line(folder / "nohz_full"), cpu), false};
  // The kernel shows rcu_nocbs only on its command line. nohz_full includes it.
  std::istringstream words(first_line(root / "proc/cmdline"));
  constexpr std::string_view kKey = "rcu_nocbs=";
  for (std::string word; words >> word;)
    if (word.starts_with(kKey))
      isolation.callbacks |= word.substr(kKey.size()) == "all" ||
                             cpu_list_holds(std::string_view(word).substr(kKey.size()), cpu);
  isolation.callbacks |= isolation.tick;
  return isolation;
}

std::optional<RealTimeLimit> real_time_limit(const fs::path& root) {
  const auto folder = root / "proc/sys/kernel";
  const auto runtime = number(first_line(folder / "sched_rt_runtime_us"));
  const auto period = number(first_line(folder / "sched_rt_period_us"));
  if (!runtime || !period) return std::nullopt;
  return RealTimeLimit{*runtime, *period};
}

}  // namespace sandhopper
