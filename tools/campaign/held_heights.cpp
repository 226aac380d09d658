#include "tools/campaign/held_heights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tools/campaign/equal_runs.hpp"
#include "tools/campaign/interpolated_samples.hpp"
#include "tools/campaign/sample_times.hpp"

namespace sandhopper {
namespace {

// Repeats between two steps in the same direction.
struct Held {
  std::size_t repeats = 0, longest = 1;
  std::size_t begins = 0;         // row of the first value that is repeated
  std::vector<double> steps_m{};  // sizes of the steps behind the runs with repeats
};

Held held_between_steps(const std::vector<EqualRun>& runs) {
  Held held;
  for (std::size_t i = 1; i + 1 < runs.size(); ++i) {
    const double before = runs[i].value - runs[i - 1].value, after = runs[i + 1].value - runs[i].value;
    if (runs[i].samples < 2 || before * after < 0.0) continue;
    if (held.repeats == 0) held.begins = runs[i].first_row;
    held.repeats += runs[i].samples - 1;
    held.longest = std::max(held.longest, runs[i].samples);
    held.steps_m.push_back(std::abs(after));
  }
  return held;
}

// A body slower than one step of a coarse sensor per row repeats values, too. Then all steps beside the
// repeats are one step of the sensor, or with noise a few; those of a held sample are what the body moved,
// and are of many sizes. Two steps of four rounded heights differ by up to two digits without a reason.
bool are_of_many_sizes(std::vector<double> steps_m, double digit_m) {
  constexpr std::size_t kFewest = 8;  // as for the runs of check_held_samples
  if (steps_m.size() < kFewest) return false;
  std::ranges::sort(steps_m);
  std::size_t sizes = 1;
  double size_m = steps_m.front();
  for (const double step_m : steps_m) {
    if (step_m - size_m <= 2.01 * digit_m) continue;
    size_m = step_m;
    ++sizes;
  }
  return 2 * sizes > steps_m.size();
}

}  // namespace

void check_held_heights(TrialRecording& recording, const Campaign& campaign, const RecordingPlaces& places) {
  constexpr std::string_view kHeight = "height_m";
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto channel = std::ranges::find(recording.channels, kHeight, &TrialRecording::Channel::name);
  if (campaign.plant != CampaignPlant::falling_body || !recording.has_time ||
      channel == recording.channels.end())
    return;
  auto& heights_m = channel->values;
  const auto runs = equal_runs(heights_m);
  const auto held = held_between_steps(runs);
  if (!are_of_many_sizes(held.steps_m, written_digit(heights_m, places.column_of(kHeight)))) return;
  std::size_t first_repeat = held.begins + 1;
  while (std::isnan(heights_m[first_repeat])) ++first_repeat;
  std::size_t samples = 0, emptied = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& run = runs[i];
    samples += run.samples;
    if (run.samples > held.longest) continue;  // a rest
    for (std::size_t row = i == 0 ? run.first_row : run.first_row + 1; row <= run.last_row; ++row) {
      emptied += !std::isnan(heights_m[row]);
      heights_m[row] = kNone;
    }
  }
  const auto [least, most] = std::ranges::minmax(held.steps_m);
  const double span_s = recording.t_s[runs.back().last_row] - recording.t_s[runs.front().first_row];
  recording.findings.push_back(
      {FindingKind::held_samples, FindingSeverity::note, places.file, places.line_of(first_repeat), 1,
       std::string(kHeight),
       fmt::format("repeats the value before in {} of {} rows and then goes on the same way by {:.3g} to "
                   "{:.3g} m, which no body does in the air: held samples, a new one comes every {} on "
                   "average; the repeats are taken for no samples",
                   held.repeats, samples, least, most,
                   duration(span_s / static_cast<double>(samples - emptied))),
       "leave the cell empty where there is no new sample"});
}

}  // namespace sandhopper
