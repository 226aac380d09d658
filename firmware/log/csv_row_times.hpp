#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/csv_cells.hpp"

// The times of a table's rows, in the order of the file.
namespace sandhopper {

class CsvRowTimes {
 public:
  // A time of day goes on beyond midnight. With a date it is as it is.
  double seconds(const CellTime& time);

  // A row's time beside those that were kept before it. `went_on`: a counter of 32 bits of a
  // microcontroller began again at 0, and `time` is put behind the last one.
  enum class Order : std::uint8_t { grows, went_on, stands, back };
  Order take(double& time, std::uint64_t line);
  double last() const { return last_; }

  // The rows whose time goes back, as a whole: a few slips, several recordings one below the other (the time
  // begins again, and then grows), or a table upside down.
  enum class BackSteps : std::uint8_t { slips, several_recordings, upside_down };
  BackSteps back_steps() const;
  std::string recordings() const;  // "lines 2 to 41, 43 to 82"
  // The other cause of a step back: a clock that was set, by an hour at the end of summer time.
  std::string clock_set_back() const;

 private:
  double midnights_s_ = 0.0;
  std::optional<double> last_of_day_s_{};
  double wraps_ = 0.0;  // full counters
  bool has_last_ = false;
  double last_ = 0.0;        // of the rows that were kept
  double previous_ = 0.0;    // of the row before, kept or not
  double first_step_ = 0.0;  // back
  std::uint64_t rows_ = 0, left_out_ = 0;
  struct Recording {
    std::uint64_t first_line, last_line;
  };
  std::vector<Recording> recordings_;
};

}  // namespace sandhopper
