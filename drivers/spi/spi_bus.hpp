#pragma once
#include <cstdint>
#include <span>

namespace sandhopper {

// One chip on an SPI bus.
class SpiBus {
 public:
  virtual ~SpiBus() = default;
  // Full duplex with the chip selected throughout; both of one length. False when the transfer failed.
  virtual bool transfer(std::span<const std::uint8_t> out, std::span<std::uint8_t> in) noexcept = 0;
};

}  // namespace sandhopper
