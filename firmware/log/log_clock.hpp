#pragma once
#include <cstdint>

namespace sandhopper {

// CLOCK_REALTIME minus CLOCK_MONOTONIC, now. Sampled once at a log's start and added to every record's time,
// so that viewers show the date and a later step of the clock does no harm. Of a few readings the one is
// taken whose two monotonic readings lie closest together; the error is at most half their distance.
std::int64_t sample_realtime_offset_ns();

}  // namespace sandhopper
