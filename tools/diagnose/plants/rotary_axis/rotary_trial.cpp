#include "tools/diagnose/plants/rotary_axis/rotary_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/diagnose/model/virtual_channels.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_balance.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_figures.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_simulation.hpp"

namespace sandhopper::diagnose {

bool without_noise_alone(Samples& torque) {
  constexpr double kNoiseAlone = 1.15;  // greatest scatter, in standard deviations of the white noise
  if (torque.value.size() < 100) return false;
  const double n = static_cast<double>(torque.value.size());
  double mean = 0.0, squares = 0.0;
  for (const double v : torque.value) mean += v / n;
  for (const double v : torque.value) squares += (v - mean) * (v - mean) / n;
  const double sd = std::sqrt(squares);
  if (sd > kNoiseAlone * fluctuation_rms(torque)) return false;
  std::ranges::fill(torque.value, std::abs(mean) < 3.0 * sd / std::sqrt(n) ? 0.0 : mean);
  return true;
}

bool speed_of_encoder(const Belief& belief) {
  return belief.value("sensors.encoder_velocity_bandwidth_Hz") > 0.0;
}

namespace {

constexpr double kBlock_s = 0.5;
constexpr double kMostRows = 3000.0;  // per channel
constexpr double kLong_s = 4.0;       // a recording this long is simulated in longer steps
// Least rows of a block; those of a slow recording are longer than kBlock_s.
constexpr std::size_t kBlockRows = 60;
constexpr double kLeadIn_s = 0.008;  // simulated before a block, because late readings still show it
// A longer gap of the torque, in s and in rows, is not simulated.
constexpr double kUnknown_s = 0.03, kUnknownRows = 5.0;
// A shorter gap (s, rows) is not simulated either if the next one is this far away: enough is left to
// simulate.
constexpr double kGap_s = 5e-3, kGapRows = 2.5, kAlone_s = 0.3;
constexpr double kShortest_s = 0.1;     // shortest stretch between two gaps
constexpr double kTimeConstants = 4.0;  // lead-in of a low-pass, until it has forgotten its start
constexpr double kStart_rad = 0.05;     // least standard deviation of a start angle
enum Phase : std::uint32_t { kRest, kSlow, kFast };
enum BlockNuisance : std::size_t { kPosition, kVelocity, kTorque, kTorqueRise };

class RotaryTrial final : public TrialModel {
 public:
  RotaryTrial(const Trial& trial, const Belief& belief, double stretch) : belief_(belief) {
    name = trial.name;
    // Fast rows are averaged, and more so in a long recording.
    const double least_step_s =
        std::max(5e-3, (trial.time_s.empty() ? 0.0 : trial.time_s.back()) / kMostRows);
    const auto positions = averaged(samples_of(trial, "position_rad"), least_step_s);
    const auto velocities = averaged(samples_of(trial, "velocity_radps"), least_step_s);
    torque_ = samples_of(trial, "torque_Nm");
    drive_acts_ = !without_noise_alone(torque_);
    if (torque_.empty() || (positions.empty() && velocities.empty())) return;
    const auto& lead = positions.empty() ? velocities : positions;
    const double row_s = median_step_s(lead.time_s);
    take_torque();
    cut(trial.time_s.back(), stretch * std::max(kBlock_s, row_s * static_cast<double>(kBlockRows)));
    // Default prior of the torque offset: the noise of one reading, unless [spread] states it.
    const double unsaid_Nm = belief.value("sensors.torque_noise_Nm");
    const double torque_sd = belief.value("spread.torque_offset_Nm", unsaid_Nm);
    has_torque_offset_ = torque_sd > 0.0;
    if (has_torque_offset_) {
      trial_nuisances.push_back({"torque_offset_Nm", torque_sd, 0.1 * torque_sd});
      trial_nuisances.back().shift_is_evidence = belief.numbers.contains("spread.torque_offset_Nm");
    }
    take_zero_of_angle(!positions.empty());
    if (stretches_.empty()) return;
    add_rows(0, positions);
    add_rows(1, velocities);
    find_starts(positions, velocities, where_it_began(trial));
  }

  void predict(const Edits& edits, std::span<const double> nuisances, std::span<double> out) const override {
    if (!has_zero_of_angle_) return predict_readings(edits, nuisances, out);
    Edits with_zero = edits;
    // Key spreads follow later in the list, so count from its beginning.
    with_zero.sensor("position_rad", SensorEdit::Kind::offset, nuisances[has_torque_offset_ ? 1 : 0]);
    predict_readings(with_zero, nuisances, out);
  }

 private:
  void predict_readings(const Edits& edits, std::span<const double> nuisances, std::span<double> out) const {
    const RotaryFigures f(belief_, edits);
    const auto laws = edits.at(LawPort::axis);
    Signal torque = acting_torque(edits);
    const std::size_t q = trial_nuisances.size();
    if (has_torque_offset_)
      for (double& value : torque.values) value += nuisances[0];
    Signal position{0.0, step_s_, {}}, velocity{0.0, step_s_, {}};
    const std::array clocks{SensorClock(edits, "position_rad"), SensorClock(edits, "velocity_radps")};
    for (std::uint32_t b = 0; b < blocks; ++b) {
      AxisStretch stretch = begun_where_read(b, clocks);
      const auto own = nuisances.subspan(q + block_nuisances.size() * b, block_nuisances.size());
      stretch.position += own[kPosition] - read_too_far_rad(edits);
      stretch.velocity += own[kVelocity];
      if (own.size() > kTorque) {
        const double acting = acting_per_recorded(edits, 0.5 * (stretch.from_s + stretch.to_s));
        stretch.torque_Nm = acting * own[kTorque];
        stretch.torque_rise_Nm = acting * own[kTorqueRise];
      }
      simulate_axis(f, laws, {torque, turned_at_, !swings_free_}, stretch, lead_in_s_, position, velocity);
      read_on_motor_side(edits, torque, position, velocity);
      read_by_angle(edits, position, velocity);
      for (const std::uint32_t channel : {0u, 1u}) {
        const auto& span = spans_[b][channel];
        if (span.count == 0) continue;
        Signal signal = channel == 0 ? position : velocity;
        observe(signal, sensors_[channel], edits, channel == 0 ? "position_rad" : "velocity_radps",
                std::span(times_).subspan(span.first, span.count), out.subspan(span.first, span.count));
        mirror_unknown(span, clocks[channel], SensorClock(edits, "actuator"), out);
      }
    }
  }

  // Adds the twist of the shaft to what an encoder on the motor reads.
  static void read_on_motor_side(const Edits& edits, const Signal& torque, Signal& position,
                                 Signal& velocity) {
    const double compliance = edits.edited("axis.compliance_rad_per_Nm", 0.0);
    if (compliance == 0.0) return;
    const double of_velocity = compliance * edits.edited("axis.velocity_on_motor_side", 0.0);
    const double half_s = 0.5 * position.step_s;
    for (std::size_t i = 0; i < position.values.size(); ++i) {
      const double t = position.start_s + position.step_s * static_cast<double>(i);
      position.values[i] += compliance * torque.at(t);
      velocity.values[i] += of_velocity * (torque.at(t + half_s) - torque.at(t - half_s)) / position.step_s;
    }
  }

  // Adds the error of the velocity reading that depends on the angle.
  static void read_by_angle(const Edits& edits, const Signal& position, Signal& velocity) {
    for (const auto& edit : edits.sensors)
      if (edit.channel == kVelocityOfAngle)
        for (std::size_t i = 0; i < velocity.values.size(); ++i)
          velocity.values[i] +=
              edit.law(AxisState{.angle_rad = position.values[i], .velocity_radps = velocity.values[i]});
  }

  // Offset of the encoder in `edits`. A stretch starts at the reading minus this offset.
  static double read_too_far_rad(const Edits& edits) {
    double sum = 0.0;
    for (const auto& edit : edits.sensors)
      if (edit.channel == "position_rad" && edit.kind == SensorEdit::Kind::offset) sum += edit.value;
    return sum;
  }

  // Acting torque per recorded torque, for the noise of the torque sensor: the gain, times the slope of the
  // drive's laws at this torque (saturation).
  double acting_per_recorded(const Edits& edits, double time_s) const {
    constexpr double kApart = 1e-3;  // step as a share of the torque
    double gain = 1.0;
    std::vector<const Law*> laws;
    for (const auto& edit : edits.sensors) {
      if (edit.channel != "actuator") continue;
      if (edit.kind == SensorEdit::Kind::gain) gain *= edit.value;
      if (edit.kind == SensorEdit::Kind::law) laws.push_back(&edit.law);
    }
    if (laws.empty()) return gain;
    const double torque_Nm = gain * drive_.at(time_s);
    const double apart_Nm = kApart * std::max(std::abs(torque_Nm), 0.1);
    const auto acting = [&](double t) { return t + sum_of(laws, SensorState{.time_s = time_s, .value = t}); };
    return gain * (acting(torque_Nm + apart_Nm) - acting(torque_Nm - apart_Nm)) / (2.0 * apart_Nm);
  }

  // Stretch corrected for clocks that `edits` change. It covers the times at which its rows were taken, and
  // it starts at the angle that was read at its start. The start speed is not corrected.
  AxisStretch begun_where_read(std::uint32_t b, const std::array<SensorClock, 2>& clocks) const {
    AxisStretch s = stretches_[b];
    double first_s = s.from_s;
    for (const std::uint32_t channel : {0u, 1u}) {
      if (spans_[b][channel].count == 0) continue;
      first_s = std::min(first_s, clocks[channel].taken_s(stretches_[b].from_s));
      s.to_s = std::max(s.to_s, clocks[channel].taken_s(stretches_[b].to_s));
    }
    const bool before = first_s < s.from_s - lead_in_s_;
    if (before) s.from_s = std::max(0.0, s.from_s - std::ceil((s.from_s - first_s) / step_s_) * step_s_);
    const SensorClock& lead = clocks[lead_channel_];
    if (before || lead.rate != 1.0 || lead.late_s != 0.0) s.position = angle_.at(lead.stamp_s(s.from_s));
    return s;
  }

  struct Span {
    std::size_t first = 0, count = 0;
  };

  // Rows taken before or after the recorded torque cannot be simulated. Each gets the residual of the row
  // that mirrors it at the end of the known range, which neither costs nor gains anything.
  void mirror_unknown(const Span& span, const SensorClock& clock, const SensorClock& drive,
                      std::span<double> out) const {
    const double from_s = drive.stamp_s(torque_.time_s.front()) - lead_in_s_;
    const double until_s = drive.stamp_s(torque_.time_s.back()) + torque_row_s_;
    std::size_t known = span.first, end = span.first + span.count;
    while (known < end && clock.taken_s(times_[known]) < from_s) ++known;
    while (end > known && clock.taken_s(times_[end - 1]) > until_s) --end;
    if (known == end) return;
    const auto mirror = [&](std::size_t i, std::size_t at) {
      out[i] = rows[i].measured + out[at] - rows[at].measured;
    };
    for (std::size_t i = span.first; i < known; ++i) mirror(i, std::min(2 * known - 1 - i, end - 1));
    for (std::size_t i = end; i < span.first + span.count; ++i)
      mirror(i, end - 1 - std::min(i - end, end - 1 - known));
  }

  // The zero of the angle may differ from recording to recording: an incremental encoder starts anew, and the
  // zero of a video is set by hand. Only an arm that hangs shows it, and only a belief knows it.
  void take_zero_of_angle(bool is_read) {
    const double sd = belief_.value("spread.position_offset_rad");
    has_zero_of_angle_ = is_read && sd > 0.0 && belief_.value("axis.gravity_torque_Nm") != 0.0;
    if (!has_zero_of_angle_) return;
    trial_nuisances.push_back({"position_offset_rad", sd, 1e-3});
    trial_nuisances.back().like["encoder.offset"] = 1.0;
  }

  // Puts the torque on the simulation's grid, as the mean over each step. Between rows it is interpolated
  // linearly, with the curvature of a cubic taken off: h^2 f'' / 12. A drive that holds its torque acts half
  // a row later; the tolerance of the channels' times covers that.
  void take_torque() {
    const double row_s = torque_row_s_ = median_step_s(torque_.time_s);
    const auto rows_per_step = static_cast<std::size_t>(
        std::clamp(std::round(torque_.time_s.back() > kLong_s ? 4e-3 / row_s : 2e-3 / row_s), 1.0, 8.0));
    step_s_ = std::min(row_s * static_cast<double>(rows_per_step), 5e-3);
    const auto count = static_cast<std::size_t>(std::ceil(torque_.time_s.back() / step_s_)) + 2;
    constexpr std::size_t kParts = 8;
    const Signal fine = on_grid(torque_, 0.0, step_s_ / kParts, count * kParts, false);
    drive_ = {0.0, step_s_, std::vector<double>(count, 0.0)};
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < kParts; ++k) drive_.values[i] += fine.values[i * kParts + k] / kParts;
    const auto straight = drive_.values;
    const double share = row_s * row_s / (12.0 * step_s_ * step_s_);
    for (std::size_t i = 1; i + 1 < count; ++i)
      drive_.values[i] -= share * (straight[i - 1] - 2.0 * straight[i] + straight[i + 1]);
    swings_free_ = std::ranges::all_of(drive_.values, [](double torque) { return torque == 0.0; });
  }

  // Cuts the trial into stretches of about `block_s` in which the torque is known, up to short gaps that are
  // close to each other. Each begins on a step of the torque's grid.
  void cut(double end_s, double block_s) {
    const double row_s = median_step_s(torque_.time_s);
    const double unknown_s = std::max(kUnknown_s, kUnknownRows * row_s);
    const double gap_s = std::max(kGap_s, kGapRows * row_s);
    std::vector<std::pair<double, double>> gaps;  // first and last time of each
    for (std::size_t i = 1; i < torque_.time_s.size(); ++i)
      if (torque_.time_s[i] - torque_.time_s[i - 1] > gap_s)
        gaps.emplace_back(torque_.time_s[i - 1], torque_.time_s[i]);
    std::vector<std::pair<double, double>> known{{0.0, end_s}};
    for (std::size_t g = 0; g < gaps.size(); ++g) {
      const auto& [first_s, last_s] = gaps[g];
      const bool alone = (g == 0 || first_s - gaps[g - 1].second > kAlone_s) &&
                         (g + 1 == gaps.size() || gaps[g + 1].first - last_s > kAlone_s);
      if (!alone && last_s - first_s <= unknown_s) continue;
      known.back().second = first_s;
      known.emplace_back(last_s, end_s);
    }
    for (const auto& [first_s, last_s] : known) {
      const double from = std::ceil(first_s / step_s_ - 1e-9), steps = last_s / step_s_ - from;
      if (known.size() > 1 && steps * step_s_ < kShortest_s) continue;
      const double parts = std::max(1.0, std::floor(steps * step_s_ / block_s));
      const double each = std::ceil(steps / parts + 1e-9);
      for (double at = 0.0; at < steps; at += each)
        stretches_.push_back(
            {step_s_ * (from + at), step_s_ * (from + std::min(at + each, std::ceil(steps + 1e-9)))});
    }
    blocks = static_cast<std::uint32_t>(stretches_.size());
  }

  Signal acting_torque(const Edits& edits) const {
    const Signal& recorded = drive_;
    const auto count = recorded.values.size();
    bool edited = false;
    for (const auto& edit : edits.sensors) edited = edited || edit.channel == "actuator";
    if (!edited) return recorded;
    std::vector<double> times(count);
    for (std::size_t i = 0; i < count; ++i) times[i] = step_s_ * static_cast<double>(i);
    Signal acting{0.0, step_s_, std::vector<double>(count)};
    Signal used = recorded;
    observe(used, {}, edits, "actuator", times, acting.values);
    return acting;
  }

  void add_rows(std::uint32_t channel, const Samples& samples) {
    if (spans_.empty()) spans_.assign(blocks, {});
    for (std::size_t i = 0; i < samples.value.size(); ++i) {
      const double t = samples.time_s[i];
      const auto after = std::ranges::upper_bound(stretches_, t, {}, &AxisStretch::from_s);
      if (after == stretches_.begin() || (after - 1)->to_s < t) continue;
      const auto block = static_cast<std::uint32_t>(after - stretches_.begin() - 1);
      auto& span = spans_[block][channel];
      if (span.count++ == 0) span.first = rows.size();
      times_.push_back(t);
      rows.push_back({channel, block, kFast, t, samples.value[i]});
    }
  }

  // Standard deviation of the mean torque of a stretch from the white noise s of the torque sensor over n
  // rows, s / sqrt(n). The simulated axis follows this noise; the recorded one did not.
  double torque_unknown_Nm() const {
    if (!drive_acts_) return 0.0;
    const double rows = static_cast<double>(torque_.time_s.size()) / static_cast<double>(blocks);
    return belief_.value("sensors.torque_noise_Nm") / std::sqrt(std::max(1.0, rows));
  }

  // Start angle in the set-up, if it states one.
  static std::optional<double> where_it_began(const Trial& trial) {
    for (const auto* key : {"position_rad", "release_position_rad"})
      if (const auto it = trial.setup.find(key); it != trial.setup.end()) return it->second;
    return std::nullopt;
  }

  // Start state of each block, from the smoothed recording; the fit moves it. Without a position it comes
  // from the integrated speed, starting at `began_rad`.
  void find_starts(const Samples& positions, const Samples& velocities, std::optional<double> began_rad) {
    const auto& lead = positions.empty() ? velocities : positions;
    const double row_s = median_step_s(lead.time_s);
    const auto half_width = static_cast<std::size_t>(std::clamp(0.01 / row_s, 3.0, 12.0));
    const Smoothed at = smooth(lead, half_width);
    Samples position = lead, velocity = lead;
    if (!positions.empty()) {
      position.value = at.value;
      velocity.value = at.rate;
    } else {
      velocity.value = at.value;
      double angle = began_rad.value_or(0.0);
      for (std::size_t i = 0; i < position.value.size(); ++i) {
        if (i > 0) angle += 0.5 * (at.value[i] + at.value[i - 1]) * (lead.time_s[i] - lead.time_s[i - 1]);
        position.value[i] = angle;
      }
    }
    const auto count = static_cast<std::size_t>(std::ceil(stretches_.back().to_s / step_s_)) + 2;
    const Samples turns{position.time_s, last_turns(position.value, kTurn_rad)};
    turned_at_ = on_grid(turns, 0.0, step_s_, count, true);
    lead_channel_ = positions.empty() ? 1 : 0;
    angle_ = on_grid(position, 0.0, step_s_, count, false);
    const Signal speed = on_grid(velocity, 0.0, step_s_, count, false);
    for (AxisStretch& stretch : stretches_) {
      stretch.position = angle_.at(stretch.from_s);
      stretch.velocity = speed.at(stretch.from_s);
    }
    double fastest = 0.0;
    for (const double v : velocity.value) fastest = std::max(fastest, std::abs(v));
    const double noise = std::max(fluctuation_rms(lead), 1e-6);
    const bool is_told = positions.empty() && began_rad;
    block_nuisances = {{"position_rad", is_told ? kStart_rad : std::max(kStart_rad, 20.0 * noise), 1e-4},
                       {"velocity_radps", std::max(0.3 * fastest, 0.05), 1e-3 * std::max(fastest, 0.1)}};
    if (const double sd = torque_unknown_Nm(); sd > 0.0) {
      block_nuisances.push_back({"torque_Nm", sd, 0.1 * sd});
      block_nuisances.push_back({"torque_rise_Nm", std::sqrt(3.0) * sd, 0.1 * sd});
    }
    Coordinate v{"velocity_radps", {}}, p{"position_rad", {}}, torque{"torque_Nm", {}}, time{"t_s", {}};
    for (Row& row : rows) {
      v.values.push_back(speed.at(row.time_s));
      p.values.push_back(angle_.at(row.time_s));
      torque.values.push_back(drive_.at(row.time_s));
      time.values.push_back(row.time_s);
      const double share = std::abs(v.values.back()) / std::max(fastest, 1e-9);
      row.phase = share < 0.03 ? kRest : share < 0.4 ? kSlow : kFast;
    }
    coordinates = {std::move(v), std::move(p), std::move(torque), std::move(time)};
    sensors_[0] = sensor_belief(belief_, "position", "rad");
    sensors_[1] =
        sensor_belief(belief_, speed_of_encoder(belief_) ? "encoder_velocity" : "velocity", "radps");
    if (const double bandwidth_Hz = sensors_[1].bandwidth_Hz; bandwidth_Hz > 0.0)
      lead_in_s_ = std::max(kLeadIn_s, kTimeConstants / (2.0 * std::numbers::pi * bandwidth_Hz));
  }

  Belief belief_;
  Samples torque_;
  Signal drive_, turned_at_, angle_;  // angle_: as recorded, smoothed
  std::size_t lead_channel_ = 0;
  bool drive_acts_ = true, swings_free_ = false, has_torque_offset_ = false, has_zero_of_angle_ = false;
  double step_s_ = 1e-3, torque_row_s_ = 0.0, lead_in_s_ = kLeadIn_s;
  std::vector<AxisStretch> stretches_;
  std::vector<std::array<Span, 2>> spans_;
  std::array<SensorBelief, 2> sensors_{};
  std::vector<double> times_;
};

}  // namespace

std::unique_ptr<TrialModel> make_rotary_trial(const Trial& trial, const Belief& belief, double stretch) {
  return std::make_unique<RotaryTrial>(trial, belief, stretch);
}

}  // namespace sandhopper::diagnose
