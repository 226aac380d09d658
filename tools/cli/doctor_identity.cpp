#include <algorithm>

#include "drivers/device_error.hpp"
#include "firmware/instance_lock.hpp"
#include "firmware/linux_board.hpp"
#include "tools/cli/doctor.hpp"

namespace sandhopper::cli {
namespace {

// Text for a device without a problem.
struct Named {
  std::string_view device;
  std::string_view what;
  std::string_view found;
};
constexpr std::array<Named, 6> kNames{
    {{"imu_body", "imu_body identity", "ISM330DHCX answers and takes its settings"},
     {"imu_foot", "imu_foot identity", "ISM330DHCX answers and takes its settings"},
     {"load_cell", "load_cell converter", "ADS1115 answers and keeps its settings"},
     {"tof", "tof controller", "answers and takes its settings"},
     {"can", "can socket", "opens"},
     {"motors", "motors", "answer in their dialect"}}};

// True if a finding of this device has failed already, for example "imu_body.device /dev/spidev0.0". Its
// identity would fail for the same reason.
bool known_red(const std::vector<Finding>& known, std::string_view device) {
  return std::ranges::any_of(known, [&](const Finding& f) {
    return f.health == Health::fail && f.what.starts_with(device) && f.what.size() > device.size() &&
           f.what[device.size()] == '.';
  });
}

Finding finding_of(const DeviceReport& report, const Named& named) {
  const std::string what(named.what);
  if (report.problem.empty()) return {Health::ok, what, std::string(named.found), ""};
  // report.problem holds both, as "device: cause. Cure".
  const auto end = report.problem.find(". ");
  if (end == std::string::npos) return {Health::fail, what, report.problem, "put it right and look again"};
  return {Health::fail, what, report.problem.substr(0, end), report.problem.substr(end + 2)};
}

}  // namespace

std::vector<Finding> examine_identities(const LinuxBoardConfig& board, const std::vector<Finding>& known) {
  const bool no_bus = known_red(known, "can");
  std::unique_ptr<InstanceLock> lock;
  try {
    if (!no_bus) lock = std::make_unique<InstanceLock>(board.can.interface);
  } catch (const DeviceError& error) {
    return {{Health::warn, "identities", "not looked at: " + error.cause(), "end hopperd and look again"}};
  }
  auto gentle = board;
  gentle.body_catch.line.clear();  // a check must not switch the magnet
  BusListener listener(board.can.interface);
  std::vector<Finding> out;
  for (const auto& report : sandhopper::examine_devices(gentle)) {
    const auto named = std::ranges::find(kNames, report.device, &Named::device);
    if (named == kNames.end() || known_red(known, report.device)) continue;
    out.push_back(finding_of(report, *named));
  }
  if (!no_bus) out.push_back(listener.seen(board.can));
  return out;
}

}  // namespace sandhopper::cli
