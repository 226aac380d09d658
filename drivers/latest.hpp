#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace sandhopper {

// Hands the newest value from one writer thread to one reader thread; older ones not yet taken are dropped.
//
// Three slots: the writer owns one, the reader owns one, and the third is exchanged through one atomic index.
// Both sides are wait-free and never touch the same slot. So a cycle that interrupts its writer on the same
// processor cannot block, as the reader of a sequence lock would.
template <class T>
class Latest {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  // Writer thread only.
  void publish(const T& value) noexcept {
    slots_[writer_].value = value;
    writer_ = shared_.exchange(writer_ | kUnread, std::memory_order_acq_rel) & kIndex;
  }

  // Reader thread only. False, and `value` untouched, when nothing new was published since the last take.
  bool take(T& value) noexcept {
    if ((shared_.load(std::memory_order_relaxed) & kUnread) == 0) return false;
    reader_ = shared_.exchange(reader_, std::memory_order_acq_rel) & kIndex;
    value = slots_[reader_].value;
    return true;
  }

 private:
  static constexpr std::uint32_t kUnread = 4;
  static constexpr std::uint32_t kIndex = 3;
  struct alignas(64) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_{};
  alignas(64) std::atomic<std::uint32_t> shared_{0};
  alignas(64) std::uint32_t writer_ = 1;
  alignas(64) std::uint32_t reader_ = 2;
};

}  // namespace sandhopper
