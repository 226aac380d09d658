#include "firmware/log/can_log.hpp"

#include <algorithm>
#include <system_error>
#include <tuple>
#include <utility>

namespace sandhopper {
namespace {

constexpr std::uint64_t kCanReserve_bytes = 4096;

}  // namespace

CanLog::CanLog(const std::filesystem::path& file, std::int64_t realtime_offset_ns, std::size_t slots,
               FileCalls calls)
    : calls_(std::move(calls)),
      writer_(make_writer(file)),
      realtime_offset_ns_(realtime_offset_ns),
      slots_(slots) {}

std::unique_ptr<CandumpWriter> CanLog::make_writer(const std::filesystem::path& file) const {
  const CandumpDisk disk{.keep_going = true, .reserve_bytes = kCanReserve_bytes, .calls = calls_};
  return std::make_unique<CandumpWriter>(file, CandumpFormat{}, disk);
}

std::size_t CanLog::add_interface(std::string name) {
  interfaces_.push_back(std::make_unique<Interface>(std::move(name), slots_));
  return interfaces_.size() - 1;
}

void CanLog::push(std::size_t interface, const CandumpFrame& frame) noexcept {
  interfaces_[interface]->ring.push(frame);
}

void CanLog::drain() {
  for (std::size_t i = 0; i < interfaces_.size(); ++i) {
    auto& ring = interfaces_[i]->ring;
    while (const CandumpFrame* frame = ring.front()) {
      hold(*frame, i);
      ring.pop();
    }
  }
  if (newest_ns_ != INT64_MIN) write_until(newest_ns_ - kHold_ns);
  note_drops();
  if (newest_ns_ != INT64_MIN && (synced_ns_ == INT64_MIN || newest_ns_ - synced_ns_ >= kSyncSpan_ns)) sync();
  lost_on_disk_.store(lost_in_older_files_ + writer_->lost(), std::memory_order_relaxed);
}

void CanLog::sync() {
  synced_ns_ = newest_ns_;
  writer_->flush();
  note_error(writer_->error());
  if (const int error = writer_->sync(); error != 0)
    note_error(writer_->path().string() + ": " + std::generic_category().message(error));
}

void CanLog::note_error(const std::string& error) {
  if (error_.empty()) error_ = error;
}

void CanLog::begin_file(const std::filesystem::path& file) {
  auto next = make_writer(file);
  writer_->close();
  lost_in_older_files_ += writer_->lost();
  writer_ = std::move(next);
}

// The frames arrive nearly sorted, so the search from the end is short.
void CanLog::hold(const CandumpFrame& frame, std::size_t interface) {
  newest_ns_ = std::max(newest_ns_, frame.time_ns);
  auto place = held_.end();
  while (place != held_.begin()) {
    const Held& before = *(place - 1);
    if (std::tie(before.frame.time_ns, before.interface) <= std::tie(frame.time_ns, interface)) break;
    --place;
  }
  held_.insert(place, {frame, interface});
}

void CanLog::write_until(std::int64_t time_ns) {
  auto held = held_.begin();
  for (; held != held_.end() && held->frame.time_ns <= time_ns; ++held) {
    CandumpFrame frame = held->frame;
    frame.time_ns += realtime_offset_ns_;
    const auto& name = interfaces_[held->interface]->name;
    if (frame.direction == CanDirection::refused)
      writer_->comment("refused by the transmit guard: " + format_candump(frame, name));
    else
      writer_->write(frame, name);
  }
  held_.erase(held_.begin(), held);
}

void CanLog::note_drops() {
  for (const auto& interface : interfaces_) {
    const std::uint64_t dropped = interface->ring.dropped();
    if (dropped == interface->noted_drops) continue;
    writer_->comment_lost(dropped - interface->noted_drops,
                          "of " + interface->name + ", the logger was too slow");
    interface->noted_drops = dropped;
  }
}

void CanLog::close() {
  drain();
  write_until(INT64_MAX);
  try {
    writer_->close();
  } catch (const std::system_error& error) {
    note_error(error.what());
  }
  note_error(writer_->error());
  lost_on_disk_.store(lost_in_older_files_ + writer_->lost(), std::memory_order_relaxed);
}

std::uint64_t CanLog::lost() const {
  std::uint64_t sum = lost_on_disk_.load(std::memory_order_relaxed);
  for (const auto& interface : interfaces_) sum += interface->ring.dropped();
  return sum;
}

}  // namespace sandhopper
