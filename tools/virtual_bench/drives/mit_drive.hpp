#pragma once
#include "tools/virtual_bench/drives/emulated_drive.hpp"

namespace sandhopper::bench {

// A drive of board V1/V2 in MIT mode, as its manual and Katz' firmware describe it:
//   - answers every frame for its id, once, with the state at the instant of the frame
//   - FF..FC enters motor mode, FF..FD leaves it, FF..FE makes the present position zero and is silent for
//     a second
//   - makes torque in motor mode only; without a frame for 25 ms (Wiring::timeout_ns) it drops the command
//   but stays in motor mode
class MitDrive : public EmulatedDrive {
 public:
  MitDrive(const CubeMarsConfig& config, Wiring wiring);

  std::optional<can_frame> receive(const can_frame& frame, std::int64_t now_ns) override;
  std::int64_t next_own_ns() const override;
  std::optional<can_frame> act(std::int64_t now_ns) override;

 private:
  OutputState state() const;
  can_frame reply() const;
  void obey(const can_frame& frame, std::int64_t now_ns);

  CubeMarsConfig config_;
  Wiring wiring_;
  std::int64_t timeout_ns_;
  bool motor_mode_ = false;
  bool commanded_ = false;  // since the watchdog last acted
  double zero_rad_ = 0.0;   // of the drive's output, as set by FF..FE
  std::int64_t last_frame_ns_ = 0;
  std::int64_t silent_until_ns_ = INT64_MIN;
};

}  // namespace sandhopper::bench
