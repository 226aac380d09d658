#pragma once
#include <atomic>
#include <cstdint>
#include <limits>

#include "firmware/records.hpp"

namespace sandhopper {

// Shared state of the cycle and its watchdogs: beats in one direction, a watchdog's trip in the other. No
// function waits. It may be in memory shared by processes, because its atomics are lock-free.
class Heartbeat {
 public:
  // Called by the cycle once per turn.
  void beat(State state, Fault fault) noexcept {
    state_.store(state, std::memory_order_relaxed);
    fault_.store(fault, std::memory_order_relaxed);
    beats_.store(beats_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }
  // Called by the cycle at its end: from now on missing beats are no stall.
  void end() noexcept { beats_.store(kEnded, std::memory_order_release); }
  // Length [ns] of the stall at which a watchdog tripped since the last call; 0: none.
  std::int64_t take_trip() noexcept { return stall_ns_.exchange(0, std::memory_order_acq_rel); }

  // Called by the watchdogs.
  std::uint64_t beats() const noexcept { return beats_.load(std::memory_order_acquire); }
  bool ended() const noexcept { return beats() == kEnded; }
  bool beating() const noexcept { return beats() != 0 && beats() != kEnded; }
  State state() const noexcept { return state_.load(std::memory_order_relaxed); }
  Fault fault() const noexcept { return fault_.load(std::memory_order_relaxed); }
  void trip(std::int64_t stall_ns) noexcept { stall_ns_.store(stall_ns, std::memory_order_release); }

  // True if the cycle has not yet seen a trip: what it computed before must not be sent.
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
