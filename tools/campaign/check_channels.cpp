#include "tools/campaign/check_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/equal_runs.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kFewestSamples = 20;
// Fraction of stuck or saturated samples above which a channel is removed.
constexpr double kUnusableShare = 0.2;

struct Shape {
  std::vector<EqualRun> runs;
  std::size_t samples = 0;
  double low = 0.0, high = 0.0;
  std::size_t usual_hold = 1;  // 90th percentile of the run length.
};

Shape shape_of(const std::vector<double>& values) {
  Shape shape;
  shape.runs = equal_runs(values);
  if (shape.runs.empty()) return shape;
  const auto [low, high] = std::ranges::minmax(shape.runs, {}, &EqualRun::value);
  shape.low = low.value;
  shape.high = high.value;
  for (const auto& run : shape.runs) shape.samples += run.samples;
  std::vector<std::size_t> lengths;
  lengths.reserve(shape.runs.size());
  for (const auto& run : shape.runs) lengths.push_back(run.samples);
  const auto ninth = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() * 9 / 10);
  std::nth_element(lengths.begin(), ninth, lengths.end());
  shape.usual_hold = *ninth;
  return shape;
}

// Distance between the 5th and 95th percentile, robust against outliers.
double spread_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.size() < 2) return 0.0;
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return at(0.95) - at(0.05);
}

// Means over 1/30 of the samples each. They average out noise but keep a real motion.
std::vector<double> means_of_stretches(const std::vector<double>& values) {
  constexpr std::size_t kStretches = 30;
  std::vector<double> fresh;
  std::ranges::copy_if(values, std::back_inserter(fresh), [](double value) { return !std::isnan(value); });
  const std::size_t each = std::max<std::size_t>(1, fresh.size() / kStretches);
  std::vector<double> means;
  for (auto at = fresh.begin(); fresh.end() - at >= static_cast<std::ptrdiff_t>(each);
       at += static_cast<std::ptrdiff_t>(each))
    means.push_back(std::accumulate(at, at + static_cast<std::ptrdiff_t>(each), 0.0) /
                    static_cast<double>(each));
  return means;
}

// Name of the velocity channel of a position channel; empty if there is none.
std::string rate_of(const std::string& channel) {
  constexpr std::string_view kPosition = "position_rad";
  return channel.ends_with(kPosition)
             ? channel.substr(0, channel.size() - kPosition.size()) + "velocity_radps"
             : "";
}

bool natural_rest(const ChannelTraits& traits, double value) {
  if (traits.may_rest == MayRest::always) return true;
  constexpr double kStandardGravity_mps2 = 9.81;  // Specific force of a noise-free sensor at rest.
  return traits.may_rest == MayRest::at_zero && (value == 0.0 || value == kStandardGravity_mps2);
}

class Checker {
 public:
  Checker(TrialRecording& recording, CampaignPlant plant, const RecordingPlaces& places)
      : recording_(recording), plant_(plant), places_(places) {
    for (const auto& channel : recording.channels) {
      shapes_.push_back(shape_of(channel.values));
      spreads_.push_back(shapes_.back().high - shapes_.back().low);
    }
  }

  void run() {
    std::vector<bool> unusable(recording_.channels.size(), false);
    for (std::size_t i = 0; i < recording_.channels.size(); ++i) {
      const auto* traits = find_channel(plant_, recording_.channels[i].name);
      if (traits == nullptr || traits->may_rest == MayRest::always) continue;
      if (shapes_[i].samples < kFewestSamples) continue;
      const bool stuck = is_stuck(i, *traits), saturated = !stuck && traits->has_range && is_saturated(i);
      unusable[i] = stuck || saturated;
      if (saturated || (stuck && shapes_[i].runs.size() == 1))
        recording_.at_one_value.push_back(recording_.channels[i]);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < unusable.size(); ++i) {
      if (unusable[i]) continue;
      if (kept != i) recording_.channels[kept] = std::move(recording_.channels[i]);
      ++kept;
    }
    recording_.channels.resize(kept);
  }

 private:
  // True if the channel must be removed.
  bool is_stuck(std::size_t i, const ChannelTraits& traits) {
    const auto& shape = shapes_[i];
    const auto longest =
        std::max_element(shape.runs.begin(), shape.runs.end(),
                         [](const EqualRun& a, const EqualRun& b) { return a.samples < b.samples; });
    const bool constant = shape.runs.size() == 1;
    const bool long_enough = constant || (longest->samples >= 100 && longest->samples * 10 >= shape.samples &&
                                          longest->samples >= 30 * shape.usual_hold);
    const bool at_end =
        traits.has_range && !constant && (longest->value == shape.low || longest->value == shape.high);
    if (!long_enough || at_end || natural_rest(traits, longest->value)) return false;
    if (!constant && !fails(i, *longest)) return false;
    if (!others_move(i, *longest)) return false;
    const double share = static_cast<double>(longest->samples) / static_cast<double>(shape.samples);
    const bool unusable = share >= kUnusableShare;
    add(i, FindingKind::stuck, unusable, longest->first_row,
        constant
            ? fmt::format("is stuck: all {} samples are {:.6g} while other channels move", shape.samples,
                          longest->value)
            : fmt::format("is stuck at {:.6g} from here to line {} ({} samples) while other channels move",
                          longest->value, places_.line_of(longest->last_row), longest->samples),
        "check the sensor and its cable; remove the column if it was not connected");
    return unusable;
  }

  // A failed sensor keeps its value to the end or comes back with a jump. A sensor of low resolution whose
  // quantity rests does neither.
  bool fails(std::size_t i, const EqualRun& run) const {
    constexpr double kJump = 5.0;
    const auto& runs = shapes_[i].runs;
    const auto at = std::find_if(runs.begin(), runs.end(),
                                 [&](const EqualRun& r) { return r.first_row == run.first_row; });
    if (at + 1 == runs.end()) return run.samples * 4 >= shapes_[i].samples;
    std::vector<double> steps;
    for (auto next = runs.begin() + 1; next != runs.end(); ++next)
      if (next != at + 1) steps.push_back(std::abs(next->value - (next - 1)->value));
    if (steps.empty()) return false;
    const auto ninth = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() * 9 / 10);
    std::nth_element(steps.begin(), ninth, steps.end());
    return std::abs((at + 1)->value - at->value) > kJump * *ninth;
  }

  // True if other channels move during the run. If the whole robot rests, every channel stays within a small
  // part of its range. For an angle only its averaged speed counts: on an axis that is held still, the speed
  // is noise and the angle stays within one step of the encoder.
  bool others_move(std::size_t self, const EqualRun& run) const {
    constexpr double kMoves = 0.3;
    const auto part_of = [&](std::size_t i) {
      const auto values = recording_.channels[i].values.begin();
      return std::vector<double>(values + static_cast<std::ptrdiff_t>(run.first_row),
                                 values + static_cast<std::ptrdiff_t>(run.last_row + 1));
    };
    const std::string rate = rate_of(recording_.channels[self].name);
    for (std::size_t i = 0; i < recording_.channels.size(); ++i)
      if (spreads_[i] > 0.0 && recording_.channels[i].name == rate)
        return spread_of(means_of_stretches(part_of(i))) > kMoves * spreads_[i];
    for (std::size_t i = 0; i < recording_.channels.size(); ++i) {
      if (i == self || spreads_[i] <= 0.0) continue;
      const auto* traits = find_channel(plant_, recording_.channels[i].name);
      if (traits == nullptr || traits->may_rest == MayRest::always) continue;
      if (spread_of(part_of(i)) > kMoves * spreads_[i]) return true;
    }
    return false;
  }

  bool is_saturated(std::size_t i) {
    std::size_t at_limit = 0;
    for (const bool top : {true, false}) at_limit += saturated_side(i, top);
    return static_cast<double>(at_limit) >= kUnusableShare * static_cast<double>(shapes_[i].samples);
  }

  // Number of samples in runs at one end of the range that are too long to be chance.
  std::size_t saturated_side(std::size_t i, bool top) {
    const auto& shape = shapes_[i];
    const double limit = top ? shape.high : shape.low;
    if (limit == 0.0 || shape.runs.size() < kFewestSamples) return 0;
    const std::size_t shortest = std::max<std::size_t>(5, 4 * shape.usual_hold);
    std::size_t samples = 0;
    const EqualRun* first = nullptr;
    for (const auto& run : shape.runs) {
      if (run.value != limit || run.samples < shortest || rests(i, run)) continue;
      samples += run.samples;
      if (first == nullptr) first = &run;
    }
    if (first == nullptr) return 0;
    const auto& channel = recording_.channels[i];
    recording_.saturated.push_back({channel.name, limit, top, samples});
    const bool unusable = static_cast<double>(samples) >= kUnusableShare * static_cast<double>(shape.samples);
    add(i, FindingKind::saturated, unusable, first->first_row,
        fmt::format("is saturated: {} samples stand at its {} value {:.6g}, first here", samples,
                    top ? "largest" : "smallest", limit),
        unusable ? "use a sensor of larger range"
                 : "these samples are not used; a sensor of larger range would tell");
    return samples;
  }

  // True while the motion itself pauses; at the start or end of the recording also if it only settles.
  bool rests(std::size_t self, const EqualRun& run) const {
    constexpr double kSettles = 0.1;  // of the range of the position
    const auto& shape = shapes_[self];
    const bool at_end =
        run.first_row == shape.runs.front().first_row || run.last_row == shape.runs.back().last_row;
    return !position_covers(at_end ? kSettles : 0.0, self, run);
  }

  // True if the first position channel covers more than `share` of its range during the run. Without one the
  // run counts as motion, but not at the start or end of the recording (share > 0).
  bool position_covers(double share, std::size_t self, const EqualRun& run) const {
    for (std::size_t i = 0; i < recording_.channels.size(); ++i) {
      if (i == self) continue;
      const auto* traits = find_channel(plant_, recording_.channels[i].name);
      if (traits == nullptr || traits->may_rest == MayRest::always || traits->has_range) continue;
      const auto& values = recording_.channels[i].values;
      double low = INFINITY, high = -INFINITY;
      for (std::size_t row = run.first_row; row <= run.last_row; ++row) {
        if (std::isnan(values[row])) continue;
        low = std::min(low, values[row]);
        high = std::max(high, values[row]);
      }
      return high - low > share * spreads_[i];  // the first position channel decides
    }
    return share == 0.0;
  }

  void add(std::size_t i, FindingKind kind, bool unusable, std::size_t row, std::string what,
           std::string cure) {
    recording_.findings.push_back({kind, unusable ? FindingSeverity::channel_unusable : FindingSeverity::note,
                                   places_.file, places_.line_of(row),
                                   places_.character(places_.line_of(row), places_.numbers[i]),
                                   recording_.channels[i].name, std::move(what), std::move(cure)});
  }

  TrialRecording& recording_;
  CampaignPlant plant_;
  const RecordingPlaces& places_;
  std::vector<Shape> shapes_;
  std::vector<double> spreads_;  // largest minus smallest value
};

}  // namespace

const UsedColumn* RecordingPlaces::column_of(std::string_view channel) const {
  const auto found = std::ranges::find(columns, channel, &UsedColumn::channel);
  return found == columns.end() ? nullptr : &*found;
}

bool RecordingPlaces::is_stated(std::string_view channel) const {
  const auto* column = column_of(channel);
  return column != nullptr && column->is_stated;
}

std::uint64_t RecordingPlaces::character(std::uint64_t line, std::uint64_t number) const {
  return file.ends_with(".mcap") ? 1 : csv_cell_character(file, line, number, format);
}

void check_channels(TrialRecording& recording, CampaignPlant plant, const RecordingPlaces& places) {
  Checker(recording, plant, places).run();
}

}  // namespace sandhopper
