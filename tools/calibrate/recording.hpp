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

// Sensor samples of one recording: every fresh sample once, with its own time.
struct Recording {
  std::string name{};
  std::int64_t begin_ns = 0;  // time 0 of a table, or the first cycle of a log
  std::array<std::vector<MotorSample>, kMotorCount> motor{};
  std::vector<ImuSample> imu_body{};
  std::vector<ImuSample> imu_foot{};
  std::vector<TofSample> tof{};
  std::vector<LoadCellSample> load_cell{};

  void add(const SensorFrame& frame);
};

// Reads a trial's or calibration's log (.mcap), or a CSV file with the columns of a recording (README.md). A
// log that carries its configuration (as logs of `hopperd` and of `hop calibrate` on devices do) is converted
// from it to `board`. All other samples are taken as recorded with `board`. Throws std::runtime_error with
// file and cause.
Recording read_recording(const std::filesystem::path& file, const LinuxBoardConfig& board);

// A quantity of the samples against the time in seconds since the first sample.
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
