#include "tools/campaign/fall_limits.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kFallHeight = "height_m";
constexpr std::size_t kFewestOfPart = 12;
constexpr double kCertain = 4.0;  // in standard errors

struct FallRow {
  double t_s, height_m;
};

// height = a + v t + 1/2 b t^2 by least squares, t from the middle of the rows.
struct FallPart {
  double speed_mps = 0.0, accel_mps2 = 0.0, accel_error_mps2 = 0.0;
};

std::optional<FallPart> part_of_fall(std::span<const FallRow> rows) {
  if (rows.size() < kFewestOfPart) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(rows.size());
  const double middle_s = 0.5 * (rows.front().t_s + rows.back().t_s);
  Eigen::MatrixXd by(n, 3);
  Eigen::VectorXd height(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    const double t = row.t_s - middle_s;
    by.row(i) << 1.0, t, 0.5 * t * t;
    height[i] = row.height_m - rows.front().height_m;
  }
  const Eigen::Matrix3d inverse = (by.transpose() * by).inverse();
  if (!inverse.allFinite()) return std::nullopt;
  const Eigen::Vector3d fit = inverse * by.transpose() * height;
  const double variance = (height - by * fit).squaredNorm() / static_cast<double>(n - 3);
  return FallPart{fit[1], fit[2], std::sqrt(variance * inverse(2, 2))};
}

class FallLimits {
 public:
  FallLimits(TrialRecording& recording, const CampaignTrial& trial, const FallingBodyBelief& belief,
             const RecordingPlaces& places)
      : recording_(recording), trial_(trial), belief_(belief), places_(places) {
    const auto heights = recording.channel(kFallHeight);
    for (std::size_t i = 0; i < heights.size(); ++i)
      if (!std::isnan(heights[i])) all_.push_back({recording.t_s[i], heights[i]});
  }

  void run() {
    if (all_.size() < 2 * kFewestOfPart) return;
    const auto [low, high] = std::ranges::minmax(all_, {}, &FallRow::height_m);
    travel_m_ = high.height_m - low.height_m;
    const bool in_gas = belief_.medium.density_kg_per_m3 < kLightestLiquid_kg_per_m3;
    if (!(travel_m_ > 0.0) || belief_.gravity_mps2 < 1.0 || !in_gas || check_release_height()) return;
    const auto fall = rows_of_fall();
    const auto early = part_of_fall(fall.first(fall.size() / 2)),
               late = part_of_fall(fall.subspan(fall.size() / 2));
    if (!early || !late || late->speed_mps >= 0.0) return;
    if (!check_stretched_time(*early, *late)) check_drag(*early, *late);
  }

 private:
  static constexpr double kLightestLiquid_kg_per_m3 = 100.0;  // a hundred times air

  // From the last row at the top to where the body is fastest: then it lands, or enters another medium.
  std::span<const FallRow> rows_of_fall() const {
    const double top = all_.front().height_m;
    std::size_t begin = 0, end = 0;
    double fastest = 0.0;
    for (std::size_t i = 0; i < all_.size() && all_[i].height_m > top - 0.98 * travel_m_; ++i)
      if (top - all_[i].height_m < 0.02 * travel_m_) begin = i;
    const std::size_t span = std::max<std::size_t>(2, all_.size() / 40);
    for (std::size_t i = begin; i + span < all_.size(); ++i) {
      const double speed = (all_[i].height_m - all_[i + span].height_m) / (all_[i + span].t_s - all_[i].t_s);
      if (speed > fastest) fastest = speed, end = i;
    }
    return end > begin ? std::span(all_).subspan(begin, end - begin) : std::span<const FallRow>();
  }

  // Air brakes a fall the more the faster it is; a fall that is slow from its first to its last row has its
  // time stretched (slow motion), its height scaled, or is no free fall.
  bool check_stretched_time(const FallPart& early, const FallPart& late) {
    // Slow motion starts at twice the time, a quarter of gravity. A ball in air may fall with 0.7 times
    // gravity from its first to its last row.
    constexpr double kSlow = 0.5, kEven = 0.1;
    const double mean = -0.5 * (early.accel_mps2 + late.accel_mps2), ratio = mean / belief_.gravity_mps2;
    const double error = std::hypot(early.accel_error_mps2, late.accel_error_mps2);
    const bool is_even =
        std::abs(early.accel_mps2 - late.accel_mps2) < kEven * mean && kCertain * error < kSlow * mean;
    if (!(ratio > 0.0) || ratio > kSlow || !is_even) return false;
    const double stretch = std::sqrt(1.0 / ratio);
    std::string cure = fmt::format(
        "if the rig is inclined or counterbalanced, write gravity_mps2 = {:.4g} into nominal.toml", mean);
    if (const auto* time = places_.column_of("t_s")) {
      auto right = in_other_unit(*time, 1.0 / stretch);
      if (right.unit.empty()) right.unit = "s as played";
      cure = fmt::format(
          "if it is slow motion, write {} into [columns], with the exact ratio of the two rates; {}",
          mapping_line(right), cure);
    }
    doubt_column(
        recording_, places_, places_.is_stated("t_s"), kFallHeight,
        fmt::format("falls evenly with {:.3g} m/s2, {:.3g} times gravity, and no air brakes a fall from "
                    "its start on: the time is stretched {:.3g} times, or the height is in another unit",
                    mean, ratio, stretch),
        std::move(cure));
    return true;
  }

  // 1/2 rho A C_d v^2 = m (g + h''), as the difference of two parts of the fall, so that gravity and the
  // scale of the height drop out.
  void check_drag(const FallPart& early, const FallPart& late) {
    // The greatest drag coefficient that Hoerner lists is 2.3, of a half tube open to the flow (Fluid-Dynamic
    // Drag, 1965, 3-17); twice that, because the area may be that of another side.
    constexpr double kGreatest = 2.0 * 2.3;
    const double rho = belief_.medium.density_kg_per_m3, area_m2 = belief_.body.frontal_area_m2;
    const double squares = late.speed_mps * late.speed_mps - early.speed_mps * early.speed_mps;
    if (!(rho > 0.0) || !(area_m2 > 0.0) || !(squares > 0.0)) return;
    const double per_accel = 2.0 * belief_.body.mass_kg / (rho * area_m2 * squares);
    const double drag = per_accel * (late.accel_mps2 - early.accel_mps2);
    const double error = per_accel * std::hypot(early.accel_error_mps2, late.accel_error_mps2);
    if (drag - kCertain * error < kGreatest) return;
    add_implausible(
        recording_, places_, FindingSeverity::trial_unusable, kFallHeight,
        fmt::format(
            "is braked from {:.3g} to {:.3g} m/s2 between {:.3g} and {:.3g} m/s, which takes a drag "
            "coefficient of {:.3g} for {:.4g} kg, {:.4g} m2 and {:.4g} kg/m3, and no body has more than "
            "2.3: one of the three numbers is in another unit",
            -early.accel_mps2, -late.accel_mps2, -early.speed_mps, -late.speed_mps, drag,
            belief_.body.mass_kg, area_m2, rho),
        fmt::format("correct mass_kg (g?), frontal_area_m2 or diameter_m (mm?), or density_kg_per_m3 (g/cm3? "
                    "air has 1.2)"));
  }

  bool check_release_height() {
    const auto stated_m = trial_.number("release_height_m");
    const bool rests_first = all_.front().height_m > all_.back().height_m;
    if (!stated_m || !rests_first || !(travel_m_ > 0.0)) return false;
    for (const double unit : {100.0, 1000.0, 0.01, 0.001})
      if (std::abs(*stated_m / travel_m_ / unit - 1.0) < kNearHeight) {
        doubt_column(recording_, places_, places_.is_stated(kFallHeight), kFallHeight,
                     fmt::format("falls by {:.4g} m, and release_height_m is {:.6g}: {:.4g} times that",
                                 travel_m_, *stated_m, *stated_m / travel_m_),
                     fmt::format("write release_height_m = {:.4g} into the [[trial]], or correct the unit of "
                                 "height_m, whichever is true",
                                 *stated_m / unit));
        return true;
      }
    return false;
  }
  // The recorded way differs from the height of release by the body's size and the first and last row.
  static constexpr double kNearHeight = 0.2;

  TrialRecording& recording_;
  const CampaignTrial& trial_;
  const FallingBodyBelief& belief_;
  const RecordingPlaces& places_;
  std::vector<FallRow> all_;
  double travel_m_ = 0.0;
};

}  // namespace

void check_fall_limits(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                       const RecordingPlaces& places) {
  const auto* belief = std::get_if<FallingBodyBelief>(&trial.belief);
  if (campaign.plant != CampaignPlant::falling_body || trial.kind != TrialKind::drop || belief == nullptr)
    return;
  const bool is_thrown = trial.number("release_speed_mps").value_or(0.0) != 0.0;
  if (is_thrown || !recording.has_time || !recording.has(kFallHeight) || any_unusable(recording.findings))
    return;
  FallLimits(recording, trial, *belief, places).run();
}

}  // namespace sandhopper
