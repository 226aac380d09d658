#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "drivers/can/cubemars.hpp"

// Replies of a real AK80-6, recorded by another laboratory as the values that its drive sent. They are exact
// multiples of the reply's counts, so the payloads can be rebuilt bit for bit.
namespace sandhopper::pendulum {

struct Grid {
  double range;
  double counts;  // 2^bits - 1

  int count(double value) const {
    return static_cast<int>(std::lround((value + range) * counts / (2.0 * range)));
  }
  double value(int count) const { return -range + count * (2.0 * range) / counts; }
};

inline constexpr Grid kPosition{95.5, 65535.0};
inline constexpr Grid kVelocity{45.0, 4095.0};
inline constexpr Grid kTorque{18.0, 4095.0};

struct Row {
  std::int64_t time_ns;
  double position_rad, velocity_radps, torque_Nm;  // as printed in the file
  int position, velocity, torque;                  // in counts of the reply's fields

  // is_near: equal to the printed digits. is_exactly: the same doubles as the formula of the counts gives.
  bool is_near(const MotorSample& s) const {
    constexpr double kPrinted = 0.501e-8;
    return std::abs(s.position_rad - position_rad) <= kPrinted &&
           std::abs(s.velocity_radps - velocity_radps) <= kPrinted &&
           std::abs(s.current_A - torque_Nm) <= kPrinted;
  }
  bool is_exactly(const MotorSample& s) const {
    return s.position_rad == kPosition.value(position) && s.velocity_radps == kVelocity.value(velocity) &&
           s.current_A == kTorque.value(torque);
  }

  std::array<std::uint8_t, 6> payload() const {
    const std::array<int, 6> bytes{1,
                                   position >> 8,
                                   position & 0xFF,
                                   velocity >> 4,
                                   ((velocity & 0xF) << 4) | (torque >> 8),
                                   torque & 0xFF};
    std::array<std::uint8_t, 6> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint8_t>(bytes[i]);
    return out;
  }
};

// Configuration of the drive that answered; the recorded torques are used as currents.
inline CanConfig drive() {
  CanConfig config;
  config.motor_count = 1;
  auto& motor = config.motor[0];
  motor.can_id = 1;
  motor.reply = ReplyFlavour::plain;
  motor.position_range_rad = kPosition.range;
  motor.velocity_range_radps = kVelocity.range;
  motor.torque_range_Nm = kTorque.range;
  motor.torque_constant_Nm_per_A = motor.drive_torque_constant_Nm_per_A = 1.0;
  return config;
}

inline std::filesystem::path folder(const std::filesystem::path& source_directory) {
  const char* elsewhere = std::getenv("SANDHOPPER_SHARED_DATA");
  const auto shared =
      elsewhere != nullptr ? std::filesystem::path(elsewhere) : source_directory / ".." / "shared" / "data";
  return shared / "pendulum_ak80_6";
}

// Throws std::runtime_error if the file has another format.
inline std::vector<Row> read(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line != "time,position,velocity,torque")
    throw std::runtime_error(path.string() + " does not begin with time,position,velocity,torque");
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    double time_s{}, p{}, v{}, t{};
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &time_s, &p, &v, &t) != 4)
      throw std::runtime_error(path.string() + ": not four numbers: " + line);
    rows.push_back({static_cast<std::int64_t>(std::llround(time_s * 1e9)), p, v, t, kPosition.count(p),
                    kVelocity.count(v), kTorque.count(t)});
  }
  return rows;
}

}  // namespace sandhopper::pendulum
