#pragma once
#include <array>
#include <cstdint>

#include "estimation/leg.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"
#include "firmware/supervision/counts.hpp"
#include "firmware/supervision/findings.hpp"

namespace sandhopper {

// Checks the sensors against each other and against the possible motion of a robot on a rail. supervisor.hpp
// states when.
class MotionCheck {
 public:
  MotionCheck(const CycleConfig& config, const Leg& leg) noexcept : config_(config), leg_(leg) {}

  struct Context {
    State state;
    double dt_s;
    bool estimating;  // the estimate belongs to this frame
  };
  void see(const SensorFrame& frame, const Estimate& estimate, const Context& context,
           Findings& findings) noexcept;

 private:
  static constexpr std::size_t kWindow_cycles = 20;

  void see_imus(const SensorFrame& frame, const Context& context, Findings& findings) noexcept;
  void see_tilt(const ImuSample& imu, double dt_s, Findings& findings) noexcept;
  void see_tof(const TofSample& tof, Findings& findings) noexcept;
  void see_load_cell(const Estimate& estimate, const Context& context, Findings& findings) noexcept;
  void see_estimate(const Estimate& estimate, const Context& context, Findings& findings) noexcept;
  void see_height(const Estimate& estimate, Findings& findings) noexcept;
  void see_energy(const Estimate& estimate, const Context& context, Findings& findings) noexcept;
  double leg_rate_mps(const SensorFrame& frame) const noexcept;

  const CycleConfig& config_;
  const Leg& leg_;
  // Integrated difference of both IMUs, and the leg's rate, over the last cycles.
  struct Instant {
    double integral_mps = 0.0;
    double leg_rate_mps = 0.0;
  };
  std::array<Instant, kWindow_cycles> window_{};
  std::size_t cycles_ = 0;
  double integral_mps_ = 0.0;
  std::array<double, 2> last_accel_mps2_{};
  int blind_ = 0;  // cycles until the window contains no clipped sample and no impact
  int disagree_ = 0;
  std::array<LeakyCount, 2> spin_{LeakyCount{1.0}, LeakyCount{1.0}};
  std::array<double, 2> tilt_rad_{};
  bool tilt_known_ = false;
  double tof_level_m_ = 0.0;
  std::int64_t tof_level_ns_ = 0;
  int tof_outliers_ = 0;
  double load_cell_error_N_ = 0.0;
  int load_cell_wrong_ = 0;
  int heights_refused_ = 0;
  double flight_energy_J_ = 0.0;
  bool in_flight_ = false;
  int too_energetic_ = 0;
};

}  // namespace sandhopper
