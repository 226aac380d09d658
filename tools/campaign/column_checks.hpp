#pragma once
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

// A column's numbers tell how they were written; looked at before anything is computed from them.
namespace sandhopper {

// A number that programs write where there is no sample (-999, 32767, 9.97e36): in the column at least once,
// exactly, and more than three times as large as every other value. Nothing where there is none.
struct FillValue {
  double value = 0.0;
  std::size_t rows = 0;
  std::size_t first_row = 0;
};
std::optional<FillValue> fill_value_in(const std::vector<double>& values);

// Times whose unit neither the file nor the mapping states, and which are likely to be no seconds: whole
// numbers more than 1 apart, or days as spreadsheets (45210.52) and MATLAB (738910.52) count them. Empty
// where nothing is to be said; else what, with {} in the place of nothing.
struct TimeDoubt {
  std::string what;
  std::string cure;
};
std::optional<TimeDoubt> doubt_time(const std::vector<double>& times, const std::string& column);

// Puts the turns back into an angle that is counted within one: a step of a whole turn (0.9 to 1.1 of 2 pi)
// between neighbouring samples, in values that span one turn at most. Number of such steps.
std::size_t put_turns_back(std::vector<double>& angle_rad);

// A channel whose every value is the row's time: the names stand over the wrong columns.
bool equals_time(const std::vector<double>& values, const std::vector<double>& times);

}  // namespace sandhopper
