#include "tools/virtual_bench/afbr_companion.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace sandhopper::bench {
namespace {

constexpr std::uint8_t kAcknowledge = 0x0A, kRefuse = 0x0B;
constexpr std::uint8_t kPing = 0x01, kReset = 0x08, kVersion = 0x0C;
constexpr std::uint8_t kSingleShot = 0x10, kStartMeasuring = 0x11, kStopMeasuring = 0x12, kAbort = 0x13;
constexpr std::uint8_t kCalibrate = 0x18, kInitialise = 0x19;
constexpr std::uint8_t kOutputMode = 0x41, kMeasurementMode = 0x42, kFrameTime = 0x43, kDualFrequency = 0x44,
                       kPowerSave = 0x45, kBaud = 0x59;
constexpr std::uint8_t k1DResult = 0xB6;

// Numbers on this wire have their high byte first.
void append(std::vector<std::uint8_t>& out, std::uint32_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint32_t number(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (const auto byte : bytes) value = value << 8 | byte;
  return value;
}

void make_raw(int fd) {
  termios settings{};
  if (::tcgetattr(fd, &settings) != 0) return;
  ::cfmakeraw(&settings);
  ::tcsetattr(fd, TCSANOW, &settings);
}

}  // namespace

AfbrCompanion::AfbrCompanion(EventLoop& loop, const TofConfig& config, double world_rate_Hz)
    : loop_(loop),
      config_(config),
      rate_(world_rate_Hz),
      controller_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
  if (!controller_ || ::grantpt(controller_.get()) != 0 || ::unlockpt(controller_.get()) != 0)
    throw std::runtime_error("no pseudo-terminal for " + config.device + ": is devpts mounted?");
  const std::string terminal = ::ptsname(controller_.get());
  terminal_ = UniqueFd(::open(terminal.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  make_raw(terminal_.get());
  std::filesystem::remove(config.device);
  std::filesystem::create_symlink(terminal, config.device);
  loop_.watch(controller_.get(), [this] { receive(); });
}

AfbrCompanion::~AfbrCompanion() { loop_.forget(controller_.get()); }

void AfbrCompanion::receive() {
  std::uint8_t bytes[256];
  const auto count = ::read(controller_.get(), bytes, sizeof bytes);
  if (count <= 0) return;
  for (const auto& request : decoder_.take({bytes, static_cast<std::size_t>(count)})) answer(request);
}

void AfbrCompanion::answer(const SciMessage& request) {
  const auto command = request.command;
  switch (command) {
    case kSingleShot:
      single_shot_ = true;
      break;
    case kStartMeasuring:
      streaming_ = true;
      break;
    case kReset:
    case kInitialise:
      frame_time_s_ = 0.1;
      [[fallthrough]];
    case kStopMeasuring:
    case kAbort:
      streaming_ = single_shot_ = false;
      break;
    case kFrameTime:
      if (request.parameters.size() != 4) return refuse(command);
      frame_time_s_ = number(request.parameters) * 1e-6;
      break;
    case kOutputMode: {
      constexpr std::uint8_t kOneDimensional = 7;
      if (request.parameters.size() != 1 || request.parameters[0] != kOneDimensional) return refuse(command);
      break;
    }
    case kVersion:
      return acknowledge(command, {1, 0, 0});
    case kPing:
    case kCalibrate:
    case kMeasurementMode:
    case kDualFrequency:
    case kPowerSave:
    case kBaud:
      break;
    default:
      return refuse(command);
  }
  acknowledge(command);
}

void AfbrCompanion::acknowledge(std::uint8_t command, std::vector<std::uint8_t> data) {
  data.insert(data.begin(), command);
  send({kAcknowledge, std::move(data)});
}

void AfbrCompanion::refuse(std::uint8_t command) {
  constexpr std::uint8_t kNotSupported = 0xFF;
  send({kRefuse, {command, 0xFF, kNotSupported}});
}

void AfbrCompanion::complete(const TofSample& sample) {
  if (!rate_.takes_next(streaming_ ? 1.0 / frame_time_s_ : 0.0) && !single_shot_) return;
  single_shot_ = false;
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  constexpr std::int64_t kTick_ns = 16'000;
  const double range_m = sample.height_m - config_.mount_offset_m;
  const auto range = static_cast<std::int32_t>(std::lround(range_m * 16384.0));  // Q9.14
  std::vector<std::uint8_t> data{0};                                             // device's address
  append(data, static_cast<std::uint16_t>(sample.status), 2);
  append(data, static_cast<std::uint32_t>(sample.time_ns / kSecond_ns), 4);
  append(data, static_cast<std::uint32_t>(sample.time_ns % kSecond_ns / kTick_ns), 2);
  append(data, 0, 4);  // state: none of the warnings
  append(data, static_cast<std::uint32_t>(range), 3);
  append(data, static_cast<std::uint32_t>(std::lround(std::clamp(sample.amplitude, 0.0, 4095.0) * 16.0)), 2);
  data.push_back(sample.quality);
  send({k1DResult, std::move(data)});
}

void AfbrCompanion::send(const SciMessage& message) {
  const auto bytes = encode_sci(message);
  // Nobody reads: the terminal is full and the frame is lost, as on a wire.
  [[maybe_unused]] const auto written = ::write(controller_.get(), bytes.data(), bytes.size());
}

}  // namespace sandhopper::bench
