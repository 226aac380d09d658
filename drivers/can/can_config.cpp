#include "drivers/can/can_config.hpp"

#include <cmath>

namespace sandhopper {
namespace {

constexpr double kBitsPerCycle = 1000.0;  // 1 Mbit/s times 1 ms

constexpr int standard_bits(int bytes) { return 55 + 10 * bytes; }
constexpr int extended_bits(int bytes) { return 80 + 10 * bytes; }

int reply_bytes(ReplyFlavour flavour) noexcept {
  if (flavour == ReplyFlavour::plain) return 6;
  return flavour == ReplyFlavour::bus_voltage ? 7 : 8;
}

double bits_per_cycle(const CubeMarsConfig& motor) noexcept {
  switch (motor.dialect) {
    case Dialect::mit:
      return standard_bits(8) + standard_bits(reply_bytes(motor.reply));
    case Dialect::servo:
      return extended_bits(4) + 1e-3 * motor.status_rate_Hz * extended_bits(8);
    case Dialect::v3:
      return 2 * extended_bits(8);
  }
  return 0.0;
}

}  // namespace

double bus_load(const CanConfig& config) noexcept {
  double bits = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(config.motor_count); ++i)
    bits += bits_per_cycle(config.motor[i]);
  return config.other_load + bits / kBitsPerCycle;
}

int in_percent(double share) noexcept { return static_cast<int>(std::lround(100.0 * share)); }

}  // namespace sandhopper
