#include "firmware/freeze/freeze_recorder.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "drivers/clock.hpp"
#include "firmware/freeze/freeze_folders.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kLook_ns = 20'000'000;

}  // namespace

FreezeRecorder::FreezeRecorder(FreezeOptions options) : options_(std::move(options)) {
  const auto memory = freeze::writable_memory_folder();
  if (!memory) {
    options_.warn("no freeze frames: no folder in memory can be written; is /dev/shm mounted?");
    return;
  }
  memory_ = *memory;
  const auto name = fmt::format("hopperd-{}-{}{}", ::getpid(), options_.start_ns, freeze::kMemoryEnding);
  try {
    ring_ =
        std::make_unique<FreezeRing>(FreezeRing::Options{.file = memory_ / name,
                                                         .log_file = options_.log_file,
                                                         .start_ns = options_.start_ns,
                                                         .realtime_offset_ns = options_.realtime_offset_ns,
                                                         .description = options_.description});
  } catch (const std::system_error& error) {
    options_.warn(fmt::format("no freeze frames: {}", error.what()));
    return;
  }
  try {
    dump_ = std::make_unique<FreezeDump>(*ring_, options_.folder);
  } catch (const std::system_error& error) {
    options_.warn(
        fmt::format("freeze frames have no room on the disk and stay in {}, until the computer is "
                    "restarted: {}",
                    memory_.string(), error.what()));
  }
}

FreezeRecorder::~FreezeRecorder() { stop(); }

void FreezeRecorder::start() {
  if (ring_) thread_ = std::thread([this] { run(); });
}

// The creating thread may run under SCHED_FIFO, which threads inherit: return to ordinary scheduling.
void FreezeRecorder::run() {
  const sched_param ordinary{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary);
  ::pthread_setname_np(::pthread_self(), "freeze");
  for (const auto& frame : write_leftovers(options_.folder, freeze::memory_folders(), options_.warn))
    if (options_.told) options_.told(frame);
  freeze::keep_newest(options_.folder, options_.newest);
  while (!stopping_.load(std::memory_order_acquire)) {
    look();
    sleep_ns(kLook_ns);
  }
}

void FreezeRecorder::look() {
  if (!ring_) return;
  const FreezeReader reader(ring_->bytes());
  const std::uint64_t count = reader.count();
  const auto newest = reader.cycle(count);
  if (!newest) return;
  for (const auto& instant : faults_after(reader, looked_to_)) due_.push_back(instant);
  looked_to_ = count;
  if (dump_) dump_->take_back();
  while (!due_.empty() && newest->frame.time_ns >= due_.front().time_ns + kFreezeAfter_ns) {
    write(due_.front());
    due_.erase(due_.begin());
  }
}

void FreezeRecorder::write(const FreezeInstant& instant) {
  const FreezeReader reader(ring_->bytes());
  for (const auto& folder : {options_.folder, memory_}) {
    try {
      const auto frame = write_frame(reader, instant, folder);
      ring_->header().written_to.store(instant.number, std::memory_order_release);
      freeze::keep_newest(folder, options_.newest);
      if (options_.told) options_.told(frame);
      return;
    } catch (const std::system_error& error) {
      options_.warn(
          fmt::format("the freeze frame of {} cannot be written: {}", name_of(instant.fault), error.what()));
    }
  }
  kept_ = true;
}

void FreezeRecorder::stop() {
  stopping_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
  if (!ring_ || std::exchange(ended_, true)) return;
  look();
  for (const auto& instant : due_) write(instant);
  due_.clear();
  if (dump_) dump_->remove();
  if (kept_)
    options_.warn(fmt::format("the last seconds stay in {}; the next start of hopperd writes their frames",
                              ring_->file().string()));
  else
    ring_->remove();
}

}  // namespace sandhopper
