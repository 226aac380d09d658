#pragma once
#include <array>

#include "firmware/board.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper {

// The simulated world as a board in the same process. read() advances the world to the frame's time and takes
// the newest samples; each is fresh only in the cycle that first sees it. write() acts at the same instant
// and samples the drives' replies, which the next read() delivers. A drive answers in every mode, but
// produces torque only in `run`.
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
