// Fuzz target of the SPI and I2C sensors: burst of the ISM330DHCX, registers of the ADS1115.
#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/adc/ads1115.hpp"
#include "drivers/device_error.hpp"
#include "drivers/imu/ism330dhcx_protocol.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;

// A device with arbitrary answers, or none.
class AnyBus final : public I2cBus {
 public:
  explicit AnyBus(fuzz::Bytes bytes) : bytes_(bytes) {}
  bool write(std::uint8_t, std::span<const std::uint8_t> bytes) noexcept override {
    if (bytes.size() == 3) written_ = {bytes[1], bytes[2]};
    return bytes_.byte() < 0xF0;
  }
  bool read(std::uint8_t, std::span<std::uint8_t> bytes) noexcept override {
    const std::uint8_t choice = bytes_.byte();
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = choice < 0x80 && i < written_.size() ? written_[i] : bytes_.byte();
    return choice < 0xF0;
  }

 private:
  fuzz::Bytes bytes_;
  std::array<std::uint8_t, 2> written_{};
};

void imu(fuzz::Bytes bytes) {
  std::array<std::uint8_t, ism330dhcx::kBurstSize> burst{};
  const fuzz::Input input = bytes.take(burst.size());
  std::copy(input.begin(), input.end(), burst.begin());
  const auto decoded = ism330dhcx::decode_burst(burst);
  const auto again = ism330dhcx::decode_burst(ism330dhcx::encode_burst(decoded));
  fuzz::require(again.status == decoded.status && again.gyro == decoded.gyro && again.accel == decoded.accel,
                "a burst encoded again is the same");
  const ImuSample sample = ism330dhcx::to_sample(decoded, ImuConfig{});
  for (const double a : sample.accel_mps2) fuzz::require(std::isfinite(a), "an acceleration is a number");
  fuzz::require(
      std::isfinite(ism330dhcx::actual_rate_Hz(ImuConfig{}, static_cast<std::int8_t>(bytes.byte()))),
      "a rate is a number");
}

void adc(fuzz::Bytes bytes) {
  LoadCellConfig config;
  config.range = static_cast<AdcRange>(bytes.byte() % EnumNames<AdcRange>::value.size());
  AnyBus bus(bytes);
  Ads1115 converter("load cell", bus, config);
  try {
    converter.start();
  } catch (const DeviceError&) {
    return;
  }
  for (int i = 0; i < 8; ++i) {
    std::int16_t counts = 0;
    if (!converter.read(counts)) continue;
    const double force_N = load_cell_force_N(config, counts);
    const double limit_N =
        config.scale_N_per_V * (ads1115_full_scale_V(config.range) + std::abs(config.zero_V));
    fuzz::require(std::abs(force_N) <= limit_N * (1.0 + 1e-9), "a force is within the converter's range");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  imu(fuzz::Bytes({data, size}));
  adc(fuzz::Bytes({data, size}));
  return 0;
}
