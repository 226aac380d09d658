#include "firmware/log/csv_row_times.hpp"

#include <array>
#include <cmath>

namespace sandhopper {
namespace {

constexpr double kDay_s = 86400.0;
constexpr double kCounter = 4294967296.0;  // number of values of 32 bits

// micros() and millis() of an Arduino are 32-bit counters and overflow.
bool is_full_counter(double last, double now) {
  const bool whole = last == std::floor(last) && now == std::floor(now);
  return whole && last < kCounter && now >= 0.0 && last - now > 0.9 * kCounter;
}

}  // namespace

double CsvRowTimes::seconds(const CellTime& time) {
  if (time.has_date) return time.s;
  if (last_of_day_s_ && time.s + midnights_s_ < *last_of_day_s_ - 0.5 * kDay_s) midnights_s_ += kDay_s;
  last_of_day_s_ = time.s + midnights_s_;
  return *last_of_day_s_;
}

CsvRowTimes::Order CsvRowTimes::take(double& time, std::uint64_t line) {
  ++rows_;
  bool wrapped = false;
  if (has_last_ && wraps_ == 0.0 && is_full_counter(last_, time)) wraps_ = kCounter, wrapped = true;
  if (restarts_at_ > 0.0 && has_last_ && time + wraps_ < last_ - 0.5 * restarts_at_) wraps_ += restarts_at_;
  time += wraps_;
  if (recordings_.size() == 1 && time < previous_) first_before_ = previous_, first_step_ = previous_ - time;
  if (recordings_.empty() || time < previous_) recordings_.push_back({line, line, time, time});
  recordings_.back().last_line = line;
  recordings_.back().last = time;
  previous_ = time;
  const auto order = !has_last_ || time > last_ ? (wrapped ? Order::went_on : Order::grows)
                     : time == last_            ? Order::stands
                                                : Order::back;
  if (order == Order::back) {
    ++left_out_;
    return order;
  }
  has_last_ = true;
  last_ = time;
  return order;
}

CsvRowTimes::BackSteps CsvRowTimes::back_steps() const {
  constexpr std::uint64_t kRowsOfARecording = 4;
  const std::uint64_t steps = recordings_.empty() ? 0 : recordings_.size() - 1;
  if (2 * steps > rows_) return BackSteps::upside_down;
  const bool long_ones = steps > 0 && left_out_ >= kRowsOfARecording * steps;
  return long_ones ? BackSteps::several_recordings : BackSteps::slips;
}

std::string CsvRowTimes::recordings() const {
  constexpr std::size_t kShown = 6;
  std::string text = "lines ";
  for (std::size_t i = 0; i < recordings_.size() && i < kShown; ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(recordings_[i].first_line) + " to " +
            std::to_string(recordings_[i].last_line);
  return recordings_.size() > kShown ? text + ", …" : text;
}

double CsvRowTimes::full_at() const {
  // Parts of a second in ms and in seconds, seconds and minutes, hours, seconds of an hour and of a day.
  constexpr std::array kFull{1.0, 24.0, 60.0, 1000.0, 3600.0, kDay_s, 1e6, 1e9};
  double moved = 0.0;
  for (const auto& recording : recordings_) moved += recording.last - recording.first;
  const auto steps = static_cast<double>(rows_ - recordings_.size());
  if (recordings_.size() < 2 || !(steps > 0.0) || !(moved > 0.0)) return 0.0;
  const double usual = moved / steps;
  for (const double full : kFull) {
    bool fits = 10.0 * usual < full;
    for (std::size_t i = 1; i < recordings_.size() && fits; ++i) {
      const double before = recordings_[i - 1].last, after = recordings_[i].first;
      fits = before <= full && after >= 0.0 && full - before + after <= 2.0 * usual;
    }
    if (fits) return full;
  }
  return 0.0;
}

std::string CsvRowTimes::clock_set_back() const {
  // Rows of one recording are less than a minute apart.
  const auto is_back_by = [&](double step) { return std::abs(first_step_ - step) < 60.0; };
  constexpr double kHalfDay_s = 43200.0;
  if (is_back_by(kHalfDay_s))
    return "; or, because the step is half a day, a clock of 12 hours without AM and PM: export hours from 0 "
           "to 23";
  if (const double full = full_at(); full > 0.0)
    return "; or, because it begins again whenever " + shown_number(full) +
           " is reached, a part of the time as the seconds of a minute: then write [format] time_restarts_at "
           "= " +
           shown_number(full) +
           ", or add the column of the larger part, plus = { column = \"NAME\", scale = … }";
  for (const int bits : {16, 24}) {
    // The largest value, and a step back by nearly all of the counter's values.
    const double values = std::ldexp(1.0, bits);
    const bool is_whole =
        first_before_ == std::floor(first_before_) && first_step_ == std::floor(first_step_);
    if (is_whole && first_before_ < values && first_step_ > 0.9 * values)
      return "; or a counter of " + std::to_string(bits) + " bits that is full and begins again: add " +
             std::to_string(1 << bits) + " to the rows behind each such step";
  }
  return std::string("; or the clock was set back") +
         (is_back_by(3600.0) ? " by an hour, as at the end of summer time" : ": record with one that is not");
}

}  // namespace sandhopper
