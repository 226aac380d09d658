#include "tools/virtual_bench/ism330dhcx.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper::bench {
namespace {

constexpr std::uint8_t kFuncCfgAccess = 0x01;
constexpr std::uint8_t kCounterBdr1 = 0x0B;
constexpr std::uint8_t kInt1Ctrl = 0x0D;
constexpr std::uint8_t kWhoAmI = 0x0F;
constexpr std::uint8_t kCtrl1Accel = 0x10;
constexpr std::uint8_t kCtrl2Gyro = 0x11;
constexpr std::uint8_t kCtrl3 = 0x12;
constexpr std::uint8_t kCtrl9 = 0x18;
constexpr std::uint8_t kCtrl10 = 0x19;
constexpr std::uint8_t kStatus = 0x1E;
constexpr std::uint8_t kOutTemperature = 0x20;
constexpr std::uint8_t kOutGyro = 0x22;
constexpr std::uint8_t kOutAccel = 0x28;
constexpr std::uint8_t kOutEnd = 0x2E;
constexpr std::uint8_t kFifoStatus1 = 0x3A;
constexpr std::uint8_t kTimestamp0 = 0x40;
constexpr std::uint8_t kTimestamp2 = 0x42;
constexpr std::uint8_t kTimestamp3 = 0x43;
constexpr std::uint8_t kFrequencyFine = 0x63;
constexpr std::uint8_t kFifoData = 0x78;

constexpr std::uint8_t kReset = 0x01, kAutoIncrement = 0x04, kActiveLow = 0x20;  // of CTRL3_C
constexpr std::uint8_t kTimestampOn = 0x20;                                      // of CTRL10_C
constexpr std::uint8_t kPulsed = 0x80;                                           // of COUNTER_BDR_REG1
constexpr std::uint8_t kAccelReady = 0x01, kGyroReady = 0x02, kTemperatureReady = 0x04;

constexpr std::int64_t kResetTime_ns = 50'000;
constexpr std::int64_t kTimestampUnit_ns = 25'000;
constexpr double kTemperature_C = 30.0;
constexpr double kStandardGravity_mps2 = 9.80665;

// By the ODR field. 11 is an accelerometer-only low-power rate.
constexpr std::array kRate_Hz{0.0,    12.5,   26.0,   52.0, 104.0, 208.0, 416.0, 833.0,
                              1666.0, 3332.0, 6667.0, 1.6,  0.0,   0.0,   0.0,   0.0};

std::uint8_t low_byte(std::uint32_t value) { return static_cast<std::uint8_t>(value & 0xFF); }

bool is_read_only(std::uint8_t address) {
  return address == kWhoAmI || address == kStatus || (address >= kOutTemperature && address < kOutEnd) ||
         address == kFifoStatus1 || address == kFifoStatus1 + 1 || address == kFrequencyFine ||
         address >= kFifoData;
}

}  // namespace

Ism330dhcx::Ism330dhcx(const Wiring& wiring, const ImuConfig& config, double world_rate_Hz)
    : wiring_(wiring), config_(config), accel_rate_(world_rate_Hz), gyro_rate_(world_rate_Hz) {
  reset();
}

void Ism330dhcx::reset() {
  register_.fill(0);
  register_[kWhoAmI] = 0x6B;
  register_[kCtrl3] = kAutoIncrement;
  register_[kCtrl9] = 0xE0;
  const auto temperature = static_cast<std::int16_t>(std::lround((kTemperature_C - 25.0) * 256.0));
  register_[kOutTemperature] = low_byte(static_cast<std::uint16_t>(temperature));
  register_[kOutTemperature + 1] = low_byte(static_cast<std::uint16_t>(temperature) >> 8);
  show_data_ready(false);
}

double Ism330dhcx::accel_unit_mps2() const noexcept {
  constexpr std::array kUnit_mg{0.061, 0.488, 0.122, 0.244};  // 2, 16, 4, 8 g
  return kUnit_mg[(register_[kCtrl1Accel] >> 2) & 3] * 1e-3 * kStandardGravity_mps2;
}

double Ism330dhcx::gyro_unit_radps() const noexcept {
  constexpr double kUnitOf250_mdps = 8.75;
  const auto field = register_[kCtrl2Gyro];
  double unit_mdps = kUnitOf250_mdps * (1 << ((field >> 2) & 3));
  if ((field & 0x02) != 0) unit_mdps = kUnitOf250_mdps / 2;   // 125 deg/s
  if ((field & 0x01) != 0) unit_mdps = kUnitOf250_mdps * 16;  // 4000 deg/s
  return unit_mdps * 1e-3 * std::numbers::pi / 180.0;
}

void Ism330dhcx::put(std::uint8_t address, const std::array<double, 3>& robot_axes, const Flaws& flaws,
                     double unit) {
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    double value = 0.0;  // rows of the mounting are the robot's axes: its transpose leads back
    for (std::size_t robot = 0; robot < 3; ++robot)
      value += config_.mount[3 * robot + axis] * robot_axes[robot];
    value = value / flaws.scale[axis] + flaws.bias[axis];
    const auto count = static_cast<std::int16_t>(std::lround(std::clamp(value / unit, -32768.0, 32767.0)));
    register_[address + 2 * axis] = low_byte(static_cast<std::uint16_t>(count));
    register_[address + 2 * axis + 1] = low_byte(static_cast<std::uint16_t>(count) >> 8);
  }
}

void Ism330dhcx::complete(const ImuSample& sample) {
  std::uint8_t ready = 0;
  if (accel_rate_.takes_next(kRate_Hz[register_[kCtrl1Accel] >> 4])) {
    put(kOutAccel, sample.accel_mps2, {config_.accel_scale, config_.accel_bias_mps2}, accel_unit_mps2());
    ready |= kAccelReady | kTemperatureReady;
  }
  if (gyro_rate_.takes_next(kRate_Hz[register_[kCtrl2Gyro] >> 4])) {
    put(kOutGyro, sample.gyro_radps, {{1, 1, 1}, config_.gyro_bias_radps}, gyro_unit_radps());
    ready |= kGyroReady | kTemperatureReady;
  }
  register_[kStatus] |= ready;
  if (ready != 0) show_data_ready(true);
}

void Ism330dhcx::show_data_ready(bool new_sample) {
  const bool wanted = (register_[kStatus] & register_[kInt1Ctrl] & (kAccelReady | kGyroReady)) != 0;
  const bool active_low = (register_[kCtrl3] & kActiveLow) != 0;
  if ((register_[kCounterBdr1] & kPulsed) == 0) return wiring_.data_ready.drive(wanted != active_low);
  if (new_sample && wanted) wiring_.data_ready.drive(!active_low);
  wiring_.data_ready.drive(active_low);  // of the pulse's 75 us only the edges are kept
}

std::uint32_t Ism330dhcx::timestamp() const noexcept {
  if ((register_[kCtrl10] & kTimestampOn) == 0) return 0;
  return static_cast<std::uint32_t>((wiring_.loop.now_ns() - timestamp_zero_ns_) / kTimestampUnit_ns);
}

std::uint8_t Ism330dhcx::read_register(std::uint8_t address) {
  const bool other_bank = (register_[kFuncCfgAccess] & 0xC0) != 0;
  if (other_bank && address != kFuncCfgAccess) return 0;
  if (address == kCtrl3 && wiring_.loop.now_ns() < reset_until_ns_) return register_[address] | kReset;
  if (address >= kTimestamp0 && address <= kTimestamp3)
    return low_byte(timestamp() >> (8 * (address - kTimestamp0)));
  const auto value = register_[address];
  const bool last_of_vector = address == kOutGyro + 5 || address == kOutAccel + 5;
  if (last_of_vector || address == kOutTemperature + 1) {
    register_[kStatus] &= static_cast<std::uint8_t>(~(address == kOutGyro + 5    ? kGyroReady
                                                      : address == kOutAccel + 5 ? kAccelReady
                                                                                 : kTemperatureReady));
    if ((register_[kCounterBdr1] & kPulsed) == 0) show_data_ready(false);
  }
  return value;
}

void Ism330dhcx::write_register(std::uint8_t address, std::uint8_t value) {
  const bool other_bank = (register_[kFuncCfgAccess] & 0xC0) != 0;
  if (is_read_only(address) || (other_bank && address != kFuncCfgAccess)) return;
  if (address == kCtrl3 && (value & kReset) != 0) {
    reset();
    reset_until_ns_ = wiring_.loop.now_ns() + kResetTime_ns;
    return;
  }
  if (address >= kTimestamp0 && address <= kTimestamp3) {
    if (address == kTimestamp2 && value == 0xAA) timestamp_zero_ns_ = wiring_.loop.now_ns();
    return;
  }
  if (address == kCtrl10 && (register_[kCtrl10] & kTimestampOn) == 0)
    timestamp_zero_ns_ = wiring_.loop.now_ns();
  constexpr std::uint8_t kBoot = 0x80;  // of CTRL3_C; over before it could be seen
  register_[address] = address == kCtrl3 ? static_cast<std::uint8_t>(value & ~kBoot) : value;
  if (address == kInt1Ctrl || address == kCtrl3 || address == kCounterBdr1) show_data_ready(false);
}

void Ism330dhcx::transfer(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
  std::ranges::fill(out, std::uint8_t{0xFF});
  if (in.empty()) return;
  constexpr std::uint8_t kRead = 0x80;
  const bool reads = (in[0] & kRead) != 0;
  auto address = static_cast<std::uint8_t>(in[0] & 0x7F);
  for (std::size_t i = 1; i < in.size(); ++i) {
    if (reads)
      out[i] = read_register(address);
    else
      write_register(address, in[i]);
    if ((register_[kCtrl3] & kAutoIncrement) != 0) address = static_cast<std::uint8_t>((address + 1) & 0x7F);
  }
}

}  // namespace sandhopper::bench
