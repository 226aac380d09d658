#include <algorithm>
#include <array>

#include "tools/diagnose/plants/hopper/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper/hopper_trial_model.hpp"

namespace sandhopper::diagnose::hopper {
namespace {

constexpr double kAtRest = 0.01;  // start of a release at rest: share of the uncertainty of a later hop

// `wanted`, or the smallest factor on the believed switch speeds of dry friction that the steps resolve.
double sharper(const WorldRobotConfig& robot, double wanted) {
  const double rail = WorldRobotConfig::kSharpestRail_mps / robot.rail_friction_switch_speed_mps,
               joint = WorldRobotConfig::kSharpestJoint_radps / robot.joint_friction_switch_speed_radps;
  return std::min(1.0, std::max({wanted, rail, joint}));
}

}  // namespace

const WorldConfig& HopperTrial::edited_world(const Edits& edits) const {
  if (edits.belief != edits_of_world_) {
    edited_world_ = world_of(belief_, edits);
    edits_of_world_ = edits.belief;
  }
  return edited_world_;
}

void HopperTrial::predict(const Edits& edits, std::span<const double> n, std::span<double> out) const {
  const WorldConfig& world = edited_world(edits);
  std::vector<double> plant_nuisances;
  for (std::size_t i = 0; i < n.size(); ++i)
    if (i < kTofBias || i >= kFirstKnot) plant_nuisances.push_back(n[i]);
  const auto key = HopperRuns::key(edits, plant_nuisances);
  for (std::uint32_t b = 0; b < blocks; ++b) {
    auto& run = runs_.run(key, b, [&] { return simulated(world, edits, b, n); });
    for (std::size_t c = 0; c < kSources.size(); ++c) {
      const auto& span = spans_[c][b];
      if (span.count == 0) continue;
      const std::array own{offset_of(c, n), scale_of(c, n), age_share(c, n)};
      run.read(c, HopperRuns::reading_key(edits, kSources[c].channel, own),
               out.subspan(span.first, span.count),
               [&](std::span<double> at) { read_channel(world, run.traces, edits, n, c, span, at); });
    }
  }
}

std::vector<VariantPair> HopperTrial::variants() const {
  constexpr double kFiner = 0.5, kHalfARow = 0.5, kSharper = 0.1;
  std::vector<VariantPair> pairs{{{}, {Variant::Kind::step, 0, kFiner}}};
  for (std::size_t i = 1; i < course_.phases.size(); ++i)
    if (course_.phases[i].time_s < course_.end_s) {
      const double unsure = kHalfARow + course_.phases[i].unsure_s / kTick_s;
      pairs.push_back({{Variant::Kind::event, i, -unsure}, {Variant::Kind::event, i, unsure}});
    }
  pairs.push_back({{}, {Variant::Kind::friction, 0, kSharper}});
  return pairs;
}

void HopperTrial::predict_variant(const Variant& variant, const Edits& edits, std::span<const double> n,
                                  std::span<double> out) const {
  const WorldConfig& world = edited_world(edits);
  auto phases = phases_at_cycles_;
  if (variant.kind == Variant::Kind::event) phases[variant.event].time_s += variant.amount * kTick_s;
  for (std::uint32_t b = 0; b < blocks; ++b) {
    HopperRun run = run_of(world, b, n);
    if (variant.kind == Variant::Kind::step) run.step_s *= variant.amount;
    if (variant.kind == Variant::Kind::friction)
      run.friction_switch_factor = sharper(world.robot, variant.amount);
    if (run.phases != nullptr) run.phases = &phases;
    run.switch_between_cycles = variant.kind == Variant::Kind::event;
    const auto traces = simulate_hopper(run, edits);
    for (std::size_t c = 0; c < kSources.size(); ++c)
      if (const auto& span = spans_[c][b]; span.count > 0)
        read_channel(world, traces, edits, n, c, span, out.subspan(span.first, span.count));
  }
}

HopperTraces HopperTrial::simulated(const WorldConfig& world, const Edits& edits, std::uint32_t block,
                                    std::span<const double> n) const {
  HopperRun run = run_of(world, block, n);
  const bool other = std::ranges::any_of(
      edits.belief, [](const BeliefEdit& edit) { return edit.key.starts_with("controller."); });
  if (!other || run.command_residual_Nm == nullptr) return simulate_hopper(run, edits);
  run.compression_stiffness_N_per_m = compression_stiffness_of(edits);
  const Signal residual = controller_.residual_Nm(world, run.compression_stiffness_N_per_m, course_.phases);
  run.command_residual_Nm = &residual;
  return simulate_hopper(run, edits);
}

HopperRun HopperTrial::run_of(const WorldConfig& world, std::uint32_t block,
                              std::span<const double> n) const {
  HopperRun run;
  run.world = world;
  run.world.terrain.stiffness_N_per_m *= 1.0 + n[kStiffness];
  run.world.terrain.stiffness_per_area_N_per_m3 *= 1.0 + n[kStiffness];
  run.compression_stiffness_N_per_m = compression_stiffness_;
  run.surface_m = n[kSurface];
  run.cable_force_N = n[kCable];
  run.torque_constant_factor = 1.0 + n[kTorqueConstant];
  run.motor_temperature_C = motor_temperature_C_;
  if (grains_.count() > 0) run.fluctuation = grains_.fluctuation(n.subspan(kFirstKnot));
  const HopStart& hop = course_.hops[block];
  run.start = hop.state;
  run.crater_m = hop.crater_m;
  run.bed_history = bed_history_;
  run.from_s = hop.from_s;
  run.to_s = block + 1 < blocks ? course_.hops[block + 1].from_s : course_.end_s;
  if (hop.at_rest) {
    run.start.foot_z_m += n[kReleaseHeight];
    run.start.foot_velocity_mps += n[kReleaseSpeed];
    run.start.angle_rad += n[kReleaseAngle];
  }
  if (!block_nuisances.empty()) {
    const auto own = n.subspan(trial_nuisances.size() + block * kHopNuisances, kHopNuisances);
    const double share = hop.at_rest ? kAtRest : 1.0;
    run.start.foot_z_m += share * own[kFootZ];
    run.start.foot_velocity_mps += share * own[kFootV];
    run.start.angle_rad += share * own[kAngle];
    run.start.angular_velocity_radps += share * own[kRate];
    run.crater_m = std::max(0.0, run.crater_m + (block == 0 ? 0.0 : own[kCrater]));
  }
  run.phases = &phases_at_cycles_;
  if (!commands_.values.empty()) run.recorded_command_Nm = &commands_;
  if (!residual_.values.empty()) run.command_residual_Nm = &residual_;
  return run;
}

void HopperTrial::read_channel(const WorldConfig& world, const HopperTraces& traces, const Edits& edits,
                               std::span<const double> n, std::size_t c, const Span& span,
                               std::span<double> at) const {
  if (is_command(c) && controller_.measured()) {
    read_command(world, edits, span, at);
    return;
  }
  Signal signal = traces.*kSources[c].trace;
  const double motors = world.robot.leg.motor_count;
  switch (c) {
    case kLeftCurrent:
    case kRightCurrent:
      for (double& v : signal.values) v /= motors * world.motor.torque_constant_Nm_per_A;
      break;
    case kLeftCommand:
    case kRightCommand:
      for (double& v : signal.values) v /= motors;
      break;
    case kImuBody:
    case kImuFoot:
      for (double& v : signal.values) v = scale_of(c, n) * (v + world.gravity_mps2);
      break;
    case kLoadCell: {
      const auto laws = edits.at(LawPort::load_cell);
      if (!laws.empty())
        for (std::size_t i = 0; i < signal.values.size(); ++i)
          signal.values[i] += sum_of(laws, CellState{.foot_accel_mps2 = traces.foot_accel_mps2.values[i]});
      break;
    }
    default:
      break;
  }
  const auto sampled_s = sampled(span, age_share(c, n));
  observe(signal, sensors_[c], edits, kSources[c].channel, sampled_s, at);
  const double offset = offset_of(c, n);
  for (double& v : at) v += offset;
}

void HopperTrial::read_command(const WorldConfig& world, const Edits& edits, const Span& span,
                               std::span<double> at) const {
  const auto commanded = [&](std::span<double> out) {
    controller_.commands_Nm(world, compression_stiffness_of(edits), course_.phases,
                            std::span(times_).subspan(span.first, span.count), out);
  };
  if (!edits.belief.empty()) return commanded(at);
  auto& believed = believed_commands_[span.first];
  if (believed.empty()) commanded(believed = std::vector<double>(span.count));
  std::ranges::copy(believed, at.begin());
}

std::vector<double> HopperTrial::sampled(const Span& span, double age_share) const {
  std::vector<double> at_s(span.count);
  for (std::size_t i = 0; i < span.count; ++i)
    at_s[i] = times_[span.first + i] - age_share * ages_s_[span.first + i];
  return at_s;
}

}  // namespace sandhopper::diagnose::hopper
