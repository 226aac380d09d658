#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/log/log_description.hpp"
#include "firmware/log/mcap_writer.hpp"
#include "firmware/log/topics.hpp"

namespace sandhopper {

// How a long log is divided, and what it may take of the disk.
struct SegmentLimits {
  std::uint64_t segment_bytes = 0;  // a new file is begun when this much is in one; 0: one file
  std::uint64_t quota_bytes = 0;  // the oldest files of this log go when all together hold more; 0: none goes
};

// The MCAP files of one log, written so that the log survives its disk. trial.mcap, then trial.part0002.mcap,
// …: each is whole in itself, with schemas, attachments and metadata.
//
// What the disk does not take is counted, and a LogGap stands in the log in its place as soon as there is
// room again, at the latest when the log is closed, for which room is kept from the start. Only a disk that
// takes nothing more at all leaves no gap record: then error() and lost() say it.
//
// Order of calls: add_topic, attach, add_metadata (these throw std::system_error); write …; finish; attach,
// close.
class SegmentedLog {
 public:
  using AddChannel = std::uint16_t (*)(mcap::Writer& writer, std::string_view topic);

  struct Options {
    std::filesystem::path file;
    std::int64_t offset_ns = 0;   // log time less a record's own time
    std::int64_t created_ns = 0;  // log time of what is attached
    SegmentLimits limits{};
    mcap::WriterOptions mcap{};
    std::function<void(const std::string&)> say{};  // the disk's troubles in words, as they begin and end
  };

  explicit SegmentedLog(Options options);

  std::uint16_t add_topic(std::string_view name, AddChannel add);
  void attach(std::string_view name, std::string_view media_type, std::string_view text);
  void add_metadata(std::string_view name, const std::map<std::string, std::string>& entries);

  // What was attached and added before finish().
  const LogDescription& description() const { return description_; }

  std::uint16_t gap_channel() const { return gap_channel_; }

  // The file a record of this time goes to.
  mcap::Writer& writer_at(std::int64_t time_ns);
  template <HasFields Record>
  void write(std::uint16_t channel, std::int64_t time_ns, const Record& record) {
    writer_at(time_ns).write(channel, stamp(time_ns), record);
    if constexpr (std::is_same_v<Record, LogGap>) note_gap(record);
  }
  mcap::Stamp stamp(std::int64_t time_ns) const {
    return {time_ns + options_.offset_ns, time_ns + options_.offset_ns};
  }

  // The last record was written: what was lost is said now, if need be from the disk's reserve.
  void finish();
  void close();

  std::uint64_t lost() const { return lost_; }  // records the disk did not take
  const std::string& error() const { return error_; }
  // What lies beside each file, here the CAN traffic: called with each file after the first as it begins,
  // asked for its size, and told of each file removed.
  std::function<void(const std::filesystem::path&)> on_begin{};
  std::function<std::uint64_t(const std::filesystem::path&)> bytes_beside{};
  std::function<void(const std::filesystem::path&)> on_remove{};

 private:
  struct Topic {
    std::string name;
    AddChannel add;
  };
  struct Segment {
    std::filesystem::path file;
    std::uint64_t bytes;
    std::uint64_t messages;
    std::int64_t first_ns;  // log times
    std::int64_t last_ns;
  };

  std::filesystem::path file_of(std::uint32_t number) const;
  std::unique_ptr<mcap::Writer> make_writer(const std::filesystem::path& file) const;
  void describe(mcap::Writer& writer, std::uint32_t number) const;
  void settle();
  void begin_segment(std::int64_t time_ns);
  void end_segment();
  std::vector<LogGap> keep_quota(std::int64_t time_ns);
  void write_pending(std::int64_t time_ns);
  void write_gap(const LogGap& gap);
  void note_gap(const LogGap& gap);
  void merge(const mcap::Loss& loss);
  void trouble(const std::string& what);

  Options options_;
  std::uint32_t number_ = 1;
  std::unique_ptr<mcap::Writer> writer_;
  std::vector<Topic> topics_;
  LogDescription description_;
  std::uint16_t gap_channel_ = 0;
  std::vector<Segment> older_;
  std::uint64_t next_segment_bytes_ = 0;

  // What the gap records in the open chunk say: lost with it, it is said again.
  struct Said {
    std::uint64_t gaps = 0;
    std::uint64_t lost = 0;
    std::int64_t first_lost_ns = INT64_MAX;
  };
  Said said_{};
  std::uint64_t chunks_settled_ = 0;
  LogGap pending_{};  // lost and not yet said
  bool is_pending_ = false;
  bool failing_ = false;  // the last chunk was lost
  bool sync_failed_ = false;
  bool finished_ = false;
  std::uint64_t lost_ = 0;
  std::string error_;
};

}  // namespace sandhopper
