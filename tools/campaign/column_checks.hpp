#pragma once
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

// Checks of a column's raw numbers, before they are scaled.
namespace sandhopper {

// A number that programs write for "no sample" (-999, 32767, 9.97e36). It must occur exactly, and be more
// than three times as large as every other value. Returns an empty optional if there is none.
struct FillValue {
  double value = 0.0;
  std::size_t rows = 0;
  std::size_t first_row = 0;
};
std::optional<FillValue> fill_value_in(const std::vector<double>& values);

// A reason to doubt that times are in s, for a file and a mapping without a unit of time: whole numbers more
// than 1 apart, or days as counted by spreadsheets (45210.52) and MATLAB (738910.52).
struct TimeDoubt {
  std::string what;
  std::string cure;
};
std::optional<TimeDoubt> doubt_time(const std::vector<double>& times, const std::string& column);

// Unwraps an angle that is counted within one turn: only if the values span 0.9 to 1 turn. A step of more
// than half a turn between neighbouring samples counts as a turn the other way. So an axis that turns by more
// than half a turn from sample to sample is read wrongly. Returns the number of such steps.
std::size_t put_turns_back(std::vector<double>& angle_rad);

// The same for a counter of any other width, 16 bits for example. A jump must be alike each time, at least
// twice, and span 0.8 of all values, while the steps on both sides of it go the other way: so a motion from
// stop to stop does not count. `width`: mean of the jumps without the motion between the samples.
struct CounterSteps {
  std::size_t count = 0;
  double width = 0.0;
};
CounterSteps put_counter_back(std::vector<double>& values);

// Both. Returns what was done, in words; empty if nothing was.
std::string put_angle_back(std::vector<double>& angle_rad);

// True if every value equals the time of its row: then the names stand above the wrong columns.
bool equals_time(const std::vector<double>& values, const std::vector<double>& times);

}  // namespace sandhopper
