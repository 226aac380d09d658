#include <algorithm>
#include <cmath>

#include "tools/diagnose/plants/doable.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {
namespace {

// Highest planned release, unless a higher one was recorded: of a campaign that lists its heights, and of
// one that does not, which may have no more than a room.
constexpr double kHighest_m = 30.0, kHighestInARoom_m = 2.5;
constexpr double kLongest_s = 10.0;  // longest planned recording

struct Drop {
  double height_m, speed_mps, payload_kg;
};

// Plans one drop. A free fall gives a first guess of the heights; the simulation then gives the motion and
// its end.
Trial planned(const PlantModel& plant, const Trial& sample, const Belief& belief, const Edits& edits,
              const Drop& drop) {
  const double g = belief.value("gravity_mps2", 9.81);
  const double duration_s = std::min(kLongest_s, 4.0 * std::sqrt(2.0 * drop.height_m / g));
  const double ground_m = belief.value("bed.surface_height_m");
  const bool bed = belief.value("bed.stiffness_N_per_m") > 0.0;
  // Without a bed the guess stays above the ground and sinks slowly: rows after a landing or a standstill
  // would be left out, and a medium lets the body land later than a free fall.
  const auto guess_m = [&](double t) {
    const double free_m = drop.height_m - drop.speed_mps * t - 0.5 * g * t * t;
    return bed ? free_m
               : std::max(free_m, ground_m + (0.5 - 0.2 * t / duration_s) * (drop.height_m - ground_m));
  };
  Trial trial = recorded_like(sample, duration_s, [&](const std::string& channel, double t) {
    return channel == "height_m" ? guess_m(t) : 0.0;
  });
  trial.setup = {{"release_height_m", drop.height_m}, {"release_speed_mps", drop.speed_mps}};
  if (drop.payload_kg > 0.0) trial.setup["payload_kg"] = drop.payload_kg;
  std::string why;
  // The heights are always simulated, because they show when the fall ends.
  Trial with_height = trial;
  auto& heights = with_height.channels["height_m"];
  heights.resize(trial.time_s.size());
  std::ranges::transform(trial.time_s, heights.begin(), guess_m);
  const auto model = plant.trial(with_height, belief, why);
  if (!model) return {};
  std::vector<double> predicted(model->rows.size());
  model->predict(edits, std::vector<double>(model->nuisance_count(), 0.0), predicted);
  double end_s = duration_s;
  const auto channels = plant.channels();
  for (std::size_t k = 1; k < model->rows.size(); ++k)
    if (channels[model->rows[k].channel] == "height_m" &&
        model->rows[k - 1].channel == model->rows[k].channel &&
        (predicted[k] < ground_m || predicted[k] > predicted[k - 1] + 1e-6)) {
      end_s = model->rows[k].time_s + (bed ? 0.1 : 0.0);
      break;
    }
  const auto rows = static_cast<std::size_t>(
      std::upper_bound(trial.time_s.begin(), trial.time_s.end(), end_s) - trial.time_s.begin());
  trial.time_s.resize(rows);
  for (auto& [name, values] : trial.channels) values.resize(rows);
  for (std::size_t k = 0; k < model->rows.size(); ++k) {
    const auto& row = model->rows[k];
    const auto found = trial.channels.find(channels[row.channel]);
    const auto at = std::lower_bound(trial.time_s.begin(), trial.time_s.end(), row.time_s - 1e-9);
    if (found == trial.channels.end() || at == trial.time_s.end()) continue;
    double& cell = found->second[static_cast<std::size_t>(at - trial.time_s.begin())];
    if (std::isfinite(cell)) cell = predicted[k];
  }
  return trial;
}

// Release heights of the recorded trials: the set-up's, else the first sample of the height.
std::vector<Trial> with_heights(const std::vector<Trial>& recorded) {
  std::vector<Trial> trials;
  for (const auto& trial : recorded) {
    Trial one;
    one.setup = trial.setup;
    const auto heights = samples_of(trial, "height_m");
    if (!heights.empty() && heights.value.front() > 0.0)
      one.setup.emplace("release_height_m", heights.value.front());
    trials.push_back(std::move(one));
  }
  return trials;
}

// Height of a fall from rest that takes as long as the longest recording.
double longest_fall_m(const std::vector<Trial>& recorded, const Belief& belief) {
  double longest_s = 0.0;
  for (const auto& trial : recorded)
    if (!trial.time_s.empty()) longest_s = std::max(longest_s, trial.time_s.back() - trial.time_s.front());
  return 0.5 * belief.value("gravity_mps2", 9.81) * longest_s * longest_s;
}

std::vector<double> with_none(std::vector<double> values) {
  if (std::ranges::count(values, 0.0) == 0) values.insert(values.begin(), 0.0);
  return values;
}

}  // namespace

std::vector<DoableTrial> doable_drops(const PlantModel& plant, const std::vector<Trial>& recorded,
                                      const Belief& belief, const Edits& edits, const Reach& reach) {
  std::vector<DoableTrial> trials;
  if (recorded.empty()) return trials;
  const auto aligned = with_heights(recorded);
  const bool height_known =
      std::ranges::any_of(aligned, [](const Trial& trial) { return trial.setup.contains("release_height_m"); });
  const auto heights = extent_of(aligned, "release_height_m", longest_fall_m(recorded, belief));
  const double mass_kg = belief.value("body.mass_kg", 1.0);
  auto release_heights =
      reach.settings("release_height_m",
                     {0.5 * heights.low, heights.low, std::sqrt(heights.low * heights.high), heights.high,
                      2.0 * heights.high, 4.0 * heights.high, 8.0 * heights.high, 16.0 * heights.high});
  // Without any recorded height (an accelerometer alone) only the speed of the release is planned: the fall
  // is the same from everywhere, unless it ends in a bed.
  const bool height_free = !height_known && release_heights.empty();
  if (height_free && belief.value("bed.stiffness_N_per_m") > 0.0) return trials;
  if (release_heights.empty()) release_heights = {heights.high};
  const auto speeds = with_none(reach.settings("release_speed_mps", {3.0, 8.0}));
  const auto payloads = with_none(reach.parts("payload_kg", {0.5 * mass_kg, mass_kg, 3.0 * mass_kg}));
  const double highest_m =
      std::max(reach.lists("release_height_m") ? kHighest_m : kHighestInARoom_m, heights.high);
  for (const double height_m : release_heights)
    for (const double speed_mps : speeds)
      for (const double payload_kg : payloads) {
        if (height_m > highest_m) continue;
        DoableTrial one;
        one.belief = belief;
        one.trial = planned(plant, recorded.front(), belief, edits, {height_m, speed_mps, payload_kg});
        one.trial.kind = "drop";
        if (height_free) one.trial.setup.erase("release_height_m");
        one.cost = std::max(0.0, std::log2(height_m / heights.high)) + (speed_mps > 0.0 ? 1.5 : 0.0) +
                   payload_kg / mass_kg;
        if (one.trial.time_s.size() >= 10) trials.push_back(std::move(one));
      }
  return trials;
}

}  // namespace sandhopper::diagnose
