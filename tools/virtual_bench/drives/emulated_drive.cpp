#include "tools/virtual_bench/drives/emulated_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/virtual_bench/drives/mit_drive.hpp"
#include "tools/virtual_bench/drives/servo_drive.hpp"

namespace sandhopper::bench {
namespace {

constexpr double kTemperature_C = 30.0;
constexpr double kBusVoltage_V = 36.0;

double known(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

}  // namespace

std::unique_ptr<EmulatedDrive> make_drive(const CubeMarsConfig& config, EmulatedDrive::Wiring wiring) {
  if (config.dialect == Dialect::mit) return std::make_unique<MitDrive>(config, std::move(wiring));
  return std::make_unique<ServoDrive>(config, std::move(wiring));
}

OutputState output_state(const CubeMarsConfig& config, const MotorSample& link) {
  const double to_drive = config.sign * config.gear_ratio;
  return {.position_rad = to_drive * (link.position_rad - config.zero_offset_rad),
          .velocity_radps = to_drive * link.velocity_radps,
          .torque_Nm = config.sign * link.current_A * config.drive_torque_constant_Nm_per_A,
          .current_A = config.sign * link.current_A,
          .temperature_C = known(link.temperature_C, kTemperature_C),
          .bus_voltage_V = std::min(known(link.bus_voltage_V, kBusVoltage_V), kBusVoltage_V),
          .error_code = link.error_code};
}

std::uint64_t bits_of(const can_frame& frame) {
  std::uint64_t bits = 0;
  for (const auto byte : frame.data) bits = bits << 8 | byte;
  return bits;
}

double decoded(std::uint64_t bits, int shift, int width, double low, double high) {
  const auto largest = (std::uint64_t{1} << width) - 1;
  return low + static_cast<double>(bits >> shift & largest) * (high - low) / static_cast<double>(largest);
}

std::uint64_t encoded(double value, int width, double low, double high) {
  const auto largest = static_cast<double>((std::uint64_t{1} << width) - 1);
  const double share = std::isfinite(value) ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0.0;
  return static_cast<std::uint64_t>(share * largest);
}

}  // namespace sandhopper::bench
