#include "tools/diagnose/plants/hopper/hopper_balance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>

#include "tools/diagnose/plants/hopper/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper/hopper_recording.hpp"
#include "tools/plant/plant.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kSmoothing = 5;  // samples to each side, of the leg's angle
// Margin after a liftoff, until the load cell is at rest, and before a touchdown.
constexpr double kSettled_s = 0.02;
constexpr double kAloft_m = 1.0;                       // foot height without contact
constexpr double kSlow_mps = 0.01, kSlow_radps = 0.2;  // dry friction changes its sign within these speeds
constexpr double kStribeck_mps = 0.1;
constexpr double kLost = 3.5;                 // in median steps: a longer interval is a gap
constexpr double kSteepest_m_per_rad = 0.03;  // least |dL/dphi|: a straight leg shows nothing of its joint

struct Grid {
  double start_s = 0.0;
  std::size_t count = 0;
  double at(std::size_t i) const { return start_s + kTick_s * static_cast<double>(i); }
};

Signal on(const Grid& grid, const Samples& samples) {
  return on_grid(samples, grid.start_s, kTick_s, grid.count, false);
}

// Per grid point, 1 if it lies between samples without a gap. Dropouts and clipped samples leave gaps.
std::vector<char> recorded_on(const Grid& grid, const Samples& samples) {
  std::vector<char> out(grid.count, 0);
  const double far_s = kLost * median_step_s(samples.time_s);
  for (std::size_t i = 0; i < grid.count; ++i) {
    const auto next = std::ranges::lower_bound(samples.time_s, grid.at(i));
    out[i] = next != samples.time_s.begin() && next != samples.time_s.end() && *next - *(next - 1) < far_s;
  }
  return out;
}

struct Height {
  std::vector<double> z_m, v_mps;
};

// Height of the body: its acceleration, integrated twice. The height sensor gives the start, the initial
// speed and a constant error of the accelerometer.
std::optional<Height> height_of(const Trial& trial, const Grid& grid, const Signal& accel_mps2) {
  auto samples = samples_of(trial, "mocap_body_z_m");
  if (samples.value.size() < 10) samples = without_repeats(samples_of(trial, "tof_height_m"));
  if (samples.value.size() < 10) return std::nullopt;
  Height height{std::vector<double>(grid.count, 0.0), std::vector<double>(grid.count, 0.0)};
  for (std::size_t i = 1; i < grid.count; ++i) {
    height.v_mps[i] = height.v_mps[i - 1] + 0.5 * kTick_s * (accel_mps2.values[i - 1] + accel_mps2.values[i]);
    height.z_m[i] = height.z_m[i - 1] + 0.5 * kTick_s * (height.v_mps[i - 1] + height.v_mps[i]);
  }
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const auto basis = [](double t) { return Eigen::Vector3d(1.0, t, 0.5 * t * t); };
  const Signal z{grid.start_s, kTick_s, height.z_m};
  for (std::size_t k = 0; k < samples.value.size(); ++k) {
    const double t = samples.time_s[k] - grid.start_s;
    if (t < 0.0 || t > kTick_s * static_cast<double>(grid.count - 1)) continue;
    normal += basis(t) * basis(t).transpose();
    right += basis(t) * (samples.value[k] - z.at(samples.time_s[k]));
  }
  const Eigen::Vector3d c = (normal + Eigen::Matrix3d::Identity() * 1e-9).ldlt().solve(right);
  for (std::size_t i = 0; i < grid.count; ++i) {
    const double t = kTick_s * static_cast<double>(i);
    height.z_m[i] += c.dot(basis(t));
    height.v_mps[i] += c[1] + c[2] * t;
  }
  return height;
}

// Per grid point, 1 in the recorded flights, except close to liftoff and touchdown. All 0 without recorded
// phases.
std::vector<char> flights(const Grid& grid, const std::vector<PhaseChange>& phases) {
  std::vector<char> aloft(grid.count, 0);
  for (std::size_t i = 0; i < grid.count && !phases.empty(); ++i) {
    const double t = grid.at(i);
    aloft[i] =
        phase_at(phases, t) == HopperPhase::flight &&
        (t < phases.front().time_s + kSettled_s || phase_at(phases, t - kSettled_s) == HopperPhase::flight) &&
        phase_at(phases, t + kSettled_s) == HopperPhase::flight;
  }
  return aloft;
}

// The recorded channels of one trial on one time grid, and the believed friction and cogging.
struct Recorded {
  Signal body_mps2, foot_mps2, angle_rad, rate_radps;
  std::vector<char> body_recorded, foot_recorded, aloft;
  std::optional<Height> height;
  Signal cell_N, motor_Nm;  // empty: not recorded
  Signal rail_believed_N, joint_believed_Nm;

  bool weighed() const { return !cell_N.values.empty(); }
  bool driven() const { return !motor_Nm.values.empty(); }
};

Recorded recorded_of(const Trial& trial, const Grid& grid, const WorldConfig& world,
                     const HopperCourse& course) {
  const auto body = samples_of(trial, "imu_body_accel_z_mps2");
  const auto foot = samples_of(trial, "imu_foot_accel_z_mps2");
  const auto angle = mean_of_motors(trial, "position_rad");
  Recorded r;
  r.body_mps2 = on(grid, body);
  r.foot_mps2 = on(grid, foot);
  const auto smoothed = smooth(angle, kSmoothing);
  r.angle_rad = on(grid, {angle.time_s, smoothed.value});
  r.rate_radps = on(grid, {angle.time_s, smoothed.rate});
  r.body_recorded = recorded_on(grid, body);
  r.foot_recorded = recorded_on(grid, foot);
  Signal accel = r.body_mps2;
  for (double& a : accel.values) a -= world.gravity_mps2;
  r.height = height_of(trial, grid, accel);
  r.aloft = flights(grid, course.phases);
  const Signal nothing{grid.start_s, kTick_s, {}};
  const auto cell = samples_of(trial, "load_cell_force_N");
  r.cell_N = cell.value.size() >= 50 ? on(grid, cell) : nothing;
  const auto currents = mean_of_motors(trial, "current_A");
  r.motor_Nm = currents.value.size() >= 100 ? on(grid, currents) : nothing;
  for (double& tau : r.motor_Nm.values)
    tau *= world.robot.leg.motor_count * world.motor.torque_constant_Nm_per_A;
  return r;
}

// Computes the believed friction and cogging. They and the motor torque get the low-pass of the
// accelerometers, so that all terms are filtered alike.
void believe_friction(const Belief& belief, const WorldConfig& world, const Leg& leg, const Grid& grid,
                      Recorded& r) {
  const Bed bed(world.terrain, world.robot.leg.foot_radius_m);
  Plant plant(world, bed);
  r.rail_believed_N = {grid.start_s, kTick_s, std::vector<double>(grid.count, 0.0)};
  r.joint_believed_Nm = r.rail_believed_N;
  for (std::size_t i = 0; i < grid.count; ++i) {
    const double dl = leg.kinematics(r.angle_rad.values[i]).dlength_m_per_rad;
    plant.place({.foot_z_m = kAloft_m,
                 .foot_velocity_mps = (r.height ? r.height->v_mps[i] : 0.0) - dl * r.rate_radps.values[i],
                 .angle_rad = r.angle_rad.values[i],
                 .angular_velocity_radps = r.rate_radps.values[i]});
    const PlantMotion motion = plant.motion(0.0);
    r.rail_believed_N.values[i] = motion.rail_force_N;
    r.joint_believed_Nm.values[i] = motion.joint_torque_Nm;
  }
  if (const double bandwidth_Hz = sensor_belief(belief, "imu", "mps2").bandwidth_Hz; bandwidth_Hz > 0.0)
    for (Signal* signal : {&r.motor_Nm, &r.rail_believed_N, &r.joint_believed_Nm})
      if (!signal->values.empty()) signal->low_pass(1.0 / (2.0 * std::numbers::pi * bandwidth_Hz));
}

// Central differences; 0 at the ends.
std::vector<double> rates_of(const Grid& grid, const Signal& signal) {
  std::vector<double> rate(grid.count, 0.0);
  for (std::size_t i = 1; i + 1 < grid.count && i + 1 < signal.values.size(); ++i)
    rate[i] = (signal.values[i + 1] - signal.values[i - 1]) / (2.0 * kTick_s);
  return rate;
}

// Appends one value to each regressor in `balance.known`.
void know(Balance& balance, std::initializer_list<double> shapes) {
  balance.known.resize(shapes.size());
  auto column = balance.known.begin();
  for (const double shape : shapes) (column++)->push_back(shape);
}

// Both balances at one instant.
class Instant {
 public:
  Instant(const Recorded& r, const Leg& leg, const Grid& grid, std::size_t i)
      : r_(r), i_(i), time_s_(grid.at(i)), d_(leg.dynamics(r.angle_rad.values[i])) {
    spin2_ = r.rate_radps.values[i] * r.rate_radps.values[i];
    if (!is_known()) return;
    phidd_ = (r.body_mps2.values[i] - r.foot_mps2.values[i] - d_.leg.d2length_m_per_rad2 * spin2_) / dl();
    const double ground_N = r.aloft[i] != 0 ? 0.0 : r.cell_N.values[i];
    rail_N_ =
        d_.m11_kg * r.foot_mps2.values[i] + d_.m12_kg_m * phidd_ + d_.dm12_kg_m_per_rad * spin2_ - ground_N;
  }

  bool is_known() const {
    if (std::abs(dl()) < kSteepest_m_per_rad || (r_.aloft[i_] == 0 && !r_.weighed())) return false;
    return r_.body_recorded[i_] != 0 && r_.foot_recorded[i_] != 0;
  }

  // Regressors: friction (dry, viscous, Stribeck, proportional to the load), cable, and on the ground the
  // accelerations. Errors of masses, accelerometers and load cell are proportional to these. In flight they
  // are left out, because the accelerations contain the rail's force itself.
  void add_rail(Balance& rail) const {
    if (!r_.height) return;
    const double z = r_.height->z_m[i_], v = r_.height->v_mps[i_], sign = std::tanh(v / kSlow_mps);
    const double load_N = r_.driven() ? std::abs(r_.motor_Nm.values[i_] / dl()) : 0.0;
    const double on_ground = r_.aloft[i_] != 0 ? 0.0 : 1.0;
    rail.rest.push_back(rail_N_ - r_.rail_believed_N.values[i_]);
    rail.states.push_back(RailState{.time_s = time_s_, .height_m = z, .velocity_mps = v});
    know(rail, {sign, v, sign * std::exp(-std::pow(v / kStribeck_mps, 2)), sign * load_N, z,
                on_ground * r_.body_mps2.values[i_], on_ground * r_.foot_mps2.values[i_]});
  }

  // Regressors: friction (dry, viscous), torque constant, saturation, delay, cogging.
  void add_joint(double motor_rate, double cogging_periods_per_rev, Balance& joint) const {
    if (!r_.driven()) return;
    const double phi = r_.angle_rad.values[i_], w = r_.rate_radps.values[i_], tau = r_.motor_Nm.values[i_];
    const double torque_Nm =
        d_.m22_kg_m2 * phidd_ + d_.m12_kg_m * r_.foot_mps2.values[i_] + 0.5 * d_.dm22_kg_m2_per_rad * spin2_;
    joint.rest.push_back(torque_Nm - tau - dl() * rail_N_ - r_.joint_believed_Nm.values[i_]);
    joint.states.push_back(
        AxisState{.time_s = time_s_, .angle_rad = phi, .velocity_radps = w, .torque_Nm = tau});
    const double cog = cogging_periods_per_rev * phi;
    know(joint,
         {std::tanh(w / kSlow_radps), w, tau, tau * std::abs(tau), motor_rate, std::sin(cog), std::cos(cog)});
  }

 private:
  double dl() const { return d_.leg.dlength_m_per_rad; }

  const Recorded& r_;
  std::size_t i_;
  double time_s_;
  LegDynamics d_;
  double spin2_ = 0.0, phidd_ = 0.0, rail_N_ = 0.0;
};

}  // namespace

std::vector<Balance> balances_of(const Trial& trial, const Belief& belief) {
  const WorldConfig world = world_of(belief, {});
  const Leg leg(world.robot.leg);
  const auto body = samples_of(trial, "imu_body_accel_z_mps2");
  const auto foot = samples_of(trial, "imu_foot_accel_z_mps2");
  const auto angle = mean_of_motors(trial, "position_rad");
  if (body.value.size() < 100 || foot.value.size() < 100 || angle.value.size() < 100) return {};
  const auto course = course_of(trial, leg, world.controller.compression_length_m);
  Grid grid;
  grid.start_s = std::max({course.hops.front().from_s, body.time_s.front(), foot.time_s.front()});
  const double end_s = std::min({course.end_s, body.time_s.back(), foot.time_s.back()});
  if (end_s < grid.start_s + 0.1) return {};
  grid.count = static_cast<std::size_t>((end_s - grid.start_s) / kTick_s);

  Recorded recorded = recorded_of(trial, grid, world, course);
  believe_friction(belief, world, leg, grid, recorded);
  const auto motor_rate = rates_of(grid, recorded.motor_Nm);
  Balance rail{"rail", {}, {}, {}}, joint{"joint", {}, {}, {}};
  for (std::size_t i = 0; i < grid.count; ++i) {
    const Instant instant(recorded, leg, grid, i);
    if (!instant.is_known()) continue;
    instant.add_rail(rail);
    instant.add_joint(motor_rate[i], world.robot.cogging_periods_per_rev, joint);
  }
  return {std::move(rail), std::move(joint)};
}

}  // namespace sandhopper::diagnose
