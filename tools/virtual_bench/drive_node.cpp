#include "tools/virtual_bench/drive_node.hpp"

namespace sandhopper::bench {

DriveNode::DriveNode(const Place& place, Side side, const CubeMarsConfig& config)
    : place_(place),
      drive_(make_drive(
          config, {.sample =
                       [this, side,
                        share = place.world.config().motor.torque_constant_Nm_per_A /
                                config.torque_constant_Nm_per_A] {
                         // The plant has one torque constant for both motors.
                         auto sample = place_.world.now().read_motor(side);
                         sample.current_A *= share;
                         return sample;
                       },
                   .command = [this, side](const MotorCommand& command,
                                           bool enabled) { place_.world.command(side, command, enabled); },
                   .timeout_ns = place.drive_timeout_ns})) {
  wake_for_own();
}

void DriveNode::receive(const can_frame& frame) {
  const auto now_ns = place_.loop.now_ns();
  if (const auto answer = drive_->receive(frame, now_ns))
    place_.loop.at(now_ns + EmulatedDrive::kReplyDelay_ns, [this, answer] { place_.bus.send(*answer); });
  wake_for_own();
}

// One timer that follows the drive's next deed, rather than one a frame.
void DriveNode::wake_for_own() {
  const auto next_ns = drive_->next_own_ns();
  if (next_ns == EmulatedDrive::kNever_ns || awake_at_ns_ != EmulatedDrive::kNever_ns) return;
  awake_at_ns_ = next_ns;
  place_.loop.at(next_ns, [this] {
    awake_at_ns_ = EmulatedDrive::kNever_ns;
    if (const auto frame = drive_->act(place_.loop.now_ns())) place_.bus.send(*frame);
    wake_for_own();
  });
}

}  // namespace sandhopper::bench
