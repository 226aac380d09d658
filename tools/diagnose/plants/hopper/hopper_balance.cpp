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

constexpr std::size_t kSmoothing = 5;                  // samples to each side, of the leg's angle
constexpr double kSettled_s = 0.02;                    // after a liftoff: the load cell has come to rest
constexpr double kAloft_m = 1.0;                       // out of the bed's reach
constexpr double kSlow_mps = 0.01, kSlow_radps = 0.2;  // dry friction turns round within that
constexpr double kStribeck_mps = 0.1;
constexpr double kLost = 3.5;                 // usual steps between samples: between them nothing is known
constexpr double kSteepest_m_per_rad = 0.03;  // a straight leg says nothing of its joint

struct Grid {
  double start_s = 0.0;
  std::size_t count = 0;
  double at(std::size_t i) const { return start_s + kTick_s * static_cast<double>(i); }
};

Signal on(const Grid& grid, const Samples& samples) {
  return on_grid(samples, grid.start_s, kTick_s, grid.count, false);
}

// Whether a sample was recorded no farther off than a few usual steps: what fell out or was clipped left
// none.
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

// The body's height: its acceleration twice integrated, with start, speed and a constant error of the
// accelerometer from the height sensor.
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

// Aloft as the controller saw it, but for the moments after a liftoff; without phases nowhere.
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

  const Signal s_body = on(grid, body), s_foot = on(grid, foot);
  const auto smoothed = smooth(angle, kSmoothing);
  const Signal phi = on(grid, {angle.time_s, smoothed.value}), spin = on(grid, {angle.time_s, smoothed.rate});
  const auto body_recorded = recorded_on(grid, body), foot_recorded = recorded_on(grid, foot);
  Signal accel = s_body;
  for (double& a : accel.values) a -= world.gravity_mps2;
  const auto height = height_of(trial, grid, accel);
  const auto aloft = flights(grid, course.phases);
  const auto cell_samples = samples_of(trial, "load_cell_force_N");
  const bool weighed = cell_samples.value.size() >= 50;
  const Signal cell = weighed ? on(grid, cell_samples) : Signal{grid.start_s, kTick_s, {}};
  const auto currents = mean_of_motors(trial, "current_A");
  const bool driven = currents.value.size() >= 100;
  Signal motor = driven ? on(grid, currents) : Signal{grid.start_s, kTick_s, {}};
  for (double& tau : motor.values) tau *= world.robot.leg.motor_count * world.motor.torque_constant_Nm_per_A;

  // What is believed of friction and cogging, seen through the accelerometers' filter like everything else.
  const Bed bed(world.terrain, world.robot.leg.foot_radius_m);
  Plant plant(world, bed);
  Signal rail_believed{grid.start_s, kTick_s, std::vector<double>(grid.count, 0.0)};
  Signal joint_believed = rail_believed;
  for (std::size_t i = 0; i < grid.count; ++i) {
    const double dl = leg.kinematics(phi.values[i]).dlength_m_per_rad;
    plant.place({.foot_z_m = kAloft_m,
                 .foot_velocity_mps = (height ? height->v_mps[i] : 0.0) - dl * spin.values[i],
                 .angle_rad = phi.values[i],
                 .angular_velocity_radps = spin.values[i]});
    const PlantMotion motion = plant.motion(0.0);
    rail_believed.values[i] = motion.rail_force_N;
    joint_believed.values[i] = motion.joint_torque_Nm;
  }
  if (const double bandwidth_Hz = sensor_belief(belief, "imu", "mps2").bandwidth_Hz; bandwidth_Hz > 0.0)
    for (Signal* signal : {&motor, &rail_believed, &joint_believed})
      if (!signal->values.empty()) signal->low_pass(1.0 / (2.0 * std::numbers::pi * bandwidth_Hz));

  const auto rates = [&](const Signal& signal) {
    std::vector<double> rate(grid.count, 0.0);
    for (std::size_t i = 1; i + 1 < grid.count && i + 1 < signal.values.size(); ++i)
      rate[i] = (signal.values[i + 1] - signal.values[i - 1]) / (2.0 * kTick_s);
    return rate;
  };
  const auto motor_rate = rates(motor);
  Balance rail{"rail", {}, {}, {}}, joint{"joint", {}, {}, {}};
  const auto know = [](Balance& balance, std::initializer_list<double> shapes) {
    balance.known.resize(shapes.size());
    auto column = balance.known.begin();
    for (const double shape : shapes) (column++)->push_back(shape);
  };
  for (std::size_t i = 0; i < grid.count; ++i) {
    const auto d = leg.dynamics(phi.values[i]);
    const double dl = d.leg.dlength_m_per_rad, spin2 = spin.values[i] * spin.values[i];
    if (std::abs(dl) < kSteepest_m_per_rad || (aloft[i] == 0 && !weighed)) continue;
    if (body_recorded[i] == 0 || foot_recorded[i] == 0) continue;
    const double phidd = (s_body.values[i] - s_foot.values[i] - d.leg.d2length_m_per_rad2 * spin2) / dl;
    const double ground_N = aloft[i] != 0 ? 0.0 : cell.values[i];
    const double rail_N =
        d.m11_kg * s_foot.values[i] + d.m12_kg_m * phidd + d.dm12_kg_m_per_rad * spin2 - ground_N;
    if (height) {
      rail.rest.push_back(rail_N - rail_believed.values[i]);
      rail.states.push_back({.time_s = grid.at(i), .position = height->z_m[i], .velocity = height->v_mps[i]});
      // Friction (dry, viscous, greater near standstill, with the load), cable. Aloft accelerations hold the
      // force that is asked for; on the ground what masses, accelerometers and load cell show otherwise than
      // believed goes with them.
      const double v = height->v_mps[i], sign = std::tanh(v / kSlow_mps);
      const double load_N = driven ? std::abs(motor.values[i] / dl) : 0.0;
      const double on_ground = aloft[i] != 0 ? 0.0 : 1.0;
      know(rail, {sign, v, sign * std::exp(-std::pow(v / kStribeck_mps, 2)), sign * load_N, height->z_m[i],
                  on_ground * s_body.values[i], on_ground * s_foot.values[i]});
    }
    if (driven) {
      const double torque_Nm =
          d.m22_kg_m2 * phidd + d.m12_kg_m * s_foot.values[i] + 0.5 * d.dm22_kg_m2_per_rad * spin2;
      joint.rest.push_back(torque_Nm - motor.values[i] - dl * rail_N - joint_believed.values[i]);
      joint.states.push_back({.time_s = grid.at(i),
                              .position = phi.values[i],
                              .velocity = spin.values[i],
                              .load = motor.values[i]});
      // Friction, the motors' constant, saturation and delay, cogging.
      const double w = spin.values[i], tau = motor.values[i];
      const double cog = world.robot.cogging_periods_per_rev * phi.values[i];
      know(joint, {std::tanh(w / kSlow_radps), w, tau, tau * std::abs(tau), motor_rate[i], std::sin(cog),
                   std::cos(cog)});
    }
  }
  return {std::move(rail), std::move(joint)};
}

}  // namespace sandhopper::diagnose
