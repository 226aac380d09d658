#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "config/fields.hpp"
#include "firmware/log/mcap_reader.hpp"

// Names of a trial log's topics, and a class that reads their records from a log.
namespace sandhopper {

namespace topic {
inline constexpr std::string_view kFrame = "/frame";      // SensorFrame: input of the cycle
inline constexpr std::string_view kOutput = "/output";    // StepOutput: result of the cycle
inline constexpr std::string_view kEvent = "/event";      // Event
inline constexpr std::string_view kStride = "/stride";    // StrideResult
inline constexpr std::string_view kProfile = "/profile";  // StrengthProfile, after each StrideResult
inline constexpr std::string_view kGround = "/ground";    // GroundSummary, after each StrengthProfile
inline constexpr std::string_view kGroundEvents = "/ground_events";  // GroundEvents, after each stride
inline constexpr std::string_view kRequest = "/request";             // RequestRecord: the operator's words
inline constexpr std::string_view kTruth = "/truth";                 // PlantTruth, simulated robot only
inline constexpr std::string_view kGap = "/gap";                     // LogGap
}  // namespace topic

enum class LossCause : std::uint8_t {
  ring_full,        // the logger was too slow: the disk, or the computer
  write_failed,     // the disk was full or failed
  sync_failed,      // written, but it may not have reached the disk; lost is 0
  segment_removed,  // an older file of this log was removed to keep the quota
  damaged           // hop recover could not read it
};
template <>
struct EnumNames<LossCause> {
  static constexpr std::array<std::string_view, 5> value{"ring_full", "write_failed", "sync_failed",
                                                         "segment_removed", "damaged"};
};

// Record of missing records; it is in the log at their place.
struct LogGap {
  std::int64_t time_ns = 0;  // time of the first record after the gap
  std::int64_t first_lost_ns = 0;
  std::int64_t last_lost_ns = 0;
  std::uint64_t lost = 0;
  std::uint8_t lane = 0;
  LossCause cause = LossCause::ring_full;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("first_lost_ns", self.first_lost_ns);
    visit("last_lost_ns", self.last_lost_ns);
    visit("lost", self.lost);
    visit("lane", self.lane);
    visit("cause", self.cause);
  }
};

// Reads one topic of a log:  TopicOf<Event> events("/event");  while (log.next(m)) if (events.take(m, event))
// … The schema is compared at the topic's first message; that of another version throws mcap::Error.
template <HasFields Record>
class TopicOf {
 public:
  explicit TopicOf(std::string_view name) : name_(name) {}

  bool take(const mcap::Message& message, Record& record) {
    if (message.channel != channel_) {
      if (channel_ != nullptr || message.channel->topic != name_) return false;
      mcap::require_schema<Record>(*message.channel);
      channel_ = message.channel;
    }
    if (cdr::decode(message.data, record)) return true;
    throw mcap::Error("topic " + name_ + ": byte " + std::to_string(message.offset) + ": a message of " +
                      std::to_string(message.data.size()) + " bytes, expected " +
                      std::to_string(cdr::size_of<Record>()));
  }

 private:
  std::string name_;
  const mcap::Channel* channel_ = nullptr;
};

}  // namespace sandhopper
