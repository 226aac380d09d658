#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/imu/imu_config.hpp"
#include "drivers/samples.hpp"

// Registers of the ISM330DHCX and the layout of their bytes. Source: ST's ism330dhcx_reg.h and the kernel's
// st_lsm6dsx.
namespace sandhopper::ism330dhcx {

inline constexpr std::uint8_t kFuncCfgAccess = 0x01;
inline constexpr std::uint8_t kFifoCtrl4 = 0x0A;
inline constexpr std::uint8_t kCounterBdr1 = 0x0B;
inline constexpr std::uint8_t kInt1Ctrl = 0x0D;
inline constexpr std::uint8_t kWhoAmI = 0x0F;
inline constexpr std::uint8_t kCtrl1Xl = 0x10;
inline constexpr std::uint8_t kCtrl2G = 0x11;
inline constexpr std::uint8_t kCtrl3C = 0x12;
inline constexpr std::uint8_t kCtrl4C = 0x13;
inline constexpr std::uint8_t kCtrl6C = 0x15;
inline constexpr std::uint8_t kCtrl7G = 0x16;
inline constexpr std::uint8_t kCtrl8Xl = 0x17;
inline constexpr std::uint8_t kCtrl9Xl = 0x18;
inline constexpr std::uint8_t kStatus = 0x1E;
inline constexpr std::uint8_t kInternalFreqFine = 0x63;

inline constexpr std::uint8_t kWhoAmIValue = 0x6B;  // other parts of the family have the same value
inline constexpr std::uint8_t kSoftwareReset = 0x01;
inline constexpr std::uint8_t kReboot = 0x80;
inline constexpr std::uint8_t kAccelReady = 0x01;
inline constexpr std::uint8_t kReadFlag = 0x80;  // of the address byte on SPI

struct RegisterValue {
  std::uint8_t address;
  std::uint8_t value;
};

// Register writes after reset, in this order: block data update, SPI only, pulsed data-ready of the
// accelerometer on INT1 held back until the filters have settled, rates, ranges and filters as configured,
// high-performance mode.
std::vector<RegisterValue> settings_of(const ImuConfig& config);

// STATUS to OUTZ_H_A (1E..2D) in one burst: status, reserved, temperature, gyro, accelerometer.
inline constexpr std::size_t kBurstSize = 16;
struct Burst {
  std::uint8_t status = 0;
  double temperature_C = 0.0;
  std::array<std::int16_t, 3> gyro{};
  std::array<std::int16_t, 3> accel{};

  bool accel_ready() const noexcept { return (status & kAccelReady) != 0; }
};
Burst decode_burst(std::span<const std::uint8_t, kBurstSize> bytes) noexcept;
std::array<std::uint8_t, kBurstSize> encode_burst(const Burst& burst) noexcept;  // for emulators

// Datasheet sensitivities. Accelerometer: 0.061 mg per count at 2 g, proportional to the range. Gyro: 4.375
// mdps at 125 dps, proportional to the range (full scale is larger than the range: 250 dps spans 286.7).
double accel_mps2_per_count(int range_g) noexcept;
double gyro_radps_per_count(int range_dps) noexcept;

// Converts between the sensor's own axes and the robot's frame, with the configured scale, biases and
// mounting.
std::array<double, 3> calibrated_accel_mps2(const std::array<double, 3>& raw,
                                            const ImuConfig& config) noexcept;
std::array<double, 3> calibrated_gyro_radps(const std::array<double, 3>& raw,
                                            const ImuConfig& config) noexcept;
std::array<double, 3> raw_accel_mps2(const std::array<double, 3>& robot, const ImuConfig& config) noexcept;
std::array<double, 3> raw_gyro_radps(const std::array<double, 3>& robot, const ImuConfig& config) noexcept;

// Specific force and angular rate in the robot's frame. The caller sets time and count.
ImuSample to_sample(const Burst& burst, const ImuConfig& config) noexcept;

// Actual output rate: nominal x (1 + 0.15 % x trim), trim from INTERNAL_FREQ_FINE.
double actual_rate_Hz(const ImuConfig& config, std::int8_t trim) noexcept;

}  // namespace sandhopper::ism330dhcx
