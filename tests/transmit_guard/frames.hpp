#pragma once
#include <linux/can.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>

// Frames built for these tests from the tables of the drives' manuals.
namespace sandhopper::transmit {

inline can_frame bytes_of(std::uint32_t id, std::initializer_list<int> bytes) {
  can_frame frame{};
  frame.can_id = id;
  for (const int byte : bytes) frame.data[frame.can_dlc++] = static_cast<std::uint8_t>(byte);
  return frame;
}

// Codes of the fields, rounded to nearest: P +-12.5, V +-50, Kp 500, Kd 5, T +-18.
struct LawFields {
  double position_rad = 0.0, velocity_radps = 0.0, kp = 0.0, kd = 0.0, torque_Nm = 0.0;
};

inline std::uint64_t code(double value, double low, double high, unsigned bits) {
  const double most = std::pow(2.0, bits) - 1.0;
  return static_cast<std::uint64_t>(std::lround((value - low) / (high - low) * most));
}

inline can_frame big_endian_frame(std::uint32_t id, std::uint64_t bits) {
  can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = 8;
  for (int i = 0; i < 8; ++i) frame.data[i] = static_cast<std::uint8_t>(bits >> (56 - 8 * i));
  return frame;
}

inline can_frame mit_law(std::uint32_t id, const LawFields& f) {
  return big_endian_frame(id, code(f.position_rad, -12.5, 12.5, 16) << 48 |
                                  code(f.velocity_radps, -50.0, 50.0, 12) << 36 |
                                  code(f.kp, 0.0, 500.0, 12) << 24 | code(f.kd, 0.0, 5.0, 12) << 12 |
                                  code(f.torque_Nm, -18.0, 18.0, 12));
}

inline can_frame v3_law(std::uint32_t id, const LawFields& f) {
  return big_endian_frame(CAN_EFF_FLAG | 0x800U | id, code(f.kp, 0.0, 500.0, 12) << 52 |
                                                          code(f.kd, 0.0, 5.0, 12) << 40 |
                                                          code(f.position_rad, -12.5, 12.5, 16) << 24 |
                                                          code(f.velocity_radps, -50.0, 50.0, 12) << 12 |
                                                          code(f.torque_Nm, -18.0, 18.0, 12));
}

inline can_frame servo_current(std::uint32_t id, std::int32_t current_mA) {
  can_frame frame{};
  frame.can_id = CAN_EFF_FLAG | 0x100U | id;
  frame.can_dlc = 4;
  for (int i = 0; i < 4; ++i)
    frame.data[i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(current_mA) >> (24 - 8 * i));
  return frame;
}

inline can_frame special(std::uint32_t id, int last) {
  return bytes_of(id, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, last});
}
inline can_frame enter(std::uint32_t id) { return special(id, 0xFC); }
inline can_frame leave(std::uint32_t id) { return special(id, 0xFD); }
inline can_frame set_zero(std::uint32_t id) { return special(id, 0xFE); }

// A drive's answer with the given position and velocity.
inline can_frame mit_reply(std::uint32_t id, double position_rad = 0.0, double velocity_radps = 0.0) {
  auto frame =
      big_endian_frame(0, static_cast<std::uint64_t>(id) << 56 | code(position_rad, -12.5, 12.5, 16) << 40 |
                              code(velocity_radps, -50.0, 50.0, 12) << 28 | 0x7FFULL << 16 | 0x4600U);
  return frame;
}

inline can_frame status(std::uint32_t id, int position_tenth_deg, int speed_10_erpm) {
  const auto u16 = [](int value) { return static_cast<std::uint64_t>(static_cast<std::uint16_t>(value)); };
  return big_endian_frame(CAN_EFF_FLAG | 0x2900U | id, u16(position_tenth_deg) << 48 | u16(speed_10_erpm)
                                                                                           << 32);
}

}  // namespace sandhopper::transmit
