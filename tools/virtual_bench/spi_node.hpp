#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "tools/virtual_bench/cuse_node.hpp"

namespace sandhopper::bench {

// A chip behind one chip select.
class SpiChip {
 public:
  virtual ~SpiChip() = default;
  // One period of the chip select: what the chip answers while it is sent `in`, byte by byte. Equal lengths.
  virtual void transfer(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) = 0;
};

// /dev/spidevB.C with one chip: the ioctls, read() and write() of Linux' spidev. Mode, word size and speed
// are kept and given back; the transfer itself takes no time.
class SpiNode : public CuseNode {
 public:
  SpiNode(EventLoop& loop, const std::string& name, SpiChip& chip) : CuseNode(loop, name), chip_(chip) {}

 protected:
  void ioctl(Ioctl& call, File& file) override;
  int read(std::span<std::uint8_t> out, File& file) override;
  int write(std::span<const std::uint8_t> in, File& file) override;

 private:
  void transfer_message(Ioctl& call, std::size_t size);

  SpiChip& chip_;
  std::uint32_t mode_ = 0;
  std::uint8_t least_significant_bit_first_ = 0;
  std::uint8_t bits_per_word_ = 8;
  std::uint32_t max_speed_Hz_ = 10'000'000;
};

}  // namespace sandhopper::bench
