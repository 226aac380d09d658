#include "tools/diagnose/plants/intruder/intruder_trial.hpp"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/plants/ground_laws.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/plants/intruder/balanced_force.hpp"
#include "tools/diagnose/plants/intruder/bed_grains.hpp"
#include "tools/diagnose/plants/intruder/intruder_motion.hpp"

namespace sandhopper::diagnose {

double pushes_of(const Samples& z) {
  double lowest_m = 0.0, count = 0.0;
  for (const double v : z.value) lowest_m = std::min(lowest_m, v);
  bool above = true;
  for (const double v : z.value) {
    if (above && v < 0.1 * lowest_m) ++count, above = false;
    if (v > -0.1 * lowest_m) above = true;
  }
  return count;
}

namespace {

// Standard deviations that nobody states.
constexpr double kSurfaceUnknown_m = 2e-4;
constexpr double kForceZeroUnknown_N = 0.02;
constexpr double kNotKnown_N = -1.0;     // BedContact::deepest_N is not known
constexpr std::size_t kMostKnots = 16;   // most knots of the bed's fluctuation along depth
constexpr double kHoldSpeed_mps = 1e-3;  // a slower foot holds
// In standard deviations: within it depth or speed count as standing still.
constexpr double kNoiseBand = 4.0;

// Samples from the first to the last of the position, with the ages of the kept ones: outside, the motion is
// not known.
Samples where_position_is_known(const Samples& all, const Samples& position, double row_s,
                                std::vector<double>& ages) {
  Samples kept;
  std::vector<double> kept_ages;
  for (std::size_t i = 0; i < all.value.size(); ++i) {
    const double t = all.time_s[i];
    if (t < position.time_s.front() - row_s || t > position.time_s.back() + row_s) continue;
    kept.time_s.push_back(t);
    kept.value.push_back(all.value[i]);
    if (!ages.empty()) kept_ages.push_back(ages[i]);
  }
  ages = std::move(kept_ages);
  return kept;
}

enum TrialNuisance : std::size_t { kSurface, kForceZero, kStiffness, kTurning, kFirstKnot };

// Prescribed motion: the bed's force at the recorded depth, speed and acceleration, through the force
// sensor.
class IntruderTrial final : public TrialModel {
 public:
  IntruderTrial(const Trial& trial, const Belief& belief) : belief_(belief) {
    name = trial.name;
    // A slow press is recorded faster than needed: limit the steps of its motion and its rows.
    constexpr double kMostSteps = 4000.0, kRows = 600.0, kSlow = 8.0;
    const double least_s = trial.time_s.empty() ? 0.0 : trial.time_s.back() / kMostSteps;
    history_ = {trial.setup_or("pushes_since_preparation", 0.0), trial.setup_or("wait_s", 0.0),
                trial.setup_or("bed_depth_m", 0.0)};
    const auto recorded = samples_of(trial, "force_N");
    auto force = without_repeats(recorded);
    auto ages = ages_s(trial, "force_N", belief.value("sensors.load_cell_rate_Hz"));
    if (ages.size() != force.value.size()) ages.clear();
    row_s_ = std::max(median_step_s(trial.time_s), 1e-6);
    const auto position = samples_of(trial, "foot_z_m");
    const auto z = averaged(position, least_s);
    if (force.empty() || z.value.size() < 10) return;
    force = where_position_is_known(force, position, row_s_, ages);
    radius_m_ = belief.value("foot.radius_m", 0.04);
    motion_ = intruder_motion(z, averaged(samples_of(trial, "foot_velocity_mps"), least_s),
                              averaged(samples_of(trial, "foot_accel_mps2"), least_s));
    double fastest_mps = 0.0;
    for (const double speed_mps : motion_.speed_mps) fastest_mps = std::max(fastest_mps, std::abs(speed_mps));
    rest_speed_mps_ = std::min(kNoiseBand * motion_.speed_sd_mps, 0.1 * fastest_mps);
    add_nuisance("surface_height_m", spread_of(belief, "spread.surface_height_m", kSurfaceUnknown_m),
                 kSurfaceStep_m);
    add_nuisance("load_cell_offset_N", spread_of(belief, "spread.load_cell_offset_N", kForceZeroUnknown_N),
                 0.05);
    add_nuisance("bed_stiffness_relative", spread_of(belief, "spread.bed_stiffness_relative", 1e-3), 1e-2);
    // Error of the deepest point, at which the steep unloading line starts. Its noise shifts all rows of the
    // unloading by the same depth.
    add_nuisance("turning_depth_m", motion_.depth_sd_m, motion_.depth_sd_m);
    trial_nuisances.back().shift_is_evidence = false;
    add_knots();
    if (!ages.empty()) {
      age_nuisance_ = trial_nuisances.size();
      add_nuisance("sample_age_share", kAgeShareUnknown, 0.05);
      trial_nuisances.back().shift_is_evidence = false;
    }
    const double noise_N =
        std::max({belief_.value("sensors.load_cell_noise_N"), fluctuation_rms(force), 1e-6});
    const auto most = static_cast<std::size_t>(std::ceil(static_cast<double>(force.value.size()) / kRows));
    const auto groups = slow_groups(force, most, kSlow * noise_N);
    const auto taken = means(force, groups);
    times_ = taken.time_s;
    if (!ages.empty()) ages_s_ = means({force.time_s, std::move(ages)}, groups).value;
    for (std::size_t i = 0; i < groups.size(); ++i)
      rows.push_back({0, 0, kAbove, taken.time_s[i], taken.value[i],
                      1.0 / std::sqrt(static_cast<double>(groups[i].count))});
    sensor_ = sensor_belief(belief_, "load_cell", "N");
    if (sensor_.bandwidth_Hz > 0.0 && sensor_.bandwidth_Hz * motion_.step_s > 1.0) sensor_.bandwidth_Hz = 0.0;
    label_rows(noise_N);
  }

  void predict(const Edits& edits, std::span<const double> nuisances, std::span<double> out) const override {
    Run run = simulate(edits, nuisances);
    observe(run.force, sensor_, edits, "force_N", sampled_s(nuisances), out);
    for (double& f : out) f += nuisances[kForceZero];
  }

 private:
  // The recorded motion with the faults of its position sensor taken out:
  //   recorded(t) = true(f t - d) + o  ->  true(u) = recorded((u + d) / f) - o
  struct Read {
    const IntruderTrial& trial;
    SensorClock clock;
    double offset_m = 0.0;
    bool plain = true;

    double at(const std::vector<double>& values, std::size_t i, bool from_position) const {
      if (plain || !from_position) return values[i];
      const double t = static_cast<double>(i) * trial.motion_.step_s;
      const double place =
          std::clamp(clock.stamp_s(t) / trial.motion_.step_s, 0.0, static_cast<double>(values.size() - 1));
      const auto left = std::min(static_cast<std::size_t>(place), values.size() - 2);
      const double u = place - static_cast<double>(left);
      return values[left] + u * (values[left + 1] - values[left]);
    }
    double depth_m(std::size_t i) const { return at(trial.motion_.depth_m, i, true) + offset_m; }
    double speed_mps(std::size_t i) const {
      return at(trial.motion_.speed_mps, i, trial.motion_.speed_from_position);
    }
    double accel_mps2(std::size_t i) const {
      return at(trial.motion_.accel_mps2, i, trial.motion_.accel_from_position);
    }
  };

  Read reading(const Edits& edits) const {
    Read read{*this, {edits, "foot_z_m"}};
    for (const auto& edit : edits.sensors) {
      if (edit.channel != "foot_z_m") continue;
      if (edit.kind == SensorEdit::Kind::offset) read.offset_m += edit.value;
      read.plain = read.plain && edit.kind == SensorEdit::Kind::offset;
    }
    return read;
  }

  // Sampling instants of the rows: a nuisance moves them between the row's own time and the instant at which
  // the cell last sampled, as recordings do not tell which of the two a value belongs to.
  std::vector<double> sampled_s(std::span<const double> nuisances) const {
    std::vector<double> at_s = times_;
    for (std::size_t i = 0; i < ages_s_.size(); ++i)
      at_s[i] -= (kAgeShare + nuisances[age_nuisance_]) * ages_s_[i];
    return at_s;
  }

  // Force on the cell; and for each step, the standard deviation that the noise of the recorded motion gives
  // it, and the phase.
  struct Run {
    Signal force;
    std::vector<double> input_sd_N;
    std::vector<IntrusionPhase> phase;
  };
  // The bed as edited, with this trial's stiffness.
  BedParameters bed_of(const Edits& edits, std::span<const double> nuisances) const {
    BedParameters parameters = bed_parameters(belief_, edits);
    parameters.stiffness_N_per_m *= 1.0 + nuisances[kStiffness];
    parameters.stiffness_per_area_N_per_m3 *= 1.0 + nuisances[kStiffness];
    parameters.unloading_stiffness_ratio *=
        1.0 - nuisances[kStiffness] * (1.0 - edits.edited(kLineFollows, 0.5)) / (1.0 + nuisances[kStiffness]);
    if (const auto size = edits.at(LawPort::foot_size); !size.empty()) {
      const double factor = std::exp(sum_of(size, FootState{.radius_m = radius_m_}));
      parameters.stiffness_N_per_m *= factor;
      parameters.stiffness_per_area_N_per_m3 *= factor;
    }
    return parameters;
  }

  double compliance_m_per_N(const Edits& edits) const {
    const double k = belief_.value("rig.stiffness_N_per_m");
    return edits.edited("rig.compliance_m_per_N", k > 0.0 ? 1.0 / k : 0.0);
  }

  // Memory of the bed from one instant to the next.
  struct Pushed {
    double deepest_m = 0.0, known_m = -1.0, known_N = 0.0;  // the curve's force at a depth, once it is known
    bool down_before = false, touching = false, touched = false;
  };
  // The foot in the bed at one instant; `down`: the bed yields.
  struct Met {
    double depth_m = 0.0;
    bool down = false;
    BedContact contact{};
    BedReaction reaction{};
  };

  // Contact and reaction of the bed at one instant. Noise of the depth must not look like unloading while the
  // foot goes down, nor like new depth while it stands. A foot that goes down does so until its speed is 0;
  // there the steep unloading line begins.
  Met meet(const Bed& bed, double depth_m, double speed_mps, double turning_m, Pushed& pushed) const {
    const double depth_band_m = kNoiseBand * motion_.depth_sd_m;
    const double deepest_m = pushed.deepest_m;
    Met met{.depth_m = depth_m};
    met.down =
        depth_m > deepest_m + depth_band_m ||
        (speed_mps > (pushed.down_before ? 0.0 : rest_speed_mps_) && depth_m > deepest_m - depth_band_m);
    if (!met.down && pushed.known_m != deepest_m) {
      pushed.known_m = deepest_m;
      pushed.known_N = bed.curve_N(deepest_m);
    }
    const double at_m = !met.down            ? std::min(depth_m - turning_m, deepest_m)
                        : pushed.down_before ? depth_m
                                             : std::max(depth_m, deepest_m);
    const double turned_m = met.down ? std::min(at_m, deepest_m) : deepest_m;
    met.contact = {.depth_m = std::max(0.0, at_m),
                   .speed_mps = met.down ? speed_mps : std::min(speed_mps, 0.0),
                   .max_depth_m = turned_m,
                   .damping_mass_kg = 0.0,
                   .deepest_N = pushed.known_m == turned_m ? pushed.known_N : kNotKnown_N};
    met.reaction = bed.reaction(met.contact);
    return met;
  }

  IntrusionPhase phase_of(bool in_contact, bool down, double speed_mps) const {
    return !in_contact                                              ? kAbove
           : down                                                   ? kLoading
           : speed_mps > -std::max(rest_speed_mps_, kHoldSpeed_mps) ? kHold
                                                                    : kUnloading;
  }

  Run simulate(const Edits& edits, std::span<const double> nuisances, bool explain = false) const {
    GroundLaws laws(edits, history_);
    Bed bed(bed_of(edits, nuisances), edits.edited("foot.radius_m", radius_m_),
            grains_.fluctuation(nuisances.subspan(kFirstKnot)));
    if (!laws.empty()) bed.extend(&laws);
    const double yields_m_per_N = compliance_m_per_N(edits);
    const double surface_m = edits.edited("surface_height_m", nuisances[kSurface]);
    const double turning_m = nuisances[kTurning];
    const Read read = reading(edits);
    const auto cell = edits.at(LawPort::load_cell);

    const std::size_t count = motion_.depth_m.size();
    Run run{{motion_.start_s, motion_.step_s, std::vector<double>(count)}, {}, {}};
    Pushed pushed;
    double deeper_m = laws.deeper_m(), before_N = 0.0, slope = 0.0, asked_before_m = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      laws.at_time(motion_.start_s + motion_.step_s * static_cast<double>(i));
      const double asked_m = read.depth_m(i) + surface_m + deeper_m;
      if (pushed.touching && asked_m <= 0.0) {
        laws.pushed();
        // The push moved the surface: the deepest point stays, so that its depth changes by as much.
        pushed.deepest_m += laws.deeper_m() - deeper_m;
        deeper_m = laws.deeper_m();
      }
      pushed.touching = asked_m > 0.0;
      laws.touching(pushed.touching);
      Met met;
      // Force of the bed if the rig yields under the force `felt_N`; it decreases with `felt_N`.
      const auto at_force = [&](double felt_N) {
        const double speed_mps = read.speed_mps(i) - yields_m_per_N * (felt_N - before_N) / motion_.step_s;
        met = meet(bed, asked_m - yields_m_per_N * felt_N, speed_mps, turning_m, pushed);
        return met.reaction.at_acceleration(-read.accel_mps2(i));
      };
      const double force_N = yields_m_per_N > 0.0 ? balanced_N(at_force, before_N, slope) : at_force(0.0);
      if (explain) {
        const bool in_contact = pushed.touching && force_N > 0.0;
        run.input_sd_N.push_back(
            in_contact ? input_sd_N(bed, met.contact, met.reaction, motion_.accel_sd_mps2[i]) : 0.0);
        run.phase.push_back(phase_of(in_contact, met.down, read.speed_mps(i)));
      }
      if (pushed.touching && !pushed.touched && i > 0 && read.speed_mps(i) > rest_speed_mps_)
        run.force.values[i - 1] += met_between_N(bed, met.contact, force_N, asked_before_m, asked_m);
      pushed.touched = pushed.touching;
      asked_before_m = asked_m;
      // While the foot goes down, the newest depth counts, not the largest: the maximum of many noisy
      // readings is too deep.
      if (met.down)
        pushed.deepest_m = pushed.down_before ? met.depth_m : std::max(pushed.deepest_m, met.depth_m);
      pushed.down_before = met.down;
      before_N = force_N;
      run.force.values[i] =
          cell.empty() ? force_N : force_N + sum_of(cell, CellState{.foot_accel_mps2 = -read.accel_mps2(i)});
    }
    return run;
  }

  // Correction of the force at the step before first contact, which comes a share u of a step after it. The
  // force jumps there to J, its value at depth 0, and rises to F. With the correction, linear interpolation
  // has the same integral:
  //   (1 - 2 u) J - u (F - J)
  static double met_between_N(const Bed& bed, const BedContact& contact, double force_N, double before_m,
                              double after_m) {
    constexpr double kNoDepth_m = 1e-7;
    if (before_m >= 0.0 || after_m <= before_m) return 0.0;
    const double u = -before_m / (after_m - before_m);
    BedContact first = contact;
    first.depth_m = first.max_depth_m = std::min(kNoDepth_m, contact.depth_m);
    first.deepest_N = kNotKnown_N;
    const double jump_N = std::min(bed.reaction(first).force_N, force_N);
    return (1.0 - 2.0 * u) * jump_N - u * (force_N - jump_N);
  }

  // Standard deviation of the force from the noise of the recorded motion, by finite differences of the bed's
  // law, and from the fluctuation between the knots.
  double input_sd_N(const Bed& bed, const BedContact& at, const BedReaction& reaction,
                    double accel_sd_mps2) const {
    constexpr double kShift_m = 1e-5, kShift_mps = 1e-3;
    BedContact shallower = at, faster = at;
    shallower.depth_m -= kShift_m;
    const bool virgin = at.depth_m >= at.max_depth_m && at.speed_mps > 0.0;
    if (virgin) shallower.max_depth_m = std::min(at.max_depth_m, shallower.depth_m);
    if (virgin) faster.speed_mps += kShift_mps;
    const double by_depth = (reaction.force_N - bed.reaction(shallower).force_N) / kShift_m;
    const double by_speed = (bed.reaction(faster).force_N - reaction.force_N) / kShift_mps;
    const double grains_N = virgin ? grains_.between_knots() * bed.quasi_static_force_N(at.depth_m) : 0.0;
    return std::hypot(std::hypot(by_depth * motion_.depth_sd_m, by_speed * motion_.speed_sd_mps),
                      std::hypot(reaction.added_mass_kg * accel_sd_mps2, grains_N));
  }

  // Standard deviation between two simulations at an edge of the force: their sampling instants may differ by
  // a twentieth of a row.
  double edge_sd_N(const std::vector<double>& force_N, std::size_t i) const {
    constexpr double kPartOfARow = 0.05;
    const auto to_side = static_cast<std::size_t>(std::ceil(row_s_ / motion_.step_s));
    const auto first = force_N.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, to_side));
    const auto last =
        force_N.begin() + static_cast<std::ptrdiff_t>(std::min(i + to_side + 1, force_N.size()));
    const auto [low, high] = std::minmax_element(first, last);
    return kPartOfARow * (*high - *low) / 2.0;
  }

  void add_nuisance(const char* what, double sd, double step) { trial_nuisances.push_back({what, sd, step}); }

  void add_knots() {
    double deepest_m = 0.0;
    for (const double d : motion_.depth_m) deepest_m = std::max(deepest_m, d);
    grains_ = BedGrains(belief_.value("spread.bed_fluctuation_relative"),
                        belief_.value("spread.bed_fluctuation_length_m", 0.002), deepest_m,
                        deepest_m / static_cast<double>(kMostKnots - 1), kMostKnots + 1);
    for (std::size_t i = 0; i < grains_.count(); ++i) add_nuisance("bed_fluctuation", grains_.sd(), 0.01);
  }

  void label_rows(double cell_sd_N) {
    Coordinate depth{"depth_m", {}}, speed{"foot_velocity_mps", {}}, accel{"foot_accel_mps2", {}},
        time{"t_s", {}};
    const Signal d{motion_.start_s, motion_.step_s, motion_.depth_m},
        v{motion_.start_s, motion_.step_s, motion_.speed_mps},
        a{motion_.start_s, motion_.step_s, motion_.accel_mps2};
    const Run run = simulate({}, std::vector<double>(nuisance_count(), 0.0), true);
    for (Row& row : rows) {
      depth.values.push_back(d.at(row.time_s));
      speed.values.push_back(-v.at(row.time_s));
      accel.values.push_back(-a.at(row.time_s));
      time.values.push_back(row.time_s);
      const auto i = std::min(
          static_cast<std::size_t>(std::max(0.0, (row.time_s - motion_.start_s) / motion_.step_s + 0.5)),
          run.phase.size() - 1);
      row.phase = run.phase[i];
      row.relative_sd = std::hypot(row.relative_sd, run.input_sd_N[i] / cell_sd_N,
                                   edge_sd_N(run.force.values, i) / cell_sd_N);
    }
    coordinates = {std::move(depth), std::move(speed), std::move(accel), std::move(time)};
  }

  Belief belief_;
  double radius_m_ = 0.04, rest_speed_mps_ = 0.0, row_s_ = 1e-3;
  IntruderMotion motion_;
  BedHistory history_;
  BedGrains grains_;
  std::vector<double> times_, ages_s_;
  std::size_t age_nuisance_ = 0;
  SensorBelief sensor_;
};

}  // namespace

std::unique_ptr<TrialModel> make_intruder_trial(const Trial& trial, const Belief& belief) {
  return std::make_unique<IntruderTrial>(trial, belief);
}

}  // namespace sandhopper::diagnose
