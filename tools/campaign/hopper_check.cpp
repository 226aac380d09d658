#include "tools/campaign/hopper_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "estimation/leg.hpp"
#include "tools/campaign/hopper_signals.hpp"
#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

constexpr std::size_t kFewestStanceRows = 20;
constexpr std::array<std::string_view, 2> kSides{"left", "right"};

class HopperChecker {
 public:
  HopperChecker(TrialRecording& recording, const Leg& leg, const RecordingPlaces& places)
      : recording_(recording), leg_(leg), places_(places) {}

  void run() {
    if (check_heights() || check_sides() || is_doubted("phase")) return;
    for (const auto side : kSides) {
      check_angle(fmt::format("motor_{}_position_rad", side));
      check_current(fmt::format("motor_{}_current_A", side));
    }
  }

 private:
  bool is_doubted(std::string_view channel) const {
    return std::ranges::find(recording_.findings, channel, &Finding::channel) != recording_.findings.end();
  }

  bool in_stance(std::size_t row) const {
    const auto* phase = recording_.find("phase");
    return phase != nullptr && (*phase)[row] > 0.0;
  }

  // Means over the rows that hold both.
  bool check_heights() {
    const auto *body = recording_.find("mocap_body_z_m"), *foot = recording_.find("mocap_foot_z_m");
    if (body == nullptr || foot == nullptr) return false;
    double above = 0.0, rows = 0.0;
    for (std::size_t i = 0; i < body->size(); ++i)
      if (!std::isnan((*body)[i]) && !std::isnan((*foot)[i])) above += (*body)[i] - (*foot)[i], rows += 1.0;
    if (rows < static_cast<double>(kFewestStanceRows) || above >= 0.0) return false;
    std::string cure = "exchange the two columns in [columns]";
    const auto *a = places_.column_of("mocap_body_z_m"), *b = places_.column_of("mocap_foot_z_m");
    if (a != nullptr && b != nullptr) {
      auto body_line = *b, foot_line = *a;
      std::swap(body_line.channel, foot_line.channel);
      cure = fmt::format("write {} and {} into [columns]", mapping_line(body_line), mapping_line(foot_line));
    }
    add("mocap_body_z_m",
        fmt::format(
            "is {:.3g} m below mocap_foot_z_m on average, and the body is above the foot: the two columns "
            "are exchanged, or one has the other sign",
            -above / rows),
        std::move(cure), places_.is_stated("mocap_body_z_m") && places_.is_stated("mocap_foot_z_m"));
    return true;
  }

  // Both motors' columns exchanged alike: the difference of the currents follows that of the commands with
  // the other sign. Motors that are asked for the same show nothing, and then nothing depends on it.
  bool check_sides() {
    double rows = 0, sc = 0, si = 0, scc = 0, sci = 0, sii = 0;
    const std::array<const std::vector<double>*, 4> columns{
        recording_.find("command_left_torque_Nm"), recording_.find("command_right_torque_Nm"),
        recording_.find("motor_left_current_A"), recording_.find("motor_right_current_A")};
    if (std::ranges::find(columns, nullptr) != columns.end()) return false;
    for (std::size_t i = 0; i < recording_.t_s.size(); ++i) {
      const double asked = (*columns[0])[i] - (*columns[1])[i], flows = (*columns[2])[i] - (*columns[3])[i];
      if (std::isnan(asked) || std::isnan(flows)) continue;
      rows += 1, sc += asked, si += flows, scc += asked * asked, sci += asked * flows, sii += flows * flows;
    }
    const double cc = scc - sc * sc / rows, ii = sii - si * si / rows, ci = sci - sc * si / rows;
    constexpr double kLeast = 0.5;  // correlation; that of motors which follow their own command is positive
    if (rows < static_cast<double>(kFewestStanceRows) || !(cc > 0.0) || !(ii > 0.0)) return false;
    if (ci > -kLeast * std::sqrt(cc * ii)) return false;
    add("motor_left_current_A",
        fmt::format("minus motor_right_current_A goes against command_left_torque_Nm minus "
                    "command_right_torque_Nm (correlation {:.2f}): left and right are exchanged in the "
                    "motors' columns or in the commands",
                    ci / std::sqrt(cc * ii)),
        "exchange left and right in [columns], in the motors' columns or in the commands",
        places_.is_stated("motor_left_current_A") && places_.is_stated("motor_right_current_A"));
    return true;
  }

  // Length of the leg as heights show it, up to a constant; empty in rows without it.
  std::optional<double> measured_length(std::size_t row) const {
    const auto *body = recording_.find("mocap_body_z_m"), *foot = recording_.find("mocap_foot_z_m");
    if (body == nullptr) return std::nullopt;
    if (foot != nullptr && !std::isnan((*foot)[row])) return (*body)[row] - (*foot)[row];
    return foot == nullptr && in_stance(row) ? std::optional((*body)[row]) : std::nullopt;
  }

  struct Match {
    double slope = 0.0, share = 0.0;  // of the measured length over that by the joints
    double apart_m = 0.0;             // rms of measured - joints, means removed
  };
  std::optional<Match> match(const std::vector<std::pair<double, double>>& angle_length, double scale,
                             double offset) const {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (const auto& [angle, length] : angle_length) {
      const double by_joint = leg_.kinematics(scale * angle + offset).length_m;
      if (!std::isfinite(by_joint)) return std::nullopt;
      n += 1, sx += by_joint, sy += length, sxx += by_joint * by_joint, sxy += by_joint * length,
          syy += length * length;
    }
    const double xx = sxx - sx * sx / n, yy = syy - sy * sy / n, xy = sxy - sx * sy / n;
    if (!(xx > 0.0) || !(yy > 0.0)) return std::nullopt;
    return Match{xy / xx, xy * xy / (xx * yy), std::sqrt(std::max(0.0, (xx - 2.0 * xy + yy) / n))};
  }

  // The leg has the same length at phi and -phi, so its length does not show a wrong sign.
  bool check_side(const std::string& channel, const std::vector<double>& angle) {
    if (std::ranges::any_of(angle, [](double value) { return value >= 0.0; })) return false;
    const auto* column = places_.column_of(channel);
    add(channel,
        "is negative throughout: the angle counts from straight down and grows as the leg shortens, so it is "
        "between 0 and pi",
        column == nullptr ? "turn its sign"
                          : fmt::format("write {} into [columns]", mapping_line(reversed(*column))),
        places_.is_stated(channel));
    return true;
  }

  void check_angle(const std::string& channel) {
    const auto* angle = recording_.find(channel);
    if (angle == nullptr || check_side(channel, *angle)) return;
    std::vector<std::pair<double, double>> pairs;
    for (std::size_t i = 0; i < angle->size(); ++i)
      if (const auto length = measured_length(i); length && !std::isnan(*length) && !std::isnan((*angle)[i]))
        pairs.emplace_back((*angle)[i], *length);
    if (pairs.size() < kFewestStanceRows) return;
    const auto now = match(pairs, 1.0, 0.0);
    const bool agrees = now && now->slope > 0.2 && now->slope < 5.0;
    if (agrees || (now && now->share < 0.8)) return;
    struct Way {
      double scale, offset;
      std::string_view what;
    };
    constexpr double kQuarter = 0.5 * std::numbers::pi, kDegree = std::numbers::pi / 180.0;
    constexpr std::array kWays{
        Way{-1.0, 0.0, "counts the other way"}, Way{-1.0, kQuarter, "is counted from the horizontal"},
        Way{-1.0, std::numbers::pi, "is counted from straight up"}, Way{kDegree, 0.0, "is in degrees"},
        Way{1.0 / kDegree, 0.0, "is in rad, taken for degrees"}};
    const Way* best = nullptr;
    double least = 1e300;
    for (const auto& way : kWays)
      if (const auto found = match(pairs, way.scale, way.offset);
          found && found->slope > 0.2 && found->slope < 5.0)
        if (found->apart_m < least) best = &way, least = found->apart_m;
    const auto* column = places_.column_of(channel);
    std::string cure = "correct unit, sign and zero: from straight down, growing as the leg shortens";
    if (best != nullptr && column != nullptr) {
      auto changed = in_other_unit(*column, best->scale);
      if (best->scale == -1.0) changed.unit = column->unit;
      changed.offset = best->scale * column->offset + best->offset;
      cure = fmt::format("write {} into [columns]", mapping_line(changed));
    }
    add(channel,
        fmt::format(
            "goes against the measured length of the leg: where the joints say 1 mm longer, the heights "
            "show {:.2g} mm{}",
            now ? now->slope : 0.0,
            best == nullptr ? std::string() : fmt::format("; the angle {}", best->what)),
        std::move(cure), places_.is_stated(channel));
  }

  void check_current(const std::string& channel) {
    const auto* current = recording_.find(channel);
    if (current == nullptr || !recording_.has("phase")) return;
    double sum = 0.0, squares = 0.0, rows = 0.0;
    for (std::size_t i = 0; i < current->size(); ++i)
      if (in_stance(i) && !std::isnan((*current)[i]))
        sum += (*current)[i], squares += (*current)[i] * (*current)[i], rows += 1.0;
    if (rows < static_cast<double>(kFewestStanceRows) || !(squares > 0.0)) return;
    const double mean = sum / rows, rms = std::sqrt(squares / rows);
    if (mean < 0.5 * rms) return;
    const auto* column = places_.column_of(channel);
    add(channel,
        fmt::format(
            "is {:+.3g} A on average in stance, where it must lengthen the leg against the robot's weight: "
            "that is negative, because the channel is positive when it shortens the leg",
            mean),
        column == nullptr ? "turn its sign"
                          : fmt::format("write {} into [columns]", mapping_line(reversed(*column))),
        places_.is_stated(channel));
  }

  void add(std::string_view channel, std::string what, std::string cure, bool stated) {
    doubt_column(recording_, places_, stated, channel, std::move(what), std::move(cure));
  }

  TrialRecording& recording_;
  const Leg& leg_;
  const RecordingPlaces& places_;
};

}  // namespace

void check_hopper(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                  const RecordingPlaces& places) {
  const auto* belief = belief_of_hop(recording, campaign, trial);
  if (belief == nullptr) return;
  try {
    HopperChecker(recording, Leg(belief->robot.leg), places).run();
  } catch (const std::invalid_argument&) {
    // Lengths that form no leg: the diagnosis says so.
  }
}

}  // namespace sandhopper
