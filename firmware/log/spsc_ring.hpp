#pragma once
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace sandhopper {

// Bounded queue from one thread to one other. No lock, no wait, and no allocation after construction, which
// also touches every page. Each side keeps a copy of the other's counter and reads the shared one only if the
// copy indicates full or empty (Rigtorp's design), which reduces cache-line contention.
template <class T>
class SpscRing {  // NOLINT(clang-analyzer-optin.performance.Padding): it keeps the sides apart
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit SpscRing(std::size_t slots) : slots_(std::bit_ceil(slots)), mask_(slots_.size() - 1) {}

  std::size_t capacity() const { return slots_.size(); }

  // Producer: returns a free slot to fill before publish(); null if full.
  T* claim() noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head - known_tail_ > mask_) {
      known_tail_ = tail_.load(std::memory_order_acquire);
      if (head - known_tail_ > mask_) return nullptr;
    }
    return &slots_[head & mask_];
  }
  void publish() noexcept {
    head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  // Producer: returns false and counts the drop if full.
  bool push(const T& value) noexcept {
    T* slot = claim();
    if (slot == nullptr) {
      count_drop();
      return false;
    }
    *slot = value;
    publish();
    return true;
  }
  void count_drop() noexcept { dropped_.store(dropped() + 1, std::memory_order_relaxed); }
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  // Consumer: the oldest value, valid until pop(); null if empty.
  const T* front() noexcept {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == known_head_) {
      known_head_ = head_.load(std::memory_order_acquire);
      if (tail == known_head_) return nullptr;
    }
    return &slots_[tail & mask_];
  }
  void pop() noexcept { tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  static constexpr std::size_t kCacheLine = 64;

  std::vector<T> slots_;
  std::size_t mask_;
  alignas(kCacheLine) std::atomic<std::uint64_t> head_{0};
  std::uint64_t known_tail_ = 0;
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> tail_{0};
  std::uint64_t known_head_ = 0;
};

}  // namespace sandhopper
