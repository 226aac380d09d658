#include "drivers/can/torque_cut.hpp"

#include <algorithm>
#include <cstring>

#include "drivers/can/cubemars.hpp"

namespace sandhopper {

std::vector<can_frame> torque_cut_frames(const CanConfig& config) {
  const CubeMarsBus bus(config);
  std::vector<can_frame> frames;
  const auto add = [&](DriveAction action) {
    for (std::size_t i = 0; i < bus.motor_count(); ++i) {
      const auto frame = bus.codec(static_cast<Side>(i)).frame(action, {}, {});
      const auto same = [&](const can_frame& f) { return std::memcmp(&f, &*frame, sizeof f) == 0; };
      if (frame && std::none_of(frames.begin(), frames.end(), same)) frames.push_back(*frame);
    }
  };
  add(DriveAction::zero);
  add(DriveAction::leave);
  return frames;
}

TorqueCut::TorqueCut(const CanConfig& config)
    : frames_(torque_cut_frames(config)), socket_(config.interface, {}) {}

void TorqueCut::cut() noexcept {
  for (const auto& frame : frames_) socket_.send(frame);
}

}  // namespace sandhopper
