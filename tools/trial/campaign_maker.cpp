#include "tools/trial/campaign_maker.hpp"

#include <fmt/format.h>
#include <fmt/os.h>

#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "firmware/log/csv_export.hpp"
#include "tools/plant/sensors.hpp"
#include "tools/plant/trial_draw.hpp"
#include "tools/trial/sim_trial.hpp"

namespace sandhopper {
namespace {

namespace fs = std::filesystem;

// Opens a file for writing; throws with the reason if that fails.
std::ofstream open(const fs::path& file) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file);
  if (!out) throw std::runtime_error("cannot write " + file.string() + "; is the folder there and writable?");
  return out;
}

struct Head {
  std::string_view name;
  std::string_view plant;
};
std::ofstream begin(const fs::path& folder, const Head& head) {
  auto out = open(folder / "campaign.toml");
  out << fmt::format("name  = \"{}\"\nplant = \"{}\"\nmodel = \"nominal.toml\"\n", head.name, head.plant);
  return out;
}

std::string trial_file(int number) { return fmt::format("trials/{:04}.csv", number + 1); }

// The foot's prescribed path: at rest above the surface, down at one speed, a dwell, up again, with ramps in
// between.
class Path {
 public:
  explicit Path(double speed_mps) : speed_mps_(speed_mps) {
    const double lead_s = kLead_m / speed_mps, ramp_s = speed_mps / kRamp_mps2;
    down_s_ = kRest_s;
    bottom_s_ = down_s_ + lead_s + kDepth_m / speed_mps + ramp_s;
    up_s_ = bottom_s_ + kDwell_s;
    end_s_ = up_s_ + 0.6 * (bottom_s_ - down_s_) + kRest_s;
  }
  double end_s() const { return end_s_; }
  // Speed profile of trapezoids; the caller integrates the position.
  double velocity_mps(double t_s) const {
    if (t_s < down_s_ || t_s > end_s_ - kRest_s) return 0.0;
    if (t_s < bottom_s_) return -ramped(t_s - down_s_, bottom_s_ - t_s);
    if (t_s < up_s_) return 0.0;
    return ramped(t_s - up_s_, end_s_ - kRest_s - t_s);
  }
  static constexpr double kLead_m = 0.010;
  static constexpr double kDepth_m = 0.045;

 private:
  static constexpr double kRest_s = 0.25, kDwell_s = 0.2, kRamp_mps2 = 60.0;
  double ramped(double since_s, double until_s) const {
    return std::min(speed_mps_, kRamp_mps2 * std::max(0.0, std::min(since_s, until_s)));
  }
  double speed_mps_, down_s_, bottom_s_, up_s_, end_s_;
};

struct Intrusion {
  double speed_mps;
  double diameter_m;

  // The bed's pressure at one depth does not depend on the plate, so the stiffness scales with the area.
  double stiffness_N_per_m(double of_foot_N_per_m, double foot_radius_m) const {
    const double size = 0.5 * diameter_m / foot_radius_m;
    return of_foot_N_per_m * size * size;
  }
};
Intrusion intrusion(int number) {
  constexpr std::array<double, 5> kSpeeds{0.022, 0.1, 0.3, 0.7, 1.1};
  return {kSpeeds[static_cast<std::size_t>(number) % kSpeeds.size()], number / 5 % 2 == 0 ? 0.080 : 0.060};
}

std::string cell(bool fresh, double value) { return fresh ? fmt::format("{:.7g}", value) : std::string(); }

void record_intrusion(const WorldConfig& world, const Intrusion& what, std::uint64_t seed,
                      std::ofstream out) {
  constexpr double kAccelNoise_mps2 = 0.1;
  const TrialDraw draw(world, {.seed = seed, .noise = true, .start_ns = 0});
  BedParameters parameters = draw.bed().parameters();
  parameters.stiffness_N_per_m =
      what.stiffness_N_per_m(parameters.stiffness_N_per_m, world.robot.leg.foot_radius_m);
  const Bed bed(parameters, 0.5 * what.diameter_m, {}, draw.bed_family());
  Random noise(seed, 77);
  const double bias_mps2 = world.spread.imu_bias_mps2 * noise.normal();
  LoadCell cell_of_trial = draw.load_cell();
  const Path path(what.speed_mps);
  double z = Path::kLead_m, deepest = 0.0, camera_s = 0.0, accel_sum = 0.0;
  std::uint32_t seen = 0;
  out << "t_s,foot_z_m,foot_accel_mps2,force_N\n";
  const int steps = static_cast<int>(path.end_s() * 1e4);
  for (int i = 0; i < steps; ++i) {
    const double t = 1e-4 * i;
    const double v = path.velocity_mps(t), a = (path.velocity_mps(t + 1e-4) - v) / 1e-4;
    const double depth = std::max(0.0, -z);
    const double force = bed.reaction({depth, -v, deepest, 0.0}).at_acceleration(a);
    cell_of_trial.step({i * World::kStep_ns, (i + 1) * World::kStep_ns}, force);
    accel_sum += a;
    if (i % 10 == 0) {
      // Mean over a millisecond, so that a short ramp is not lost.
      const double accel = accel_sum / (i == 0 ? 1.0 : 10.0);
      accel_sum = 0.0;
      const bool frame = t >= camera_s;
      if (frame) camera_s += 1.0 / world.sensors.mocap_rate_Hz;
      const bool fresh = cell_of_trial.sample().samples != seen;
      seen = cell_of_trial.sample().samples;
      out << fmt::format(
          "{:.3f},{},{:.5f},{}\n", t, cell(frame, z + world.sensors.mocap_noise_m * noise.normal()),
          accel + bias_mps2 + kAccelNoise_mps2 * noise.normal(), cell(fresh, cell_of_trial.sample().force_N));
    }
    z += 1e-4 * v + 0.5e-8 * a;
    deepest = std::max(deepest, -z);
  }
}

// Properties of the simulated bed that a nominal.toml must contain.
std::string bed_keys(const BedParameters& bed) {
  return fmt::format(
      "[terrain]\nstiffness_N_per_m         = {}\nintercept_depth_m         = {}\nadded_mass_factor         "
      "= {}\ndrag_factor               "
      "= {}\n"
      "unloading_stiffness_ratio = {}\nunloading_damping_ratio   = {}\n",
      bed.stiffness_N_per_m, bed.intercept_depth_m, bed.added_mass_factor, bed.drag_factor,
      bed.unloading_stiffness_ratio, bed.unloading_damping_ratio);
}

}  // namespace

void make_hop_campaign(const CampaignMakerSetup& setup) {
  constexpr std::array<double, 5> kHeights_m{0.0025, 0.0125, 0.0303, 0.0618, 0.0890};
  constexpr std::array<double, 3> kStiffnesses_N_per_m{250.0, 375.0, 500.0};
  auto out = begin(setup.folder, {"simulated hops", "hopper"});
  open(setup.folder / "nominal.toml")
      << "[sensors]\nencoder_latency_s = 0.001   # a row holds the reply to the "
         "previous cycle's command\n\n"
      << fmt::format(
             "[robot]\nrail_coulomb_N        = {}\njoint_coulomb_Nm      = {}\ncogging_amplitude_Nm  = "
             "{}\n\n",
             setup.world.robot.rail_coulomb_N, setup.world.robot.joint_coulomb_Nm,
             setup.world.robot.cogging_amplitude_Nm)
      << bed_keys(setup.world.terrain);
  const fs::path log = setup.folder / "making.mcap";
  for (int i = 0; i < setup.trials; ++i) {
    SimTrialSetup trial{.robot = setup.robot, .world = setup.world, .log = log};
    trial.robot.limits.strides = 1;
    trial.trial = {.release_height_m = kHeights_m[static_cast<std::size_t>(i) % kHeights_m.size()],
                   .seed = setup.seed + static_cast<std::uint64_t>(i)};
    const double stiffness =
        kStiffnesses_N_per_m[static_cast<std::size_t>(i) / kHeights_m.size() % kStiffnesses_N_per_m.size()];
    trial.robot.controller.compression_stiffness_N_per_m = stiffness;
    fs::remove(log);
    run_sim_trial(trial);
    auto csv = open(setup.folder / trial_file(i));
    export_csv(log, csv);
    out << fmt::format(
        "\n[[trial]]\nfile = \"{}\"\nkind = \"hop\"\nrelease_height_m = {}\ncompression_stiffness_N_per_m = "
        "{}\n",
        trial_file(i), trial.trial.release_height_m, stiffness);
    if (setup.progress) setup.progress(i + 1);
  }
  fs::remove(log);
}

void make_intrusion_campaign(const CampaignMakerSetup& setup) {
  auto out = begin(setup.folder, {"simulated intrusions", "intruder"});
  open(setup.folder / "nominal.toml") << "[foot]\nradius_m = 0.040\n\n" << bed_keys(setup.world.terrain);
  for (int i = 0; i < setup.trials; ++i) {
    const auto what = intrusion(i);
    record_intrusion(setup.world, what, setup.seed + static_cast<std::uint64_t>(i),
                     open(setup.folder / trial_file(i)));
    out << fmt::format(
        "\n[[trial]]\nfile = \"{}\"\nkind = \"intrusion\"\nimpact_speed_mps = {}\nplate_diameter_m = {}\n"
        "stiffness_N_per_m = {}\n",
        trial_file(i), what.speed_mps, what.diameter_m,
        what.stiffness_N_per_m(setup.world.terrain.stiffness_N_per_m, setup.world.robot.leg.foot_radius_m));
    if (setup.progress) setup.progress(i + 1);
  }
}

}  // namespace sandhopper
