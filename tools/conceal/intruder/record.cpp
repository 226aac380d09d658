#include <algorithm>
#include <cmath>

#include "tools/conceal/intruder/world.hpp"

namespace sandhopper::conceal::intruder {
namespace {

// Force along a prescribed motion, with the memory of the bed. With a compliant rig the plate is less deep
// than the actuator.
class Press {
 public:
  Press(const World& w, const Setup& setup, const TrialRandom& trial) : world_(w), bed_(w.bed) {
    bed_.foot_radius_m = setup.number("plate_diameter_m", 2.0 * bed_.foot_radius_m) / 2.0;
    state_.stiffness_relative = trial.stream("bed").normal(0.0, w.bed_stiffness_spread);
    state_.fluctuation = draw_fluctuation(w.bed_fluctuation, trial.stream("grains"));
    state_.bed_depth_m = setup.number("bed_depth_m", 0.15);
    state_.wait_s = setup.number("wait_s", 0.0);
    state_.pushes = static_cast<int>(setup.number("pushes_since_preparation", 0.0));
    state_.surface_m = surface_m(w, trial);
  }

  double force_N(double t_s, double depth_m, double speed_mps, double acceleration_mps2) {
    const double asked_m = depth_m + state_.surface_m;
    double z_m = asked_m;
    if (world_.rig_stiffness_N_per_m > 0.0 && asked_m > 0.0)
      z_m = settled_m(t_s, asked_m, speed_mps, acceleration_mps2);
    if (z_m <= 0.0) {
      if (touching_) ++state_.pushes;
      touching_ = false;
      return 0.0;
    }
    if (!touching_) state_.touched_s = t_s;
    touching_ = true;
    const double force_N = on_plate_N(t_s, z_m, speed_mps, acceleration_mps2);
    state_.deepest_m = std::max(state_.deepest_m, z_m);
    return force_N;
  }

 private:
  double on_plate_N(double t_s, double z_m, double speed_mps, double acceleration_mps2) const {
    if (z_m < state_.deepest_m || speed_mps <= 0.0) return rebound_N(bed_, state_, z_m, speed_mps, 0.0);
    const auto force = virgin(bed_, state_, t_s, z_m, speed_mps);
    return std::max(0.0, force.steady_N + force.moving_mass_kg * acceleration_mps2);
  }

  // Depth z with z + F(z) / k = depth of the actuator, k: stiffness of the rig.
  double settled_m(double t_s, double asked_m, double speed_mps, double acceleration_mps2) const {
    double low = 0.0, high = asked_m;
    for (int i = 0; i < 40; ++i) {
      const double z = 0.5 * (low + high);
      const double total =
          z + on_plate_N(t_s, z, speed_mps, acceleration_mps2) / world_.rig_stiffness_N_per_m;
      (total < asked_m ? low : high) = z;
    }
    return 0.5 * (low + high);
  }

  const World& world_;
  Bed bed_;
  BedState state_;
  bool touching_ = false;
};

}  // namespace

Table record(const World& w, const Setup& setup, const TrialRandom& trial) {
  const auto motion = prescribed(w, setup);
  Press press(w, setup, trial);
  Trace force{motion.depth_m.step_s, {}}, height{motion.depth_m.step_s, {}}, rise = height, lift = height;
  for (std::size_t i = 0; i < motion.depth_m.values.size(); ++i) {
    const double t_s = static_cast<double>(i) * force.step_s, a = motion.acceleration_mps2.values[i];
    const double felt_N = press.force_N(t_s, motion.depth_m.values[i], motion.speed_mps.values[i], a);
    force.values.push_back(felt_N + w.plate_mass_kg * a);
    height.values.push_back(-motion.depth_m.values[i]);
    rise.values.push_back(-motion.speed_mps.values[i]);
    lift.values.push_back(-a);
  }
  const double duration_s = static_cast<double>(force.values.size() - 1) * force.step_s;
  std::vector<double> rows_s(static_cast<std::size_t>(duration_s * w.row_rate_Hz) + 1);
  for (std::size_t i = 0; i < rows_s.size(); ++i) rows_s[i] = static_cast<double>(i) / w.row_rate_Hz;

  Table table;
  table.add("t_s", 4).values = rows_s;
  const auto add = [&](const char* name, const Trace& truth, ChannelChain chain) {
    record_channel(table, name, truth, rows_s, chain, w.faults_of(name), trial);
  };
  add("foot_z_m", height, {.noise = w.position_noise_m, .quantum = 1e-6, .decimals = 6});
  add("foot_velocity_mps", rise, {.noise = w.velocity_noise_mps, .quantum = 1e-4, .decimals = 4});
  add("foot_accel_mps2", lift, {.noise = w.accel_noise_mps2, .quantum = 1e-3, .decimals = 3});
  add("force_N", force,
      {.bandwidth_Hz = w.load_cell_bandwidth_Hz,
       .rate_Hz = w.load_cell_rate_Hz,
       .offset = trial.stream("load cell").normal(0.0, w.load_cell_offset_spread_N),
       .noise = w.load_cell_noise_N,
       .quantum = 1e-3,
       .decimals = 3});
  return table;
}

}  // namespace sandhopper::conceal::intruder
