#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "config/robot_config.hpp"
#include "firmware/fault.hpp"
#include "tools/faults/forwarding_port.hpp"

namespace sandhopper::faults {

// True state of this cycle, set by the test and not by the code under test.
struct Truth {
  bool emergency_stop = true;
  Fault fault = Fault::none;
};

// Frames that passed the guard. `breach` is empty as long as no frame broke a rule.
struct WireRecord {
  std::string breach;
  std::uint64_t frames = 0;
  std::uint64_t torque_frames = 0;
  std::uint64_t gain_frames = 0;
  double most_torque_share = 0.0;  // relative to the limit
  void note(const std::string& what) {
    if (breach.empty()) breach = what;
  }
};

// Stands between guard and bus and checks every frame that leaves against the rules, with an independent
// implementation: its own decoding by integer division and its own counts. The record and the truth must
// outlive it.
class WireOracle final : public ForwardingPort {
 public:
  WireOracle(std::unique_ptr<CanPort> port, const RobotConfig& robot, const Truth& truth, WireRecord& record);

  void begin_cycle() noexcept override;
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override;
  std::span<const ReceivedFrame> receive(bool& more) noexcept override;

 private:
  struct Fields {
    double position_rad, velocity_radps, kp, kd, torque_Nm;  // at the drive
  };
  struct Motor {
    bool entered = false;
    int replies = 0;
    int energising = 0;  // energising frames in this cycle
    double velocity_radps = 0.0;
  };
  void see(std::size_t i, const can_frame& frame);
  void see_law(std::size_t i, const Fields& f);
  void see_current(std::size_t i, double current_A);
  void see_energised(std::size_t i, bool stiff, bool torque);
  double gain_scale(std::size_t i) const;

  const RobotConfig& robot_;
  const Truth& truth_;
  WireRecord& record_;
  std::array<Motor, kMotorCount> motor_{};
};

}  // namespace sandhopper::faults
