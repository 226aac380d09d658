#include "tools/diagnose/plants/intruder.hpp"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/plants/doable.hpp"
#include "tools/diagnose/plants/ground_laws.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kSurfaceUnknown_m = 2e-4;  // where the belief gives no spread
constexpr double kForceZeroUnknown_N = 0.02;
constexpr std::size_t kMostKnots = 16;  // of the bed's fluctuation along depth
enum Phase : std::uint32_t { kAbove, kLoading, kUnloading };

// Prescribed motion: the bed's force at the recorded depth, speed and acceleration, through the force sensor.
class IntruderTrial final : public TrialModel {
 public:
  IntruderTrial(const Trial& trial, const Belief& belief) : belief_(belief) {
    name = trial.name;
    constexpr double kMostSteps = 900.0;  // a slow press has no need of the recorder's rate
    const double least_s = trial.time_s.empty() ? 0.0 : trial.time_s.back() / kMostSteps;
    history_ = {trial.setup_or("pushes_since_preparation", 0.0), trial.setup_or("wait_s", 0.0),
                trial.setup_or("bed_depth_m", 0.0)};
    const auto force = averaged(without_repeats(samples_of(trial, "force_N")), least_s);
    const auto z = averaged(samples_of(trial, "foot_z_m"), least_s);
    if (force.empty() || z.value.size() < 10) return;
    radius_m_ = belief.value("foot.radius_m", 0.04);
    step_s_ = std::clamp(median_step_s(z.time_s), 2.5e-4, 0.02);
    take_motion(z, averaged(samples_of(trial, "foot_velocity_mps"), least_s),
                averaged(samples_of(trial, "foot_accel_mps2"), least_s));
    const double spread_surface = belief.value("spread.surface_height_m");
    const double spread_force = belief.value("spread.load_cell_offset_N");
    add_nuisance("surface_height_m", std::max(spread_surface, kSurfaceUnknown_m), 1e-4);
    add_nuisance("load_cell_offset_N", std::max(spread_force, kForceZeroUnknown_N), 0.05);
    add_nuisance("bed_stiffness_relative", std::max(belief.value("spread.bed_stiffness_relative"), 1e-3),
                 1e-2);
    add_knots();
    for (std::size_t i = 0; i < force.value.size(); ++i) {
      times_.push_back(force.time_s[i]);
      rows.push_back({0, 0, kAbove, force.time_s[i], force.value[i]});
    }
    sensor_ = sensor_belief(belief_, "load_cell", "N");
    if (sensor_.bandwidth_Hz > 0.0 && sensor_.bandwidth_Hz * step_s_ > 1.0) sensor_.bandwidth_Hz = 0.0;
    label_rows();
  }

  void predict(const Edits& edits, std::span<const double> nuisances, std::span<double> out) const override {
    BedParameters parameters = bed_parameters(belief_, edits);
    parameters.stiffness_N_per_m *= 1.0 + nuisances[2];
    parameters.stiffness_per_area_N_per_m3 *= 1.0 + nuisances[2];
    if (const auto size = edits.at("foot.size"); !size.empty()) {
      const double factor = std::exp(sum_of(size, {.position = radius_m_}));
      parameters.stiffness_N_per_m *= factor;
      parameters.stiffness_per_area_N_per_m3 *= factor;
    }
    BedFluctuation fluctuation;
    if (knots_ > 0) {
      fluctuation.relative = 1.0;
      fluctuation.spacing_m = knot_spacing_m_;
      for (std::size_t i = 0; i < knots_; ++i) fluctuation.knots[i] = nuisances[3 + i];
    }
    GroundLaws laws(edits, history_);
    Bed bed(parameters, edits.edited("foot.radius_m", radius_m_), fluctuation);
    if (!laws.empty()) bed.extend(&laws);
    double compliance_m_per_N = 0.0;
    if (const double k = belief_.value("rig.stiffness_N_per_m"); k > 0.0) compliance_m_per_N = 1.0 / k;
    compliance_m_per_N = edits.edited("rig.compliance_m_per_N", compliance_m_per_N);
    const double surface_m = edits.edited("surface_height_m", nuisances[0]);
    const Read read = reading(edits);
    const auto cell = edits.at("load_cell");

    Signal force{start_s_, step_s_, std::vector<double>(depth_m_.size())};
    double deepest_m = 0.0, before_N = 0.0;
    bool touching = false;
    for (std::size_t i = 0; i < depth_m_.size(); ++i) {
      laws.at_time(start_s_ + step_s_ * static_cast<double>(i));
      double force_N = before_N;
      double depth_m = 0.0;
      const double asked_m = read.depth_m(i) + surface_m + laws.deeper_m();
      if (touching && asked_m <= 0.0) laws.pushed();
      touching = asked_m > 0.0;
      for (int pass = 0; pass < (compliance_m_per_N > 0.0 ? 4 : 1); ++pass) {
        depth_m = asked_m - compliance_m_per_N * force_N;
        const double speed_mps = read.speed_mps(i) - compliance_m_per_N * (force_N - before_N) / step_s_;
        // Noise of the depth must not read as unloading while the foot goes down.
        const bool down = speed_mps > rest_speed_mps_ && depth_m > deepest_m - depth_noise_m_;
        const double at_m = down ? std::max(depth_m, deepest_m) : depth_m;
        const auto reaction = bed.reaction({.depth_m = std::max(0.0, at_m),
                                            .speed_mps = down ? speed_mps : std::min(speed_mps, 0.0),
                                            .max_depth_m = deepest_m,
                                            .damping_mass_kg = 0.0});
        const double next_N = reaction.at_acceleration(-read.accel_mps2(i));
        force_N = pass == 0 ? next_N : 0.5 * (force_N + next_N);
      }
      deepest_m = std::max(deepest_m, depth_m);
      before_N = force_N;
      force.values[i] = cell.empty() ? force_N : force_N + sum_of(cell, {.accel = read.accel_mps2(i)});
    }
    observe(force, sensor_, edits, "force_N", times_, out);
    for (double& f : out) f += nuisances[1];
  }

 private:
  // The recorded motion with the faults of its position sensor taken out:
  //   recorded(t) = true(f t - d) + o  ->  true(u) = recorded((u + d) / f) - o
  struct Read {
    const IntruderTrial& trial;
    double delay_s = 0.0, rate = 1.0, offset_m = 0.0;
    bool plain = true;

    double at(const std::vector<double>& values, std::size_t i, bool from_position) const {
      if (plain || !from_position) return values[i];
      const double t = static_cast<double>(i) * trial.step_s_;
      const double place =
          std::clamp((t + delay_s) / rate / trial.step_s_, 0.0, static_cast<double>(values.size() - 1));
      const auto left = std::min(static_cast<std::size_t>(place), values.size() - 2);
      const double u = place - static_cast<double>(left);
      return values[left] + u * (values[left + 1] - values[left]);
    }
    double depth_m(std::size_t i) const { return at(trial.depth_m_, i, true) + offset_m; }
    double speed_mps(std::size_t i) const { return at(trial.speed_mps_, i, trial.speed_from_position_); }
    double accel_mps2(std::size_t i) const { return at(trial.accel_mps2_, i, trial.accel_from_position_); }
  };

  Read reading(const Edits& edits) const {
    Read read{*this};
    for (const auto& edit : edits.sensors) {
      if (edit.channel != "foot_z_m") continue;
      if (edit.kind == SensorEdit::Kind::delay_s) read.delay_s += edit.value;
      if (edit.kind == SensorEdit::Kind::time_scale) read.rate *= edit.value;
      if (edit.kind == SensorEdit::Kind::offset) read.offset_m += edit.value;
      read.plain = read.plain && edit.kind == SensorEdit::Kind::offset;
    }
    return read;
  }

  void add_nuisance(const char* what, double sd, double step) { trial_nuisances.push_back({what, sd, step}); }

  void take_motion(const Samples& z, const Samples& v, const Samples& a) {
    constexpr double kSmoothing_s = 0.004;
    const auto half = static_cast<std::size_t>(std::clamp(kSmoothing_s / step_s_, 2.0, 8.0));
    const double noise_m = fluctuation_rms(z);
    const Smoothed at = smooth(z, half);
    const auto count = static_cast<std::size_t>((z.time_s.back() - z.time_s.front()) / step_s_) + 1;
    start_s_ = z.time_s.front();
    const auto put = [&](std::vector<double>& into, const Samples& samples) {
      into = on_grid(samples, start_s_, step_s_, count, false).values;
      for (double& value : into) value = -value;
    };
    put(depth_m_, {z.time_s, noise_m > 2e-6 ? at.value : z.value});
    put(speed_mps_, v.value.size() > 10 ? v : Samples{z.time_s, at.rate});
    put(accel_mps2_, a.value.size() > 10   ? a
                     : v.value.size() > 10 ? Samples{v.time_s, smooth(v, half).rate}
                                           : Samples{z.time_s, smooth(z, 2 * half).curvature});
    speed_from_position_ = v.value.size() <= 10;
    accel_from_position_ = speed_from_position_ && a.value.size() <= 10;
    depth_noise_m_ = 4.0 * noise_m + 1e-6;
    double fastest = 0.0;
    for (const double s : speed_mps_) fastest = std::max(fastest, std::abs(s));
    const double speed_noise = v.value.size() > 10 ? fluctuation_rms(v) : 2.0 * noise_m / (step_s_ * 6.0);
    rest_speed_mps_ = std::min(2.0 * speed_noise, 0.1 * fastest);
  }

  void add_knots() {
    double deepest_m = 0.0;
    for (const double d : depth_m_) deepest_m = std::max(deepest_m, d);
    const double relative = belief_.value("spread.bed_fluctuation_relative");
    const double length_m = belief_.value("spread.bed_fluctuation_length_m", 0.002);
    if (relative <= 0.0 || deepest_m <= 0.0) return;
    knot_spacing_m_ = std::max(length_m, deepest_m / static_cast<double>(kMostKnots - 1));
    knots_ = static_cast<std::size_t>(deepest_m / knot_spacing_m_) + 2;
    const double sd = relative * std::sqrt(length_m / knot_spacing_m_);
    for (std::size_t i = 0; i < knots_; ++i) add_nuisance("bed_fluctuation", sd, 0.01);
  }

  void label_rows() {
    Coordinate depth{"depth_m", {}}, speed{"foot_velocity_mps", {}}, accel{"foot_accel_mps2", {}},
        time{"t_s", {}};
    const Signal d{start_s_, step_s_, depth_m_}, v{start_s_, step_s_, speed_mps_},
        a{start_s_, step_s_, accel_mps2_};
    for (Row& row : rows) {
      depth.values.push_back(d.at(row.time_s));
      speed.values.push_back(-v.at(row.time_s));
      accel.values.push_back(-a.at(row.time_s));
      time.values.push_back(row.time_s);
      row.phase = depth.values.back() <= 0.0 ? kAbove : v.at(row.time_s) > 0.0 ? kLoading : kUnloading;
    }
    coordinates = {std::move(depth), std::move(speed), std::move(accel), std::move(time)};
  }

  Belief belief_;
  double radius_m_ = 0.04, step_s_ = 1e-3, start_s_ = 0.0;
  double depth_noise_m_ = 0.0, rest_speed_mps_ = 0.0;
  std::vector<double> depth_m_, speed_mps_, accel_mps2_;  // down positive
  bool speed_from_position_ = false, accel_from_position_ = false;
  BedHistory history_;
  std::size_t knots_ = 0;
  double knot_spacing_m_ = 0.002;
  std::vector<double> times_;
  SensorBelief sensor_;
};

class Intruder final : public PlantModel {
 public:
  std::vector<std::string> channels() const override { return {"force_N"}; }
  std::vector<std::string> phases() const override { return {"above_surface", "loading", "unloading"}; }

  std::unique_ptr<TrialModel> trial(const Trial& trial, const Belief& belief,
                                    std::string& why) const override {
    auto model = std::make_unique<IntruderTrial>(trial, belief);
    if (model->rows.size() >= 20) return model;
    why = "needs foot_z_m and force_N";
    return nullptr;
  }

  void describe(const std::vector<Trial>& trials, Context& context) const override {
    double deepest = 0.0, fastest = 0.0, strongest = 0.0, duration = 0.0, hardest = 0.0;
    for (const auto& trial : trials) {
      const auto z = samples_of(trial, "foot_z_m");
      for (const double v : z.value) deepest = std::max(deepest, -v);
      for (const double v : samples_of(trial, "force_N").value) strongest = std::max(strongest, std::abs(v));
      auto velocity = samples_of(trial, "foot_velocity_mps");
      if (velocity.empty() && z.value.size() > 10) velocity = {z.time_s, smooth(z, 5).rate};
      for (const double v : velocity.value) fastest = std::max(fastest, std::abs(v));
      for (const double v : samples_of(trial, "foot_accel_mps2").value)
        hardest = std::max(hardest, std::abs(v));
      if (!trial.time_s.empty()) duration = std::max(duration, trial.time_s.back());
    }
    context.scales["foot_radius_m"] = context.belief.value("foot.radius_m", 0.04);
    context.scales["depth_m"] = std::max(deepest, 1e-3);
    context.scales["speed_mps"] = std::max(fastest, 1e-3);
    context.scales["accel_mps2"] = std::max(hardest, 0.1);
    context.scales["force_N"] = std::max(strongest, 0.1);
    context.scales["duration_s"] = duration;
    // What the set-ups differ in, and how near the foot came to the floor of the bed.
    for (const char* key : {"pushes_since_preparation", "wait_s"})
      context.scales[std::string("range of ") + key] = range_of_setup(trials, key);
    for (const auto& trial : trials) {
      const double bed_m = trial.setup_or("bed_depth_m", 0.0);
      if (bed_m <= 0.0) continue;
      double lowest = 0.0;
      for (const double v : samples_of(trial, "foot_z_m").value) lowest = std::min(lowest, v);
      const auto it = context.scales.find("floor_distance_m");
      const double near_m = std::max(1e-3, bed_m + lowest);
      context.scales["floor_distance_m"] = it == context.scales.end() ? near_m : std::min(it->second, near_m);
    }
    // The foot's position is an input, no prediction; its faults are candidates, too.
    double longest_s = 1e-3;
    for (const auto& trial : trials) longest_s = std::max(longest_s, median_step_s(trial.time_s));
    context.scales["input_step_s"] = longest_s;
  }

  std::vector<DoableTrial> doable(const std::vector<Trial>& recorded, const Belief& belief,
                                  const Edits& /*edits*/) const override {
    return doable_intrusions(recorded, belief);
  }

  std::vector<FreePort> free_ports(const Context& context) const override {
    return {{"ground.force", false, 0.1 * context.scale("force_N")}};
  }
};

}  // namespace

std::unique_ptr<PlantModel> make_intruder() { return std::make_unique<Intruder>(); }

}  // namespace sandhopper::diagnose
