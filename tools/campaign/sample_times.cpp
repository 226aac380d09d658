#include "tools/campaign/sample_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper {
std::string duration(double s) {
  if (s < 0.9995e-3) return fmt::format("{:.3g} us", 1e6 * s);
  if (s < 0.9995) return fmt::format("{:.3g} ms", 1e3 * s);
  return fmt::format("{:.3g} s", s);
}

bool holds_in_truth(const std::string& channel) {
  return channel.starts_with("command_") || channel.ends_with("_torque_Nm") || channel == "torque_Nm" ||
         channel.ends_with("_current_A") || channel == "phase";
}

namespace {

using enum FindingSeverity;

constexpr std::size_t kFewestRows = 10;

void add(TrialRecording& recording, FindingKind kind, FindingSeverity severity, const RecordingPlaces& places,
         std::size_t row, const std::string& channel, std::string what, std::string cure) {
  recording.findings.push_back(
      {kind, severity, places.file, places.line_of(row), 1, channel, std::move(what), std::move(cure)});
}

// True if some channel has different values in the two rows: then they are two samples, not one row in two
// parts.
bool rows_differ(const TrialRecording& recording, std::size_t a, std::size_t b) {
  return std::any_of(recording.channels.begin(), recording.channels.end(), [&](const auto& channel) {
    return !std::isnan(channel.values[a]) && !std::isnan(channel.values[b]) &&
           channel.values[a] != channel.values[b];
  });
}

struct SharedTimes {
  std::size_t rows = 0;   // rows with the same time as the row before
  std::size_t first = 0;  // index of the first of them
  std::size_t distinct = 1;
  double resolution_s = std::numeric_limits<double>::infinity();
};

SharedTimes shared_times(const TrialRecording& recording) {
  SharedTimes shared;
  const auto& t = recording.t_s;
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (t[i] > t[i - 1]) {
      ++shared.distinct;
      shared.resolution_s = std::min(shared.resolution_s, t[i] - t[i - 1]);
    } else if (t[i] == t[i - 1] && rows_differ(recording, i - 1, i)) {
      if (shared.rows++ == 0) shared.first = i;
    }
  }
  return shared;
}

// Least squares t_i = a + b i: the row number is exact, the time is rounded.
void spread(std::vector<double>& t_s) {
  const auto n = static_cast<double>(t_s.size());
  const double first = t_s.front(), middle = 0.5 * (n - 1.0);
  double sum = 0.0, slope = 0.0, square = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    const double at = static_cast<double>(i) - middle;
    sum += t_s[i] - first;
    slope += at * (t_s[i] - first);
    square += at * at;
  }
  for (std::size_t i = 0; i < t_s.size(); ++i)
    t_s[i] = first + sum / n + slope / square * (static_cast<double>(i) - middle);
}

bool nearly_all(std::size_t count, std::size_t of) { return 5 * count >= 4 * of; }

// True if every step is a multiple of the shortest one and nearly all are the shortest: then rows are missing
// in an even table. Rounded times of even rows have steps of n or n + 1 resolutions, both often.
bool are_lost_rows(const std::vector<double>& t_s, const std::vector<double>& distinct_steps) {
  const double shortest = distinct_steps.front();
  if (!(shortest > 0.0)) return false;
  const bool multiples = std::ranges::all_of(distinct_steps, [&](double step) {
    return std::abs(step / shortest - std::round(step / shortest)) < 0.01;
  });
  std::size_t alone = 0;
  for (std::size_t i = 1; i < t_s.size(); ++i) alone += t_s[i] - t_s[i - 1] < 1.5 * shortest;
  return multiples && nearly_all(alone, t_s.size() - 1);
}

// Common divisor of all steps if it is coarse; otherwise 0.
double coarse_resolution(const std::vector<double>& t_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    const double step = t_s[i] - t_s[i - 1];
    if (step == 0.0) continue;  // The same row twice: rows that differ are told as shared times.
    const auto same = [&](double other) { return std::abs(step - other) < 1e-6 * std::abs(other) + 1e-9; };
    if (std::none_of(steps.begin(), steps.end(), same)) steps.push_back(step);
    if (steps.size() > 4) return 0.0;
  }
  if (steps.size() < 2) return 0.0;
  std::sort(steps.begin(), steps.end());
  if (are_lost_rows(t_s, steps)) return 0.0;
  const double resolution = steps[1] - steps[0],
               mean = (t_s.back() - t_s.front()) / static_cast<double>(t_s.size() - 1);
  const bool multiples = std::all_of(steps.begin(), steps.end(), [&](double step) {
    return std::abs(step / resolution - std::round(step / resolution)) < 0.01;
  });
  // In a regular table with gaps nearly all steps are the shortest; that is not a coarse time.
  const bool regular = std::abs(mean - steps.front()) < 0.02 * mean;
  return multiples && !regular && resolution > 0.15 * mean && steps.back() < 3.0 * mean ? resolution : 0.0;
}

// Lengths of the runs of equal values, without the first and the last run.
struct Runs {
  std::vector<std::size_t> lengths;
  double largest_step = 0.0;
  std::size_t first_row = 0;
};

Runs inner_runs(const std::vector<double>& values) {
  Runs runs;
  std::size_t length = 0, count = 0;
  double last = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isnan(values[row])) continue;
    if (values[row] == last) {
      ++length;
      continue;
    }
    if (count++ > 1) runs.lengths.push_back(length);
    if (count == 2) runs.first_row = row;
    if (!std::isnan(last)) runs.largest_step = std::max(runs.largest_step, std::abs(values[row] - last));
    length = 1;
    last = values[row];
  }
  return runs;
}

// Length of nearly all runs; 0 if they differ.
std::size_t usual_length(std::vector<std::size_t> lengths) {
  if (lengths.size() < 8) return 0;
  std::nth_element(lengths.begin(), lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2),
                   lengths.end());
  const std::size_t middle = lengths[lengths.size() / 2];
  const auto alike =
      std::count_if(lengths.begin(), lengths.end(), [&](std::size_t length) { return length == middle; });
  return nearly_all(static_cast<std::size_t>(alike), lengths.size()) ? middle : 0;
}

// Replaces filled-in zeros by NaN: v 0 0 0 v 0 0 0, single samples with equally many zeros in between.
bool drop_filled_zeros(std::vector<double>& values) {
  std::vector<std::size_t> zeros;
  std::size_t samples = 0, alone = 0, length = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isnan(values[row])) return false;
    if (values[row] == 0.0) {
      ++length;
      continue;
    }
    ++samples;
    alone += row > 0 && row + 1 < values.size() && values[row - 1] == 0.0 && values[row + 1] == 0.0;
    if (samples > 1) zeros.push_back(length);
    length = 0;
  }
  if (usual_length(zeros) == 0 || alone * 10 < samples * 8) return false;
  for (double& value : values)
    if (value == 0.0) value = std::numeric_limits<double>::quiet_NaN();
  return true;
}

// Replaces the repeats of held values by NaN. Nobody knows how old a run of another length is that comes
// first, so it goes as a whole.
void drop_repeats(std::vector<double>& values, std::size_t usual) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double held = kNone;
  std::size_t first_run = 0;
  bool in_first = true;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isnan(values[row])) continue;
    const bool repeats = values[row] == held;
    in_first = in_first && (repeats || std::isnan(held));
    first_run += in_first;
    held = values[row];
    if (repeats) values[row] = kNone;
  }
  if (first_run != usual)
    *std::ranges::find_if(values, [](double value) { return !std::isnan(value); }) = kNone;
}

}  // namespace

void check_times(TrialRecording& recording, const RecordingPlaces& places, bool spread_times) {
  const std::size_t rows = recording.t_s.size();
  if (rows < kFewestRows) return;
  const auto shared = shared_times(recording);
  const double step_s = (recording.t_s.back() - recording.t_s.front()) / static_cast<double>(rows - 1);
  if (shared.distinct == 1 && shared.rows > 0) {
    add(recording, FindingKind::coarse_time, trial_unusable, places, 0, "t_s",
        fmt::format("all {} rows have the same time ({:.6g}): written with too few digits", rows,
                    recording.t_s.front()),
        "export the time with more digits (\"%.6f\" in place of \"%g\"), or as seconds since the start");
  } else if (shared.rows * 10 > rows) {
    const std::string what = fmt::format(
        "times have a resolution of {}, rows come every {}: {} of {} rows share a time with the row before",
        duration(shared.resolution_s), duration(step_s), shared.rows, rows);
    if (spread_times) {
      spread(recording.t_s);
      add(recording, FindingKind::coarse_time, note, places, shared.first, "t_s",
          what + "; spread evenly, as [format] says", "");
    } else {
      add(recording, FindingKind::coarse_time, trial_unusable, places, shared.first, "t_s", what,
          "export the time with more digits, or, if the rows came evenly, write [format] spread_times = true "
          "into "
          "campaign.toml");
    }
  } else if (const double resolution_s = coarse_resolution(recording.t_s); resolution_s > 0.0) {
    add(recording, FindingKind::coarse_time, note, places, 0, "t_s",
        fmt::format("times have a resolution of {}, rows come every {}: each may be {} off",
                    duration(resolution_s), duration(step_s), duration(0.5 * resolution_s)),
        "speeds and accelerations from them are as coarse; export the time with more digits");
    return;
  } else {
    return;
  }
  std::erase_if(recording.findings,
                [](const Finding& f) { return f.kind == FindingKind::time_stands_still; });
}

void check_held_samples(TrialRecording& recording, const RecordingPlaces& places) {
  const std::size_t rows = recording.t_s.size();
  if (rows < 2 * kFewestRows || !recording.has_time) return;
  const double step_s = (recording.t_s.back() - recording.t_s.front()) / static_cast<double>(rows - 1);
  std::vector<std::size_t> length;
  for (auto& channel : recording.channels) {
    const bool filled = drop_filled_zeros(channel.values);
    if (filled)
      add(recording, FindingKind::held_samples, note, places, 0, channel.name,
          "is filled with zeros between single samples; the zeros are taken for no samples",
          "leave the cell empty where there is no sample");
    length.push_back(filled ? 0 : usual_length(inner_runs(channel.values).lengths));
  }
  const bool any_changes = std::find(length.begin(), length.end(), 1U) != length.end();
  for (std::size_t i = 0; i < length.size() && any_changes; ++i) {
    if (length[i] < 2) continue;
    auto& channel = recording.channels[i];
    const auto runs = inner_runs(channel.values);
    const double held_s = static_cast<double>(length[i]) * step_s;
    const bool is_kept = holds_in_truth(channel.name);
    add(recording, FindingKind::held_samples, note, places, runs.first_row, channel.name,
        fmt::format(
            "is held over {} rows at a time ({}) while other channels change with every row; {}, and "
            "what changes faster than {:.3g} Hz does not show",
            length[i], duration(held_s),
            is_kept ? fmt::format("between its true samples it may be up to {:.3g} off", runs.largest_step)
                    : "the repeats are taken for no samples",
            0.5 / held_s),
        "leave the cell empty where there is no new sample");
    if (!is_kept) drop_repeats(channel.values, length[i]);
  }
}

}  // namespace sandhopper
