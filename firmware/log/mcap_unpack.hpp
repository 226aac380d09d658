#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "firmware/log/mcap_format.hpp"

namespace sandhopper::mcap {

// The same MCAP file with every chunk unpacked that another recorder compressed with zstd or lz4 (the two
// methods of the format). Empty if no chunk is compressed. A chunk cut by the file's end keeps the lengths of
// the whole chunk, so that a reader also sees the cut. A damaged chunk is as long as its readable part and
// has a wrong CRC. A chunk with another compression is left as it is.
std::optional<std::vector<std::byte>> unpack(Bytes file);

}  // namespace sandhopper::mcap
