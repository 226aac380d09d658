#include "tools/campaign/hopper_height_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "tools/campaign/hopper_signals.hpp"
#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

// Sums of a regression z = kappa d after a straight line in t is taken out of both in each window.
struct Doubled {
  double dd = 0.0, dz = 0.0, zz = 0.0;
  double kappa() const { return dz / dd; }
  double agreement() const { return dz * dz / (dd * zz); }
};

struct WindowRow {
  double t_s, d_m, z_m;
};

void take_window(const std::vector<WindowRow>& rows, Doubled& sums) {
  constexpr std::size_t kFewest = 5;  // A line and a curvature, with two rows more.
  if (rows.size() < kFewest) return;
  double n = 0, st = 0, stt = 0, sd = 0, std_ = 0, sz = 0, stz = 0;
  for (const auto& row : rows)
    n += 1, st += row.t_s, stt += row.t_s * row.t_s, sd += row.d_m, std_ += row.t_s * row.d_m, sz += row.z_m,
        stz += row.t_s * row.z_m;
  const double tt = stt - st * st / n;
  if (!(tt > 0.0)) return;
  const double slope_d = (std_ - st * sd / n) / tt, slope_z = (stz - st * sz / n) / tt;
  for (const auto& row : rows) {
    const double t = row.t_s - st / n, d = row.d_m - sd / n - slope_d * t, z = row.z_m - sz / n - slope_z * t;
    sums.dd += d * d, sums.dz += d * z, sums.zz += z * z;
  }
}

class HopperHeightChecker {
 public:
  HopperHeightChecker(TrialRecording& recording, const HopperBelief& belief, const RecordingPlaces& places)
      : recording_(recording), belief_(belief), places_(places) {}

  void run() {
    check_body();
    if (!any_unusable(recording_.findings)) check_touchdown();
  }

 private:
  Doubled compare(const std::vector<double>& height, const std::vector<double>& accel) const {
    Doubled sums;
    constexpr std::size_t kWindows = 5;
    const std::size_t span = std::max<std::size_t>(2, recording_.rows() / kWindows);
    for (std::size_t begin = 0; begin + span <= recording_.rows(); begin += span) {
      std::vector<WindowRow> rows;
      double d_m = 0.0, v_mps = 0.0, last = NAN;
      for (std::size_t i = begin; i < begin + span; ++i) {
        const double next = (std::isnan(accel[i]) ? last : accel[i]) - belief_.gravity_mps2;
        if (i > begin && !std::isnan(last)) {
          const double dt_s = recording_.t_s[i] - recording_.t_s[i - 1];
          const double mean = 0.5 * (next + last - belief_.gravity_mps2);
          d_m += v_mps * dt_s + 0.5 * mean * dt_s * dt_s;
          v_mps += mean * dt_s;
        }
        if (!std::isnan(accel[i])) last = accel[i];
        if (!std::isnan(height[i]) && !std::isnan(last))
          rows.push_back({recording_.t_s[i] - recording_.t_s[begin], d_m, height[i]});
      }
      take_window(rows, sums);
    }
    return sums;
  }

  // True if a finding has named the channel already.
  bool is_doubted(std::string_view channel) const {
    return std::ranges::any_of(recording_.findings, [&](const Finding& finding) {
      return finding.channel == channel && finding.severity != FindingSeverity::note;
    });
  }

  bool has_samples(std::string_view channel) const {
    const auto* values = recording_.find(channel);
    return values != nullptr && std::ranges::any_of(*values, [](double value) { return !std::isnan(value); });
  }

  // The whole number, or its inverse, that the factor is within 3 %, as for ratios of rates.
  static double rounded(double factor) {
    constexpr double kNear = 0.03;
    const double whole = std::round(std::max(factor, 1.0 / factor));
    const double near = factor < 1.0 ? 1.0 / whole : whole;
    return std::abs(factor / near - 1.0) < kNear ? near : factor;
  }

  void check_body() {
    const auto* accel = recording_.find("imu_body_accel_z_mps2");
    const std::string_view channel = has_samples("mocap_body_z_m") ? "mocap_body_z_m" : "tof_height_m";
    const auto* height = recording_.find(channel);
    if (accel == nullptr || height == nullptr) return;
    if (is_doubted("t_s") || is_doubted(channel) || is_doubted("imu_body_accel_z_mps2")) return;
    const auto sums = compare(*height, *accel);
    if (!(sums.dd > 0.0) || !(sums.zz > 0.0) || sums.agreement() < kBelongTogether) return;
    // Half way, on a scale of ratios, to a time that is twice as long or half as long.
    constexpr double kTwice = 4.0;
    const double kappa = sums.kappa(), limit = std::sqrt(kTwice);
    if (kappa > 1.0 / limit && kappa < limit) return;
    const auto* time = places_.column_of("t_s");
    std::string cure = "correct the unit or scale of one of the three";
    if (kappa > 0.0 && time != nullptr)
      cure = fmt::format(
          "if the time is wrong (a recorder's rate that is not the stated one), write {} into "
          "[columns]; else correct the unit of the height or of the acceleration",
          mapping_line(in_other_unit(*time, rounded(std::sqrt(kappa)))));
    add(channel,
        fmt::format("moves {:.3g} times as far as imu_body_accel_z_mps2 gives{}", kappa,
                    kappa > 0.0 ? fmt::format(": the time is {:.3g} times too {}, or one of the two is in "
                                              "another unit",
                                              rounded(std::sqrt(std::max(kappa, 1.0 / kappa))),
                                              kappa < 1.0 ? "long" : "short")
                                : ": one of the two has the other sign"),
        std::move(cure),
        places_.is_stated("t_s") && places_.is_stated(channel) && places_.is_stated("imu_body_accel_z_mps2"));
  }

  // Mean of the samples of the foot's height nearest to the touchdown, one before and one after it.
  std::optional<double> height_at(const std::vector<double>& height, std::size_t row) const {
    std::size_t before = row, after = row;
    while (before > 0 && std::isnan(height[before])) --before;
    while (after + 1 < height.size() && std::isnan(height[after])) ++after;
    if (std::isnan(height[before]) || std::isnan(height[after])) return std::nullopt;
    return 0.5 * (height[before] + height[after]);
  }

  // Only a touchdown that the recording shows: rows without load before it.
  void check_touchdown() {
    const auto *cell = recording_.find("load_cell_force_N"), *foot = recording_.find("mocap_foot_z_m");
    if (cell == nullptr || foot == nullptr) return;
    const auto row = first_loaded_row(*cell);
    if (!row || *row < recording_.rows() / 20) return;
    const auto height = height_at(*foot, *row);
    if (!height || std::abs(*height) <= belief_.robot.leg.foot_radius_m) return;
    const auto* column = places_.column_of("mocap_foot_z_m");
    std::string cure = "correct the zero of the height: 0 at the undisturbed surface";
    if (column != nullptr) {
      auto changed = *column;
      changed.offset -= 1e-3 * std::round(1e3 * *height);  // Samples near the touchdown are some mm apart.
      cure = fmt::format("write {} into [columns]", mapping_line(changed));
    }
    add("mocap_foot_z_m",
        fmt::format("is {:+.3f} m when the load cell first carries load, at {:.3f} s, and the height counts "
                    "from the undisturbed surface: its zero is another",
                    *height, recording_.t_s[*row]),
        std::move(cure), places_.is_stated("mocap_foot_z_m"));
  }

  void add(std::string_view channel, std::string what, std::string cure, bool stated) {
    doubt_column(recording_, places_, stated, channel, std::move(what), std::move(cure));
  }

  TrialRecording& recording_;
  const HopperBelief& belief_;
  const RecordingPlaces& places_;
};

}  // namespace

void check_hopper_heights(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                          const RecordingPlaces& places) {
  const auto* belief = belief_of_hop(recording, campaign, trial);
  if (belief == nullptr) return;
  HopperHeightChecker(recording, *belief, places).run();
}

}  // namespace sandhopper
