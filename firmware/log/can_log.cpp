#include "firmware/log/can_log.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace sandhopper {

CanLog::CanLog(const std::filesystem::path& file, std::int64_t realtime_offset_ns, std::size_t slots)
    : writer_(file), realtime_offset_ns_(realtime_offset_ns), slots_(slots) {}

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
}

// Nearly sorted already: the place is near the end.
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
    writer_.write(frame, interfaces_[held->interface]->name);
  }
  held_.erase(held_.begin(), held);
}

void CanLog::note_drops() {
  for (const auto& interface : interfaces_) {
    const std::uint64_t dropped = interface->ring.dropped();
    if (dropped == interface->noted_drops) continue;
    writer_.comment(std::to_string(dropped - interface->noted_drops) + " frames of " + interface->name +
                    " lost: the logger was too slow");
    interface->noted_drops = dropped;
  }
}

void CanLog::close() {
  drain();
  write_until(INT64_MAX);
  writer_.close();
}

std::uint64_t CanLog::dropped() const {
  std::uint64_t sum = 0;
  for (const auto& interface : interfaces_) sum += interface->ring.dropped();
  return sum;
}

}  // namespace sandhopper
