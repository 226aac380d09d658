#pragma once
#include <optional>
#include <span>
#include <vector>

#include "tools/diagnose/plants/hopper/hopper_recording.hpp"

namespace sandhopper::diagnose {

// The controller as it was recorded, held against the believed one. A command is what a controller makes of
// what it measured: nothing of the plant is in between, so that no physics can explain a difference.
class RecordedController {
 public:
  RecordedController() = default;
  RecordedController(const Trial& trial, const Leg& leg, const WorldConfig& believed, double end_s);

  // The leg was recorded well enough to say what should have been commanded.
  bool measured() const { return measured_.time_s.size() >= kLeastSamples; }

  // A command goes with the leg of its own row, or of a row before: a controller that acts on what it
  // received in the cycle before. By which the recorded commands are nearest to the believed controller's,
  // if by less than half.
  void find_age(const WorldConfig& world, double compression_stiffness_N_per_m,
                const std::vector<PhaseChange>& phases);

  // Of both motors, on a grid of 1 ms from zero: what was commanded less what this controller makes of the
  // recorded leg, smoothed. What is left is the encoder's noise on its way through the controller. Empty
  // where the leg or the commands were not recorded.
  Signal residual_Nm(const WorldConfig& world, double compression_stiffness_N_per_m,
                     const std::vector<PhaseChange>& phases) const;

  // Of one motor, at these times, from the leg exactly as it was measured.
  void commands_Nm(const WorldConfig& world, double compression_stiffness_N_per_m,
                   const std::vector<PhaseChange>& phases, std::span<const double> times_s,
                   std::span<double> out) const;

  // Of every change from compression to extension, by how much it came later than its rule says, as the next
  // row shows it: it is due once the leg lengthens again and is shorter than in flight by more than
  // `compression_end_min_deflection_m`; where that is a matter of the encoder's noise, anything from the
  // first such instant to the first that is sure is in time. One that was never made was due before the
  // compression ended. 20 ms at most.
  std::vector<double> late_switches_s(const WorldConfig& world, const std::vector<PhaseChange>& phases) const;

 private:
  static constexpr std::size_t kLeastSamples = 50;
  std::optional<double> due_s(const WorldConfig& world, double from_s, double to_s, double shorter_m) const;

  Leg leg_{LegParameters{}};
  MeasuredLeg measured_;
  Samples commands_;
  Signal smooth_angle_{0.0, 1e-3, {}}, smooth_rate_{0.0, 1e-3, {}};
  double end_s_ = 0.0;
};

std::vector<double> late_switches_s(const Trial& trial, const WorldConfig& world);

}  // namespace sandhopper::diagnose
