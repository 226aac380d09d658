#include "tools/campaign/hopper_flight_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/hopper_signals.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/mass_below_cell.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kPhaseFlag = "phase";
constexpr double kFewestFlightRows = 20.0;  // in stance and in flight, as in hopper_check
constexpr double kFlightClear = 5.0;        // in standard deviations

// y = a + slope x; `together`: squared correlation.
struct FlightLine {
  double slope, error, together;
};

std::optional<FlightLine> flight_line(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sx += x[i], sy += y[i], sxx += x[i] * x[i], sxy += x[i] * y[i], syy += y[i] * y[i];
  const double xx = sxx - sx * sx / n, yy = syy - sy * sy / n, xy = sxy - sx * sy / n;
  if (n < kFewestFlightRows || !(xx > 0.0) || !(yy > 0.0)) return std::nullopt;
  const double left = std::max(0.0, yy - xy * xy / xx) / (n - 2.0);
  return FlightLine{xy / xx, std::sqrt(left / xx), xy * xy / (xx * yy)};
}

class FlightChecker {
 public:
  FlightChecker(TrialRecording& recording, const HopperBelief& belief, const RecordingPlaces& places)
      : recording_(recording), belief_(belief), places_(places) {}

  void run() {
    if (check_phase()) return;
    for (const auto channel : {kBodyAccel, kFootAccel}) check_gravity_of(channel);
    if (!any_unusable(recording_.findings)) check_mass();
  }

 private:
  double mean_of(const std::vector<double>& values) const {
    double sum = 0.0, rows = 0.0;
    for (const double value : values)
      if (!std::isnan(value)) sum += value, rows += 1.0;
    return rows > 0.0 ? sum / rows : NAN;
  }

  // Without a load cell: the ground carries the body with more than g on average, and in flight it falls.
  bool is_inverted_by_body(const std::vector<double>& phase) {
    const auto* body = recording_.find(kBodyAccel);
    if (body == nullptr) return false;
    double sums[2] = {}, rows[2] = {};  // in flight, in stance
    for (std::size_t i = 0; i < phase.size(); ++i)
      if (!std::isnan(phase[i]) && !std::isnan((*body)[i]))
        sums[phase[i] > 0.0] += (*body)[i], rows[phase[i] > 0.0] += 1.0;
    if (std::min(rows[0], rows[1]) < kFewestFlightRows) return false;
    const double in_flight = sums[0] / rows[0], in_stance = sums[1] / rows[1], g = belief_.gravity_mps2;
    if (!(in_flight > g && in_stance < 0.5 * g)) return false;
    doubt(kPhaseFlag,
          fmt::format(
              "is flight in rows in which {} is {:.1f} m/s2 on average, and stance where it is {:.1f} m/s2; "
              "a robot that is carried reads g or more, and one that falls about 0: the flag is inverted",
              kBodyAccel, in_flight, in_stance),
          phase_cure(phase));
    return true;
  }

  bool check_phase() {
    const auto *phase = recording_.find(kPhaseFlag), *force = recording_.find(kLoadCell);
    if (phase == nullptr) return false;
    if (force == nullptr) return is_inverted_by_body(*phase);
    const auto loaded = loaded_rows(*force);
    double rows[2][2] = {};  // [stance][loaded]
    for (std::size_t i = 0; i < phase->size(); ++i)
      if (!std::isnan((*phase)[i]) && !std::isnan((*force)[i])) rows[(*phase)[i] > 0.0][loaded[i]] += 1.0;
    const double flight = rows[0][0] + rows[0][1], stance = rows[1][0] + rows[1][1],
                 free = rows[0][0] + rows[1][0], carries = rows[0][1] + rows[1][1];
    if (std::min({flight, stance, free, carries}) < kFewestFlightRows) return false;
    constexpr double kLeast = 0.5;  // as for exchanged sides in hopper_check
    const double together =
        (rows[1][1] * rows[0][0] - rows[1][0] * rows[0][1]) / std::sqrt(flight * stance * free * carries);
    if (together > -kLeast) return false;
    doubt(kPhaseFlag,
          fmt::format("is flight in {:.0f} of the {:.0f} rows in which {} carries load, and stance in {:.0f} "
                      "of the {:.0f} others: the flag is inverted",
                      rows[0][1], carries, kLoadCell, rows[1][0], free),
          phase_cure(*phase));
    return true;
  }

  std::string phase_cure(const std::vector<double>& phase) const {
    const auto* column = places_.column_of(kPhaseFlag);
    const bool is_flag =
        std::ranges::all_of(phase, [](double p) { return std::isnan(p) || p == 0.0 || p == 1.0; });
    if (column == nullptr || !is_flag) return "exchange the words of flight and stance in this column";
    auto inverted = *column;
    inverted.unit.clear();
    inverted.scale = -column->scale, inverted.offset = 1.0 - column->offset;
    return fmt::format(
        "write {} into [columns]; a flag does not tell compression from extension, so if hop terrain then "
        "finds no complete stance, rename the column in the file: without it the load cell shows the stance",
        mapping_line(inverted));
  }

  // The specific force s of a body has the mean g + (v_end - v_begin) / T. A speed is at most the largest
  // change that the channel shows beside its mean.
  void check_gravity_of(std::string_view channel) {
    const auto* accel = recording_.find(channel);
    if (accel == nullptr || recording_.rows() < 2) return;
    const double mean = mean_of(*accel), g = belief_.gravity_mps2;
    if (!(std::abs(mean) < 0.5 * g)) return;
    double speed = 0.0, low = 0.0, high = 0.0, squares = 0.0, samples = 0.0;
    double last_s = recording_.t_s.front(), first_s = NAN;
    for (std::size_t i = 0; i < accel->size(); ++i) {
      if (std::isnan((*accel)[i])) continue;
      if (std::isnan(first_s)) first_s = last_s = recording_.t_s[i];
      speed += ((*accel)[i] - mean) * (recording_.t_s[i] - last_s);
      last_s = recording_.t_s[i];
      low = std::min(low, speed), high = std::max(high, speed);
      squares += (*accel)[i] * (*accel)[i], samples += 1.0;
    }
    // A dead channel does not read -g in flight.
    const bool is_alive = squares > 0.25 * g * g * samples;
    const bool is_long = (0.5 * g - std::abs(mean)) * (last_s - first_s) > high - low;
    if (!is_alive || !is_long) return;
    std::string cure = "record the specific force, which an accelerometer at rest reads as +g";
    if (const auto* column = places_.column_of(channel)) {
      auto with = *column;
      with.offset += g;
      cure = fmt::format("write {} into [columns]", mapping_line(with));
    }
    doubt(channel,
          fmt::format(
              "is {:.2f} m/s2 on average over the hop, and the speed changes by {:.2g} m/s at most: the "
              "mean of a specific force is then near {:.2f}, so gravity was subtracted",
              mean, high - low, g),
          std::move(cure));
  }

  void check_mass() {
    const auto *cell = recording_.find(kLoadCell), *accel = recording_.find(kFootAccel),
               *phase = recording_.find(kPhaseFlag);
    if (cell == nullptr || accel == nullptr || phase == nullptr) return;
    if (mass_below_cell_kg(belief_, kLoadCell) != 0.0) return;
    // A touchdown comes some rows before the phase shows it.
    const auto loaded = loaded_rows(*cell);
    std::vector<double> x, y;
    for (std::size_t i = 0; i < cell->size(); ++i)
      if ((*phase)[i] == 0.0 && !loaded[i] && !std::isnan((*cell)[i]) && !std::isnan((*accel)[i]))
        x.push_back((*accel)[i]), y.push_back((*cell)[i]);
    const auto line = flight_line(x, y);
    if (!line || line->together < kBelongTogether || line->slope > -kFlightClear * line->error) return;
    add_implausible(
        recording_, places_, FindingSeverity::note, kLoadCell,
        fmt::format("follows {} in flight, where no ground pushes: about {:.2g} kg hang below the cell, "
                    "and its force in stance is wrong by that mass times the foot's acceleration",
                    kFootAccel, -line->slope),
        fmt::format(
            "write \"{}\" = {{ mass_kg = {:.2g} }} into [effects] of nominal.toml; hop terrain and hop "
            "diagnose use it",
            mass_below_cell_effect(kLoadCell), -line->slope));
  }

  void doubt(std::string_view channel, std::string what, std::string cure) {
    doubt_column(recording_, places_, places_.is_stated(channel), channel, std::move(what), std::move(cure));
  }

  TrialRecording& recording_;
  const HopperBelief& belief_;
  const RecordingPlaces& places_;
};

}  // namespace

void check_hopper_flight(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                         const RecordingPlaces& places) {
  const auto* belief = belief_of_hop(recording, campaign, trial);
  if (belief == nullptr) return;
  FlightChecker(recording, *belief, places).run();
}

}  // namespace sandhopper
