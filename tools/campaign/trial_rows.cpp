#include "tools/campaign/trial_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/log/csv_import.hpp"

namespace sandhopper {

void note_at_row(TrialRecording& recording, const RecordingPlaces& places, FindingKind kind, std::size_t row,
                 std::string what, std::string cure) {
  recording.findings.push_back({kind, FindingSeverity::note, places.file, places.line_of(row), 1, "t_s",
                                std::move(what), std::move(cure)});
}

std::vector<std::size_t> selected_rows(const RowSelection& rows, const std::vector<double>& t_s,
                                       const std::vector<double>* column) {
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < t_s.size(); ++row)
    if ((column == nullptr || (*column)[row] == rows.value) && t_s[row] >= rows.from_s &&
        t_s[row] <= rows.to_s)
      keep.push_back(row);
  return keep;
}

std::string selection_text(const RowSelection& rows, const std::vector<double>& t_s,
                           const std::vector<std::size_t>& keep, std::string_view file) {
  if (t_s.empty()) return fmt::format("select leaves none of the rows: none was read from {}", file);
  const bool by_line = rows.from_line > 0 || rows.to_line < RowSelection{}.to_line;
  const auto whole = by_line ? std::string("rows") : fmt::format("of {} rows", t_s.size());
  const auto [first, last] = std::ranges::minmax(t_s);
  const auto goes =
      fmt::format("{} {} from {:.9g} to {:.9g} s", file, by_line ? "has these" : "goes", first, last);
  if (keep.empty()) return fmt::format("select leaves none {}; {}", whole, goes);
  double from_s = t_s[keep.front()], to_s = from_s;
  for (const auto row : keep) from_s = std::min(from_s, t_s[row]), to_s = std::max(to_s, t_s[row]);
  return fmt::format("select leaves {} {}, from {:.9g} to {:.9g} s; {} are needed, and {}", keep.size(),
                     whole, from_s, to_s, kFewestSelectedRows, goes);
}

void keep_rows(TrialRecording& recording, RecordingPlaces& places, const std::vector<std::size_t>& keep) {
  const auto pick = [&](auto& values) {
    for (std::size_t k = 0; k < keep.size(); ++k) values[k] = values[keep[k]];
    values.resize(keep.size());
  };
  pick(recording.t_s);
  pick(places.lines);
  for (auto& channel : recording.channels) pick(channel.values);
}

void join_equal_times(TrialRecording& recording, RecordingPlaces& places) {
  bool stepped_back = false;
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < recording.t_s.size(); ++row) {
    const double last_s = keep.empty() ? -INFINITY : recording.t_s[keep.back()];
    if (recording.t_s[row] > last_s) {
      keep.push_back(row);
    } else if (recording.t_s[row] == last_s) {
      for (auto& channel : recording.channels)
        if (std::isnan(channel.values[keep.back()])) channel.values[keep.back()] = channel.values[row];
    } else if (!stepped_back) {
      stepped_back = true;
      note_at_row(recording, places, FindingKind::time_backwards, row,
                  fmt::format("time goes backwards, from {:.9g} to {:.9g} s; row left out", last_s,
                              recording.t_s[row]),
                  "sort the rows, or record with a clock that is not set back");
    }
  }
  if (keep.size() != recording.t_s.size()) keep_rows(recording, places, keep);
}

void note_gaps(TrialRecording& recording, const RecordingPlaces& places) {
  const auto& t_s = recording.t_s;
  if (t_s.size() < 3) return;
  const double usual_s = median_step_s(t_s);
  std::size_t count = 0, largest = 0;
  double largest_s = 0.0;
  for (std::size_t i = 0; i + 1 < t_s.size(); ++i) {
    const double step_s = t_s[i + 1] - t_s[i];
    if (step_s <= kLongestStep * usual_s) continue;
    ++count;
    if (count > 1 && step_s <= largest_s) continue;
    largest = i;
    largest_s = step_s;
  }
  if (count == 0) return;
  const double lost_share = largest_s / (t_s.back() - t_s.front());
  note_at_row(recording, places, FindingKind::gap, largest + 1,
              fmt::format("a gap of {:.6g} s before this row (median step {:.3g} s){}", largest_s, usual_s,
                          count > 1 ? fmt::format(", the largest of {}", count) : ""),
              lost_share > 0.2 ? "much of the trial is missing: record it again if it matters"
                               : "the rows on both sides are used as they are");
}

}  // namespace sandhopper
