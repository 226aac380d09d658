#include "tools/campaign/hopper_force_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "tools/campaign/hopper_signals.hpp"
#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

struct ForceUnit {
  std::string_view name;
  double in_N;
};
constexpr std::array kForceUnits{ForceUnit{"lbf", 4.4482216}, ForceUnit{"kgf", 9.80665},
                                 ForceUnit{"kN", 1000.0}, ForceUnit{"gf", 0.00980665},
                                 ForceUnit{"mN", 0.001}};

class HopperForceChecker {
 public:
  HopperForceChecker(TrialRecording& recording, const Leg& leg, const HopperBelief& belief,
                     const RecordingPlaces& places)
      : recording_(recording),
        belief_(belief),
        places_(places),
        forces_(hopper_forces(recording, leg, belief)) {}

  void run() {
    if (check_exchange() || check_lag()) return;
    check_cell();
    check_currents();
  }

 private:
  bool check_exchange() {
    const auto *body = recording_.find(kBodyAccel), *foot = recording_.find(kFootAccel);
    const auto from = first_loaded_row(forces_.leg_N);
    if (body == nullptr || foot == nullptr || !from) return false;
    const double own = together(forces_.leg_N, *body, *from), other = together(forces_.leg_N, *foot, *from);
    if (other <= std::max(kBelongTogether, own + kClearlyBetter)) return false;
    const auto *a = places_.column_of(kBodyAccel), *b = places_.column_of(kFootAccel);
    std::string cure = "exchange the two columns in [columns]";
    if (a != nullptr && b != nullptr) {
      auto of_foot = *a, of_body = *b;
      std::swap(of_foot.channel, of_body.channel);
      cure = fmt::format("write {} and {} into [columns]", mapping_line(of_body), mapping_line(of_foot));
    }
    add(kBodyAccel,
        fmt::format("does not follow the leg's force, torque over L' (correlation {:.2f}), and {} does "
                    "({:.2f}): the leg pushes the body, and the foot stands in stance: the two columns are "
                    "exchanged",
                    std::sqrt(own), kFootAccel, std::sqrt(other)),
        std::move(cure), places_.is_stated(kBodyAccel) && places_.is_stated(kFootAccel));
    return true;
  }

  double row_s() const {
    return (recording_.t_s.back() - recording_.t_s.front()) / static_cast<double>(recording_.rows() - 1);
  }

  // Rows of one stance by the recorded phases; without them all rows in which the cell carries load.
  double stance_rows() const {
    const auto* phase = recording_.find("phase");
    double rows = 0.0, touchdowns = 0.0;
    for (std::size_t i = 0; phase != nullptr && i < phase->size(); ++i) {
      if (!((*phase)[i] > 0.0)) continue;
      rows += 1.0;
      if (i == 0 || !((*phase)[i - 1] > 0.0)) touchdowns += 1.0;
    }
    if (touchdowns > 0.0) return rows / touchdowns;
    return static_cast<double>(std::ranges::count(loaded_rows(*recording_.find(kLoadCell)), true));
  }

  // Late by more than the share of a stance that a rate's spans have of a recording. Below that the sensors'
  // own delays and those of the drives, which the diagnosis finds, look alike.
  bool is_far(const BestLag& lag) const {
    constexpr double kShare = 1.0 / 20.0;
    return std::abs(static_cast<double>(lag.rows)) > kShare * stance_rows();
  }

  // A latency that nominal.toml states is no contradiction.
  bool is_stated_latency(double lag_s) const {
    const double stated_s = belief_.sensors.other.load_cell_latency_s;
    return stated_s > 0.0 && std::abs(lag_s - stated_s) < 0.5 * stated_s;
  }

  bool check_lag() {
    const auto* cell = recording_.find(kLoadCell);
    const auto from = cell == nullptr ? std::nullopt : first_loaded_row(*cell);
    if (recording_.rows() < 2 || !from) return false;
    const auto by_inertia = best_lag(forces_.inertia_N, *cell, *from);
    const auto by_leg = best_lag(forces_.foot_N, *cell, *from);
    const auto is_late = [&](const BestLag& lag) { return lag.is_shifted() && is_far(lag); };
    const auto& lag = has(kBodyAccel) ? by_inertia : by_leg;
    if (!is_late(lag) || (has_leg() && !is_late(by_leg))) return false;
    const double lag_s = static_cast<double>(lag.rows) * row_s();
    if (is_stated_latency(lag_s)) return false;
    add(kLoadCell,
        fmt::format("is {:.3f} s {} against the forces of the accelerometers and the leg (correlation {:.2f} "
                    "there, {:.2f} in the same row)",
                    std::abs(lag_s), lag_s > 0.0 ? "late" : "early", std::sqrt(lag.at_best),
                    std::sqrt(lag.at_zero)),
        fmt::format("move this column by {} rows towards {} rows in the file; see that both recorders share "
                    "one clock, and that no filter delays it",
                    std::abs(lag.rows), lag_s > 0.0 ? "earlier" : "later"),
        places_.is_stated(kLoadCell) && places_.is_stated("t_s"));
    return true;
  }

  // Mean of the cell over that of `force` in the rows in which the cell carries load. Empty if the two do not
  // move together.
  std::optional<double> ratio_to(const std::vector<double>& force) const {
    const auto& cell = *recording_.find(kLoadCell);
    const auto from = first_loaded_row(cell);
    if (!from || together(force, cell, *from) < kBelongTogether) return std::nullopt;
    const auto loaded = loaded_rows(cell);
    double cells = 0.0, forces = 0.0;
    for (std::size_t i = 0; i < cell.size(); ++i)
      if (loaded[i] && !std::isnan(force[i])) cells += cell[i], forces += force[i];
    return forces > 0.0 ? std::optional(cells / forces) : std::nullopt;
  }

  // Half way, on a scale of ratios, between newtons and the nearest unit.
  static bool is_force(double ratio) {
    const double limit = std::sqrt(kForceUnits.front().in_N);
    return ratio > 1.0 / limit && ratio < limit;
  }

  static const ForceUnit* unit_of(double ratio) {
    constexpr double kNear = 0.15;  // Friction of the rail and the masses; as for far ratios of rates.
    const auto off = [&](const ForceUnit& unit) { return std::abs(std::abs(ratio) * unit.in_N - 1.0); };
    const auto* best = &*std::ranges::min_element(kForceUnits, {}, off);
    return off(*best) < kNear ? best : nullptr;
  }

  void check_cell() {
    if (!has(kLoadCell)) return;
    const auto by_inertia = ratio_to(forces_.inertia_N), by_leg = ratio_to(forces_.foot_N);
    const auto& ratio = by_inertia ? by_inertia : by_leg;
    if (!ratio || is_force(*ratio) || (by_leg && is_force(*by_leg))) return;
    const bool is_turned = *ratio < 0.0, is_scaled = !is_force(std::abs(*ratio));
    const auto* unit = is_scaled ? unit_of(*ratio) : nullptr;
    std::string meaning;
    if (unit != nullptr) meaning = fmt::format("the numbers are in {} ({:.4g} N)", unit->name, unit->in_N);
    if (is_scaled && unit == nullptr) meaning = "the scale of the cell is wrong";
    if (is_turned) meaning += fmt::format("{}it counts tension", meaning.empty() ? "" : ", and ");
    const auto* column = places_.column_of(kLoadCell);
    std::string cure = "correct unit, scale and sign: newtons, compression positive";
    if (column != nullptr && is_scaled && unit == nullptr) {
      cure = scale_cure(*column);
    } else if (column != nullptr) {
      const auto scaled = unit != nullptr ? in_other_unit(*column, unit->in_N) : *column;
      cure = fmt::format("write {} into [columns]", mapping_line(is_turned ? reversed(scaled) : scaled));
    }
    add(kLoadCell,
        fmt::format("is {:.3g} times the ground's force by {}, in the rows with load: {}", *ratio,
                    by_inertia ? "the masses and accelerometers" : "the motors' torques over L'", meaning),
        std::move(cure), places_.is_stated(kLoadCell));
  }

  // Half way, on a scale of ratios, between the currents' peak and their effective value.
  void check_currents() {
    if (!has(kLoadCell) || any_unusable(recording_.findings)) return;
    const auto ratio = ratio_to(forces_.foot_N);
    const double limit = std::pow(2.0, 0.25);
    if (!ratio || (*ratio > 1.0 / limit && *ratio < limit)) return;
    const double factor = *ratio > 1.0 ? std::numbers::sqrt2 : 1.0 / std::numbers::sqrt2;
    add_implausible(
        recording_, places_, FindingSeverity::note, "motor_left_current_A",
        fmt::format(
            "and that of the other motor give, by torque over L', {:.2f} times the force of the load cell, "
            "in the rows with load: the currents are {} values, the torque constant is another, or the "
            "cell has a gain error. What hop terrain says from the currents is off by that",
            1.0 / *ratio, factor > 1.0 ? "effective (rms)" : "summed"),
        fmt::format(
            "if it is the currents, write scale = {:.4g} for both into [columns]; if it is the motor, "
            "correct motor.torque_constant_Nm_per_A",
            factor));
  }

  bool has(std::string_view channel) const { return recording_.has(channel); }
  bool has_leg() const {
    return std::ranges::any_of(forces_.leg_N, [](double force) { return !std::isnan(force); });
  }

  void add(std::string_view channel, std::string what, std::string cure, bool stated) {
    doubt_column(recording_, places_, stated, channel, std::move(what), std::move(cure));
  }

  TrialRecording& recording_;
  const HopperBelief& belief_;
  const RecordingPlaces& places_;
  const HopperForces forces_;
};

}  // namespace

void check_hopper_forces(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                         const RecordingPlaces& places) {
  const auto* belief = belief_of_hop(recording, campaign, trial);
  if (belief == nullptr || any_unusable(recording.findings)) return;
  try {
    HopperForceChecker(recording, Leg(belief->robot.leg), *belief, places).run();
  } catch (const std::invalid_argument&) {
    // Lengths that form no leg: the diagnosis says so.
  }
}

}  // namespace sandhopper
