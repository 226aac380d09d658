#pragma once
#include <cstdint>
#include <vector>

#include "drivers/can/can_config.hpp"

// Timing of the bus from which limits for a trace are derived (ISO 11898-1).
namespace sandhopper::trace {

// Duration of the shortest classic frame (standard identifier, no data): 47 bits, i.e. 47 us at 1 Mbit/s. Two
// frames on one bus cannot end closer together.
inline constexpr std::int64_t kShortestFrame_ns = 47'000;
// Delay of a drive's answer after the command (B. Katz' note).
inline constexpr std::int64_t kDriveAnswers_ns = 15'000;
// Duration of the shortest answer: 6 bytes without stuff bits.
inline constexpr std::int64_t kShortestReply_ns = 95'000;
// A driver may write the frames of one batch in another order. A full-speed USB adapter delivers one batch
// per millisecond.
inline constexpr std::int64_t kBatch_ns = 1'000'000;

// Longest delay of a reply by the bus itself: every frame of a cycle, with all stuff bits, is sent before it.
inline std::int64_t longest_reply_ns(const CanConfig& config) noexcept {
  constexpr double kCycle_ns = 1e6;
  return kDriveAnswers_ns + static_cast<std::int64_t>(bus_load(config) * kCycle_ns);
}

// Median; the lower middle value for an even number, 0 without values.
std::int64_t median(std::vector<std::int64_t> values);
// Differences between neighbouring times.
std::vector<std::int64_t> steps(const std::vector<std::int64_t>& times_ns);

}  // namespace sandhopper::trace
