#include "tools/explain/recording.hpp"

#include <charconv>
#include <stdexcept>

#include "firmware/freeze/freeze_folders.hpp"
#include "firmware/freeze/freeze_ring.hpp"
#include "firmware/log/mapped_file.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/log/trial_description.hpp"

namespace sandhopper {
namespace {

std::int64_t integer_of(const std::string& text) {
  std::int64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

void take_configuration(Recording& recording, std::string text) {
  recording.robot = parse_config_text(recording.file.string(), text).root;
  recording.robot_toml = std::move(text);
}

// The fault that began the last episode: those before it were ended by a `disarmed`.
std::optional<std::int64_t> last_episode_ns(const std::vector<Event>& events) {
  std::optional<std::int64_t> began;
  bool in_fault = false;
  for (const Event& event : events) {
    if (event.kind == EventKind::disarmed) in_fault = false;
    if (event.kind != EventKind::fault_raised) continue;
    if (!in_fault) began = event.time_ns;
    in_fault = true;
  }
  return began;
}

// First pass over a log: its events, and what it carries in front of them.
struct LogSurvey {
  std::vector<Event> events;
  std::optional<std::int64_t> frozen_ns;  // a freeze frame's own instant
  bool killed = false;
};

LogSurvey survey(const std::filesystem::path& file, Recording& recording) {
  LogSurvey found;
  mcap::Reader log(file, {.check_crc = true, .skip_damaged = true});
  TopicOf<Event> events(topic::kEvent);
  mcap::Message message;
  Event event;
  while (log.next(message))
    if (events.take(message, event)) found.events.push_back(event);
  for (const auto& metadata : log.metadata()) {
    if (metadata.name != kFreezeMetadata) {
      recording.facts.insert(metadata.entries.begin(), metadata.entries.end());
      continue;
    }
    const auto& entries = metadata.entries;
    if (entries.contains("time_ns")) found.frozen_ns = integer_of(entries.at("time_ns"));
    found.killed = entries.contains("cause") && entries.at("cause") == name_of(FreezeCause::killed);
    if (entries.contains("log")) recording.facts["log"] = entries.at("log");
  }
  for (const auto& attachment : log.attachments())
    if (attachment.name == kRobotAttachment)
      take_configuration(recording, std::string(mcap::text_of(attachment.data)));
  recording.cut = log.truncated_at().has_value();
  return found;
}

void read_cycles(const std::filesystem::path& file, Recording& recording) {
  mcap::Reader log(file, {.check_crc = true, .skip_damaged = true});
  TopicOf<SensorFrame> frames(topic::kFrame);
  TopicOf<StepOutput> outputs(topic::kOutput);
  mcap::Message message;
  SensorFrame frame;
  StepOutput output;
  const std::int64_t from_ns = recording.time_ns - kFreezeBefore_ns;
  const std::int64_t to_ns = recording.time_ns + kFreezeAfter_ns;
  while (log.next(message)) {
    if (frames.take(message, frame)) continue;
    if (!outputs.take(message, output) || output.cycle != frame.cycle) continue;
    recording.realtime_offset_ns = message.stamp.log_ns - output.time_ns;
    if (output.time_ns >= from_ns && output.time_ns <= to_ns) recording.cycles.emplace_back(frame, output);
  }
}

Recording read_log(const std::filesystem::path& file) {
  Recording recording;
  recording.file = file;
  const auto found = survey(file, recording);
  const auto fault_ns = last_episode_ns(found.events);
  if (!found.frozen_ns && !fault_ns)
    throw std::runtime_error(file.string() + ": there is no fault in this log");
  recording.time_ns = found.frozen_ns ? *found.frozen_ns : *fault_ns;
  recording.cause = found.killed ? FreezeCause::killed : FreezeCause::fault;
  read_cycles(file, recording);
  for (const Event& event : found.events)
    if (event.time_ns >= recording.time_ns - kFreezeBefore_ns &&
        event.time_ns <= recording.time_ns + kFreezeAfter_ns)
      recording.events.push_back(event);
  return recording;
}

FreezeReader reader_of(std::span<const std::byte> bytes, const std::filesystem::path& file) {
  try {
    return FreezeReader(bytes);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

Recording read_ring(const std::filesystem::path& file) {
  const MappedFile map(file);
  const FreezeReader ring = reader_of(map.bytes(), file);
  const auto instants = instants_left(ring);
  if (instants.empty()) throw std::runtime_error(file.string() + ": it holds no cycle");
  const auto& instant = instants.back();
  Recording recording;
  recording.file = file;
  recording.cause = instant.cause;
  recording.time_ns = instant.time_ns;
  recording.realtime_offset_ns = ring.header().realtime_offset_ns;
  recording.facts["log"] = ring.log_file().string();
  const auto description = ring.description();
  for (const auto& [name, entries] : description.metadata)
    recording.facts.insert(entries.begin(), entries.end());
  for (const auto& attachment : description.attachments)
    if (attachment.name == kRobotAttachment) take_configuration(recording, attachment.text);
  for (std::uint64_t number = ring.oldest(); number <= ring.count(); ++number) {
    const auto cycle = ring.cycle(number);
    if (!cycle || cycle->frame.time_ns < instant.time_ns - kFreezeBefore_ns ||
        cycle->frame.time_ns > instant.time_ns + kFreezeAfter_ns)
      continue;
    recording.cycles.emplace_back(cycle->frame, cycle->output);
    for (const Event& event : cycle->seen_events()) recording.events.push_back(event);
  }
  return recording;
}

}  // namespace

Recording read_recording(const std::filesystem::path& file) {
  const auto name = file.filename().string();
  const bool is_ring = name.ends_with(freeze::kMemoryEnding) || name.ends_with(freeze::kDumpEnding);
  return is_ring ? read_ring(file) : read_log(file);
}

}  // namespace sandhopper
