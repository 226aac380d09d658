#pragma once
#include <span>

namespace sandhopper {

// Work that the guard process does after it has cut the torque, for example writing shared memory to a file.
// It runs in the guard process, a fork of a program with threads: run() may only make async-signal-safe calls
// (signal-safety(7)), may not allocate, and must end by itself. Memory that hopperd writes after the fork is
// seen only if it is mapped with MAP_SHARED before the fork.
class LastAct {
 public:
  virtual ~LastAct() = default;

  // Called after the cut: once after hopperd's death, and once per standstill while hopperd still exists. The
  // torque is cut again after each call, so a long call delays the next cut.
  virtual void run() noexcept = 0;

  // File descriptors that run() needs, open before the fork. The guard process closes all others.
  virtual std::span<const int> descriptors() const noexcept { return {}; }
};

}  // namespace sandhopper
