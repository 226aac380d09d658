#pragma once
#include "tools/conceal/core/random.hpp"
#include "tools/conceal/hopper/leg.hpp"

namespace sandhopper::conceal::hopper {

// Phase of the gait, as in the channel `phase`.
enum class Phase { flight = 0, compression = 1, extension = 2 };

// Inputs of the controller in one cycle.
struct Seen {
  double t_s, angle_rad, angle_rate_radps, foot_over_surface_m;
};

// The nominal 1 kHz controller on measured values: a virtual leg spring in each phase. Torques have the
// resolution of the CAN frame. Hidden deviations from the configuration are included.
class Controller {
 public:
  Controller(const World& world, const Setup& setup);

  // Sum of the torques of both motors, Nm.
  double torque_Nm(const Seen& seen);
  Phase phase() const { return phase_; }

 private:
  double hop_N(const Seen& seen, const Curve& leg, double rate_mps);
  void switch_phase(const Seen& seen, double length_m, double rate_mps);

  const World& world_;
  std::string kind_;
  double compression_N_per_m_, extension_N_per_m_;
  double sweep_centre_rad_, sweep_rad_, sweep_Hz_;
  Phase phase_ = Phase::flight;
  bool left_ground_ = true;
};

}  // namespace sandhopper::conceal::hopper
