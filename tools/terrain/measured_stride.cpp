#include "tools/terrain/measured_stride.hpp"

#include <fmt/format.h>

#include <cmath>

#include "estimation/motion_smoother.hpp"

namespace sandhopper {
namespace {

constexpr double kUnloaded_N = 0.5;
constexpr int kUnloadedRows = 5;
constexpr double kLongestFlight_s = 5.0;

std::vector<double> without_gravity(const TrialRecording& in) {
  const auto* accel = in.find("imu_foot_accel_z_mps2");
  if (accel == nullptr) return std::vector<double>(in.rows(), NAN);
  std::vector<double> out = *accel;
  for (double& value : out) value -= kGravity_mps2;
  return out;
}

// The load cell's samples in the rows in which its force acted, earlier than the rows that hold them by its
// stated latency.
std::vector<double> cell_forces_N(const TrialRecording& in, double latency_s) {
  const auto force = in.channel("load_cell_force_N");
  std::vector<double> out(force.begin(), force.end());
  if (latency_s <= 0.0 || in.rows() < 2) return out;
  const double half_row_s = 0.5 * (in.t_s.back() - in.t_s.front()) / static_cast<double>(in.rows() - 1);
  std::size_t from = 0;
  for (std::size_t row = 0; row < in.rows(); ++row) {
    while (from < in.rows() && in.t_s[from] + half_row_s < in.t_s[row] + latency_s) ++from;
    out[row] = from < in.rows() ? force[from] : NAN;
  }
  return out;
}

// Reading of the load cell in the air before first contact: a tare that was not subtracted.
double offset_in_air_N(std::span<const double> force_N, const SmoothMotion& motion, std::size_t first_row) {
  constexpr double kClear_m = 1e-3;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t row = first_row; row < force_N.size() && motion.position_m[row] > kClear_m; ++row) {
    if (std::isnan(force_N[row])) continue;
    sum += force_N[row];
    ++count;
  }
  return count >= 10 ? sum / static_cast<double>(count) : 0.0;
}

// Determines the state of each row if no phase was recorded: stance from loading to unloading.
class LoadPhases {
 public:
  explicit LoadPhases(double contact_force_N) : contact_force_N_(contact_force_N) {}
  State next(double force_N) {
    unloaded_ = force_N < kUnloaded_N ? unloaded_ + 1 : 0;
    if (state_ == State::flight && !stood_ && force_N >= contact_force_N_) state_ = State::compression;
    // The recorder closes a stride at the end of an extension, but here the stance has no switch: enter
    // extension just before unloading.
    if (state_ == State::compression && unloaded_ == kUnloadedRows - 1) state_ = State::extension;
    if (state_ == State::extension && unloaded_ >= kUnloadedRows) {
      state_ = State::flight;
      stood_ = true;
    }
    return state_;
  }

 private:
  double contact_force_N_;
  State state_ = State::flight;
  int unloaded_ = 0;
  bool stood_ = false;
};

std::optional<State> recorded(double phase) {
  if (std::isnan(phase)) return std::nullopt;
  const long number = std::lround(phase);
  return number == 1 ? State::compression : number == 2 ? State::extension : State::flight;
}

}  // namespace

std::optional<MeasuredStride> measured_stride(const CampaignTrial& trial, const TrialRecording& in,
                                              const StiffnessConfig& config, std::string& missing) {
  missing.clear();
  for (const auto* name : {"load_cell_force_N", "mocap_foot_z_m"})
    if (!in.has(name)) missing += fmt::format("{}{}", missing.empty() ? "" : ", ", name);
  if (!missing.empty()) return std::nullopt;

  const auto& belief = std::get<HopperBelief>(trial.belief);
  MotionNoise noise;
  noise.position_m = std::max(1e-5, belief.sensors.robot.mocap_noise_m);
  const auto accel = without_gravity(in);
  const auto motion = smooth_motion(in.t_s, in.channel("mocap_foot_z_m"), accel, noise);
  const auto* phase = in.find("phase");
  const auto force = cell_forces_N(in, belief.sensors.other.load_cell_latency_s);

  MeasuredStride out;
  out.phases_known = phase != nullptr;
  if (phase != nullptr)
    while (out.first_row < phase->size() && std::isnan((*phase)[out.first_row])) ++out.first_row;
  const double offset_N = offset_in_air_N(force, motion, out.first_row);
  LoadPhases by_load(config.contact_force_N);
  State state = State::flight;
  double held_N = 0.0;
  for (std::size_t row = out.first_row; row < in.rows(); ++row) {
    if (!std::isnan(force[row])) held_N = force[row] - offset_N;
    const State next = phase != nullptr ? recorded((*phase)[row]).value_or(state) : by_load.next(held_N);
    Estimate e;
    e.force_time_ns = static_cast<std::int64_t>(std::llround(in.t_s[row] * 1e9));
    e.force_depth_m = -motion.position_m[row];
    e.force_velocity_mps = -motion.velocity_mps[row];
    e.foot_z_m = motion.position_m[row];
    e.foot_velocity_mps = motion.velocity_mps[row];
    e.foot_accel_mps2 = motion.accel_mps2[row];
    e.weighting_accel_mps2 = std::abs(motion.accel_mps2[row]);
    e.contact_force_N = e.direct_force_N = e.quasi_static_force_N = e.load_cell_force_N = held_N;
    out.stride.samples.push_back({e, next, NAN, NAN, NAN, NAN, NAN});
    if (state == State::extension && next == State::flight) {
      out.stride.complete = true;
      break;
    }
    if (in.t_s[row] - in.t_s[out.first_row] > kLongestFlight_s && state == State::flight) break;
    state = next;
  }
  return out;
}

}  // namespace sandhopper
