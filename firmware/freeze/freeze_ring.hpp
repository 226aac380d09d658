#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/unique_fd.hpp"
#include "firmware/freeze/freeze_cycle.hpp"
#include "firmware/log/log_description.hpp"

// The newest cycles in shared memory. The memory outlives the process that writes it: after a crash or a
// SIGKILL the guard process, the next start of hopperd, `hop explain` and `hop recover` read it.
namespace sandhopper {

namespace freeze {

inline constexpr std::uint32_t kLayout = 1;  // increase it when anything below changes
inline constexpr std::size_t kSlots = 8192;  // 6 s are written to a frame; 2.1 s remain as margin for a late
                                             // writer
inline constexpr std::size_t kTextBytes = 131'072;

// One cycle. `number` counts cycles since start, from 1. It is 0 while the cycle is being written.
struct Slot {
  std::atomic<std::uint64_t> number{0};
  FreezeCycle cycle{};
};

// Header in front of the slots. The non-atomic values are written once, before the first cycle.
struct Header {
  std::array<char, 8> magic{};
  std::uint32_t layout = 0;
  std::uint32_t slot_bytes = 0;
  std::uint32_t slots = 0;
  std::uint32_t text_bytes = 0;
  std::uint64_t schema_hash = 0;  // schema_hash() of the three records
  std::int64_t start_ns = 0;      // CLOCK_MONOTONIC
  std::int64_t realtime_offset_ns = 0;
  std::int32_t process = 0;
  std::array<char, 32> version{};
  std::array<char, 1024> log_file{};
  std::atomic<std::uint64_t> count{0};       // number of cycles pushed since start
  std::atomic<std::uint64_t> dumped_at{0};   // value of `count` when the guard dumped the ring
  std::atomic<std::uint64_t> written_to{0};  // number of the last cycle whose faults are already in frames
};

struct Block {
  Header header{};
  std::array<char, kTextBytes> text{};
  std::array<Slot, kSlots> slots{};
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

// FNV-1a of the schema texts of SensorFrame, StepOutput and Event, and of their sizes in memory.
std::uint64_t schema_hash();

}  // namespace freeze

// Writer of the ring. One thread pushes; a push copies about 1 kB and makes no wait, lock, allocation or
// system call. Readers in the same process use FreezeReader on bytes().
class FreezeRing {
 public:
  struct Options {
    std::filesystem::path file{};  // on tmpfs; newly created, locked (flock) while this process lives
    std::filesystem::path log_file{};
    std::int64_t start_ns = 0;
    std::int64_t realtime_offset_ns = 0;
    LogDescription description{};
  };
  // Throws std::system_error if the file cannot be created or its memory cannot be reserved.
  explicit FreezeRing(const Options& options);
  // Keeps the file. remove() deletes it at an orderly end.
  ~FreezeRing();
  FreezeRing(const FreezeRing&) = delete;
  FreezeRing& operator=(const FreezeRing&) = delete;

  void push(const SensorFrame& frame, const StepOutput& output, std::span<const Event> events) noexcept {
    const std::uint64_t count = block_->header.count.load(std::memory_order_relaxed);
    freeze::Slot& slot = block_->slots[count % freeze::kSlots];
    slot.number.store(0, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    slot.cycle.frame = frame;
    slot.cycle.output = output;
    const std::size_t kept = std::min(events.size(), slot.cycle.events.size());
    slot.cycle.event_count = static_cast<std::uint32_t>(kept);
    std::copy_n(events.begin(), kept, slot.cycle.events.begin());
    slot.number.store(count + 1, std::memory_order_release);
    block_->header.count.store(count + 1, std::memory_order_release);
  }

  std::span<const std::byte> bytes() const noexcept { return std::as_bytes(std::span(block_, 1)); }
  freeze::Header& header() noexcept { return block_->header; }
  const std::filesystem::path& file() const { return file_; }
  void remove() noexcept;

 private:
  std::filesystem::path file_;
  UniqueFd lock_;
  freeze::Block* block_ = nullptr;
};

// Reader of a ring's bytes, of this process or of a file. If a file is of another version, torn or damaged,
// the constructor throws std::runtime_error with the reason. `bytes` must outlive the reader.
class FreezeReader {
 public:
  explicit FreezeReader(std::span<const std::byte> bytes);

  const freeze::Header& header() const { return *header_; }
  std::string version() const;
  std::filesystem::path log_file() const;
  LogDescription description() const;

  std::uint64_t count() const { return header_->count.load(std::memory_order_acquire); }
  std::uint64_t oldest() const;  // number of the oldest cycle that was not overwritten
  // The cycle with this number (from 1). Empty if it was overwritten before or during the copy.
  std::optional<FreezeCycle> cycle(std::uint64_t number) const;

 private:
  const freeze::Header* header_ = nullptr;
  const char* text_ = nullptr;
  const freeze::Slot* slots_ = nullptr;
};

}  // namespace sandhopper
