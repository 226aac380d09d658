#include "drivers/tof/sci_protocol.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {

namespace {

constexpr unsigned kCrcPolynomial = 0x1D;
constexpr std::size_t kMeasurementSize = 18;
constexpr double kRangePerCount_m = 1.0 / 16384.0;  // Q9.14
constexpr double kAmplitudePerCount = 1.0 / 16.0;   // UQ12.4
constexpr std::int64_t kTickPerSecond_ns = 1'000'000'000;
constexpr std::int64_t kTick_ns = 16'000;

// Takes big-endian fields from the front of the bytes.
class Fields {
 public:
  explicit Fields(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint32_t take(std::size_t size) noexcept {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = (value << 8U) | bytes_[at_++];
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

void put(std::vector<std::uint8_t>& out, std::uint32_t value, std::size_t size) {
  for (std::size_t i = size; i-- > 0;) out.push_back(static_cast<std::uint8_t>((value >> (8U * i)) & 0xFFU));
}

bool needs_escape(std::uint8_t byte) noexcept {
  return byte == kSciStart || byte == kSciStop || byte == kSciEscape;
}

std::uint8_t complement(std::uint8_t byte) noexcept { return static_cast<std::uint8_t>(byte ^ 0xFFU); }

}  // namespace

std::uint8_t sci_crc(std::span<const std::uint8_t> bytes) noexcept {
  unsigned crc = 0;
  for (const auto byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit)
      crc = ((crc & 0x80U) != 0 ? (crc << 1U) ^ kCrcPolynomial : crc << 1U) & 0xFFU;
  }
  return static_cast<std::uint8_t>(crc);
}

std::vector<std::uint8_t> sci_encode(SciCommand command, std::span<const std::uint8_t> payload,
                                     std::optional<std::uint8_t> address) {
  std::vector<std::uint8_t> plain{static_cast<std::uint8_t>(command)};
  if (address) {
    plain[0] |= kSciAddressed;
    plain.push_back(*address);
  }
  plain.insert(plain.end(), payload.begin(), payload.end());
  plain.push_back(sci_crc(plain));
  std::vector<std::uint8_t> out{kSciStart};
  for (const auto byte : plain) {
    if (needs_escape(byte)) out.push_back(kSciEscape);
    out.push_back(needs_escape(byte) ? complement(byte) : byte);
  }
  out.push_back(kSciStop);
  return out;
}

std::optional<SciFrame> SciParser::feed(std::uint8_t byte) noexcept {
  if (byte == kSciStart) {
    if (state_ != State::between) ++broken_frames_;
    begin();
    return std::nullopt;
  }
  if (state_ == State::between) return std::nullopt;
  if (byte == kSciStop) return finish();
  if (byte == kSciEscape && state_ == State::inside) {
    state_ = State::escaped;
    return std::nullopt;
  }
  const bool was_escaped = state_ == State::escaped;
  const auto plain = was_escaped ? complement(byte) : byte;
  if (size_ == bytes_.size() || (was_escaped && !needs_escape(plain))) {
    abandon();
    return std::nullopt;
  }
  state_ = State::inside;
  bytes_[size_++] = plain;
  return std::nullopt;
}

void SciParser::begin() noexcept {
  state_ = State::inside;
  size_ = 0;
}

void SciParser::abandon() noexcept {
  state_ = State::between;
  ++broken_frames_;
}

std::optional<SciFrame> SciParser::finish() noexcept {
  const auto all = std::span<const std::uint8_t>(bytes_).first(size_);
  const bool addressed = size_ > 0 && (all[0] & kSciAddressed) != 0;
  const std::size_t head = addressed ? 2 : 1;
  if (state_ == State::escaped || size_ < head + 1 || sci_crc(all.first(size_ - 1)) != all.back()) {
    abandon();
    return std::nullopt;
  }
  state_ = State::between;
  SciFrame frame;
  frame.command = static_cast<SciCommand>(all[0] & ~kSciAddressed);
  if (addressed) frame.address = all[1];
  frame.payload = all.subspan(head, size_ - head - 1);
  return frame;
}

std::optional<SciMeasurement> decode_measurement_1d(const SciFrame& frame) noexcept {
  if (frame.command != SciCommand::measurement_1d || frame.payload.size() != kMeasurementSize)
    return std::nullopt;
  Fields fields(frame.payload);
  SciMeasurement out;
  out.status = static_cast<std::int16_t>(fields.take(2));
  const auto seconds = fields.take(4);
  out.device_time_ns = seconds * kTickPerSecond_ns + fields.take(2) * kTick_ns;
  fields.take(4);  // state flags
  const auto range = fields.take(3);
  out.range_m = (static_cast<double>(range) - (range >= 0x800000U ? 16777216.0 : 0.0)) * kRangePerCount_m;
  out.amplitude = fields.take(2) * kAmplitudePerCount;
  out.quality = static_cast<std::uint8_t>(fields.take(1));
  return out;
}

std::vector<std::uint8_t> encode_measurement_1d(const SciMeasurement& m) {
  std::vector<std::uint8_t> payload;
  put(payload, static_cast<std::uint16_t>(m.status), 2);
  put(payload, static_cast<std::uint32_t>(m.device_time_ns / kTickPerSecond_ns), 4);
  put(payload, static_cast<std::uint32_t>(m.device_time_ns % kTickPerSecond_ns / kTick_ns), 2);
  put(payload, 0, 4);
  const double counts = std::clamp(m.range_m / kRangePerCount_m, -8388608.0, 8388607.0);
  put(payload, static_cast<std::uint32_t>(std::lround(counts)) & 0xFFFFFFU, 3);
  put(payload,
      static_cast<std::uint32_t>(std::lround(std::clamp(m.amplitude / kAmplitudePerCount, 0.0, 65535.0))), 2);
  put(payload, m.quality, 1);
  return sci_encode(SciCommand::measurement_1d, payload, std::uint8_t{0});
}

std::optional<SciAnswer> decode_answer(const SciFrame& frame) noexcept {
  const bool accepted = frame.command == SciCommand::acknowledge;
  if ((!accepted && frame.command != SciCommand::refuse) || frame.payload.empty()) return std::nullopt;
  SciAnswer out{static_cast<SciCommand>(frame.payload[0] & ~kSciAddressed), accepted, 0};
  if (!accepted && frame.payload.size() >= 3)
    out.reason = static_cast<std::int16_t>((frame.payload[1] << 8) | frame.payload[2]);
  return out;
}

}  // namespace sandhopper
