#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "tools/virtual_bench/cuse_node.hpp"

namespace sandhopper::bench {

// A chip on an I2C bus. Each call is one message after its address byte.
class I2cChip {
 public:
  virtual ~I2cChip() = default;
  virtual void write(std::span<const std::uint8_t> in) = 0;
  virtual void read(std::span<std::uint8_t> out) = 0;
};

// /dev/i2c-N: I2C_RDWR, I2C_SLAVE with read() and write(), I2C_FUNCS, timeout and retries as i2c-dev has
// them. An address where no chip sits answers ENXIO. No SMBus calls: the bus says so in I2C_FUNCS.
class I2cNode : public CuseNode {
 public:
  using CuseNode::CuseNode;
  void connect(int address, I2cChip& chip) { chips_[address] = &chip; }

 protected:
  void ioctl(Ioctl& call, File& file) override;
  int read(std::span<std::uint8_t> out, File& file) override;
  int write(std::span<const std::uint8_t> in, File& file) override;

 private:
  void transfer_messages(Ioctl& call);
  I2cChip* chip_at(std::uint64_t address) const;

  std::map<int, I2cChip*> chips_;
};

}  // namespace sandhopper::bench
