#pragma once
#include <atomic>
#include <cstdint>
#include <limits>

#include "firmware/records.hpp"

namespace sandhopper {

// What the cycle and those who watch it share: beats one way, the watchdog's trip the other. Nothing here
// waits. It may lie in memory shared by processes: its atomics take no lock.
class Heartbeat {
 public:
  // The cycle's, once a turn.
  void beat(State state, Fault fault) noexcept {
    state_.store(state, std::memory_order_relaxed);
    fault_.store(fault, std::memory_order_relaxed);
    beats_.store(beats_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }
  // The cycle has ended: from now on silence is right.
  void end() noexcept { beats_.store(kEnded, std::memory_order_release); }
  // For how long the watchdog saw it stand still and tripped, since the last call; 0: it did not.
  std::int64_t take_trip() noexcept { return stall_ns_.exchange(0, std::memory_order_acq_rel); }

  // The watchers'.
  std::uint64_t beats() const noexcept { return beats_.load(std::memory_order_acquire); }
  bool ended() const noexcept { return beats() == kEnded; }
  bool beating() const noexcept { return beats() != 0 && beats() != kEnded; }
  State state() const noexcept { return state_.load(std::memory_order_relaxed); }
  Fault fault() const noexcept { return fault_.load(std::memory_order_relaxed); }
  void trip(std::int64_t stall_ns) noexcept { stall_ns_.store(stall_ns, std::memory_order_release); }

  // A trip that the cycle has not seen yet: what it computed before is not to be sent any more.
  bool tripped() const noexcept { return stall_ns_.load(std::memory_order_acquire) != 0; }

 private:
  static constexpr std::uint64_t kEnded = std::numeric_limits<std::uint64_t>::max();
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free &&
                std::atomic<std::int64_t>::is_always_lock_free && std::atomic<State>::is_always_lock_free &&
                std::atomic<Fault>::is_always_lock_free);
  std::atomic<std::uint64_t> beats_{0};
  std::atomic<std::int64_t> stall_ns_{0};
  std::atomic<State> state_{State::idle};
  std::atomic<Fault> fault_{Fault::none};
};

}  // namespace sandhopper
