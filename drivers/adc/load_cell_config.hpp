#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "config/fields.hpp"
#include "drivers/gpio/line_config.hpp"

namespace sandhopper {

// Measured inputs of the ADS1115, in the order of its MUX field.
enum class AdcInput : std::uint8_t { a0_a1, a0_a3, a1_a3, a2_a3, a0, a1, a2, a3 };
template <>
struct EnumNames<AdcInput> {
  static constexpr std::array<std::string_view, 8> value{"a0_a1", "a0_a3", "a1_a3", "a2_a3",
                                                         "a0",    "a1",    "a2",    "a3"};
};

// Full scale, in the order of the PGA field. The inputs must stay within the supply voltage at every range.
enum class AdcRange : std::uint8_t { v6_144, v4_096, v2_048, v1_024, v0_512, v0_256 };
template <>
struct EnumNames<AdcRange> {
  static constexpr std::array<std::string_view, 6> value{"6.144V", "4.096V", "2.048V",
                                                         "1.024V", "0.512V", "0.256V"};
};

// Conversions per second, in the order of the DR field.
enum class AdcRate : std::uint8_t { sps8, sps16, sps32, sps64, sps128, sps250, sps475, sps860 };
template <>
struct EnumNames<AdcRate> {
  static constexpr std::array<std::string_view, 8> value{"8SPS",   "16SPS",  "32SPS",  "64SPS",
                                                         "128SPS", "250SPS", "475SPS", "860SPS"};
};

// The load cell's converter: an ADS1115 behind an amplifier, or one with a driver of the kernel (IIO).
enum class LoadCellConverter : std::uint8_t { ads1115, iio };
template <>
struct EnumNames<LoadCellConverter> {
  static constexpr std::array<std::string_view, 2> value{"ads1115", "iio"};
};

// An HX711 (10 or 80 conversions a second) or NAU7802 (10 to 320) as an IIO device of the kernel, which holds
// its gain and rate.
struct IioConverterConfig {
  std::string device = "/sys/bus/iio/devices/iio:device0";
  int channel = 0;
  double rate_Hz = 80.0;  // at which the converter is set up

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("device", self.device);
    visit("channel", self.channel, Range{0, 15});
    visit("rate_Hz", self.rate_Hz, Range{10.0, 320.0});
  }
};

// The foot's load cell. Force = sign . scale . (voltage - zero). `device` to `rate` are the ADS1115's; an IIO
// converter has [load_cell.iio] besides and does not use them.
struct LoadCellConfig {
  std::optional<LoadCellConverter> converter = LoadCellConverter::ads1115;  // left out: ads1115
  std::string device = "/dev/i2c-1";
  int address = 0x48;
  LineConfig ready{.chip = "", .line = "", .active_low = true};  // ALERT/RDY: a falling edge per conversion
  AdcInput input = AdcInput::a0_a1;
  AdcRange range = AdcRange::v4_096;
  AdcRate rate = AdcRate::sps860;
  double scale_N_per_V = 100.0;
  double zero_V = 0.0;
  int sign = 1;  // chosen so that compression is positive
  // From the middle of a conversion's averaging time to its ready edge: half a conversion plus the
  // amplifier's delay.
  double latency_s = 0.00058;
  int thread_priority = 55;  // SCHED_FIFO; 0: ordinary scheduling
  std::optional<IioConverterConfig> iio{};

  bool is_iio() const noexcept { return converter == LoadCellConverter::iio; }

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("converter", self.converter);
    visit("device", self.device);
    visit("address", self.address, Range{0x48, 0x4B});
    visit("ready", self.ready);
    visit("input", self.input);
    visit("range", self.range);
    visit("rate", self.rate);
    visit("scale_N_per_V", self.scale_N_per_V, Range{1e-3, 1e6});
    visit("zero_V", self.zero_V, Range{-6.144, 6.144});
    visit("sign", self.sign, Range{-1, 1});
    visit("latency_s", self.latency_s, Range{0, 0.1});
    visit("thread_priority", self.thread_priority, Range{0, 98});
    visit("iio", self.iio);
  }

  template <class Problem>
  void check(Problem&& problem) const {
    if (sign == 0) problem("sign", "must be 1 or -1");
    if (is_iio() && !iio)
      problem("converter", "\"iio\" needs a table [load_cell.iio] with device, channel and rate_Hz");
    if (!is_iio() && iio)
      problem("iio", "is not used by an ADS1115: write converter = \"iio\", or take the table out");
    if (!is_iio() && !ready.fitted())
      problem("ready",
              "chip and line of the ADS1115's ALERT/RDY pin must be given: its conversions cannot be timed "
              "without it");
  }
};

}  // namespace sandhopper
