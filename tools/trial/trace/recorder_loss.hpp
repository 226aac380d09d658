#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace sandhopper::trace {

// A line of a recorder that says that it lost frames.
struct RecorderLoss {
  std::uint64_t frames = 0;  // 0: the line gives no number
};

// Recognises candump's "DROPCOUNT: dropped 311 CAN frames on 'can0' socket (total drops 311)", the comments
// of this project's own log, and other lines that have a word of loss (dropped, lost, discarded, missed,
// overrun, overflow) beside a word for what is lost (frame, message, packet, receive buffer). A comment of a
// person is only recognised with a number in front of or behind the word. Empty for "0 frames lost".
std::optional<RecorderLoss> loss_said_in(std::string_view line);

}  // namespace sandhopper::trace
