#include "tools/campaign/fall_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/column_guess.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/unit_ratios.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

constexpr std::string_view kHeight = "height_m";
constexpr std::size_t kFewest = 10;

struct Sample {
  double t_s, height_m;
};

// height = a0 + a1 t + a2 t^2 by least squares; `share`: explained share of the variance.
struct Parabola {
  double acceleration = 0.0, share = 0.0;
};

std::optional<Parabola> parabola_through(std::span<const Sample> samples) {
  if (samples.size() < kFewest) return std::nullopt;
  const double middle = 0.5 * (samples.front().t_s + samples.back().t_s);
  const double half = 0.5 * (samples.back().t_s - samples.front().t_s);
  if (!(half > 0.0)) return std::nullopt;
  double n = 0, s1 = 0, s2 = 0, s3 = 0, s4 = 0, y0 = 0, y1 = 0, y2 = 0, yy = 0;
  for (const auto& sample : samples) {
    const double u = (sample.t_s - middle) / half, y = sample.height_m - samples.front().height_m;
    n += 1, s1 += u, s2 += u * u, s3 += u * u * u, s4 += u * u * u * u;
    y0 += y, y1 += u * y, y2 += u * u * y, yy += y * y;
  }
  // Cramer's rule for the normal equations.
  const auto det = [](double a, double b, double c, double d, double e, double f, double g, double h,
                      double i) { return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g); };
  const double all = det(n, s1, s2, s1, s2, s3, s2, s3, s4);
  if (!(std::abs(all) > 0.0)) return std::nullopt;
  const double a0 = det(y0, s1, s2, y1, s2, s3, y2, s3, s4) / all;
  const double a1 = det(n, y0, s2, s1, y1, s3, s2, y2, s4) / all;
  const double a2 = det(n, s1, y0, s1, s2, y1, s2, s3, y2) / all;
  const double variance = yy - y0 * y0 / n, left = yy - a0 * y0 - a1 * y1 - a2 * y2;
  return Parabola{2.0 * a2 / (half * half), variance > 0.0 ? 1.0 - left / variance : 0.0};
}

class FallChecker {
 public:
  FallChecker(TrialRecording& recording, const CampaignTrial& trial, const FallingBodyBelief& belief,
              const RecordingPlaces& places)
      : recording_(recording), trial_(trial), belief_(belief), places_(places) {}

  void run() {
    const auto heights = recording_.channel(kHeight);
    for (std::size_t i = 0; i < heights.size(); ++i)
      if (!std::isnan(heights[i])) all_.push_back({recording_.t_s[i], heights[i]});
    if (all_.size() < kFewest) return;
    const auto [low, high] = std::ranges::minmax(all_, {}, &Sample::height_m);
    low_ = low.height_m, width_ = high.height_m - low.height_m;
    if (!(width_ > 0.0) || check_speed() || trial_.kind != TrialKind::drop) return;
    if (check_slow() || check_direction()) return;
    check_gravity();
  }

 private:
  double place(const Sample& sample) const { return (sample.height_m - low_) / width_; }
  double gravity() const { return std::max(belief_.gravity_mps2, 1.0); }
  bool is_thrown() const { return trial_.number("release_speed_mps").value_or(0.0) != 0.0; }
  bool is_braked() const {
    return belief_.medium.drag_coefficient > 0.0 || belief_.medium.linear_drag_N_s_per_m > 0.0;
  }
  // A belief with a liquid: the body may sink slowly in it. 100 kg/m3: a hundred times the density of air.
  bool in_liquid() const { return belief_.medium.density_kg_per_m3 > 100.0; }

  bool check_speed() {
    constexpr double kThrow_mps = 15.0, kStated = 1.5;  // A stated release speed may be a third too small.
    const double release_mps = std::abs(trial_.number("release_speed_mps").value_or(0.0));
    const double start_mps = std::max(kThrow_mps, kStated * release_mps);
    const auto is_too_fast = [&](const Sample& from, const Sample& to) {
      const double t = to.t_s - from.t_s + unknown_age_s();
      return std::abs(to.height_m - from.height_m) >
             start_mps * t + std::max(belief_.gravity_mps2, 10.0) * t * t;
    };
    const auto& first = all_.front();
    for (const auto& sample : all_) {
      const double t = sample.t_s - first.t_s, way = std::abs(sample.height_m - first.height_m);
      if (t < 0.05 || !is_too_fast(first, sample)) continue;
      const auto limit = start_mps > kThrow_mps
                             ? fmt::format("1.5 times the stated release speed of {:.3g} m/s", release_mps)
                             : "a throw of 15 m/s (no larger release_speed_mps is stated)";
      const auto what =
          fmt::format("changes by {:.4g} m within {:.3g} s, faster than {} and a fall", way, t, limit);
      if (is_rising(first, sample))
        add(what + "; it rises, and nothing in the belief drives it upward", rising_cure(way / t));
      else if (const auto held = most_behind_repeats(is_too_fast); !held.empty())
        add(what + held,
            "leave the cell empty where there is no new sample, also in the first row if it repeats the one "
            "before it");
      else
        add(what, speed_cure(way / t) + driven_cure(first, sample));
      return true;
    }
    return false;
  }

  // A body that goes up from its first row on, to the upper end of its way. One that falls in a column that
  // counts downward does so, too: it begins at rest, at an end of the numbers, and ends fastest. A throw or a
  // shot is slowed by gravity: its way in the second half of the time is shorter.
  bool is_rising(const Sample& first, const Sample& fast) const {
    const auto top = std::ranges::max_element(all_, {}, &Sample::height_m);
    return fast.height_m > first.height_m && place(first) < 0.2 && top->t_s > fast.t_s &&
           all_.back().height_m < top->height_m;
  }
  static std::string driven_cure(const Sample& first, const Sample& fast) {
    return fast.height_m > first.height_m
               ? "; if a motor drives it upward (a rocket), no plant describes that part of its way"
               : "";
  }
  static std::string rising_cure(double speed_mps) {
    return fmt::format(
        "if it is thrown or shot up, write release_speed_mps = {:.3g} into its [[trial]]; if a motor drives "
        "it (a rocket), no plant describes that part: keep the rows after the motor has stopped, select = "
        "{{ from_s = … }}, with the speed there as release_speed_mps; else correct unit, scale or sign of "
        "the height",
        speed_mps);
  }

  // check_held_heights has emptied the repeats of held samples. Each that is left was taken at any time since
  // the row before it, so two may lie one row further apart than their times.
  double unknown_age_s() const {
    const bool is_held = std::ranges::any_of(recording_.findings, [](const Finding& f) {
      return f.kind == FindingKind::held_samples && f.channel == kHeight;
    });
    return is_held ? median_step_s(recording_.t_s) : 0.0;
  }

  // Words for held samples if more than half of the steps that are too fast from row to row follow on a row
  // that repeats the one before. A wrong unit makes all steps too fast.
  template <typename IsTooFast>
  std::string most_behind_repeats(const IsTooFast& is_too_fast) const {
    std::size_t jumps = 0, behind = 0;
    for (std::size_t i = 1; i < all_.size(); ++i) {
      if (!is_too_fast(all_[i - 1], all_[i])) continue;
      ++jumps;
      behind += i > 1 && all_[i - 1].height_m == all_[i - 2].height_m;
    }
    if (2 * behind <= jumps) return "";
    return fmt::format("; {} of {} such steps follow on a row that repeats the height before: held samples",
                       behind, jumps);
  }

  // The first part of the way that is a parabola: what follows may be a landing or a liquid. Offer only units
  // that make the body slower: a braked body accelerates little, so its ratio to gravity may match a unit by
  // chance. `start_mps`: its speed, if it is that fast from the first row on.
  std::string speed_cure(double start_mps) const {
    const auto samples = way();
    for (const std::size_t parts : {1U, 2U, 4U, 8U}) {
      const auto curve = parabola_through(samples.first(samples.size() / parts));
      if (!curve || curve->share < 0.995) continue;
      const double too_large = -curve->acceleration / gravity();
      if (too_large <= 1.0) continue;
      if (const auto unit = unit_behind(too_large)) return unit->cure;
    }
    return fmt::format(
        "if the body is that fast from the first row on, write release_speed_mps = {:.3g} into its "
        "[[trial]]; else {}",
        start_mps, usual_cure());
  }

  // A force column that the campaign does not use: what was pushed was recorded with its force.
  std::string unused_force() const {
    for (const auto& name : recording_.unused_columns) {
      const auto guess = guess_column(name, unit_in_name(name), CampaignPlant::intruder, {});
      if (guess && guess->channel == "force_N") return name;
    }
    return "";
  }

  // Duration between 5 % and 95 % of the way, against that of a fall from rest. An error beside a force; else
  // a note, because a light body may sink slowly in air.
  bool check_slow() {
    const double start = place(all_.front()), end = place(all_.back());
    if (is_thrown() || in_liquid() || is_braked() || std::abs(end - start) < 0.6) return false;
    double from_s = NAN, to_s = NAN;
    for (const auto& sample : all_) {
      const double way = std::abs(place(sample) - start);
      if (way < 0.05) from_s = sample.t_s, to_s = NAN;
      if (way > 0.95 * std::abs(end - start) && std::isnan(to_s)) to_s = sample.t_s;
    }
    if (std::isnan(from_s) || std::isnan(to_s)) return false;
    const double fall_s = std::sqrt(2.0 * 0.9 * width_ / gravity()), took_s = to_s - from_s;
    if (took_s < 5.0 * fall_s) return false;
    const auto force = unused_force();
    std::string cure = "if it is pushed, import it again with --plant intruder";
    if (!force.empty()) cure += fmt::format(" (column \"{}\" is a force)", force);
    cure +=
        "; if it sinks, write the medium's density_kg_per_m3 and drag into nominal.toml; else correct unit "
        "or scale";
    add(fmt::format("takes {:.3g} s for {:.3g} m, and a body that is let go falls so far in {:.2g} s: {}, or "
                    "the height or the time is in another unit",
                    took_s, width_, fall_s,
                    end > start
                        ? "it is lifted or driven upward, or it sinks slowly and its height counts downward"
                        : "it is pushed or lowered, or it sinks slowly"),
        cure, !force.empty());
    return !force.empty();
  }

  bool check_direction() {
    if (is_thrown() || place(all_.front()) >= 0.2 || place(all_.back()) <= 0.8) return false;
    const auto* column = places_.column_of(kHeight);
    add("ends highest and begins lowest, where a body that is let go falls: it rises, or it counts downward "
        "and the channel counts upward; a throw says release_speed_mps",
        column == nullptr
            ? ""
            : fmt::format(
                  "if it counts downward write {} into [columns]; if it rises (a rocket, a balloon) keep the "
                  "part in which nothing drives it, with release_speed_mps",
                  mapping_line(reversed(*column))));
    return true;
  }

  // The way from the last row before the motion to the first row farthest from there.
  std::span<const Sample> way() const {
    const double start = place(all_.front());
    const auto far =
        std::ranges::max_element(all_, {}, [&](const Sample& s) { return std::abs(place(s) - start); });
    const auto end = static_cast<std::size_t>(far - all_.begin());
    std::size_t begin = 0;
    for (std::size_t i = 0; i < end; ++i)
      if (std::abs(place(all_[i]) - start) < 0.02) begin = i;
    // The last rows may be of the landing.
    return std::span(all_).subspan(begin, (end - begin) * 9 / 10);
  }

  // The same acceleration in both halves of the way: drag would brake the second half.
  static bool is_even(std::span<const Sample> samples, const Parabola& whole) {
    const auto half = samples.size() / 2;
    const auto early = parabola_through(samples.first(half)), late = parabola_through(samples.subspan(half));
    const auto near = [&](const std::optional<Parabola>& part) {
      return part && std::abs(part->acceleration / whole.acceleration - 1.0) < 0.15;
    };
    return near(early) && near(late);
  }

  void check_gravity() {
    const auto samples = way();
    const auto curve = parabola_through(samples);
    if (!curve || curve->share < 0.995 || belief_.gravity_mps2 < 1.0) return;
    const double ratio = -curve->acceleration / belief_.gravity_mps2;
    const auto unit = unit_behind(ratio);
    const bool too_fast = ratio > 1.5, is_unit = !in_liquid() && unit && is_even(samples, *curve);
    // A body that begins with a speed of its own and is braked (an impact) has no parabola of a fall.
    if (!(ratio > 0.0) || (!too_fast && !is_unit)) return;
    add(fmt::format(
            "falls with {:.4g} m/s2, {:.3g} times gravity ({:.4g} m/s2): height or time is in another unit{}",
            -curve->acceleration, ratio, belief_.gravity_mps2, unit ? ", " + unit->text : ""),
        unit ? unit->cure : "");
  }

  struct Unit {
    std::string text, cure;
  };
  // Units of length that differ by `ratio`, or of time that differ by its root.
  std::optional<Unit> unit_behind(double ratio) const {
    const auto *height = places_.column_of(kHeight), *time = places_.column_of("t_s");
    if (height == nullptr || !(ratio > 0.0)) return std::nullopt;
    const auto is = [&](double known) { return std::abs(ratio / known - 1.0) < 0.05; };
    for (const double known : kLengthRatios)
      if (is(known)) {
        const auto other = in_other_unit(*height, 1.0 / known);
        return Unit{fmt::format("the height in {} for {}", named(other), named(*height)),
                    fmt::format("write {} into [columns]", mapping_line(other))};
      }
    if (time != nullptr)
      for (const double known : {1e3, 1e-3})
        if (is(1.0 / (known * known))) {
          const auto other = in_other_unit(*time, 1.0 / known);
          return Unit{fmt::format("the time in {} for {}", named(other), named(*time)),
                      fmt::format("write {} into [columns]", mapping_line(other))};
        }
    return std::nullopt;
  }
  static std::string named(const UsedColumn& column) {
    return column.unit.empty() ? "an unknown unit" : column.unit;
  }

  std::string usual_cure() const {
    const auto* column = places_.column_of(kHeight);
    return column == nullptr ? "correct its scale" : scale_cure(*column);
  }

  void add(std::string what, std::string cure, bool is_error = true) {
    const bool stated = places_.is_stated(kHeight);
    if (cure.empty()) cure = usual_cure();
    if (is_error || stated)
      doubt_column(recording_, places_, stated, kHeight, std::move(what), std::move(cure));
    else
      add_implausible(recording_, places_, note, kHeight, std::move(what), std::move(cure));
  }

  TrialRecording& recording_;
  const CampaignTrial& trial_;
  const FallingBodyBelief& belief_;
  const RecordingPlaces& places_;
  std::vector<Sample> all_;
  double low_ = 0.0, width_ = 0.0;
};

}  // namespace

void check_falls(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                 const RecordingPlaces& places) {
  const auto* belief = std::get_if<FallingBodyBelief>(&trial.belief);
  const bool falls = campaign.plant == CampaignPlant::falling_body && recording.has_time;
  if (belief != nullptr && falls && recording.has(kHeight))
    FallChecker(recording, trial, *belief, places).run();
}

}  // namespace sandhopper
