#pragma once
#include <atomic>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <vector>

#include "firmware/log/can_log.hpp"
#include "firmware/log/segmented_log.hpp"
#include "firmware/log/spsc_ring.hpp"
#include "firmware/log/topics.hpp"

namespace sandhopper {

// Thread that pushes a topic's records: the cycle, or the thread that solves finished strides.
enum class Lane : std::uint8_t { cycle, background };

template <class Record>
struct LogTopic {
  std::uint16_t number = 0;
};

struct TrialLogOptions {
  std::filesystem::path mcap_file;      // empty: nothing is logged
  std::filesystem::path candump_file;   // empty: CAN traffic is not logged
  std::int64_t start_ns = 0;            // CLOCK_MONOTONIC; time of the attachments
  std::int64_t realtime_offset_ns = 0;  // realtime_offset_ns(), or a fixed date for repeatable files
  std::size_t slots = 8192;             // about 2.7 s of three records a cycle
  std::size_t can_slots = 16384;        // per interface; about 4 s of four frames a cycle
  bool own_thread = true;               // false: push() itself writes when the ring is full (simulation)
  SegmentLimits limits{};
  mcap::WriterOptions mcap{};
  // Disk errors in words, at begin and end. Called from the logger's thread.
  std::function<void(const std::string&)> say{};
};

// Logger of a running trial. The cycle pushes records, which costs a copy and no wait, lock or allocation. A
// thread of ordinary priority takes them out every 5 ms, encodes and writes them. If it is too slow, or the
// disk accepts no more, records are lost and counted, and a LogGap replaces them in the log; the cycle is not
// affected (see SegmentedLog for the disk and for a log in several files). The content of the files depends
// only on what was pushed, not on the thread's timing: two runs in virtual time, or one with and one without
// the thread, give the same bytes.
//
// Order of calls: add_topic, add_can_interface, attach, add_metadata; start; push, push_can; stop; attach,
// close.
class TrialLogger {  // NOLINT(clang-analyzer-optin.performance.Padding): padding of the rings
 public:
  // Throws std::system_error if a file cannot be created.
  explicit TrialLogger(TrialLogOptions options);
  ~TrialLogger();

  template <HasFields Record>
  LogTopic<Record> add_topic(std::string_view name, Lane lane = Lane::cycle) {
    static_assert(std::is_trivially_copyable_v<Record>);
    static_assert(sizeof(Record) <= kMaxRecordBytes, "raise kMaxRecordBytes");
    const auto channel = log_.add_topic(
        name, [](mcap::Writer& writer, std::string_view topic) { return writer.add_channel<Record>(topic); });
    topics_.push_back({channel, lane, &write_record<Record>});
    return {static_cast<std::uint16_t>(topics_.size() - 1)};
  }
  // Returns the number for push_can().
  std::size_t add_can_interface(std::string name);
  void attach(std::string_view name, std::string_view media_type, std::string_view text);
  void add_metadata(std::string_view name, const std::map<std::string, std::string>& entries);

  // Attachments and metadata added so far.
  const LogDescription& description() const { return log_.description(); }

  void start();

  // Call it only from the thread of the topic's lane. `time_ns` is the record's own time, CLOCK_MONOTONIC.
  template <HasFields Record>
  void push(LogTopic<Record> topic, std::int64_t time_ns, const Record& record) noexcept {
    push_bytes(topic.number, time_ns, &record, sizeof record);
  }
  // Call it from one thread per interface.
  void push_can(std::size_t interface, const CandumpFrame& frame) noexcept;

  // Afterwards everything pushed is written, or counted as lost with a gap record.
  void stop();
  void close();

  // After stop(): the first disk error in words; empty if there was none.
  std::string error() const;
  std::uint64_t lost_records() const noexcept;
  std::uint64_t lost_can_frames() const noexcept { return can_ ? can_->lost() : 0; }

 private:
  static constexpr std::size_t kMaxRecordBytes = 1000;
  // A stride's result is solved some time after its instant. It is written before the first record of the
  // cycle that is younger by this much. By then it has been pushed.
  static constexpr std::int64_t kBackgroundHold_ns = 100'000'000;

  struct Slot {
    std::int64_t time_ns = 0;
    std::uint16_t topic = 0;
    alignas(std::max_align_t) std::byte record[kMaxRecordBytes]{};
  };
  struct TopicEntry {
    std::uint16_t channel;
    Lane lane;
    void (*write)(SegmentedLog&, std::uint16_t channel, std::int64_t time_ns, const std::byte* record);
  };
  struct LaneState {
    explicit LaneState(std::size_t slots) : ring(slots) {}
    SpscRing<Slot> ring;
    LogGap gap{};  // of the producer: records lost since the last record that fitted
  };

  template <class Record>
  static void write_record(SegmentedLog& log, std::uint16_t channel, std::int64_t time_ns,
                           const std::byte* bytes) {
    Record record;
    std::memcpy(&record, bytes, sizeof record);
    log.write(channel, time_ns, record);
  }

  void push_bytes(std::uint16_t topic, std::int64_t time_ns, const void* record, std::size_t bytes) noexcept;
  bool put(LaneState& lane, std::uint16_t topic, std::int64_t time_ns, const void* record,
           std::size_t bytes) noexcept;
  void run();
  void drain() noexcept;
  void write_background_until(std::int64_t time_ns);
  void write_final_gap(LaneState& lane);
  void keep_can_beside();
  void write_slot(const Slot& slot);
  LaneState& lane_of(Lane lane) { return lane == Lane::cycle ? cycle_ : background_; }

  TrialLogOptions options_;
  SegmentedLog log_;
  std::unique_ptr<CanLog> can_;
  std::vector<TopicEntry> topics_;
  LogTopic<LogGap> gap_topic_{};  // the first topic
  LaneState cycle_;
  LaneState background_;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> lost_on_disk_{0};
};

}  // namespace sandhopper
