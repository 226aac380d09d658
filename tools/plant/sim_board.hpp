#pragma once
#include <array>

#include "firmware/board.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper {

// The simulated world behind the cycle's seam, in the process. read() moves the world to the frame's time and
// takes the newest samples, each fresh in the one cycle that first sees it; write() acts at that same instant
// and samples the drives' replies, which the next read() delivers. A drive answers in every mode; it makes
// torque in `run` only.
class SimBoard : public Board {
 public:
  explicit SimBoard(World& world) : world_(world) {}

  void read(SensorFrame& frame) noexcept override;
  void write(const Command& command) noexcept override;

 private:
  World& world_;
  std::array<MotorSample, kMotorCount> reply_{};  // fresh: not delivered yet
};

}  // namespace sandhopper
