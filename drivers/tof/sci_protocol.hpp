#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// The serial protocol of the AFBR-S50's companion controller (Broadcom's ExplorerApp): 0x02, command,
// payload, CRC-8, 0x03; 0x02, 0x03 and 0x1B inside are sent as 0x1B and the complement; numbers big-endian.
// CRC: polynomial 0x1D, initial 0, over command and payload before escaping.
namespace sandhopper {

inline constexpr std::uint8_t kSciStart = 0x02;
inline constexpr std::uint8_t kSciStop = 0x03;
inline constexpr std::uint8_t kSciEscape = 0x1B;
inline constexpr std::uint8_t kSciAddressed = 0x80;  // flag in the command: a device address follows

enum class SciCommand : std::uint8_t {
  ping = 0x01,
  acknowledge = 0x0A,
  refuse = 0x0B,
  start = 0x11,
  stop = 0x12,
  measurement_1d = 0x36,
  output_mode = 0x41,
  frame_time = 0x43,
  dual_frequency_mode = 0x44,
  smart_power_save = 0x45,
};

inline constexpr std::uint8_t kSciOutputMode1d = 7;

struct SciFrame {
  SciCommand command{};
  std::optional<std::uint8_t> address;
  std::span<const std::uint8_t> payload;  // valid until the parser's next byte
};

std::uint8_t sci_crc(std::span<const std::uint8_t> bytes) noexcept;

// The bytes of one frame on the wire.
std::vector<std::uint8_t> sci_encode(SciCommand command, std::span<const std::uint8_t> payload = {},
                                     std::optional<std::uint8_t> address = std::nullopt);

// Parses byte by byte. After noise, a lost byte or a broken frame it synchronises at the next start byte.
class SciParser {
 public:
  // The frame that this byte completes, if any.
  std::optional<SciFrame> feed(std::uint8_t byte) noexcept;

  std::uint32_t broken_frames() const noexcept { return broken_frames_; }  // CRC, escape or length wrong

 private:
  void begin() noexcept;
  std::optional<SciFrame> finish() noexcept;
  void abandon() noexcept;

  enum class State : std::uint8_t { between, inside, escaped };
  State state_ = State::between;
  std::array<std::uint8_t, 512> bytes_{};
  std::size_t size_ = 0;
  std::uint32_t broken_frames_ = 0;
};

// A range measurement. status 0: good, > 0 warning, < 0 error.
struct SciMeasurement {
  std::int16_t status = 0;
  std::int64_t device_time_ns = 0;  // time on the companion's clock, in steps of 16 us
  double range_m = 0.0;
  double amplitude = 0.0;
  std::uint8_t quality = 0;
};

std::optional<SciMeasurement> decode_measurement_1d(const SciFrame& frame) noexcept;
std::vector<std::uint8_t> encode_measurement_1d(const SciMeasurement& measurement);  // for emulators

// Acknowledgement or refusal of `command`.
struct SciAnswer {
  SciCommand command{};
  bool accepted = false;
  std::int16_t reason = 0;
};
std::optional<SciAnswer> decode_answer(const SciFrame& frame) noexcept;

}  // namespace sandhopper
