#pragma once
#include <linux/can.h>

#include <cstdint>
#include <functional>

#include "drivers/can/can_config.hpp"
#include "tools/virtual_bench/bench_world.hpp"
#include "tools/virtual_bench/event_loop.hpp"

namespace sandhopper::bench {

// One CubeMars drive in MIT mode, as its manual and Katz' firmware describe it and apart from the driver's
// code:
//   - answers every frame for its id, once, with the state at the instant of the frame, about 0.22 ms later
//   - FF..FC enters motor mode, FF..FD leaves it, FF..FE makes the present position zero and is silent for a
//   second
//   - makes torque in motor mode only; without a frame for 25 ms it drops the command but stays in motor mode
// The plant's link turns `sign / gear_ratio` of the drive's output, plus the zero offset.
class MitDrive {
 public:
  using Send = std::function<void(const can_frame&)>;

  struct Wiring {
    EventLoop& loop;
    BenchWorld& world;
    Send send;
  };
  MitDrive(const Wiring& wiring, Side side, const CubeMarsConfig& config);

  void receive(const can_frame& frame);

 private:
  struct State {
    double position_rad, velocity_radps, torque_Nm;  // of the drive's output
    double temperature_C;
    std::uint8_t error_code;
  };

  State state() const;
  can_frame reply() const;
  void obey(const can_frame& frame);
  void command(const MotorCommand& link);
  void watch_silence();

  Wiring wiring_;
  Side side_;
  CubeMarsConfig config_;
  bool motor_mode_ = false;
  double zero_rad_ = 0.0;  // of the drive's output, as set by FF..FE
  std::int64_t last_frame_ns_ = 0;
  std::int64_t silent_until_ns_ = 0;
  bool watched_ = false;
};

}  // namespace sandhopper::bench
