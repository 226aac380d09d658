#pragma once
#include "estimation/leg.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/records.hpp"
#include "terrain/ground_events.hpp"

namespace sandhopper {

// Accumulates a stride's regressions in the cycle. The sums are committed whenever a new greatest depth is
// reached. So the result ends at the end of penetration, although that instant is not known in advance.
class StrideRecorder {
 public:
  struct Foot {
    double radius_m;
    double reduced_mass_kg;  // of foot and leg in flight
  };
  StrideRecorder(const StiffnessConfig& config, const Foot& foot);

  void on_release(std::int64_t now_ns) noexcept;
  void on_touchdown(std::int64_t now_ns) noexcept;
  void on_switch(std::int64_t now_ns) noexcept;
  // Closes the stride; sums() is complete afterwards and the next flight begins.
  void on_liftoff(std::int64_t now_ns) noexcept;

  void update(const Estimate& estimate, State state) noexcept;

  const StrideSums& sums() const noexcept { return done_; }
  // True for one update: the foot has left its crater and the samples of that stance are complete. They
  // remain until the next contact.
  bool foot_is_clear() const noexcept { return clear_; }
  const GroundEventSums& event_sums() const noexcept { return events_.sums(); }
  std::uint32_t strides_begun() const noexcept { return current_.stride; }
  // Greatest depth of the present stride on new ground; 0 before it reaches new ground.
  double new_ground_m() const noexcept { return new_deepest_m_; }
  // Expected height of the ground: at first the surface, then the floor of the foot's own crater.
  double surface_z_m() const noexcept { return surface_z_m_; }

 private:
  void begin_flight(std::int64_t release_ns) noexcept;
  bool still_falling(const Estimate& estimate) const noexcept;
  void restart_sums() noexcept;
  void accumulate(const Estimate& estimate, double depth_m) noexcept;
  JointSample joint_sample(const Estimate& estimate, double depth_m, std::int64_t contact_ns) const noexcept;
  void commit() noexcept;
  void take_crater_floor(std::int64_t now_ns) noexcept;
  bool on_new_ground(const JointSample& sample) const noexcept;
  void begin_events(const Estimate& estimate) noexcept;
  void follow_leaving_foot(const Estimate& estimate) noexcept;
  double event_time_s() const noexcept;
  bool counts(const Estimate& estimate, double depth_m) const noexcept;

  StiffnessConfig config_;
  RecursiveRegression quasi_static_;
  RecursiveRegression observer_;
  RecursiveRegression weighted_;
  JointRegression joint_;
  ProfileRegression profile_;
  UnloadingRecorder unloading_;
  double reduced_mass_kg_;
  GroundEventRecorder events_;
  StrideSummary current_{};
  StrideSums committed_{};
  StrideSums done_{};
  double datum_m_ = 0.0;          // depth estimated by the filter at which the first stride met the surface
  double deepest_m_ = 0.0;        // of this and all earlier strides, below that datum
  double new_deepest_m_ = 0.0;    // of this stride on new ground; 0 before it reaches new ground
  bool rested_ = false;           // since its last sample on new ground the foot stood still or moved up
  double crater_depth_m_ = 0.0;   // of earlier strides
  double deepest_force_N_ = 0.0;  // force without drag and added mass at the deepest point
  double crater_force_N_ = 0.0;   // the same for earlier strides
  double contact_depth_m_ = 0.0;  // depth estimated by the filter at contact
  double surface_z_m_ = 0.0;
  double last_foot_z_m_ = 0.0;
  std::int64_t last_force_time_ns_ = 0;
  double sample_duration_s_ = 0.0;
  bool touched_ = false;  // contact of this stride was detected
  std::int64_t event_contact_ns_ = 0;
  bool leaving_ = false;  // after liftoff, until the foot is clear of its crater
  bool rises_ = false;
  bool clear_ = false;
};

StrideRecorder::Foot foot_in_flight(const CycleConfig& config, const Leg& leg) noexcept;

StrideResult solve_stride(const StrideSums& sums, const StiffnessConfig& config) noexcept;

}  // namespace sandhopper
