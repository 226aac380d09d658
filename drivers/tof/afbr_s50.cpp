#include "drivers/tof/afbr_s50.hpp"

#include <array>
#include <cmath>
#include <string>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {

namespace {

constexpr std::int64_t kByteWait_ns = 50'000'000;
constexpr std::int64_t kAnswerWait_ns = 300'000'000;
constexpr int kTries = 3;
// Quality of a result [%]. The sensor marks an invalid result with 1; PX4's driver drops these, too. 0 means
// that the firmware gives no quality. Higher values are logged and not used.
constexpr std::uint8_t kInvalidQuality = 1;

std::string device_of(const TofConfig& config) {
  return "tof (companion controller on " + config.device + ")";
}

std::string hex(SciCommand command) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  const auto value = static_cast<unsigned>(command);
  return {'0', 'x', kDigits[value >> 4U], kDigits[value & 0xFU]};
}

}  // namespace

TofSample to_sample(const SciMeasurement& m, const TofConfig& config, std::int64_t time_ns) noexcept {
  TofSample out;
  out.time_ns = time_ns;
  out.amplitude = m.amplitude;
  out.status = m.status;
  out.quality = m.quality;
  out.fresh = true;
  const bool good = m.status == 0 && m.quality != kInvalidQuality && m.range_m >= config.range_min_m &&
                    m.range_m <= config.range_max_m;
  if (good) out.height_m = m.range_m + config.mount_offset_m;
  return out;
}

AfbrS50::AfbrS50(const TofConfig& config) : config_(config), port_(config.device, config.baud) {
  port_.discard_input();
  request(SciCommand::stop);  // it may still be measuring for an earlier user
  request(SciCommand::ping);
  const auto flag = [](bool on) {
    return std::array<std::uint8_t, 1>{static_cast<std::uint8_t>(on ? 1 : 0)};
  };
  request(SciCommand::output_mode, std::array{kSciOutputMode1d});
  request(SciCommand::dual_frequency_mode, flag(config.dual_frequency_mode));
  request(SciCommand::smart_power_save, flag(config.smart_power_save));
  const auto period_us = static_cast<std::uint32_t>(std::lround(config.frame_time_s * 1e6));
  std::array<std::uint8_t, 4> bytes{};
  for (std::size_t i = 0; i < 4; ++i)
    bytes[i] = static_cast<std::uint8_t>((period_us >> (24U - 8U * i)) & 0xFFU);
  request(SciCommand::frame_time, bytes);
  request(SciCommand::start);
}

AfbrS50::~AfbrS50() { port_.write(sci_encode(SciCommand::stop)); }

void AfbrS50::request(SciCommand command, std::span<const std::uint8_t> payload) {
  const auto bytes = sci_encode(command, payload);
  for (int i = 0; i < kTries; ++i) {
    if (!port_.write(bytes))
      throw DeviceError(device_of(config_), errno_cause("cannot write"),
                        "Plug the companion controller in again");
    const auto answer = await_answer(command);
    if (!answer) continue;
    if (answer->accepted) return;
    throw DeviceError(
        device_of(config_),
        "command " + hex(command) + " refused with code " + std::to_string(answer->reason),
        "Check tof.frame_time_s and the modes against the sensor, and the ExplorerApp's version");
  }
  throw DeviceError(
      device_of(config_), "no answer to command " + hex(command),
      "Check that the controller runs Broadcom's ExplorerApp, is powered, and that tof.baud is its own "
      "(NUCLEO-F401RE 1000000, KL46Z 115200)");
}

std::optional<SciAnswer> AfbrS50::await_answer(SciCommand command) {
  const auto deadline = monotonic_ns() + kAnswerWait_ns;
  for (auto left = kAnswerWait_ns; left > 0; left = deadline - monotonic_ns()) {
    if (!port_.wait(left)) continue;
    std::array<std::uint8_t, 64> bytes{};
    const auto count = port_.read(bytes);
    if (count == 0) {
      sleep_ns(1'000'000);
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto frame = parser_.feed(bytes[i]);
      const auto answer = frame ? decode_answer(*frame) : std::nullopt;
      if (answer && answer->command == command) return answer;
    }
  }
  return std::nullopt;
}

bool AfbrS50::acquire(TofSample& sample) noexcept {
  if (!port_.wait(kByteWait_ns)) return false;
  const auto arrival_ns = monotonic_ns();
  std::array<std::uint8_t, 512> bytes{};
  const auto count = port_.read(bytes);
  if (count == 0) {
    ++counters_.failed_transfers;
    sleep_ns(kByteWait_ns);  // if the line has failed, sleep so that the thread does not spin
    return false;
  }
  bool found = false;
  for (std::size_t i = 0; i < count; ++i) {
    const auto frame = parser_.feed(bytes[i]);
    const auto measurement = frame ? decode_measurement_1d(*frame) : std::nullopt;
    if (!measurement) continue;
    sample = to_sample(*measurement, config_, stamp(*measurement, arrival_ns));
    found = true;
  }
  counters_.invalid = parser_.broken_frames();
  return found;
}

std::int64_t AfbrS50::stamp(const SciMeasurement& m, std::int64_t arrival_ns) noexcept {
  const auto mapped =
      config_.clock == TofClock::companion ? clock_.map(m.device_time_ns, arrival_ns) : arrival_ns;
  return mapped - to_ns(config_.latency_s);
}

}  // namespace sandhopper
