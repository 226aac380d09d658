#include "firmware/supervision/motion_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "config/robot_config.hpp"

namespace sandhopper {
namespace {

constexpr double kDt_s = 1e-3;
const DetectorMask kAll;

// The check alone, cycle by cycle. Only samples that a test sets are fresh.
class Motion {
 public:
  explicit Motion(CycleConfig config = cycle_config(RobotConfig{})) : config_(std::move(config)) {
    estimate.leg_length_m = 0.3;
    estimate.body_z_m = 0.40;
    estimate.foot_z_m = 0.05;
    estimate.normalised_innovation_squared.fill(kNotMeasured);
  }
  FaultFound next(State state = State::flight) {
    Findings findings(kAll);
    check_.see(frame, estimate, {state, kDt_s, true}, findings);
    return findings.worst();
  }
  // Number of the first cycle with a fault; 0: none in `cycles`.
  template <class Change>
  int first_fault(int cycles, Change&& change, State state = State::flight) {
    for (int k = 1; k <= cycles; ++k) {
      change(k * kDt_s);
      found = next(state);
      if (found.fault != Fault::none) return k;
    }
    return 0;
  }
  double weight_N() const {
    return (config_.robot.body_mass_kg + config_.robot.foot_mass_kg) * kGravity_mps2;
  }
  void move(double height_m, double velocity_mps) {
    estimate.body_z_m = 0.40 + height_m;
    estimate.foot_z_m = 0.05 + height_m;
    estimate.body_velocity_mps = estimate.foot_velocity_mps = velocity_mps;
  }

  SensorFrame frame{};
  Estimate estimate{};
  FaultFound found{};

 private:
  CycleConfig config_;
  Leg leg_{config_.robot};
  MotionCheck check_{config_, leg_};
};

TEST(MotionCheckEnergy, ABallisticFlightKeepsIts) {
  Motion motion;
  EXPECT_EQ(motion.first_fault(400,
                               [&](double t) {
                                 motion.move(1.9 * t - 0.5 * kGravity_mps2 * t * t, 1.9 - kGravity_mps2 * t);
                               }),
            0);
}

// At constant speed the energy gain is weight times height: 2 J after 95 ms. The fault needs five cycles
// above the limit.
TEST(MotionCheckEnergy, ARobotThatIsLiftedGainsIt) {
  Motion motion;
  const int at = motion.first_fault(400, [&](double t) { motion.move(t, 1.0); });
  EXPECT_EQ(motion.found.fault, Fault::energy_implausible);
  const double limit_s = 2.0 / motion.weight_N() + kDt_s;  // counted from the first cycle of the flight
  EXPECT_NEAR(at * kDt_s, limit_s + 4 * kDt_s, 1.1 * kDt_s);
}

TEST(MotionCheckEnergy, IsTheMotorsBusinessInStance) {
  Motion motion;
  EXPECT_EQ(motion.first_fault(
                150, [&](double t) { motion.move(t, 1.0); }, State::extension),
            0);
}

TEST(MotionCheckEnergy, EachFlightBeginsAnew) {
  Motion motion;
  double height_m = 0.0;
  for (int flight = 0; flight < 5; ++flight) {
    for (int k = 0; k < 30; ++k) {
      motion.move(height_m += 1e-3, 1.0);
      ASSERT_EQ(motion.next().fault, Fault::none) << height_m << " m in all";
    }
    motion.next(State::compression);
  }
}

// The body at rest, tilted by `angle_rad` about y.
void lean(SensorFrame& frame, double angle_rad) {
  frame.imu_body.fresh = true;
  frame.imu_body.accel_mps2 = {-kGravity_mps2 * std::sin(angle_rad), 0.0,
                               kGravity_mps2 * std::cos(angle_rad)};
}

TEST(MotionCheckTilt, IsTheDirectionOfGravityAtRest) {
  for (const double sign : {-1.0, 1.0}) {
    Motion upright, leaning;
    lean(upright.frame, sign * 0.19);
    lean(leaning.frame, sign * 0.21);
    EXPECT_EQ(upright.first_fault(2000, [](double) {}), 0);
    EXPECT_EQ(leaning.first_fault(1, [](double) {}), 1);
    EXPECT_EQ(leaning.found.fault, Fault::tilt_limit);
    EXPECT_NEAR(leaning.found.values[0], 0.21, 1e-9);
  }
}

// Free fall shows no gravity, so the gyroscope alone gives the tilt: 0.2 rad at 1 rad/s.
TEST(MotionCheckTilt, IsTheGyroscopesIntegralInFreeFall) {
  Motion motion;
  lean(motion.frame, 0.0);
  motion.next();
  motion.frame.imu_body.accel_mps2 = {0.0, 0.0, 0.1};
  motion.frame.imu_body.gyro_radps = {1.0, 0.0, 0.0};
  EXPECT_NEAR(motion.first_fault(400, [](double) {}), 201, 1);
  EXPECT_EQ(motion.found.fault, Fault::tilt_limit);
}

TEST(MotionCheckTilt, AnImpactsSidewaysBlowIsNoTilt) {
  Motion motion;
  lean(motion.frame, 0.0);
  motion.next();
  EXPECT_EQ(motion.first_fault(50, [&](double) { motion.frame.imu_body.accel_mps2 = {30.0, 0.0, 40.0}; }), 0);
}

TEST(MotionCheckTilt, AGyroscopesBiasIsHeldBackByGravity) {
  Motion motion;
  lean(motion.frame, 0.0);
  motion.frame.imu_body.gyro_radps = {0.0, 0.1, 0.0};  // 0.05 rad remain, by the filter's time constant of
                                                       // 0.5 s
  EXPECT_EQ(motion.first_fault(20'000, [](double) {}), 0);
}

TEST(MotionCheckHeight, AFilterThatRefusesTwentyReadingsInARowHasDiverged) {
  Motion motion;
  motion.estimate.innovation[0] = -0.07;
  motion.estimate.normalised_innovation_squared[0] = 37.0;
  EXPECT_EQ(motion.first_fault(
                100, [](double) {}, State::armed),
            20);
  EXPECT_EQ(motion.found.fault, Fault::estimate_diverged);
  EXPECT_EQ(motion.found.values[0], -0.07);
}

// Number of cycles until the fault; `squared_at`: normalised innovation squared of cycle i, i from 1 on.
template <class Squared>
int first_refused(int cycles, Squared&& squared_at) {
  Motion motion;
  int cycle = 0;
  return motion.first_fault(
      cycles, [&](double) { motion.estimate.normalised_innovation_squared[0] = squared_at(++cycle); });
}

TEST(MotionCheckHeight, OutliersAmongReadingsThatAreTakenAreNothing) {
  EXPECT_EQ(first_refused(1000, [](int reading) { return reading % 20 == 0 ? 0.5 : 400.0; }), 0);
}

TEST(MotionCheckHeight, CyclesWithoutAReadingNeitherCountNorForgive) {
  EXPECT_EQ(first_refused(100, [](int cycle) { return cycle % 3 == 0 ? 37.0 : kNotMeasured; }), 60);
}

TEST(MotionCheckHeight, TheGateIsTheFilters) {
  auto config = cycle_config(RobotConfig{});
  config.estimator.kalman.tof_gate_sigma = 10.0;
  Motion motion(config);
  motion.estimate.normalised_innovation_squared[0] = 99.0;
  EXPECT_EQ(motion.first_fault(100, [](double) {}), 0);
}

}  // namespace
}  // namespace sandhopper
