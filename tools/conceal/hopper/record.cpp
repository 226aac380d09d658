#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tools/conceal/hopper/simulate.hpp"

namespace sandhopper::conceal::hopper {
namespace {

// Builds one recording, channel by channel.
class Recorder {
 public:
  Recorder(const World& w, const Run& run, const TrialRandom& trial) : w_(w), run_(run), trial_(trial) {
    for (std::size_t i = 0; i < run.cycles.size(); ++i) rows_s_.push_back(kCycle_s * static_cast<double>(i));
    table_.add("t_s", 6).values = rows_s_;
  }

  void add(const std::string& name, const Trace& truth, const ChannelChain& chain) {
    record_channel(table_, name, truth, rows_s_, chain, w_.faults_of(name), trial_);
  }

  Trace of_cycles(const std::function<double(const Run::Cycle&)>& value) const {
    Trace trace{kCycle_s, {}};
    for (const auto& cycle : run_.cycles) trace.values.push_back(value(cycle));
    return trace;
  }

  void add_motor(const std::string& side) {
    const auto& s = w_.sensors;
    const double step = 2.0 * std::numbers::pi / s.encoder_counts;
    const bool other = side == "right";
    // The controller reads the left encoder. The reading of the right one differs by its own noise.
    add("motor_" + side + "_position_rad", of_cycles([](const auto& c) { return c.angle_rad; }),
        {.noise = other ? std::sqrt(2.0) * s.encoder_noise_rad : 0.0, .quantum = step, .decimals = 6});
    add("motor_" + side + "_velocity_radps", of_cycles([](const auto& c) { return c.angle_rate_radps; }),
        {.noise = other ? 0.05 : 0.0, .quantum = 1e-3, .decimals = 3});
    const double offset_A = trial_.stream("current offset " + side).normal(0.0, w_.spread.current_offset_A);
    add("motor_" + side + "_current_A", run_.current_A,
        {.offset = offset_A, .noise = s.current_noise_A, .quantum = 1e-3, .decimals = 3});
    add("motor_" + side + "_temperature_C", of_cycles([](const auto& c) { return c.temperature_C; }),
        {.quantum = 1.0, .decimals = 0});
  }

  // Specific force. In stance the vibration of the structure adds noise.
  void add_imu(const std::string& name, const Trace& acceleration) {
    const auto& s = w_.sensors;
    auto random = trial_.noise("structure " + name);
    Trace specific = acceleration;
    for (std::size_t i = 0; i < specific.values.size(); ++i) {
      const double ringing = random.normal(0.0, 1.8 * s.imu_structure_noise_mps2);
      specific.values[i] += w_.gravity_mps2 + (run_.contact_N.values[i] > 0.0 ? ringing : 0.0);
    }
    const double bias = trial_.stream("bias " + name).normal(0.0, w_.spread.imu_bias_mps2);
    add(name, specific,
        {.bandwidth_Hz = s.imu_bandwidth_Hz,
         .rate_Hz = s.imu_rate_Hz,
         .offset = bias,
         .noise = s.imu_noise_mps2,
         .quantum = 9.81 * 0.488e-3,
         .decimals = 4});
  }

  Table take() { return std::move(table_); }

 private:
  const World& w_;
  const Run& run_;
  const TrialRandom& trial_;
  std::vector<double> rows_s_;
  Table table_;
};

}  // namespace

Table record(const World& w, const Setup& setup, const TrialRandom& trial) {
  const auto run = simulate(w, setup, trial);
  const auto& s = w.sensors;
  Recorder r(w, run, trial);
  r.add_motor("left");
  r.add_motor("right");
  const auto command = r.of_cycles([](const auto& c) { return 0.5 * c.command_Nm; });
  r.add("command_left_torque_Nm", command, {.decimals = 5});
  r.add("command_right_torque_Nm", command, {.decimals = 5});
  r.add_imu("imu_body_accel_z_mps2", run.body_mps2);
  r.add_imu("imu_foot_accel_z_mps2", run.foot_mps2);
  r.add("tof_height_m", run.body_m,
        {.latency_s = s.tof_latency_s,
         .rate_Hz = s.tof_rate_Hz,
         .offset = trial.stream("tof").normal(0.0, w.spread.tof_bias_m),
         .noise = s.tof_noise_m,
         .quantum = 1e-4,
         .decimals = 4});
  r.add("load_cell_force_N", run.contact_N,
        {.bandwidth_Hz = s.load_cell_bandwidth_Hz,
         .rate_Hz = s.load_cell_rate_Hz,
         .offset = trial.stream("load cell").normal(0.0, w.spread.load_cell_offset_N),
         .noise = s.load_cell_noise_N,
         .quantum = 1e-3,
         .decimals = 3});
  if (s.mocap) {
    const ChannelChain camera{
        .rate_Hz = s.mocap_rate_Hz, .noise = s.mocap_noise_m, .quantum = 1e-5, .decimals = 5};
    r.add("mocap_body_z_m", run.body_m, camera);
    r.add("mocap_foot_z_m", run.foot_m, camera);
  }
  r.add("phase", r.of_cycles([](const auto& c) { return static_cast<double>(c.phase); }),
        {.quantum = 1.0, .decimals = 0});
  return r.take();
}

}  // namespace sandhopper::conceal::hopper
