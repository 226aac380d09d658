#include "firmware/log/segmented_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace sandhopper {
namespace {

// Disk space kept for the last gap record, attachments at the end, and the summary.
constexpr std::uint64_t kReserve_bytes = 262'144;
// If a new file cannot be created, this much more is written to the old one before the next try.
constexpr std::uint64_t kRetry_bytes = 4'194'304;

}  // namespace

SegmentedLog::SegmentedLog(Options options) : options_(std::move(options)) {
  options_.mcap.keep_going = true;
  options_.mcap.reserve_bytes = kReserve_bytes;
  next_segment_bytes_ = options_.limits.segment_bytes;
  writer_ = make_writer(options_.file);
  gap_channel_ = add_topic(topic::kGap, [](mcap::Writer& writer, std::string_view name) {
    return writer.add_channel<LogGap>(name);
  });
}

std::filesystem::path SegmentedLog::file_of(std::uint32_t number) const {
  if (number == 1) return options_.file;
  auto file = options_.file;
  return file.replace_extension(fmt::format(".part{:04}{}", number, options_.file.extension().string()));
}

std::unique_ptr<mcap::Writer> SegmentedLog::make_writer(const std::filesystem::path& file) const {
  return std::make_unique<mcap::Writer>(file, options_.mcap);
}

std::uint16_t SegmentedLog::add_topic(std::string_view name, AddChannel add) {
  topics_.push_back({std::string(name), add});
  return add(*writer_, name);
}

void SegmentedLog::attach(std::string_view name, std::string_view media_type, std::string_view text) {
  try {
    writer_->attach(name, media_type, options_.created_ns, mcap::bytes_of(text));
  } catch (const std::system_error& error) {
    if (!finished_) throw;
    trouble(fmt::format("{} is not in the log: {}", name, error.what()));
  }
  if (finished_) return;
  description_.attachments.push_back({std::string(name), std::string(media_type), std::string(text)});
}

void SegmentedLog::add_metadata(std::string_view name, const std::map<std::string, std::string>& entries) {
  writer_->add_metadata(name, entries);
  description_.metadata.emplace_back(name, entries);
}

// Each further file begins with the same schemas, attachments and metadata as the first one.
void SegmentedLog::describe(mcap::Writer& writer, std::uint32_t number) const {
  for (const Topic& topic : topics_) topic.add(writer, topic.name);
  for (const auto& a : description_.attachments)
    writer.attach(a.name, a.media_type, options_.created_ns, mcap::bytes_of(a.text));
  for (const auto& [name, entries] : description_.metadata) writer.add_metadata(name, entries);
  writer.add_metadata("segment", {{"number", std::to_string(number)},
                                  {"first_file", options_.file.filename().string()},
                                  {"previous_file", file_of(number - 1).filename().string()}});
}

mcap::Writer& SegmentedLog::writer_at(std::int64_t time_ns) {
  settle();
  writer_->close_chunk_before(time_ns + options_.offset_ns);
  settle();
  if (options_.limits.segment_bytes > 0 && writer_->bytes() >= next_segment_bytes_) begin_segment(time_ns);
  if (is_pending_) write_pending(time_ns);
  return *writer_;
}

// Checks whether the last closed chunk was written.
void SegmentedLog::settle() {
  if (writer_->chunks_closed() == chunks_settled_) return;
  chunks_settled_ = writer_->chunks_closed();
  const auto loss = writer_->take_loss();
  if (loss) merge(*loss);
  const bool fails = loss && loss->synced;
  if (failing_ && !fails && options_.say)
    options_.say("the log can be written again; a gap record says what is missing");
  failing_ = fails;
  said_ = {};
}

void SegmentedLog::merge(const mcap::Loss& loss) {
  const std::string why =
      writer_->path().string() + ": " + std::generic_category().message(loss.error) + ": ";
  if (!is_pending_)
    pending_ = {.first_lost_ns = std::min(loss.first_ns - options_.offset_ns, said_.first_lost_ns),
                .cause = LossCause::sync_failed};
  is_pending_ = true;
  pending_.last_lost_ns = loss.last_ns - options_.offset_ns;
  if (loss.synced) {
    const std::uint64_t records = loss.messages - said_.gaps;
    pending_.cause = LossCause::write_failed;
    pending_.lost += records + said_.lost;
    lost_ += records;
    if (!failing_) trouble(why + "records are being lost");
  } else if (!std::exchange(sync_failed_, true)) {
    trouble(why + "what was written may not be on the disk");
  }
}

// Written as the first record of a chunk. While the disk accepts nothing every chunk is a retry, and its gap
// record is lost with it.
void SegmentedLog::write_pending(std::int64_t time_ns) {
  is_pending_ = false;
  pending_.time_ns = time_ns;
  write_gap(pending_);
}

void SegmentedLog::write_gap(const LogGap& gap) {
  writer_->write(gap_channel_, stamp(gap.time_ns), gap);
  note_gap(gap);
}

void SegmentedLog::note_gap(const LogGap& gap) {
  ++said_.gaps;
  said_.lost += gap.lost;
  said_.first_lost_ns = std::min(said_.first_lost_ns, gap.first_lost_ns);
}

void SegmentedLog::begin_segment(std::int64_t time_ns) {
  writer_->flush();
  settle();
  const auto removed = keep_quota(time_ns);
  const auto file = file_of(number_ + 1);
  std::unique_ptr<mcap::Writer> next;
  try {
    next = make_writer(file);
    describe(*next, number_ + 1);
    end_segment();
    writer_ = std::move(next);
    ++number_;
    chunks_settled_ = 0;
    next_segment_bytes_ = options_.limits.segment_bytes;
    if (on_begin) on_begin(file);
  } catch (const std::system_error& error) {
    if (next) {
      next.reset();
      std::error_code ignored;
      std::filesystem::remove(file, ignored);
    }
    next_segment_bytes_ = writer_->bytes() + kRetry_bytes;
    trouble(fmt::format("no new file is begun: {}", error.what()));
  }
  for (const LogGap& gap : removed) write_gap(gap);
}

void SegmentedLog::end_segment() {
  older_.push_back({writer_->path(), 0, writer_->messages(), writer_->first_ns(), writer_->last_ns()});
  close();
  older_.back().bytes = writer_->bytes() + (bytes_beside ? bytes_beside(writer_->path()) : 0);
}

// Called when a file is full, so that there is room for the next one.
std::vector<LogGap> SegmentedLog::keep_quota(std::int64_t time_ns) {
  std::vector<LogGap> removed;
  if (options_.limits.quota_bytes == 0) return removed;
  std::uint64_t all = writer_->bytes() + (bytes_beside ? bytes_beside(writer_->path()) : 0);
  for (const Segment& segment : older_) all += segment.bytes;
  while (!older_.empty() && all + options_.limits.segment_bytes > options_.limits.quota_bytes) {
    const Segment oldest = older_.front();
    std::error_code error;
    std::filesystem::remove(oldest.file, error);
    if (error) {
      trouble(
          fmt::format("{}: cannot be removed to keep the quota: {}", oldest.file.string(), error.message()));
      break;
    }
    if (on_remove) on_remove(oldest.file);
    removed.push_back({.time_ns = time_ns,
                       .first_lost_ns = oldest.first_ns - options_.offset_ns,
                       .last_lost_ns = oldest.last_ns - options_.offset_ns,
                       .lost = oldest.messages,
                       .cause = LossCause::segment_removed});
    all -= oldest.bytes;
    older_.erase(older_.begin());
  }
  return removed;
}

void SegmentedLog::finish() {
  writer_->flush();
  settle();
  writer_->open_reserve();
  finished_ = true;
  if (!is_pending_) return;
  write_pending(pending_.last_lost_ns);
  writer_->flush();
  settle();
}

void SegmentedLog::close() {
  try {
    writer_->close();
  } catch (const std::system_error& error) {
    trouble(error.what());
  }
  if (const auto loss = writer_->take_loss(); loss && !loss->synced) merge(*loss);
}

void SegmentedLog::trouble(const std::string& what) {
  if (options_.say) options_.say(what);
  if (error_.empty()) error_ = what;
}

}  // namespace sandhopper
