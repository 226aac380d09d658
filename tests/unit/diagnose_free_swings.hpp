#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/unit/diagnose_campaigns.hpp"

namespace sandhopper::diagnose {

struct FreeSwing {
  double viscous_Nm_s = 0.0;
  double coulomb_Nm = 0.0;
  double gravity_torque_Nm = 2.0;  // the belief has 2 N m
  double kick_Nm = 0.0;            // acts for a tenth of a second at a time of its own in each trial
  std::vector<double> zeros_rad{0.0, 0.0, 0.0, 0.0};  // offset of the encoder in each trial
};

// Four trials of a pendulum that swings free for 6 s.
inline Recordings free_swings(const FreeSwing& swing) {
  constexpr double kInertia_kg_m2 = 0.1, kStep_s = 1e-4, kSwitch_radps = 0.02;
  Recordings r = swings([](double, double, double) { return 0.0; }, 1, 4);
  for (std::size_t i = 0; i < r.trials.size(); ++i) {
    Random random(7, i);
    Trial& trial = r.trials[i];
    trial.time_s.clear();
    for (auto& [name, values] : trial.channels) values.clear();
    double angle = 0.6 + 0.1 * static_cast<double>(i), speed = 0.0;
    const double kick_s = 2.0 + 0.7 * static_cast<double>(i);
    for (long step = 0; step < 60'000; ++step) {
      const double t = kStep_s * static_cast<double>(step);
      if (step % 100 == 0) {
        trial.time_s.push_back(t);
        trial.channels["position_rad"].push_back(angle + swing.zeros_rad[i] + 5e-4 * random.normal());
        trial.channels["velocity_radps"].push_back(speed + 0.02 * random.normal());
        trial.channels["torque_Nm"].push_back(0.0);
      }
      const double torque_Nm = (std::abs(t - kick_s) < 0.05 ? swing.kick_Nm : 0.0) -
                               swing.gravity_torque_Nm * std::sin(angle) - swing.viscous_Nm_s * speed -
                               swing.coulomb_Nm * std::tanh(speed / kSwitch_radps);
      speed += kStep_s / kInertia_kg_m2 * torque_Nm;
      angle += kStep_s * speed;
    }
  }
  return r;
}

}  // namespace sandhopper::diagnose
