#pragma once
#include <span>

namespace sandhopper {

// Work of the guard process after it has cut the torque, for example writing shared memory to a file. It runs
// in a fork of a program with threads: run() may make only async-signal-safe calls (signal-safety(7)), may
// not allocate, and must end by itself. It sees what hopperd writes after the fork only in memory that was
// mapped with MAP_SHARED before the fork.
class LastAct {
 public:
  virtual ~LastAct() = default;

  // Called once after hopperd's death, in the guard process after its last cut, and once per standstill, in a
  // child of the guard process while the cuts go on.
  virtual void run() noexcept = 0;

  // File descriptors that run() needs, open before the fork. The guard process closes all others.
  virtual std::span<const int> descriptors() const noexcept { return {}; }
};

}  // namespace sandhopper
