#include "tools/campaign/repeated_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

struct Sample {
  double value;
  std::size_t row;
};

std::vector<Sample> samples_of(std::span<const double> values) {
  std::vector<Sample> samples;
  for (std::size_t row = 0; row < values.size(); ++row)
    if (!std::isnan(values[row])) samples.push_back({values[row], row});
  return samples;
}

struct Code {
  double value = 0.0;
  std::size_t rows = 0, first_row = 0;
};

// Steps to and from `value`, and all other steps: between the samples beside its rows, too. Of the two steps
// of a row the smaller one counts for both: a position that begins again at 0 jumps there, but not back.
struct Steps {
  std::vector<double> edges{};
  std::size_t others = 0, rows = 0, first_row = 0;
  double largest_other = 0.0;
  std::set<double> values{};  // all others
};
Steps steps_around(const std::vector<Sample>& samples, double value) {
  Steps steps;
  const Sample* before = nullptr;  // the last sample with another value
  bool is_code_before = false;
  double inward = NAN;  // the step to the code, until the step away from it
  for (const auto& sample : samples) {
    const bool is_code = sample.value == value;
    if (is_code && steps.rows++ == 0) steps.first_row = sample.row;
    const bool is_first = &sample == &samples.front();
    if (is_code && !is_code_before && !is_first) inward = std::abs(before->value - value);
    if (!is_code && is_code_before && !is_first) {
      const double outward = std::abs(sample.value - value);
      steps.edges.insert(steps.edges.end(), std::isnan(inward) ? 1U : 2U, std::fmin(outward, inward));
      inward = NAN;
    }
    if (!is_code) {
      if (before != nullptr)
        ++steps.others,
            steps.largest_other = std::max(steps.largest_other, std::abs(sample.value - before->value));
      before = &sample;
      steps.values.insert(sample.value);
    }
    is_code_before = is_code;
  }
  if (!std::isnan(inward)) steps.edges.push_back(inward);
  return steps;
}

// Natural logarithm of the number of ways to choose `few` of `many`.
double log_choices(std::size_t many, std::size_t few) {
  const auto log_factorial = [](std::size_t n) { return std::lgamma(static_cast<double>(n) + 1.0); };
  return log_factorial(many) - log_factorial(few) - log_factorial(many - few);
}

std::optional<Code> code_in(const std::vector<Sample>& samples) {
  constexpr std::size_t kFewestEdges = 3, kFewestValues = 10;  // two levels are a switch, and no position
  constexpr double kRare = 1e-5;                               // per recording
  if (samples.size() < 2) return std::nullopt;
  // The largest step of all leads to the code or away from it.
  std::size_t largest = 1;
  const auto step = [&](std::size_t i) { return std::abs(samples[i].value - samples[i - 1].value); };
  for (std::size_t i = 2; i < samples.size(); ++i)
    if (step(i) > step(largest)) largest = i;
  for (const double value : {samples[largest - 1].value, samples[largest].value}) {
    const auto steps = steps_around(samples, value);
    if (steps.rows < 2 || 2 * steps.rows > samples.size()) continue;
    // All steps above the largest other one are edges of the code. At random so many would rarely be.
    const auto large = static_cast<std::size_t>(
        std::ranges::count_if(steps.edges, [&](double edge) { return edge > steps.largest_other; }));
    if (large < kFewestEdges || steps.values.size() <= kFewestValues) continue;
    const double log_chance = std::log(static_cast<double>(steps.values.size() + 1)) +
                              log_choices(steps.edges.size(), large) -
                              log_choices(steps.edges.size() + steps.others, large);
    if (log_chance < std::log(kRare)) return Code{value, steps.rows, steps.first_row};
  }
  return std::nullopt;
}

// The diagnosis finds a sensor that falls out to 0 and leaves these samples out. Nothing else reads the
// recordings of an axis. For a falling body 0 is also the height of the bed.
bool is_left_to_diagnosis(const Campaign& campaign, const Code& code) {
  return campaign.plant == CampaignPlant::rotary_axis && code.value == 0.0;
}

}  // namespace

bool check_repeated_codes(TrialRecording& recording, const Campaign& campaign,
                          const RecordingPlaces& places) {
  constexpr std::array<std::string_view, 8> kPositions{"position_rad",
                                                       "foot_z_m",
                                                       "height_m",
                                                       "motor_left_position_rad",
                                                       "motor_right_position_rad",
                                                       "mocap_body_z_m",
                                                       "mocap_foot_z_m",
                                                       "tof_height_m"};
  bool is_lost = false;
  for (const auto channel : kPositions) {
    if (!recording.has(channel)) continue;
    const auto samples = samples_of(recording.channel(channel));
    const auto code = code_in(samples);
    if (!code) continue;
    const auto* column = places.column_of(channel);
    const double written = column == nullptr ? code->value : (code->value - column->offset) / column->scale;
    const auto what = fmt::format(
        "reads {:.9g} in {} rows, the first of them line {}, and jumps there and back farther than in any "
        "other row: a code that the sensor writes where it has no sample",
        written, code->rows, places.line_of(code->first_row));
    if (is_left_to_diagnosis(campaign, *code)) {
      add_implausible(recording, places, FindingSeverity::note, channel, what,
                      "hop diagnose reports these rows as lost samples (data.dropout)");
      continue;
    }
    const bool is_stated = places.is_stated(channel);
    is_lost |= !is_stated;
    doubt_column(
        recording, places, is_stated, channel, what,
        fmt::format(
            "write [format] no_sample = [\"{:.9g}\"] into campaign.toml; if it was measured, state unit and "
            "scale of the column",
            written));
  }
  return is_lost;
}

}  // namespace sandhopper
