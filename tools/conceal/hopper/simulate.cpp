#include "tools/conceal/hopper/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/conceal/core/dormand_prince.hpp"
#include "tools/conceal/hopper/controller.hpp"

namespace sandhopper::conceal::hopper {
namespace {

constexpr int kPieces = 4;  // integration pieces per cycle
constexpr double kPiece_s = kCycle_s / kPieces;
constexpr double kFullCurrent_A = 32.0;
constexpr double kWinding_ohm = 0.125, kRoom_C = 25.0;

Robot as_built(const World& w) {
  auto r = w.robot;
  const auto& h = w.hidden;
  r.body_kg += h.body_kg, r.foot_kg += h.foot_kg, r.upper_kg += h.upper_kg, r.lower_kg += h.lower_kg;
  r.rotor_kg_m2 += h.rotor_kg_m2, r.upper_m += h.upper_m, r.lower_m += h.lower_m;
  return r;
}

// Simulates one trial: the controller once per cycle, the drive once per piece, contact events in between.
class Trial {
 public:
  Trial(const World& w, const Setup& setup, const TrialRandom& trial)
      : w_(w),
        scene_{w, as_built(w), setup.number("payload_kg", 0.0), {}, 0.0, false},
        controller_(w, setup),
        encoder_(trial.noise("encoder")),
        kind_(setup.kind()) {
    const double exact = w.sensors.ideal ? 0.0 : 1.0;
    auto& bed = scene_.bed;
    bed.stiffness_relative = exact * trial.stream("bed").normal(0.0, w.spread.bed_stiffness);
    if (!w.sensors.ideal)
      bed.fluctuation = draw_fluctuation(w.spread.bed_fluctuation, trial.stream("grains"));
    bed.surface_m = exact * trial.stream("surface").normal(0.0, w.spread.surface_m);
    bed.bed_depth_m = setup.number("bed_depth_m", 0.17);
    bed.wait_s = setup.number("wait_s", 0.0);
    bed.pushes = static_cast<int>(setup.number("pushes_since_preparation", 0.0));
    foot_error_m_ = exact * trial.stream("foot estimate").normal(0.0, 2e-3);
    temperature_C_ = trial.stream("warm").uniform(kRoom_C, kRoom_C + 50.0);
    place(setup, exact * trial.stream("release").normal(0.0, w.spread.release_m));
  }

  Run run(double duration_s) {
    for (auto* trace :
         {&run_.body_m, &run_.foot_m, &run_.body_mps2, &run_.foot_mps2, &run_.contact_N, &run_.current_A})
      trace->step_s = kPiece_s;
    const auto cycles = static_cast<int>(std::lround(duration_s / kCycle_s));
    for (int i = 0; i < cycles; ++i) cycle(i);
    return std::move(run_);
  }

 private:
  void place(const Setup& setup, double release_error_m) {
    double length_m = w_.gains.compression_length_m;
    double foot_m = setup.number("release_height_m", 0.05) + release_error_m;
    x_.fill(0.0);
    if (kind_ == "air_sweep") {
      scene_.clamped = true;
      foot_m = 0.3;
      x_[kAngle] = setup.number("sweep_centre_rad", 1.1);
    } else {
      if (kind_ == "hold") foot_m = 0.0;
      if (kind_ == "press") {
        scene_.clamped = true;
        foot_m = 2e-3;
        x_[kFootRate] = -setup.number("press_speed_mps", 0.02);
      } else if (kind_ != "hop" && kind_ != "hold" && !kind_.empty()) {
        throw std::invalid_argument("the hopper cannot do a trial of kind '" + kind_ +
                                    "': hop, hold, press or air_sweep");
      }
      x_[kAngle] = angle_for(scene_.robot, length_m);
    }
    x_[kFoot] = foot_m;
    x_[kRotor] = x_[kAngle];
    last_angle_ = x_[kRotor];
    scene_.cable_rest_m = body_height_m(scene_, x_);
  }

  void cycle(int number) {
    const double t_s = number * kCycle_s;
    const auto seen = look(t_s);
    command_Nm_ = controller_.torque_Nm(seen);
    commands_.push_back(command_Nm_);
    run_.cycles.push_back({seen.angle_rad, seen.angle_rate_radps, x_[kFootRate], drive_Nm_, command_Nm_,
                           scene_.bed.deepest_m, temperature_C_, static_cast<int>(controller_.phase())});
    for (int piece = 0; piece < kPieces; ++piece) {
      note(t_s + piece * kPiece_s);
      advance(t_s + piece * kPiece_s);
    }
    const double current_A = 0.5 * drive_Nm_ / w_.drive.torque_constant_Nm_per_A;
    temperature_C_ += kCycle_s * (current_A * current_A * kWinding_ohm / 60.0);
  }

  // The encoders are on the rotors.
  Seen look(double t_s) {
    const auto& s = w_.sensors;
    const auto& h = w_.hidden;
    double angle = x_[kRotor] + h.encoder_offset_rad +
                   h.eccentricity_rad * std::sin(x_[kRotor] + h.eccentricity_phase_rad);
    const double step = 2.0 * std::numbers::pi / s.encoder_counts;
    if (s.ideal) return {t_s, angle, x_[kRotorRate], x_[kFoot]};
    angle = step * std::round((angle + encoder_.normal(0.0, s.encoder_noise_rad)) / step);
    const double keep = std::exp(-2.0 * std::numbers::pi * s.encoder_velocity_bandwidth_Hz * kCycle_s);
    if (t_s > 0.0) rate_ = keep * rate_ + (1.0 - keep) * (angle - last_angle_) / kCycle_s;
    last_angle_ = angle;
    return {t_s, angle, rate_, x_[kFoot] - scene_.bed.surface_m + foot_error_m_};
  }

  double ordered_Nm(double t_s) const {
    const double place = std::floor((t_s - w_.hidden.delay_s) / kCycle_s + 1e-6);
    if (place < 0.0) return 0.0;
    return commands_[std::min(static_cast<std::size_t>(place), commands_.size() - 1)];
  }

  // Torque at the shaft from the torque of the current, both motors together.
  double shaft_Nm(double drive_Nm, double t_s) const {
    const auto& h = w_.hidden;
    const double load = 0.5 * drive_Nm / w_.drive.torque_constant_Nm_per_A / kFullCurrent_A;
    double torque = drive_Nm * (1.0 + h.torque_constant) * (1.0 - h.saturation * load * load);
    torque *= 1.0 - h.derating_per_K * (temperature_C_ - kRoom_C);
    return torque + h.hum_Nm * std::sin(2.0 * std::numbers::pi * h.hum_Hz * t_s) * std::abs(load) * 2.0;
  }

  double limited_Nm(double ordered_Nm) const {
    const auto& h = w_.hidden;
    if (h.supply_V <= 0.0) return ordered_Nm;
    const double k = w_.drive.torque_constant_Nm_per_A;
    const double most_A = std::max(1.0, (h.supply_V - k * std::abs(x_[kRotorRate])) / kWinding_ohm);
    return std::clamp(ordered_Nm, -2.0 * k * most_A, 2.0 * k * most_A);
  }

  void advance(double from_s) {
    const double target_Nm = limited_Nm(ordered_Nm(from_s)), start_Nm = drive_Nm_;
    const auto drive_Nm = [&](double t_s) {
      return target_Nm + (start_Nm - target_Nm) * std::exp(-(t_s - from_s) / w_.drive.current_lag_s);
    };
    const double end_s = from_s + kPiece_s;
    double t_s = from_s;
    for (int events = 0; t_s < end_s - 1e-12 && events < 50; ++events) {
      const auto rhs = [&](double t, const State& x) {
        return accelerations(scene_, contact_, t, x, shaft_Nm(drive_Nm(t), t)).slope;
      };
      const auto guard = [&](double, const State& x) { return remains(x); };
      if (integrator_.advance(t_s, x_, end_s, rhs, guard)) change_contact(t_s);
    }
    drive_Nm_ = drive_Nm(end_s);
  }

  // Positive while the present contact law holds.
  double remains(const State& x) const {
    const double z = depth_m(scene_, x);
    switch (contact_) {
      case Contact::none:
        return -z;
      case Contact::virgin:
        return -x[kFootRate];
      case Contact::rebound:
        return std::min(z + 1e-9, scene_.bed.deepest_m - z + 1e-9);
    }
    return 1.0;
  }

  void change_contact(double t_s) {
    auto& bed = scene_.bed;
    const double z = depth_m(scene_, x_);
    if (contact_ == Contact::none) {
      bed.touched_s = t_s;
      contact_ = bed.deepest_m > 0.0 ? Contact::rebound : Contact::virgin;
    } else if (contact_ == Contact::virgin) {
      bed.deepest_m = std::max(bed.deepest_m, z);
      contact_ = Contact::rebound;
    } else if (z > 0.5 * bed.deepest_m) {
      contact_ = Contact::virgin;
    } else {
      contact_ = Contact::none;
      ++bed.pushes;
    }
  }

  void note(double t_s) {
    const auto now = accelerations(scene_, contact_, t_s, x_, shaft_Nm(drive_Nm_, t_s));
    run_.body_m.values.push_back(body_height_m(scene_, x_) - scene_.bed.surface_m);
    run_.foot_m.values.push_back(x_[kFoot] - scene_.bed.surface_m);
    run_.body_mps2.values.push_back(now.body_mps2);
    run_.foot_mps2.values.push_back(now.foot_mps2);
    run_.contact_N.values.push_back(now.contact_N - w_.hidden.load_cell_kg * now.foot_mps2);
    run_.current_A.values.push_back(0.5 * drive_Nm_ / w_.drive.torque_constant_Nm_per_A);
    if (contact_ == Contact::virgin)
      scene_.bed.deepest_m = std::max(scene_.bed.deepest_m, depth_m(scene_, x_));
  }

  const World& w_;
  Scene scene_;
  Controller controller_;
  Random encoder_;
  std::string kind_;
  DormandPrince<10> integrator_{{1e-6, 1e-8, 1e-7}};
  Contact contact_ = Contact::none;
  State x_{};
  std::vector<double> commands_;
  double command_Nm_ = 0.0, drive_Nm_ = 0.0, rate_ = 0.0, last_angle_ = 0.0, foot_error_m_ = 0.0;
  double temperature_C_ = kRoom_C;
  Run run_;
};

}  // namespace

Run simulate(const World& world, const Setup& setup, const TrialRandom& trial) {
  return Trial(world, setup, trial).run(setup.number("duration_s", 1.0));
}

}  // namespace sandhopper::conceal::hopper
