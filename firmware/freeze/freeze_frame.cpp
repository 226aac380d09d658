#include "firmware/freeze/freeze_frame.hpp"

#include <algorithm>
#include <system_error>

#include "firmware/freeze/freeze_folders.hpp"
#include "firmware/log/mcap_writer.hpp"
#include "firmware/log/topics.hpp"

namespace sandhopper {
namespace {

// Number of the first cycle at or after `time_ns`. Times increase with the numbers.
std::uint64_t first_at(const FreezeReader& ring, std::int64_t time_ns) {
  std::uint64_t low = ring.oldest(), high = ring.count() + 1;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    const auto cycle = ring.cycle(middle);
    // A cycle that was overwritten was older than all remaining ones.
    if (!cycle || cycle->frame.time_ns < time_ns)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

class FrameWriter {
 public:
  FrameWriter(const FreezeReader& ring, const std::filesystem::path& file)
      : ring_(ring),
        writer_(file),
        frame_(writer_.add_channel<SensorFrame>(topic::kFrame)),
        output_(writer_.add_channel<StepOutput>(topic::kOutput)),
        event_(writer_.add_channel<Event>(topic::kEvent)) {}

  void describe(const FreezeInstant& instant) {
    const auto cycle = ring_.cycle(instant.number);
    const auto description = ring_.description();
    const std::int64_t created_ns = stamp(instant.time_ns).log_ns;
    for (const auto& a : description.attachments)
      writer_.attach(a.name, a.media_type, created_ns, mcap::bytes_of(a.text));
    for (const auto& [name, entries] : description.metadata) writer_.add_metadata(name, entries);
    writer_.add_metadata(kFreezeMetadata, {{"cause", std::string(name_of(instant.cause))},
                                           {"fault", std::string(name_of(instant.fault))},
                                           {"time_ns", std::to_string(instant.time_ns)},
                                           {"cycle", cycle ? std::to_string(cycle->frame.cycle) : ""},
                                           {"log", ring_.log_file().string()},
                                           {"start_ns", std::to_string(ring_.header().start_ns)},
                                           {"process", std::to_string(ring_.header().process)}});
  }

  void write_between(std::int64_t from_ns, std::int64_t to_ns) {
    const std::uint64_t end = ring_.count();
    for (std::uint64_t number = first_at(ring_, from_ns); number <= end; ++number) {
      const auto cycle = ring_.cycle(number);
      if (!cycle) continue;
      const std::int64_t time_ns = cycle->frame.time_ns;
      if (time_ns > to_ns) break;
      writer_.write(frame_, stamp(time_ns), cycle->frame);
      writer_.write(output_, stamp(time_ns), cycle->output);
      for (const Event& event : cycle->seen_events()) writer_.write(event_, stamp(time_ns), event);
    }
  }

  void close() { writer_.close(); }

 private:
  mcap::Stamp stamp(std::int64_t time_ns) const {
    const std::int64_t log_ns = time_ns + ring_.header().realtime_offset_ns;
    return {log_ns, log_ns};
  }

  const FreezeReader& ring_;
  mcap::Writer writer_;
  std::uint16_t frame_;
  std::uint16_t output_;
  std::uint16_t event_;
};

}  // namespace

std::vector<FreezeInstant> faults_after(const FreezeReader& ring, std::uint64_t number) {
  std::vector<FreezeInstant> instants;
  const std::uint64_t end = ring.count();
  for (std::uint64_t i = std::max(number + 1, ring.oldest()); i <= end; ++i) {
    const auto cycle = ring.cycle(i);
    if (!cycle) continue;
    for (const Event& event : cycle->seen_events())
      if (event.kind == EventKind::fault_raised)
        instants.push_back({i, cycle->frame.time_ns, FreezeCause::fault, event.fault});
  }
  return instants;
}

std::vector<FreezeInstant> instants_left(const FreezeReader& ring) {
  auto instants = faults_after(ring, ring.header().written_to.load(std::memory_order_acquire));
  const std::uint64_t last = ring.count();
  const auto cycle = ring.cycle(last);
  if (!cycle) return instants;
  const bool shown = !instants.empty() && cycle->frame.time_ns <= instants.back().time_ns + kFreezeAfter_ns;
  if (!shown) instants.push_back({last, cycle->frame.time_ns, FreezeCause::killed, cycle->output.fault});
  return instants;
}

std::string frame_name_of(const FreezeReader& ring, const FreezeInstant& instant) {
  const auto what = instant.cause == FreezeCause::fault ? name_of(instant.fault) : name_of(instant.cause);
  return freeze::frame_name(instant.time_ns + ring.header().realtime_offset_ns, ring.log_file(), what);
}

std::filesystem::path write_frame(const FreezeReader& ring, const FreezeInstant& instant,
                                  const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const auto name = frame_name_of(ring, instant) + std::string(freeze::kFrameEnding);
  const auto file = folder / name;
  if (std::filesystem::exists(file)) return file;
  const auto part = folder / ("." + name + ".part");
  std::filesystem::remove(part);
  try {
    FrameWriter writer(ring, part);
    writer.describe(instant);
    writer.write_between(instant.time_ns - kFreezeBefore_ns, instant.time_ns + kFreezeAfter_ns);
    writer.close();
    std::filesystem::rename(part, file);
  } catch (const std::system_error&) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
  return file;
}

}  // namespace sandhopper
