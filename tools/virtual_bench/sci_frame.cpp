#include "tools/virtual_bench/sci_frame.hpp"

namespace sandhopper::bench {
namespace {

constexpr std::uint8_t kStart = 0x02, kStop = 0x03, kEscape = 0x1B;

}  // namespace

std::uint8_t sci_crc8(std::span<const std::uint8_t> data) noexcept {
  unsigned crc = 0;
  for (const auto byte : data) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80) != 0 ? (crc << 1 ^ 0x1D) & 0xFF : crc << 1;
  }
  return static_cast<std::uint8_t>(crc);
}

std::vector<std::uint8_t> encode_sci(const SciMessage& message) {
  std::vector<std::uint8_t> body{message.command};
  body.insert(body.end(), message.parameters.begin(), message.parameters.end());
  body.push_back(sci_crc8(body));
  std::vector<std::uint8_t> out{kStart};
  for (const auto byte : body) {
    if (byte == kStart || byte == kStop || byte == kEscape) {
      out.push_back(kEscape);
      out.push_back(static_cast<std::uint8_t>(~byte));
    } else {
      out.push_back(byte);
    }
  }
  out.push_back(kStop);
  return out;
}

std::vector<SciMessage> SciDecoder::take(std::span<const std::uint8_t> bytes) {
  std::vector<SciMessage> out;
  for (const auto byte : bytes) {
    if (byte == kStart) {
      if (inside_) ++rejected_;
      frame_.clear();
      inside_ = true;
      escaped_ = false;
    } else if (!inside_) {
      continue;
    } else if (byte == kStop) {
      end_of_frame(out);
    } else if (byte == kEscape) {
      escaped_ = true;
    } else {
      frame_.push_back(escaped_ ? static_cast<std::uint8_t>(~byte) : byte);
      escaped_ = false;
    }
  }
  return out;
}

void SciDecoder::end_of_frame(std::vector<SciMessage>& out) {
  inside_ = false;
  // A CRC over data and its own CRC is zero.
  if (frame_.size() < 2 || sci_crc8(frame_) != 0) {
    ++rejected_;
    return;
  }
  out.push_back({frame_.front(), {frame_.begin() + 1, frame_.end() - 1}});
}

}  // namespace sandhopper::bench
