#pragma once
#include <cstdint>
#include <span>
#include <vector>

// The serial protocol of Broadcom's ExplorerApp for the AFBR-S50 (SCI), the companion controller's side of
// it: start byte 0x02, command, parameters, CRC-8, stop byte 0x03, with 0x1B as escape. Written from the
// protocol's description, apart from the driver.
namespace sandhopper::bench {

struct SciMessage {
  std::uint8_t command = 0;
  std::vector<std::uint8_t> parameters;
};

// Polynomial 0x1D, initial value 0, no reflection.
std::uint8_t sci_crc8(std::span<const std::uint8_t> data) noexcept;

std::vector<std::uint8_t> encode_sci(const SciMessage& message);

// Cuts a stream of bytes into messages; what is not one, or has a wrong CRC, is dropped and counted.
class SciDecoder {
 public:
  std::vector<SciMessage> take(std::span<const std::uint8_t> bytes);
  unsigned rejected() const noexcept { return rejected_; }

 private:
  void end_of_frame(std::vector<SciMessage>& out);

  std::vector<std::uint8_t> frame_;
  bool inside_ = false;
  bool escaped_ = false;
  unsigned rejected_ = 0;
};

}  // namespace sandhopper::bench
