#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/model/plant.hpp"
#include "tools/diagnose/plants/hopper/hopper_recording.hpp"
#include "tools/diagnose/plants/hopper/hopper_runs.hpp"
#include "tools/diagnose/plants/hopper/hopper_trial.hpp"
#include "tools/diagnose/plants/hopper/recorded_controller.hpp"
#include "tools/diagnose/plants/intruder/bed_grains.hpp"

// Model of one recorded hop: rows, nuisances and readings.
namespace sandhopper::diagnose::hopper {

enum Phase : std::uint32_t { kFlight, kTouchdown, kCompression, kSwitch, kExtension, kLiftoff };

enum TrialNuisance : std::size_t {
  kStiffness,
  kReleaseHeight,
  kReleaseSpeed,
  kReleaseAngle,
  kSurface,
  kCable,
  kTorqueConstant,
  kTofBias,
  kBodyBias,
  kFootBias,
  kBodyScale,
  kFootScale,
  kLeftOffset,
  kRightOffset,
  kCellOffset,
  kTofAge,
  kCellAge,
  kMocapAge,
  kFirstKnot
};
enum HopNuisance : std::size_t { kFootZ, kFootV, kAngle, kRate, kCrater, kHopNuisances };

// From a run to a recorded channel: trace, sensor, nuisances.
struct ChannelSource {
  const char* channel;
  Signal HopperTraces::*trace;
  const char* sensor;  // prefix of the sensor's keys in the belief
  const char* unit;
  std::size_t every;  // one sample in so many is used; the others of a fast channel add little
  std::optional<TrialNuisance> offset{}, scale{}, age{};  // nuisances of the reading, if it has them
};
inline constexpr std::array<ChannelSource, 14> kSources{
    {{"motor_left_position_rad", &HopperTraces::angle_rad, "", "", 4},
     {"motor_right_position_rad", &HopperTraces::angle_rad, "", "", 4},
     {"motor_left_velocity_radps", &HopperTraces::rate_radps, "encoder_velocity", "radps", 4},
     {"motor_right_velocity_radps", &HopperTraces::rate_radps, "encoder_velocity", "radps", 4},
     {"motor_left_current_A", &HopperTraces::current_torque_Nm, "current", "A", 2, kLeftOffset},
     {"motor_right_current_A", &HopperTraces::current_torque_Nm, "current", "A", 2, kRightOffset},
     {"command_left_torque_Nm", &HopperTraces::command_torque_Nm, "", "", 4},
     {"command_right_torque_Nm", &HopperTraces::command_torque_Nm, "", "", 4},
     {"imu_body_accel_z_mps2", &HopperTraces::body_accel_mps2, "imu", "mps2", 2, kBodyBias, kBodyScale},
     {"imu_foot_accel_z_mps2", &HopperTraces::foot_accel_mps2, "imu", "mps2", 2, kFootBias, kFootScale},
     {"tof_height_m", &HopperTraces::body_z_m, "tof", "m", 1, kTofBias, {}, kTofAge},
     {"load_cell_force_N", &HopperTraces::force_N, "load_cell", "N", 1, kCellOffset, {}, kCellAge},
     {"mocap_body_z_m", &HopperTraces::body_z_m, "mocap", "m", 1, {}, {}, kMocapAge},
     {"mocap_foot_z_m", &HopperTraces::foot_z_m, "mocap", "m", 1, {}, {}, kMocapAge}}};
enum Source : std::size_t {
  kLeftCurrent = 4,
  kRightCurrent,
  kLeftCommand,
  kRightCommand,
  kImuBody,
  kImuFoot,
  kTof,
  kLoadCell
};
constexpr bool is_command(std::size_t source) { return source == kLeftCommand || source == kRightCommand; }
constexpr bool is_accelerometer(std::size_t source) { return source == kImuBody || source == kImuFoot; }

// Rows, nuisances and labels are in hopper_trial.cpp, runs and readings in hopper_predict.cpp.
class HopperTrial final : public TrialModel {
 public:
  HopperTrial(const Trial& trial, const Belief& belief);

  // True if each command is computed from the row before and acts in its own row: the recorder wrote commands
  // and phases a row late.
  bool has_late_commands() const { return has_late_commands_; }

  void predict(const Edits& edits, std::span<const double> n, std::span<double> out) const override;
  std::vector<VariantPair> variants() const override;
  void predict_variant(const Variant& variant, const Edits& edits, std::span<const double> n,
                       std::span<double> out) const override;

 private:
  struct Span {
    std::size_t first = 0, count = 0;
  };

  void take_commands(const Trial& trial);
  void add_nuisances();
  double deepest_believed_m() const;
  // Time after the release until an accelerometer's low-pass has forgotten whether it started from the catch,
  // which reads 1 g, or from the fall: t = period + tau ln(g / noise).
  double imu_settling_s(double period_s) const;
  // Sampling rate of a sensor with a clock of its own; 0: it is sampled with the rows.
  double rate_Hz(std::size_t c) const;
  // Sampling period of a sensor that samples faster than the rows, with its own clock; 0 for others. It
  // leaves no empty cells: a row holds the latest sample, on average half a period old.
  double period_within_rows_s(std::size_t c, double step_s) const;
  void add_rows(const Trial& trial, std::size_t c);
  std::uint32_t block_at(double t) const;
  Phase window_at(double t) const;
  // Ends the course before the leg hits its end stop: the time of the bounce depends on hundredths of a
  // millisecond.
  void end_before_end_stop(const Trial& trial);
  // Ends the course before the next landing if the recorded phases do not show it; the simulation gives its
  // time.
  void end_before_next_landing();
  void label_rows();

  // The believed world after `edits`. The last one is kept, because most predictions in a row share it.
  const WorldConfig& edited_world(const Edits& edits) const;
  // Simulates one block. If `edits` change the controller, the residual command is computed against the
  // changed one.
  HopperTraces simulated(const WorldConfig& world, const Edits& edits, std::uint32_t block,
                         std::span<const double> n) const;
  HopperRun run_of(const WorldConfig& world, std::uint32_t block, std::span<const double> n) const;
  void read_channel(const WorldConfig& world, const HopperTraces& traces, const Edits& edits,
                    std::span<const double> n, std::size_t c, const Span& span, std::span<double> at) const;
  // Commands follow from the recorded measurements, not from the run. Those of the believed controller are
  // cached.
  void read_command(const WorldConfig& world, const Edits& edits, const Span& span,
                    std::span<double> at) const;
  // Sampling instants of a slow sensor. No recording tells if a row holds the value at the sampling instant
  // (`age_share` 1) or at the row's time (0).
  std::vector<double> sampled(const Span& span, double age_share) const;
  double compression_stiffness_of(const Edits& edits) const {
    return edits.edited("controller.compression_stiffness_N_per_m", compression_stiffness_);
  }
  static double offset_of(std::size_t c, std::span<const double> n) {
    return kSources[c].offset ? n[*kSources[c].offset] : 0.0;
  }
  static double scale_of(std::size_t c, std::span<const double> n) {
    return kSources[c].scale ? 1.0 + n[*kSources[c].scale] : 1.0;
  }
  static double age_share(std::size_t c, std::span<const double> n) {
    return kSources[c].age ? kAgeShare + n[*kSources[c].age] : 1.0;
  }

  mutable HopperRuns runs_;
  mutable std::map<std::size_t, std::vector<double>> believed_commands_;  // key: first row of a span
  Belief belief_;
  WorldConfig world_;
  mutable std::vector<BeliefEdit> edits_of_world_;
  mutable WorldConfig edited_world_;
  double compression_stiffness_ = 375.0;
  double motor_temperature_C_ = kRoom_C;
  BedHistory bed_history_;
  HopperCourse course_;
  std::vector<PhaseChange> phases_at_cycles_;  // those of `course_`, for the simulated controller
  Signal commands_{0.0, kTick_s, {}}, residual_{0.0, kTick_s, {}};
  bool has_late_commands_ = false;
  RecordedController controller_;
  BedGrains grains_;
  std::array<std::vector<Span>, kSources.size()> spans_;
  std::array<SensorBelief, kSources.size()> sensors_{};
  std::vector<double> times_, ages_s_;
};

}  // namespace sandhopper::diagnose::hopper
