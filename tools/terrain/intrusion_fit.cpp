#include "tools/terrain/intrusion_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "terrain/none.hpp"

namespace sandhopper {
namespace {

constexpr double kContactForce_N = 2.0;
constexpr double kDisplacementResolution_m = 2e-5;

using Presses = std::vector<const PressTrial*>;

std::vector<DepthTrial> loadings(const Presses& presses) {
  std::vector<DepthTrial> out;
  for (const auto* press : presses) out.push_back(press->loading);
  return out;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0.0, n = 0.0;
  for (const double value : values)
    if (!std::isnan(value)) {
      sum += value * value;
      n += 1.0;
    }
  return n > 0.0 ? std::sqrt(sum / n) : kNone;
}

RigResult judge_rig(std::span<const PressTrial> trials) {
  std::vector<double> compliance, toe, stop_unloading, bed_unloading;
  for (const auto& trial : trials) {
    const ForcePath path{trial.path_displacement_m, trial.path_force_N};
    const double relief = unloading(path, kDisplacementResolution_m).stiffness_N_per_m;
    if (trial.on_stop) {
      const auto loading = loading_compliance(path, kContactForce_N);
      compliance.push_back(loading.compliance_m_per_N);
      toe.push_back(loading.toe_m);
      stop_unloading.push_back(relief);
    } else if (!trial.held_out) {
      bed_unloading.push_back(relief);
    }
  }
  RigResult out{.stop_compliance_m_per_N = mean_over_trials(compliance),
                .stop_unloading_N_per_m = mean_over_trials(stop_unloading),
                .toe_m = mean_over_trials(toe),
                .bed_unloading_N_per_m = mean_over_trials(bed_unloading)};
  const double stop = out.stop_compliance_m_per_N.value, bed = 1.0 / out.bed_unloading_N_per_m.value;
  if (out.stop_compliance_m_per_N.trials == 0) {
    out.why = "There is no trial on a rigid stop; the rig counts as rigid.";
  } else if (out.bed_unloading_N_per_m.trials > 0 && bed < 0.5 * stop) {
    out.why =
        "Unloaded in the bed, the rig springs back far less than on the stop. So the part that yields on the "
        "stop does not lie between displacement sensor and plate while the plate is in the bed. Its "
        "compliance "
        "is not taken off the depth.";
  } else {
    out.compliance_used_m_per_N = stop;
    out.why = "What the rig yields on the stop is taken off the recorded depth.";
  }
  return out;
}

void predict(LawResult& law, const Presses& held_out, const DepthLawOptions& options) {
  std::vector<double> rms;
  std::vector<std::vector<double>> errors(kPredictedDepths_m.size());
  for (const auto* press : held_out) {
    PressPrediction prediction{press->trial, press->loading.diameter_m, 0.0, {}, {}};
    prediction.rms_N = rms_residual_N(law.fit, press->loading, options);
    rms.push_back(prediction.rms_N);
    for (std::size_t i = 0; i < kPredictedDepths_m.size(); ++i) {
      const double depth_m = kPredictedDepths_m[i];
      prediction.measured_N.push_back(measured_force_N(press->loading, depth_m));
      prediction.predicted_N.push_back(
          depth_law_force_N(law.fit, depth_m, press->loading.diameter_m, options));
      errors[i].push_back(prediction.predicted_N.back() / prediction.measured_N.back() - 1.0);
    }
    law.predictions.push_back(std::move(prediction));
  }
  law.heldout_rms_N = root_mean_square(rms);
  for (const auto& error : errors) law.relative_error.push_back(mean_over_trials(error).value);
}

LawResult fit_law(DepthLaw kind, const Presses& fit, const Presses& held_out,
                  const DepthLawOptions& options) {
  const auto trials = loadings(fit);
  LawResult out;
  out.fit = fit_depth_law(kind, trials, options);
  std::vector<double> stiffness, shape;
  std::vector<std::vector<double>> predicted(kPredictedDepths_m.size());
  for (const auto& trial : trials) {
    const auto own = fit_depth_law(kind, std::span(&trial, 1), options);
    stiffness.push_back(own.stiffness_per_area_N_per_m3);
    shape.push_back(own.shape);
    for (std::size_t i = 0; i < predicted.size() && !held_out.empty(); ++i)
      predicted[i].push_back(
          depth_law_force_N(own, kPredictedDepths_m[i], held_out.front()->loading.diameter_m, options));
  }
  for (const auto& forces : predicted) out.predicted_N.push_back(mean_over_trials(forces));
  out.stiffness_per_area_N_per_m3 = mean_over_trials(stiffness);
  out.shape = mean_over_trials(shape);
  out.cross_validation_N =
      trials.size() > 1 ? root_mean_square(cross_validate(kind, trials, options)) : kNone;
  predict(out, held_out, options);
  return out;
}

// Exponent p from every pair of trials of two sizes. For each trial of the second size the mean over those of
// the first is taken, so that the interval counts trials.
AreaExponent area_exponent(const Presses& first, const Presses& second, double depth_m) {
  std::vector<double> exponents;
  for (const auto* b : second) {
    std::vector<double> own;
    for (const auto* a : first)
      own.push_back(std::log(measured_force_N(b->loading, depth_m) / measured_force_N(a->loading, depth_m)) /
                    (2.0 * std::log(b->loading.diameter_m / a->loading.diameter_m)));
    exponents.push_back(mean_over_trials(own).value);
  }
  return {.depth_m = depth_m, .exponent = mean_over_trials(exponents)};
}

std::vector<AreaExponent> area_exponents(const Presses& all) {
  std::vector<AreaExponent> out;
  if (all.empty()) return out;
  const auto other = std::find_if(all.begin(), all.end(), [&](const PressTrial* press) {
    return press->loading.diameter_m != all.front()->loading.diameter_m;
  });
  if (other == all.end()) return out;
  Presses first, second;
  for (const auto* press : all) {
    if (press->loading.diameter_m == all.front()->loading.diameter_m) first.push_back(press);
    if (press->loading.diameter_m == (*other)->loading.diameter_m) second.push_back(press);
  }
  for (const double depth_m : kPredictedDepths_m) {
    out.push_back(area_exponent(first, second, depth_m));
    out.back().from_held_out = first.front()->held_out || second.front()->held_out;
  }
  return out;
}

}  // namespace

IntrusionFit fit_intrusions(std::span<const PressTrial> trials) {
  IntrusionFit out;
  Presses fit, held_out, all;
  for (const auto& trial : trials) {
    if (trial.on_stop || trial.loading.samples.size() < 3) continue;
    all.push_back(&trial);
    (trial.held_out ? held_out : fit).push_back(&trial);
  }
  out.fit_trials = fit.size();
  out.held_out_trials = held_out.size();
  out.rig = judge_rig(trials);
  if (fit.empty()) return out;
  out.options = {.friction_angle_rad = fit.front()->friction_angle_rad,
                 .compliance_m_per_N = out.rig.compliance_used_m_per_N};
  for (std::size_t i = 0; i < EnumNames<DepthLaw>::value.size(); ++i) {
    out.laws.push_back(fit_law(static_cast<DepthLaw>(i), fit, held_out, out.options));
    const auto& law = out.laws.back();
    const auto error = [&](const LawResult& result) {
      return fit.size() > 1 ? result.cross_validation_N : result.fit.rms_N;
    };
    const bool better = !out.chosen || error(law) < error(out.laws[*out.chosen]);
    if (better && std::isfinite(law.fit.rms_N)) out.chosen = i;
  }
  if (out.chosen && out.rig.compliance_used_m_per_N == 0.0 && out.rig.stop_compliance_m_per_N.trials > 0) {
    auto with = out.options;
    with.compliance_m_per_N = out.rig.stop_compliance_m_per_N.value;
    out.with_stop_compliance = fit_law(out.laws[*out.chosen].fit.law, fit, held_out, with);
  }
  if (out.chosen && out.laws[*out.chosen].fit.law == DepthLaw::confined_layer && !held_out.empty()) {
    const auto error_with = [&](double step_rad) {
      auto changed = out.options;
      changed.friction_angle_rad += step_rad;
      return fit_law(DepthLaw::confined_layer, fit, held_out, changed).relative_error.back();
    };
    constexpr double kStep_rad = 5.0 * std::numbers::pi / 180.0;
    out.friction_angle_sensitivity = {error_with(-kStep_rad), error_with(kStep_rad)};
  }
  out.area = area_exponents(all);
  return out;
}

}  // namespace sandhopper
