#include "firmware/freeze/newest_cycles.hpp"

#include <exception>

#include "firmware/cycle.hpp"
#include "firmware/freeze/freeze_folders.hpp"
#include "firmware/freeze/freeze_ring.hpp"
#include "firmware/log/mapped_file.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/topics.hpp"

namespace sandhopper {
namespace {

// Time of cycle 0. A damaged file may hold any number, so the arithmetic is unsigned.
std::uint64_t origin_of(std::int64_t time_ns, std::uint64_t cycle) {
  return static_cast<std::uint64_t>(time_ns) - cycle * static_cast<std::uint64_t>(kCyclePeriod_ns);
}

class Search {
 public:
  explicit Search(const LoggedCycles& log) : origin_(origin_of(log.first_ns, log.first)) {}

  void look_at_ring(const std::filesystem::path& file) {
    const MappedFile map(file);
    const FreezeReader ring(map.bytes());
    std::vector<FreezeCycle> cycles;
    for (std::uint64_t number = ring.oldest(); number <= ring.count(); ++number)
      if (const auto cycle = ring.cycle(number); cycle && belongs(cycle->frame)) cycles.push_back(*cycle);
    offer(file, std::move(cycles));
  }

  void look_at_frame(const std::filesystem::path& file) {
    mcap::Reader log(file, {.check_crc = true, .skip_damaged = true});
    TopicOf<SensorFrame> frames(topic::kFrame);
    TopicOf<StepOutput> outputs(topic::kOutput);
    TopicOf<Event> events(topic::kEvent);
    std::vector<FreezeCycle> cycles;
    mcap::Message message;
    FreezeCycle cycle;
    Event event;
    while (log.next(message)) {
      if (frames.take(message, cycle.frame)) {
        if (!belongs(cycle.frame)) return;
        cycle.event_count = 0;
      } else if (outputs.take(message, cycle.output)) {
        cycles.push_back(cycle);
      } else if (events.take(message, event) && !cycles.empty() &&
                 cycles.back().event_count < cycle.events.size()) {
        cycles.back().events[cycles.back().event_count++] = event;
      }
    }
    offer(file, std::move(cycles));
  }

  std::optional<NewestCycles> best;

 private:
  bool belongs(const SensorFrame& frame) const { return origin_of(frame.time_ns, frame.cycle) == origin_; }

  void offer(const std::filesystem::path& file, std::vector<FreezeCycle> cycles) {
    if (cycles.empty()) return;
    if (best && best->cycles.back().frame.cycle >= cycles.back().frame.cycle) return;
    best = NewestCycles{file, std::move(cycles)};
  }

  std::uint64_t origin_;
};

}  // namespace

std::optional<NewestCycles> find_newest_cycles(const LoggedCycles& log,
                                               const std::vector<std::filesystem::path>& folders) {
  Search search(log);
  const auto each = [&](const std::filesystem::path& folder, std::string_view ending, auto look) {
    for (const auto& file : freeze::files_in(folder, ending)) {
      try {
        (search.*look)(file);
      } catch (const std::exception&) {
        // A file of another build or a damaged file: it cannot be shown to belong to this trial.
      }
    }
  };
  for (const auto& folder : folders) {
    each(folder, freeze::kMemoryEnding, &Search::look_at_ring);
    each(folder, freeze::kDumpEnding, &Search::look_at_ring);
    each(folder, freeze::kFrameEnding, &Search::look_at_frame);
  }
  return search.best;
}

}  // namespace sandhopper
