#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"
#include "firmware/sensor_frame.hpp"
#include "tools/calibrate/still.hpp"

namespace sandhopper::calibrate {

// What the sensors said in one recording, every fresh sample once, at its own time.
struct Recording {
  std::string name{};
  std::int64_t begin_ns = 0;  // zero of a table's time, the first cycle of a log
  std::array<std::vector<MotorSample>, kMotorCount> motor{};
  std::vector<ImuSample> imu_body{};
  std::vector<ImuSample> imu_foot{};
  std::vector<TofSample> tof{};
  std::vector<LoadCellSample> load_cell{};

  void add(const SensorFrame& frame);
};

// A trial's or calibration's log (.mcap), or a CSV file with the columns of a recording (README.md). The
// samples are those that the configuration `board` makes of the devices' raw figures: a log that carries the
// one it was recorded with (as all logs of `hopperd` and `hop calibrate` on devices do) is converted,
// anything else is taken to be recorded with `board`. Throws std::runtime_error with file and cause.
Recording read_recording(const std::filesystem::path& file, const LinuxBoardConfig& board);

// Time in seconds from the first sample, and one figure.
template <class Sample, class Figure>
Series series_of(const std::vector<Sample>& samples, Figure&& figure) {
  Series out;
  for (const auto& sample : samples) {
    out.time_s.push_back(static_cast<double>(sample.time_ns - samples.front().time_ns) * 1e-9);
    out.value.push_back(figure(sample));
  }
  return out;
}

}  // namespace sandhopper::calibrate
