#include "tools/calibrate/recording.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "config/load.hpp"
#include "firmware/log/csv_import.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/log/trial_description.hpp"
#include "tools/calibrate/devices.hpp"

namespace sandhopper::calibrate {
namespace {

template <class Sample>
void take(std::vector<Sample>& samples, const Sample& sample) {
  if (sample.fresh && (samples.empty() || sample.time_ns > samples.back().time_ns)) samples.push_back(sample);
}

template <class Sample, class Config>
void convert_all(std::vector<Sample>& samples, const Config& from, const Config& to) {
  for (auto& sample : samples) sample = converted(sample, from, to);
}

void convert_all(Recording& recording, const LinuxBoardConfig& from, const LinuxBoardConfig& to) {
  for (std::size_t i = 0; i < kMotorCount; ++i)
    convert_all(recording.motor[i], from.can.motor[i], to.can.motor[i]);
  convert_all(recording.imu_body, from.imu_body, to.imu_body);
  convert_all(recording.imu_foot, from.imu_foot, to.imu_foot);
  convert_all(recording.tof, from.tof, to.tof);
  convert_all(recording.load_cell, from.load_cell, to.load_cell);
}

// The configuration that the log carries. Files that it lacks are taken from `board`.
LinuxBoardConfig recorded_with(const mcap::Reader& log, const std::string& file,
                               const LinuxBoardConfig& board) {
  auto out = board;
  for (const auto& attachment : log.attachments()) {
    const auto name = fmt::format("{}: {}", file, attachment.name);
    const auto text = mcap::text_of(attachment.data);
    if (attachment.name == kBoardAttachment) {
      const auto motors = out.can.motor;
      out = load_text<LinuxBoardConfig>(name, text, MissingKeys::use_default);
      out.can.motor = motors;
    }
    if (attachment.name == kRobotAttachment)
      out.can.motor = load_text<RobotConfig>(name, text, MissingKeys::use_default).motor;
  }
  return out;
}

Recording read_log(const std::filesystem::path& file, const LinuxBoardConfig& board) {
  mcap::Reader log(file, {.check_crc = true, .skip_damaged = true});
  Recording out;
  TopicOf<SensorFrame> frames(topic::kFrame);
  SensorFrame frame;
  mcap::Message message;
  std::size_t count = 0;
  while (log.next(message))
    if (frames.take(message, frame)) {
      if (count == 0) out.begin_ns = frame.time_ns;
      out.add(frame);
      ++count;
    }
  if (count == 0)
    throw std::runtime_error(file.string() + ": holds no frame of sensors: name a log of hopperd");
  convert_all(out, recorded_with(log, file.string(), board), board);
  return out;
}

// The cells of one row, by the name of their column.
class Row {
 public:
  explicit Row(const CsvTable& table) : table_(table) {}
  void at(std::size_t row) { row_ = row; }

  // Returns true if all `needed` cells hold a number. An optional cell without a number leaves its value
  // unchanged.
  struct Cell {
    std::string name;
    double* value;
  };
  bool fill(const std::vector<Cell>& needed, const std::vector<Cell>& optional = {}) const {
    for (const auto& [name, value] : needed) {
      const auto* column = table_.find(name);
      if (column == nullptr || std::isnan((*column)[row_])) return false;
      *value = (*column)[row_];
    }
    for (const auto& [name, value] : optional)
      if (const auto* column = table_.find(name); column && !std::isnan((*column)[row_]))
        *value = (*column)[row_];
    return true;
  }

 private:
  const CsvTable& table_;
  std::size_t row_ = 0;
};

void fill_imu(const Row& row, const std::string& name, ImuSample& imu) {
  auto& a = imu.accel_mps2;
  auto& g = imu.gyro_radps;
  imu.fresh = row.fill({{name + "_accel_z_mps2", &a[2]}}, {{name + "_accel_x_mps2", &a[0]},
                                                           {name + "_accel_y_mps2", &a[1]},
                                                           {name + "_gyro_x_radps", &g[0]},
                                                           {name + "_gyro_y_radps", &g[1]},
                                                           {name + "_gyro_z_radps", &g[2]}});
}

SensorFrame frame_of(const Row& row, std::int64_t time_ns, const LinuxBoardConfig& board) {
  SensorFrame frame;
  frame.time_ns = time_ns;
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    const std::string name = i == 0 ? "motor_left" : "motor_right";
    auto& m = frame.motor[i];
    m.fresh = row.fill({{name + "_position_rad", &m.position_rad}},
                       {{name + "_velocity_radps", &m.velocity_radps}, {name + "_current_A", &m.current_A}});
    m.time_ns = time_ns;
  }
  fill_imu(row, "imu_body", frame.imu_body);
  fill_imu(row, "imu_foot", frame.imu_foot);
  frame.tof.fresh = row.fill({{"tof_height_m", &frame.tof.height_m}});
  double voltage_V = 0.0;
  frame.load_cell.fresh = row.fill({{"load_cell_force_N", &frame.load_cell.force_N}});
  if (row.fill({{"load_cell_voltage_V", &voltage_V}})) {
    const auto& cell = board.load_cell;
    frame.load_cell = {time_ns, cell.sign * cell.scale_N_per_V * (voltage_V - cell.zero_V), 0, true};
  }
  frame.imu_body.time_ns = frame.imu_foot.time_ns = frame.tof.time_ns = frame.load_cell.time_ns = time_ns;
  return frame;
}

Recording read_table(const std::filesystem::path& file, const LinuxBoardConfig& board) {
  const auto table = read_csv(file);
  for (const auto& issue : table.issues)
    if (issue.severity == CsvIssue::Severity::error) throw std::runtime_error(describe(file.string(), issue));
  const auto* time = table.find("t_s");
  Recording out;
  Row row(table);
  for (std::size_t i = 0; time != nullptr && i < table.rows(); ++i) {
    row.at(i);
    out.add(frame_of(row, std::llround((*time)[i] * 1e9), board));
  }
  return out;
}

}  // namespace

void Recording::add(const SensorFrame& frame) {
  for (std::size_t i = 0; i < kMotorCount; ++i) take(motor[i], frame.motor[i]);
  take(imu_body, frame.imu_body);
  take(imu_foot, frame.imu_foot);
  if (std::isfinite(frame.tof.height_m)) take(tof, frame.tof);
  take(load_cell, frame.load_cell);
}

Recording read_recording(const std::filesystem::path& file, const LinuxBoardConfig& board) {
  auto out = file.extension() == ".csv" ? read_table(file, board) : read_log(file, board);
  out.name = file.filename().string();
  return out;
}

}  // namespace sandhopper::calibrate
