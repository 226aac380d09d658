#pragma once
#include <cstdint>
#include <vector>

#include "drivers/can/can_config.hpp"

// Facts of the bus that limits of a trace follow from (ISO 11898-1).
namespace sandhopper::trace {

// The shortest classic frame, standard identifier and no data, takes 47 bits: 47 us at 1 Mbit/s. Two frames
// of one bus cannot end closer together.
inline constexpr std::int64_t kShortestFrame_ns = 47'000;
// A drive begins its answer 15 us after the command (B. Katz' note).
inline constexpr std::int64_t kDriveAnswers_ns = 15'000;
// The shortest answer, 6 bytes without stuff bits.
inline constexpr std::int64_t kShortestReply_ns = 95'000;
// Frames that a driver hands over in one batch may be written in another order. A full-speed USB adapter
// delivers one batch a millisecond.
inline constexpr std::int64_t kBatch_ns = 1'000'000;

// The longest that the bus itself can delay a reply: every frame of a cycle, with all stuff bits, goes first.
inline std::int64_t longest_reply_ns(const CanConfig& config) noexcept {
  constexpr double kCycle_ns = 1e6;
  return kDriveAnswers_ns + static_cast<std::int64_t>(bus_load(config) * kCycle_ns);
}

// Middle of the values, the lower one of an even number; 0 without any.
std::int64_t median(std::vector<std::int64_t> values);
// Between neighbours.
std::vector<std::int64_t> steps(const std::vector<std::int64_t>& times_ns);

}  // namespace sandhopper::trace
