#pragma once
#include <cstdint>
#include <span>

namespace sandhopper {

// One chip on an SPI bus.
class SpiBus {
 public:
  virtual ~SpiBus() = default;
  // Full-duplex transfer with the chip selected throughout. Both spans have the same length. False if it
  // failed.
  virtual bool transfer(std::span<const std::uint8_t> out, std::span<std::uint8_t> in) noexcept = 0;
};

}  // namespace sandhopper
