// Prints the overruns of the cycle in a log: each gap (start [ms of CLOCK_MONOTONIC], cycles missed), then
// their sum, the last frame's own count, and the faults raised.
//   overruns_in_log FILE
#include <cstdio>
#include <exception>
#include <string>

#include "firmware/event.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/sensor_frame.hpp"

int main(int argc, char** argv) try {
  using namespace sandhopper;
  if (argc != 2) return 2;
  mcap::Reader log(argv[1]);
  TopicOf<SensorFrame> frames(topic::kFrame);
  TopicOf<Event> events(topic::kEvent);
  mcap::Message message;
  SensorFrame frame;
  Event event;
  std::uint64_t last = 0, missed = 0;
  while (log.next(message)) {
    if (events.take(message, event) && event.kind == EventKind::fault_raised)
      std::printf("fault %s: %g\n", std::string(name_of(event.fault)).c_str(), event.values[0]);
    if (!frames.take(message, frame)) continue;
    const auto gap = frame.cycle - last - 1;
    if (gap > 0)
      std::printf("gap %.3f %lu\n", 1e-6 * static_cast<double>(frame.time_ns) - static_cast<double>(gap),
                  static_cast<unsigned long>(gap));
    missed += gap;
    last = frame.cycle;
  }
  std::printf("missed %lu\noverruns %u\n", static_cast<unsigned long>(missed), frame.overruns);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 3;
}
