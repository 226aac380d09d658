#include "tools/terrain/penetrometer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sandhopper {
namespace {

constexpr double kAverage_s = 0.010;
constexpr double kRest_s = 1.0;  // length of the part at the end of a recording that must be at rest
constexpr double kRestTolerance_mps2 = 0.4;
constexpr double kBeforeImpact_s = 0.6;
constexpr double kTouchdownSigmas = 4.0;
constexpr double kSlowest_mps = 0.05;  // below it a drop counts as stopped
constexpr double kFalling_mps = 0.3;   // above it the body counts as falling
constexpr std::size_t kMostSamples = 400;

struct Signals {
  std::vector<double> t_s;
  std::vector<std::string> names;
  std::vector<std::vector<double>> accel_mps2;
  std::vector<std::vector<double>> lateral_mps2;
  std::vector<double> pressure_Pa;  // empty: not recorded
};

Signals signals_of(const TrialRecording& recording) {
  Signals out;
  std::vector<const std::vector<double>*> axial, lateral;
  const auto* pressure = recording.find("pressure_Pa");
  for (const auto* name : {"accel_mps2", "accel_2_mps2", "accel_3_mps2", "accel_4_mps2"})
    if (const auto* values = recording.find(name)) {
      axial.push_back(values);
      out.names.emplace_back(name);
    }
  for (const auto* name : {"lateral_x_accel_mps2", "lateral_y_accel_mps2"})
    if (const auto* values = recording.find(name)) lateral.push_back(values);
  out.accel_mps2.resize(axial.size());
  out.lateral_mps2.resize(lateral.size());
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const auto missing = [&](const auto* values) { return std::isnan((*values)[row]); };
    if (std::any_of(axial.begin(), axial.end(), missing)) continue;
    out.t_s.push_back(recording.t_s[row]);
    if (pressure != nullptr) out.pressure_Pa.push_back((*pressure)[row]);
    for (std::size_t i = 0; i < axial.size(); ++i) out.accel_mps2[i].push_back((*axial[i])[row]);
    for (std::size_t i = 0; i < lateral.size(); ++i) out.lateral_mps2[i].push_back((*lateral[i])[row]);
  }
  return out;
}

double mean_from(const std::vector<double>& values, std::size_t first) {
  double sum = 0.0;
  for (std::size_t i = first; i < values.size(); ++i) sum += values[i];
  return sum / static_cast<double>(values.size() - first);
}

double cos_tilt(const Signals& signals, std::size_t rest_row, double gravity_mps2) {
  double across = 0.0;
  for (const auto& lateral : signals.lateral_mps2)
    across += std::pow(mean_from(lateral, rest_row) / gravity_mps2, 2);
  return std::sqrt(std::max(1.0 - across, 0.0));
}

class DropAnalysis {
 public:
  DropAnalysis(const Signals& signals, const FallingBodyBelief& belief, PenetrometerDrop& drop)
      : signals_(signals), gravity_mps2_(belief.gravity_mps2), drop_(drop) {}

  // Throws std::invalid_argument with the reason if the drop cannot be used.
  void run() {
    std::vector<std::span<const double>> channels(signals_.accel_mps2.begin(), signals_.accel_mps2.end());
    drop_.fused = fuse_accelerometers(channels, {});
    const auto& t = signals_.t_s;
    const double step_s = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
    average_ = 2 * static_cast<std::size_t>(0.5 * kAverage_s / step_s) + 1;
    const auto& f = drop_.fused.specific_force_mps2;
    const auto rest = find_rest(f, average_, static_cast<std::size_t>(kRest_s / step_s), kRestTolerance_mps2);
    if (rest >= t.size()) throw std::invalid_argument("the recording does not end at rest");
    drop_.cos_tilt = cos_tilt(signals_, rest, gravity_mps2_);
    rest_mps2_ = gravity_mps2_ * drop_.cos_tilt;
    motion_ = speed_from_rest(t, f, rest_mps2_, rest);
    drop_.rest_bias_mps2 = motion_.bias_mps2;
    touchdown_ = find_touchdown(t, f, average_, kBeforeImpact_s, kTouchdownSigmas);
    if (touchdown_.row == 0 || touchdown_.peak_row >= rest)
      throw std::invalid_argument("no impact before the rest at its end");
    drop_.impact_speed_mps = motion_.speed_mps[touchdown_.row];
    fit_fall();
    follow_penetration();
    keep_impact();
  }

 private:
  void fit_fall() {
    const auto& t = signals_.t_s;
    const auto& v = motion_.speed_mps;
    std::size_t from = touchdown_.row;
    while (from > 0 && v[from - 1] > kFalling_mps) --from;
    std::size_t to = touchdown_.row;
    while (to > from && t[to] > t[touchdown_.row] - 0.1) --to;
    std::vector<double> f;
    for (std::size_t i = from; i < to; ++i)
      f.push_back(drop_.fused.specific_force_mps2[i] + motion_.bias_mps2 + gravity_mps2_ - rest_mps2_);
    drop_.fluid = fit_fluid(std::span(v).subspan(from, to - from), f, gravity_mps2_);
    // The body hung still from 0.7 to 0.5 s before the fall.
    double sum = 0.0, rows = 0.0;
    for (std::size_t i = 0; i < from; ++i)
      if (t[i] > t[from] - 0.7 && t[i] < t[from] - 0.5) {
        sum += v[i];
        rows += 1.0;
      }
    drop_.speed_before_release_mps = rows > 0.0 ? sum / rows : std::nan("");
    compare_with_pressure(from);
  }

  void compare_with_pressure(std::size_t from) {
    const auto& t = signals_.t_s;
    drop_.fallen_m = 0.0;
    for (std::size_t i = from; i < motion_.rest_row; ++i)
      drop_.fallen_m += 0.5 * (motion_.speed_mps[i] + motion_.speed_mps[i + 1]) * (t[i + 1] - t[i]);
    drop_.fallen_by_pressure_m = std::nan("");
    const double weight_N_per_m3 = drop_.body.density_kg_per_m3 * gravity_mps2_;
    if (signals_.pressure_Pa.empty() || !(weight_N_per_m3 > 0.0)) return;
    const auto& p = signals_.pressure_Pa;
    const std::vector<double> before(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(from));
    const std::size_t last = std::min<std::size_t>(before.size(), 100);
    drop_.fallen_by_pressure_m =
        (mean_from(p, p.size() - 100) - mean_from(before, before.size() - last)) / weight_N_per_m3;
  }

  void follow_penetration() {
    const auto& t = signals_.t_s;
    const auto& v = motion_.speed_mps;
    const auto averaged = moving_average(drop_.fused.specific_force_mps2, 5);
    std::vector<ResistanceSample> samples;
    double depth_m = 0.0;
    for (std::size_t i = touchdown_.row; i + 1 < motion_.rest_row && v[i] > kSlowest_mps; ++i) {
      const double accel = averaged[i] + motion_.bias_mps2 - rest_mps2_;  // h''
      samples.push_back(
          {depth_m, v[i], accel + drop_.fluid.alpha * gravity_mps2_ - drop_.fluid.kappa_per_m * v[i] * v[i]});
      depth_m += 0.5 * (v[i] + v[i + 1]) * (t[i + 1] - t[i]);
    }
    drop_.depth_m = depth_m;
    const std::size_t step = 1 + samples.size() / kMostSamples;
    for (std::size_t i = 0; i < samples.size(); i += step) drop_.penetration.push_back(samples[i]);
  }

  void keep_impact() {
    const auto& t = signals_.t_s;
    const double from_s = t[touchdown_.row] - 0.1, to_s = t[touchdown_.peak_row] + 0.2;
    std::size_t rows = 0;
    for (const double time : t) rows += time >= from_s && time <= to_s ? 1 : 0;
    const std::size_t step = 1 + rows / kMostSamples;
    std::size_t row = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (t[i] < from_s || t[i] > to_s || row++ % step != 0) continue;
      drop_.t_s.push_back(t[i] - t[touchdown_.row]);
      drop_.specific_force_mps2.push_back(drop_.fused.specific_force_mps2[i] + motion_.bias_mps2);
      drop_.source.push_back(static_cast<double>(drop_.fused.source[i]));
    }
  }

  const Signals& signals_;
  double gravity_mps2_;
  PenetrometerDrop& drop_;
  std::size_t average_ = 1;
  double rest_mps2_ = 0.0;
  FallingMotion motion_;
  Touchdown touchdown_;
};

void add_quantities(const PenetrometerDrop& drop, TrialResult& result) {
  const auto add = [&](const std::string& name, double value) {
    TrialQuantity quantity;
    quantity.name = name;
    quantity.value = value;
    result.quantities.push_back(std::move(quantity));
  };
  double greatest = 0.0;
  for (const auto& sample : drop.penetration) greatest = std::max(greatest, sample.resistance);
  add("impact_speed_mps", drop.impact_speed_mps);
  add("penetration_depth_m", drop.depth_m);
  add("fluid_alpha", drop.fluid.alpha);
  add("fluid_kappa_per_m", drop.fluid.kappa_per_m);
  add("greatest_resistance_mps2", greatest);
}

}  // namespace

void keep_drop(const CampaignTrial& trial, const TrialRecording& recording, TrialResult& result) {
  const auto signals = signals_of(recording);
  if (signals.accel_mps2.empty() || signals.t_s.size() < 100) {
    result.ruled_out.push_back("resistance of the bed: needs accel_mps2");
    return;
  }
  const auto& belief = std::get<FallingBodyBelief>(trial.belief);
  PenetrometerDrop drop;
  drop.trial = trial.name;
  drop.names = signals.names;
  drop.mass_min_kg = trial.number("mass_min_kg").value_or(belief.body.mass_kg);
  drop.mass_max_kg = trial.number("mass_max_kg").value_or(belief.body.mass_kg);
  drop.body = {.mass_kg = 0.5 * (drop.mass_min_kg + drop.mass_max_kg),
               .volume_m3 = belief.body.volume_m3,
               .frontal_area_m2 = belief.body.frontal_area_m2,
               .density_kg_per_m3 = belief.medium.density_kg_per_m3};
  try {
    DropAnalysis(signals, belief, drop).run();
  } catch (const std::invalid_argument& error) {
    result.ruled_out.push_back(fmt::format("resistance of the bed: {}", error.what()));
    return;
  }
  keep_numbers(drop, result);
  add_quantities(drop, result);
}

PenetrometerFit fit_penetrations(const std::vector<PenetrometerDrop>& drops) {
  std::vector<Penetration> penetrations;
  PenetrometerFit out;
  for (const auto& drop : drops) {
    penetrations.push_back(drop.penetration);
    out.depth_speed_correlation.push_back(depth_speed_correlation(drop.penetration));
  }
  for (std::size_t i = 0; i < EnumNames<ResistanceLaw>::value.size(); ++i) {
    const auto law = static_cast<ResistanceLaw>(i);
    ResistanceResult result;
    result.fit = fit_resistance(law, penetrations);
    std::vector<double> exponents, rates;
    for (const auto& penetration : penetrations) {
      const auto own = fit_resistance(law, std::span(&penetration, 1));
      exponents.push_back(own.exponent);
      rates.push_back(own.rate);
    }
    result.exponent = mean_over_trials(exponents);
    result.rate = mean_over_trials(rates);
    double squares = 0.0;
    const auto errors = cross_validate(law, penetrations);
    for (const double error : errors) squares += error * error / static_cast<double>(errors.size());
    result.cross_validation = std::sqrt(squares);
    out.laws.push_back(std::move(result));
    const auto error = [&](const ResistanceResult& r) {
      return drops.size() > 1 ? r.cross_validation : r.fit.rms;
    };
    if (error(out.laws.back()) < error(out.laws[out.chosen])) out.chosen = i;
  }
  return out;
}

}  // namespace sandhopper
