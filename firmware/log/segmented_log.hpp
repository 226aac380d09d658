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

// Division of a long log into files, and its disk quota.
struct SegmentLimits {
  std::uint64_t segment_bytes = 0;  // a new file begins when one reaches this size; 0: one file
  std::uint64_t quota_bytes = 0;    // beyond this sum the oldest files of this log are removed; 0: none
};

// The MCAP files of one log, written so that disk errors do not end the log. Files: trial.mcap, then
// trial.part0002.mcap, …; each is complete, with schemas, attachments and metadata.
//
// Records that the disk does not accept are counted. A LogGap replaces them in the log as soon as there is
// room, at the latest when the log is closed; space for it is reserved from the start. If the disk accepts
// nothing at all there is no gap record; then error() and lost() report it.
//
// Order of calls: add_topic, attach, add_metadata (these throw std::system_error); write …; finish; attach,
// close.
class SegmentedLog {
 public:
  using AddChannel = std::uint16_t (*)(mcap::Writer& writer, std::string_view topic);

  struct Options {
    std::filesystem::path file;
    std::int64_t offset_ns = 0;   // log time minus a record's own time
    std::int64_t created_ns = 0;  // log time of the attachments
    SegmentLimits limits{};
    mcap::WriterOptions mcap{};
    std::function<void(const std::string&)> say{};  // disk errors in words, at begin and end
  };

  explicit SegmentedLog(Options options);

  std::uint16_t add_topic(std::string_view name, AddChannel add);
  void attach(std::string_view name, std::string_view media_type, std::string_view text);
  void add_metadata(std::string_view name, const std::map<std::string, std::string>& entries);

  // Attachments and metadata added before finish().
  const LogDescription& description() const { return description_; }

  std::uint16_t gap_channel() const { return gap_channel_; }

  // The file for a record of this time.
  mcap::Writer& writer_at(std::int64_t time_ns);
  template <HasFields Record>
  void write(std::uint16_t channel, std::int64_t time_ns, const Record& record) {
    writer_at(time_ns).write(channel, stamp(time_ns), record);
    if constexpr (std::is_same_v<Record, LogGap>) note_gap(record);
  }
  mcap::Stamp stamp(std::int64_t time_ns) const {
    return {time_ns + options_.offset_ns, time_ns + options_.offset_ns};
  }

  // Call it after the last record: writes the pending gap record, if necessary from the disk's reserve.
  void finish();
  void close();

  std::uint64_t lost() const { return lost_; }  // records that the disk did not accept
  const std::string& error() const { return error_; }
  // Hooks for the files beside each log file, here the CAN traffic. on_begin is called with each file after
  // the first when it begins, bytes_beside returns their size, on_remove is called for each removed file.
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

  // Content of the gap records in the open chunk. If the chunk is lost they are reported again.
  struct Said {
    std::uint64_t gaps = 0;
    std::uint64_t lost = 0;
    std::int64_t first_lost_ns = INT64_MAX;
  };
  Said said_{};
  std::uint64_t chunks_settled_ = 0;
  LogGap pending_{};  // lost records without a gap record yet
  bool is_pending_ = false;
  bool failing_ = false;  // the last chunk was lost
  bool sync_failed_ = false;
  bool finished_ = false;
  std::uint64_t lost_ = 0;
  std::string error_;
};

}  // namespace sandhopper
