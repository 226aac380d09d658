#pragma once
#include <optional>
#include <span>
#include <vector>

#include "tools/diagnose/plants/hopper/hopper_recording.hpp"

namespace sandhopper::diagnose {

// Longest time from the rule of a switch to the row that shows it: a controller may ask for its rule in three
// cycles in a row, read its sensors half a cycle before it acts, and act up to half a cycle before that row.
// No belief states these.
inline constexpr double kCyclesToSwitch = 4.0;

// Compares the recorded controller with the believed one. A command depends only on the controller and on
// what it measured, not on the plant. No physics can therefore explain a difference.
class RecordedController {
 public:
  RecordedController() = default;
  RecordedController(const Trial& trial, const Leg& leg, const WorldConfig& believed, double end_s);

  // True if the leg was recorded well enough to compute the expected commands.
  bool measured() const { return measured_.time_s.size() >= kLeastSamples; }

  // Finds by how many rows, 0 to 2, a command is later than the measurement it uses: a controller may act on
  // what it received in an earlier cycle. A larger age must halve the difference from the believed
  // controller's commands.
  void find_age(const WorldConfig& world, double compression_stiffness_N_per_m,
                const std::vector<PhaseChange>& phases);

  double age_s() const { return age_s_; }

  // Smooths the recorded leg again, as its difference from a simulated one. The leg's rate bends sharply
  // where the command jumps; smoothing the recording itself would round that off, and the command that
  // follows from it. `angle_rad`, `rate_radps`: of a simulation with the same phase changes.
  void smooth_about(const Signal& angle_rad, const Signal& rate_radps);

  // Recorded command minus what this controller computes from the smoothed recorded leg; both motors, on a 1
  // ms grid from 0. The rest is the encoder's noise that passed the controller. Empty if the leg or the
  // commands were not recorded.
  Signal residual_Nm(const WorldConfig& world, double compression_stiffness_N_per_m,
                     const std::vector<PhaseChange>& phases) const;

  // Commands of one motor at these times, computed from the leg as it was measured.
  void commands_Nm(const WorldConfig& world, double compression_stiffness_N_per_m,
                   const std::vector<PhaseChange>& phases, std::span<const double> times_s,
                   std::span<double> out) const;

  // Delay of every change from compression to extension against its rule, as the next row shows it, s; at
  // most +-20 ms. The change is due once the leg lengthens again and is shorter than in flight by more than
  // `compression_end_min_deflection_m`, and stays so for kCyclesToSwitch or until the change: near the turn
  // the speed's noise makes and breaks the rule. If the encoder's noise makes that uncertain, any time from
  // the first possible to the first certain instant is in time. A change that never came was due before the
  // compression ended, when its rule held first.
  std::vector<double> late_switches_s(const WorldConfig& world, const std::vector<PhaseChange>& phases) const;

 private:
  static constexpr std::size_t kLeastSamples = 50;
  void take_smoothed(const Signal* angle_rad, const Signal* rate_radps);
  struct Between {
    double from_s, to_s, switch_s;
  };
  // Start of the time in which the rule holds until `switch_s`, or long enough; else the first time after it.
  std::optional<double> due_s(const WorldConfig& world, const Between& times, double shorter_m) const;

  Leg leg_{LegParameters{}};
  MeasuredLeg measured_;
  Samples commands_;
  Signal smooth_angle_{0.0, 1e-3, {}}, smooth_rate_{0.0, 1e-3, {}};
  double end_s_ = 0.0, rate_time_constant_s_ = 0.0, age_s_ = 0.0;
};

// The same for a recorded trial.
std::vector<double> late_switches_s(const Trial& trial, const WorldConfig& world);

}  // namespace sandhopper::diagnose
