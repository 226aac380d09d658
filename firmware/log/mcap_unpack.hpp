#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "firmware/log/mcap_format.hpp"

namespace sandhopper::mcap {

// The same MCAP file with every chunk unpacked that is compressed with zstd or lz4 (the two that the format
// knows), as other recorders write them; empty if none is. A chunk that the file's end cuts keeps the lengths
// of the whole, so that a reader sees it cut there, too. One that is damaged is as long as what could be
// unpacked, and its CRC is wrong. One that is compressed in another way stays as it is.
std::optional<std::vector<std::byte>> unpack(Bytes file);

}  // namespace sandhopper::mcap
