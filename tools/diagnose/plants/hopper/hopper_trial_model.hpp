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

// The parts of one recorded hop: its rows, what differs from trial to trial, and its readings.
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

// The way from a run to a recorded channel: trace, sensor, nuisances.
struct ChannelSource {
  const char* channel;
  Signal HopperTraces::*trace;
  const char* sensor;  // of the belief's keys
  const char* unit;
  std::size_t every;  // sample that is kept: fast channels say the same thing many times
  std::optional<TrialNuisance> offset{}, scale{}, age{};
};
inline constexpr std::array<ChannelSource, 14> kSources{
    {{"motor_left_position_rad", &HopperTraces::angle_rad, "", "", 4},
     {"motor_right_position_rad", &HopperTraces::angle_rad, "", "", 4},
     {"motor_left_velocity_radps", &HopperTraces::rate_radps, "encoder_velocity", "radps", 4},
     {"motor_right_velocity_radps", &HopperTraces::rate_radps, "encoder_velocity", "radps", 4},
     {"motor_left_current_A", &HopperTraces::current_torque_Nm, "", "", 2, kLeftOffset},
     {"motor_right_current_A", &HopperTraces::current_torque_Nm, "", "", 2, kRightOffset},
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

// Rows, nuisances and labels are in hopper_trial.cpp, runs and readings in hopper_predict.cpp.
class HopperTrial final : public TrialModel {
 public:
  HopperTrial(const Trial& trial, const Belief& belief);

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
  // Sampling rate of a sensor with a clock of its own; 0: it is sampled with the rows.
  double rate_Hz(std::size_t c) const;
  // A sensor that samples more often than rows are written, with a clock of its own, leaves no empty cells
  // that would tell when: a row holds the latest sample, half a period old in the middle.
  double period_within_rows_s(std::size_t c, double step_s) const;
  void add_rows(const Trial& trial, std::size_t c);
  std::uint32_t block_at(double t) const;
  Phase window_at(double t) const;
  // A leg that is thrown against its end stop bounces: when, depends on hundredths of a millisecond.
  void end_before_end_stop(const Trial& trial);
  // A controller that never sees the next landing records no end of its flight: the simulation knows it.
  void end_before_next_landing();
  void label_rows();

  // The run with another controller than is believed: what was commanded is held against that one.
  HopperTraces simulated(const WorldConfig& world, const Edits& edits, std::uint32_t block,
                         std::span<const double> n) const;
  HopperRun run_of(const WorldConfig& world, std::uint32_t block, std::span<const double> n) const;
  void read_channel(const WorldConfig& world, const HopperTraces& traces, const Edits& edits,
                    std::span<const double> n, std::size_t c, const Span& span, std::span<double> at) const;
  // What was commanded follows from what was measured, not from the run; mostly by the controller as
  // believed.
  void read_command(const WorldConfig& world, const Edits& edits, const Span& span,
                    std::span<double> at) const;
  // Instants of a slow sensor's samples. No recording tells whether a row holds the value at the sample's
  // instant or at the row's: `age_share` is between.
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
  mutable std::map<std::size_t, std::vector<double>> believed_commands_;  // by a span's first row
  Belief belief_;
  WorldConfig world_;
  double compression_stiffness_ = 375.0;
  double motor_temperature_C_ = kRoom_C;
  BedHistory bed_history_;
  HopperCourse course_;
  Signal commands_{0.0, kTick_s, {}}, residual_{0.0, kTick_s, {}};
  RecordedController controller_;
  BedGrains grains_;
  std::array<std::vector<Span>, kSources.size()> spans_;
  std::array<SensorBelief, kSources.size()> sensors_{};
  std::vector<double> times_, ages_s_;
};

}  // namespace sandhopper::diagnose::hopper
