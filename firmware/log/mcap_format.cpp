#include "firmware/log/mcap_format.hpp"

#include <zlib.h>

namespace sandhopper::mcap {

std::uint32_t crc32(std::uint32_t crc, Bytes bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace sandhopper::mcap
