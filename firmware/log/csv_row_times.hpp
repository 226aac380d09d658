#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/csv_cells.hpp"

// Times of a table's rows, in the order of the file.
namespace sandhopper {

class CsvRowTimes {
 public:
  // `restarts_at`: the time begins again at 0 there, as the seconds of a minute; 0: it does not.
  explicit CsvRowTimes(double restarts_at = 0.0) : restarts_at_(restarts_at) {}

  // Time [s]. A time of day continues beyond midnight; a time with a date is returned unchanged.
  double seconds(const CellTime& time);

  // Compares a row's time with that of the last kept row. `went_on`: a microcontroller's 32-bit counter
  // overflowed and `time` was increased accordingly.
  enum class Order : std::uint8_t { grows, went_on, stands, back };
  Order take(double& time, std::uint64_t line);
  double last() const { return last_; }

  // Common cause of the rows whose time goes back: a few single slips, several recordings one below the other
  // (the time starts again and then grows), or a table in reverse order.
  enum class BackSteps : std::uint8_t { slips, several_recordings, upside_down };
  BackSteps back_steps() const;
  std::string recordings() const;  // "lines 2 to 41, 43 to 82"
  // Text of another possible cause: a clock that was set back, e.g. by an hour at the end of summer time, or
  // a part of the time that begins again when it is full.
  std::string clock_set_back() const;

 private:
  double midnights_s_ = 0.0;
  std::optional<double> last_of_day_s_{};
  // Value at which the time begins again in each step back, such as 60 s; 0 if there is none.
  double full_at() const;

  double restarts_at_;
  double wraps_ = 0.0;  // sum of the counter's overflows
  bool has_last_ = false;
  double last_ = 0.0;                             // time of the last kept row
  double previous_ = 0.0;                         // time of the previous row, kept or not
  double first_step_ = 0.0, first_before_ = 0.0;  // size of the first step back, and the time before it
  std::uint64_t rows_ = 0, left_out_ = 0;
  struct Recording {
    std::uint64_t first_line, last_line;
    double first, last;
  };
  std::vector<Recording> recordings_;
};

}  // namespace sandhopper
