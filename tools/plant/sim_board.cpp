#include "tools/plant/sim_board.hpp"

namespace sandhopper {
namespace {

template <class Sample>
void take(Sample& held, const Sample& newest) noexcept {
  const bool fresh = newest.time_ns != held.time_ns;
  if (fresh) held = newest;
  held.fresh = fresh;
}

}  // namespace

void SimBoard::read(SensorFrame& frame) noexcept {
  world_.advance_to(frame.time_ns);
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    if (reply_[i].fresh) frame.motor[i] = reply_[i];
    frame.motor[i].fresh = reply_[i].fresh;
    reply_[i].fresh = false;
  }
  take(frame.imu_body, world_.imu_body());
  take(frame.imu_foot, world_.imu_foot());
  take(frame.tof, world_.tof());
  take(frame.load_cell, world_.load_cell());
  frame.emergency_stop = false;
}

void SimBoard::write(const Command& command) noexcept {
  const bool enabled = command.drive == DriveRequest::run;
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    const auto side = static_cast<Side>(i);
    world_.command(side, command.motor[i], enabled);
    reply_[i] = world_.read_motor(side);
  }
  if (command.open_catch) world_.open_catch();
}

}  // namespace sandhopper
