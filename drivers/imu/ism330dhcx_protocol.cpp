#include "drivers/imu/ism330dhcx_protocol.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper::ism330dhcx {

namespace {

constexpr double kStandardGravity_mps2 = 9.80665;

struct Code {
  int value;
  std::uint8_t code;
};

template <std::size_t N>
std::uint8_t code_of(const std::array<Code, N>& table, int value) noexcept {
  const auto found = std::ranges::find(table, value, &Code::value);
  return found == table.end() ? table[0].code : found->code;
}

constexpr std::array<Code, 5> kRates{{{416, 6}, {833, 7}, {1666, 8}, {3332, 9}, {6667, 10}}};
constexpr std::array<Code, 4> kAccelRanges{{{2, 0}, {16, 1}, {4, 2}, {8, 3}}};
constexpr std::array<Code, 6> kGyroRanges{
    {{250, 0x0}, {125, 0x2}, {500, 0x4}, {1000, 0x8}, {2000, 0xC}, {4000, 0x1}}};
constexpr std::array<Code, 8> kLowpass{
    {{4, 0}, {10, 1}, {20, 2}, {45, 3}, {100, 4}, {200, 5}, {400, 6}, {800, 7}}};

constexpr std::uint8_t byte(unsigned value) { return static_cast<std::uint8_t>(value); }

std::int16_t word(std::span<const std::uint8_t, kBurstSize> bytes, std::size_t at) noexcept {
  return static_cast<std::int16_t>(bytes[at] | (bytes[at + 1] << 8));
}

using Vector = std::array<double, 3>;

// The rows of `mount` are the robot's axes in the sensor's frame: the matrix transforms sensor to robot, its
// transpose robot to sensor.
Vector to_robot(const std::array<double, 9>& mount, const Vector& sensor) noexcept {
  Vector out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) out[i] += mount[3 * i + k] * sensor[k];
  return out;
}

Vector to_sensor(const std::array<double, 9>& mount, const Vector& robot) noexcept {
  Vector out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) out[k] += mount[3 * i + k] * robot[i];
  return out;
}

Vector scaled(const std::array<std::int16_t, 3>& counts, double unit) noexcept {
  return {counts[0] * unit, counts[1] * unit, counts[2] * unit};
}

}  // namespace

std::vector<RegisterValue> settings_of(const ImuConfig& c) {
  const unsigned rate = unsigned{code_of(kRates, c.rate_Hz)} << 4U;
  const unsigned lowpass_on = c.accel_lowpass_divisor == 2 ? 0x00U : 0x02U;
  const unsigned lowpass =
      c.accel_lowpass_divisor == 2 ? 0x00U : unsigned{code_of(kLowpass, c.accel_lowpass_divisor)} << 5U;
  return {
      {kCtrl3C, 0x44},       // BDU, IF_INC
      {kCtrl4C, 0x0E},       // DRDY_MASK, I2C off, gyro LPF1 on
      {kCtrl9Xl, 0xE2},      // DEVICE_CONF
      {kCounterBdr1, 0x80},  // data-ready as a pulse per sample
      {kCtrl6C, byte(static_cast<unsigned>(c.gyro_lowpass_code) & 0x7U)},
      {kCtrl7G, 0x00},
      {kCtrl8Xl, byte(lowpass)},
      {kInt1Ctrl, 0x01},  // DRDY_XL
      {kCtrl2G, byte(rate | code_of(kGyroRanges, c.gyro_range_dps))},
      {kCtrl1Xl, byte(rate | (unsigned{code_of(kAccelRanges, c.accel_range_g)} << 2U) | lowpass_on)},
  };
}

Burst decode_burst(std::span<const std::uint8_t, kBurstSize> bytes) noexcept {
  Burst out;
  out.status = bytes[0];
  out.temperature_C = 25.0 + word(bytes, 2) / 256.0;
  for (std::size_t i = 0; i < 3; ++i) {
    out.gyro[i] = word(bytes, 4 + 2 * i);
    out.accel[i] = word(bytes, 10 + 2 * i);
  }
  return out;
}

std::array<std::uint8_t, kBurstSize> encode_burst(const Burst& burst) noexcept {
  std::array<std::uint8_t, kBurstSize> out{};
  const auto put = [&](std::size_t at, std::int16_t value) {
    out[at] = byte(static_cast<std::uint16_t>(value) & 0xFFU);
    out[at + 1] = byte(static_cast<unsigned>(static_cast<std::uint16_t>(value)) >> 8U);
  };
  out[0] = burst.status;
  put(2, static_cast<std::int16_t>(std::lround((burst.temperature_C - 25.0) * 256.0)));
  for (std::size_t i = 0; i < 3; ++i) {
    put(4 + 2 * i, burst.gyro[i]);
    put(10 + 2 * i, burst.accel[i]);
  }
  return out;
}

double accel_mps2_per_count(int range_g) noexcept { return range_g / 2.0 * 0.061e-3 * kStandardGravity_mps2; }

double gyro_radps_per_count(int range_dps) noexcept {
  return range_dps / 125.0 * 4.375e-3 * std::numbers::pi / 180.0;
}

Vector calibrated_accel_mps2(const Vector& raw, const ImuConfig& config) noexcept {
  Vector sensor{};
  for (std::size_t k = 0; k < 3; ++k)
    sensor[k] = config.accel_scale[k] * (raw[k] - config.accel_bias_mps2[k]);
  return to_robot(config.mount, sensor);
}

Vector calibrated_gyro_radps(const Vector& raw, const ImuConfig& config) noexcept {
  Vector sensor{};
  for (std::size_t k = 0; k < 3; ++k) sensor[k] = raw[k] - config.gyro_bias_radps[k];
  return to_robot(config.mount, sensor);
}

Vector raw_accel_mps2(const Vector& robot, const ImuConfig& config) noexcept {
  auto sensor = to_sensor(config.mount, robot);
  for (std::size_t k = 0; k < 3; ++k)
    sensor[k] = sensor[k] / config.accel_scale[k] + config.accel_bias_mps2[k];
  return sensor;
}

Vector raw_gyro_radps(const Vector& robot, const ImuConfig& config) noexcept {
  auto sensor = to_sensor(config.mount, robot);
  for (std::size_t k = 0; k < 3; ++k) sensor[k] += config.gyro_bias_radps[k];
  return sensor;
}

ImuSample to_sample(const Burst& burst, const ImuConfig& config) noexcept {
  ImuSample out;
  out.accel_mps2 =
      calibrated_accel_mps2(scaled(burst.accel, accel_mps2_per_count(config.accel_range_g)), config);
  out.gyro_radps =
      calibrated_gyro_radps(scaled(burst.gyro, gyro_radps_per_count(config.gyro_range_dps)), config);
  out.fresh = true;
  return out;
}

double actual_rate_Hz(const ImuConfig& config, std::int8_t trim) noexcept {
  return config.rate_Hz * (1.0 + 0.0015 * trim);
}

}  // namespace sandhopper::ism330dhcx
