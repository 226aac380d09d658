#include "firmware/log/trial_logger.hpp"

#include <pthread.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <stdexcept>
#include <utility>

namespace sandhopper {
namespace {

constexpr std::int64_t kPollPeriod_ns = 5'000'000;
constexpr std::size_t kBackgroundSlots = 64;

// Sleeps to the next point of a time grid, so that virtual time wakes it at the same instants in every run.
void sleep_until_grid_point() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  const std::int64_t now_ns = std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
  const std::int64_t next_ns = (now_ns / kPollPeriod_ns + 1) * kPollPeriod_ns;
  time.tv_sec = static_cast<time_t>(next_ns / 1'000'000'000);
  time.tv_nsec = static_cast<long>(next_ns % 1'000'000'000);
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

}  // namespace

TrialLogger::TrialLogger(TrialLogOptions options)
    : options_(std::move(options)),
      log_({.file = options_.mcap_file,
            .offset_ns = options_.realtime_offset_ns,
            .created_ns = options_.start_ns + options_.realtime_offset_ns,
            .limits = options_.limits,
            .mcap = options_.mcap,
            .say = options_.say}),
      cycle_(options_.slots),
      background_(kBackgroundSlots) {
  if (!options_.candump_file.empty()) keep_can_beside();
  cycle_.gap.lane = static_cast<std::uint8_t>(Lane::cycle);
  background_.gap.lane = static_cast<std::uint8_t>(Lane::background);
  topics_.push_back({log_.gap_channel(), Lane::cycle, &write_record<LogGap>});
}

namespace {

std::filesystem::path can_file_beside(const std::filesystem::path& mcap_file) {
  return std::filesystem::path(mcap_file).replace_extension(".candump");
}

}  // namespace

// Each file of the log gets a file of CAN traffic beside it.
void TrialLogger::keep_can_beside() {
  can_ = std::make_unique<CanLog>(options_.candump_file, options_.realtime_offset_ns, options_.can_slots,
                                  options_.mcap.calls);
  const auto beside = [this](const std::filesystem::path& file) {
    return file == options_.mcap_file ? options_.candump_file : can_file_beside(file);
  };
  log_.on_begin = [this, beside](const auto& file) { can_->begin_file(beside(file)); };
  log_.bytes_beside = [beside](const auto& file) {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(beside(file), none);
    return none ? std::uint64_t{0} : std::uint64_t{bytes};
  };
  log_.on_remove = [beside](const auto& file) {
    std::error_code ignored;
    std::filesystem::remove(beside(file), ignored);
  };
}

TrialLogger::~TrialLogger() {
  try {
    stop();
    close();
  } catch (const std::exception&) {
  }
}

std::size_t TrialLogger::add_can_interface(std::string name) {
  if (!can_) throw std::logic_error("no candump file was asked for");
  return can_->add_interface(std::move(name));
}

void TrialLogger::attach(std::string_view name, std::string_view media_type, std::string_view text) {
  log_.attach(name, media_type, text);
}

void TrialLogger::add_metadata(std::string_view name, const std::map<std::string, std::string>& entries) {
  log_.add_metadata(name, entries);
}

void TrialLogger::start() {
  if (options_.own_thread) thread_ = std::thread([this] { run(); });
}

void TrialLogger::push_can(std::size_t interface, const CandumpFrame& frame) noexcept {
  if (can_) can_->push(interface, frame);
}

void TrialLogger::push_bytes(std::uint16_t topic, std::int64_t time_ns, const void* record,
                             std::size_t bytes) noexcept {
  LaneState& lane = lane_of(topics_[topic].lane);
  if (!options_.own_thread && lane.ring.claim() == nullptr) drain();
  LogGap& gap = lane.gap;
  if (gap.lost > 0) {
    gap.time_ns = time_ns;
    if (put(lane, gap_topic_.number, time_ns, &gap, sizeof gap)) gap.lost = 0;
  }
  if (gap.lost == 0 && put(lane, topic, time_ns, record, bytes)) return;
  if (gap.lost == 0) gap.first_lost_ns = time_ns;
  gap.last_lost_ns = time_ns;
  ++gap.lost;
  lane.ring.count_drop();
}

bool TrialLogger::put(LaneState& lane, std::uint16_t topic, std::int64_t time_ns, const void* record,
                      std::size_t bytes) noexcept {
  Slot* slot = lane.ring.claim();
  if (slot == nullptr) return false;
  slot->time_ns = time_ns;
  slot->topic = topic;
  std::memcpy(slot->record, record, bytes);
  lane.ring.publish();
  return true;
}

// The creating thread may run under SCHED_FIFO, which threads inherit: return to ordinary scheduling.
void TrialLogger::run() {
  const sched_param ordinary{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary);
  ::pthread_setname_np(::pthread_self(), "logger");
  while (!stopping_.load(std::memory_order_acquire)) {
    sleep_until_grid_point();
    drain();
  }
}

void TrialLogger::drain() noexcept {
  while (const Slot* slot = cycle_.ring.front()) {
    write_background_until(slot->time_ns - kBackgroundHold_ns);
    write_slot(*slot);
    cycle_.ring.pop();
  }
  if (can_) can_->drain();
  lost_on_disk_.store(log_.lost(), std::memory_order_relaxed);
}

void TrialLogger::write_background_until(std::int64_t time_ns) {
  while (const Slot* slot = background_.ring.front()) {
    if (slot->time_ns > time_ns) return;
    write_slot(*slot);
    background_.ring.pop();
  }
}

void TrialLogger::write_slot(const Slot& slot) {
  const TopicEntry& topic = topics_[slot.topic];
  topic.write(log_, topic.channel, slot.time_ns, slot.record);
}

void TrialLogger::write_final_gap(LaneState& lane) {
  if (lane.gap.lost == 0) return;
  lane.gap.time_ns = lane.gap.last_lost_ns;
  log_.write(log_.gap_channel(), lane.gap.time_ns, lane.gap);
  lane.gap.lost = 0;
}

void TrialLogger::stop() {
  stopping_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
  drain();
  write_background_until(INT64_MAX);
  write_final_gap(cycle_);
  write_final_gap(background_);
  log_.finish();
  if (can_) can_->close();
  lost_on_disk_.store(log_.lost(), std::memory_order_relaxed);
}

void TrialLogger::close() { log_.close(); }

std::string TrialLogger::error() const { return log_.error().empty() && can_ ? can_->error() : log_.error(); }

std::uint64_t TrialLogger::lost_records() const noexcept {
  return cycle_.ring.dropped() + background_.ring.dropped() + lost_on_disk_.load(std::memory_order_relaxed);
}

}  // namespace sandhopper
