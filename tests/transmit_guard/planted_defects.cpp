#include "tests/transmit_guard/planted_defects.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace sandhopper::faults {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Frame = const can_frame&;
using Frames = std::function<void(Frame, const Send&)>;

// Frames to enter or leave motor mode, which the defects leave unchanged.
bool is_special(Frame frame) {
  return frame.can_dlc == 8 && std::all_of(frame.data, frame.data + 7, [](auto b) { return b == 0xFF; });
}
Frames altering(std::function<void(can_frame& frame)> alter) {
  return [alter = std::move(alter)](Frame frame, const Send& send) {
    can_frame out = frame;
    if (!is_special(frame)) alter(out);
    send(out);
  };
}

unsigned torque_code(Frame f) { return (f.data[6] & 0x0FU) << 8 | f.data[7]; }
void set_torque_code(can_frame& f, unsigned code) {
  f.data[6] = static_cast<std::uint8_t>((f.data[6] & 0xF0U) | code >> 8);
  f.data[7] = static_cast<std::uint8_t>(code & 0xFFU);
}
bool has_torque(Frame f) {
  if (f.can_dlc == 4) return std::any_of(f.data, f.data + 4, [](auto b) { return b != 0; });
  return !is_special(f) && torque_code(f) != 0x7FF && torque_code(f) != 0x800;
}
std::int32_t current_mA(Frame f) {
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits = bits << 8 | f.data[i];
  return static_cast<std::int32_t>(bits);
}
void set_current_mA(can_frame& f, std::int32_t value) {
  for (int i = 0; i < 4; ++i)
    f.data[i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (24 - 8 * i));
}

// Sends the same command to every motor.
std::function<void(const StepOutput&, Command&, Fault&)> commanding(const MotorCommand& motor) {
  return [motor](const StepOutput&, Command& command, Fault&) {
    command.drive = DriveRequest::run;
    command.motor.fill(motor);
  };
}

// Sends the last frame with torque again.
Frames resending_torque() {
  return [last = std::vector<can_frame>{}](Frame frame, const Send& send) mutable {
    if (has_torque(frame)) {
      std::erase_if(last, [&](Frame f) { return f.can_id == frame.can_id; });
      last.push_back(frame);
      return send(frame);
    }
    const auto stale = std::ranges::find(last, frame.can_id, &can_frame::can_id);
    send(stale == last.end() ? frame : *stale);
  };
}

std::vector<Defect> of_the_controller_hopping() {
  const auto clamped = [](const StepOutput&, Command& command, Fault&) {
    for (auto& motor : command.motor) motor.torque_Nm *= 20.0;
  };
  return {
      {.name = "torque clamp removed", .command = clamped},
      {.name = "torque clamp removed, v3", .dialect = Dialect::v3, .command = clamped},
      {.name = "gains at full scale",
       .command = commanding({.position_rad = 1.0, .kp_Nm_per_rad = 1e9, .kd_Nm_s_per_rad = 1e9})},
      {.name = "velocity set-point with damping while hopping",
       .command = commanding({.velocity_radps = 39.0, .kd_Nm_s_per_rad = 0.3})},
      {.name = "position set-point outside the leg's angles",
       .command = commanding({.position_rad = 3.0, .kp_Nm_per_rad = 5.0})},
  };
}

std::vector<Defect> of_the_controller_stopped() {
  const auto ignoring = [](double torque_Nm) { return commanding({.torque_Nm = torque_Nm}); };
  return {
      {.name = "torque after the e-stop", .occasion = Occasion::stop_open, .command = ignoring(0.5)},
      {.name = "damping after the e-stop",
       .occasion = Occasion::stop_open,
       .command = commanding({.kd_Nm_s_per_rad = 0.1})},
      {.name = "torque again when the e-stop closes, fault latched",
       .occasion = Occasion::stop_tapped,
       .command = ignoring(0.5)},
      {.name = "torque after a fault that ends limp",
       .occasion = Occasion::limp_fault,
       .command = ignoring(0.5)},
      {.name = "enter motor mode on a latched fault",
       .occasion = Occasion::limp_fault,
       .command =
           [n = 0](const StepOutput&, Command& command, Fault&) mutable {
             if (++n > 20) command.drive = DriveRequest::enable;  // by then the drives have left motor mode
           }},
  };
}

std::vector<Defect> of_the_controller_reacting() {
  return {
      {.name = "torque left on while damping",
       .occasion = Occasion::damp_fault,
       .command =
           [](const StepOutput&, Command& command, Fault&) {
             for (auto& m : command.motor) m.torque_Nm = 0.3;
           }},
      {.name = "stiffness left on while damping",
       .occasion = Occasion::damp_fault,
       .command =
           [](const StepOutput&, Command& command, Fault&) {
             for (auto& m : command.motor) m.kp_Nm_per_rad = 10.0, m.position_rad = 1.0;
           }},
      {.name = "damping above its limit",
       .occasion = Occasion::damp_fault,
       .command =
           [](const StepOutput&, Command& command, Fault&) {
             for (auto& m : command.motor) m.kd_Nm_s_per_rad *= 3.0;
           }},
      {.name = "damping towards a moving set-point",
       .occasion = Occasion::damp_fault,
       .command =
           [](const StepOutput&, Command& command, Fault&) {
             for (auto& m : command.motor) m.velocity_radps = 5.0;
           }},
      {.name = "torque while holding",
       .occasion = Occasion::hold_fault,
       .command =
           [](const StepOutput&, Command& command, Fault&) {
             for (auto& m : command.motor) m.torque_Nm = 0.3;
           }},
      {.name = "hold at a wrong angle",
       .occasion = Occasion::hold_fault,
       .command =
           [](const StepOutput&, Command& command, Fault&) {
             for (auto& m : command.motor) m.position_rad += 0.5;
           }},
      {.name = "hold stiffness ten times too high",
       .occasion = Occasion::hold_fault,
       .command =
           [](const StepOutput&, Command& command, Fault&) {
             for (auto& m : command.motor) m.kp_Nm_per_rad *= 10.0;
           }},
  };
}

std::vector<Defect> of_the_mit_codec() {
  return {
      {.name = "torque in millinewton metres",
       .frames = altering([](can_frame& f) {
         const double off = 1000.0 * (torque_code(f) - 2047.5);
         if (has_torque(f)) set_torque_code(f, static_cast<unsigned>(std::clamp(2047.5 + off, 0.0, 4095.0)));
       })},
      {.name = "not a number packed as code 0",
       .command = commanding({.torque_Nm = kNaN}),
       .frames =
           [](Frame frame, const Send& send) {
             can_frame out = frame;
             if (has_torque(frame)) set_torque_code(out, 0);
             send(out);
           }},
      {.name = "full scale wraps to 2^n", .frames = altering([](can_frame& f) {
                                            if (!has_torque(f)) return;
                                            f.data[6] = static_cast<std::uint8_t>(f.data[6] +
                                                                                  // carry into the Kd field
                                                                                  0x10);
                                            set_torque_code(f, 0);
                                          })},
      {.name = "gain at full scale",
       .frames = altering([](can_frame& f) { f.data[3] |= 0x0F, f.data[4] = 0xFF; })},
      {.name = "layout of the V3 board",
       .frames = altering([](can_frame& f) {
         const can_frame m = f;
         f.data[0] = static_cast<std::uint8_t>((m.data[3] & 0x0F) << 4 | m.data[4] >> 4);
         f.data[1] = static_cast<std::uint8_t>((m.data[4] & 0x0F) << 4 | m.data[5] >> 4);
         f.data[2] = static_cast<std::uint8_t>((m.data[5] & 0x0F) << 4 | m.data[6] >> 4);
         f.data[3] = m.data[0], f.data[4] = m.data[1], f.data[5] = m.data[2];
         f.data[6] = static_cast<std::uint8_t>((m.data[3] & 0xF0) | (m.data[6] & 0x0F));
       })},
      {.name = "bytes in reverse order",
       .frames = altering([](can_frame& f) { std::reverse(f.data, f.data + 8); })},
  };
}

std::vector<Defect> of_the_mit_driver() {
  return {
      {.name = "identifier of no motor", .frames = altering([](can_frame& f) { f.can_id += 7; })},
      {.name = "identifier of the other motor",
       .frames =
           [](Frame frame, const Send& send) {
             can_frame out = frame;
             if (has_torque(frame)) out.can_id = 2;
             send(out);
           }},
      {.name = "extended identifier", .frames = altering([](can_frame& f) { f.can_id |= CAN_EFF_FLAG; })},
      {.name = "remote frame", .frames = altering([](can_frame& f) { f.can_id |= CAN_RTR_FLAG; })},
      {.name = "seven bytes", .frames = altering([](can_frame& f) { f.can_dlc = 7; })},
      {.name = "set zero for leave",
       .frames =
           [](Frame frame, const Send& send) {
             can_frame out = frame;
             if (is_special(frame) && frame.data[7] == 0xFD) out.data[7] = 0xFE;
             send(out);
           }},
      {.name = "run frame without an enter frame",
       .frames =
           [](Frame frame, const Send& send) {
             if (!is_special(frame) || frame.data[7] != 0xFC) send(frame);
           }},
      {.name = "enter frame as a keep-alive while running",
       .frames =
           [n = 0](Frame frame, const Send& send) mutable {
             can_frame out = frame;
             if (has_torque(frame) && ++n % 50 == 0) std::fill_n(out.data, 7, 0xFF), out.data[7] = 0xFC;
             send(out);
           }},
      {.name = "two frames in one cycle",
       .frames =
           [](Frame frame, const Send& send) {
             send(frame);
             if (has_torque(frame)) send(frame);
           }},
      {.name = "stale torque after the e-stop",
       .occasion = Occasion::stop_open,
       .frames = resending_torque()},
      {.name = "stale torque after a fault", .occasion = Occasion::damp_fault, .frames = resending_torque()},
      {.name = "frames sent twice as often", .begin_cycles = 2},
  };
}

std::vector<Defect> of_the_other_drivers() {
  return {
      {.name = "servo: amperes taken for milliamperes, thousandfold",
       .dialect = Dialect::servo,
       .frames = altering([](can_frame& f) {
         set_current_mA(f, static_cast<std::int32_t>(std::clamp(1000.0 * current_mA(f), -2e9, 2e9)));
       })},
      {.name = "servo: little-endian current",
       .dialect = Dialect::servo,
       .frames = altering([](can_frame& f) { std::reverse(f.data, f.data + 4); })},
      {.name = "servo: mode duty for current",
       .dialect = Dialect::servo,
       .frames = altering([](can_frame& f) { f.can_id &= ~0x100U; })},
      {.name = "servo: damping with the wrong sign",
       .dialect = Dialect::servo,
       .occasion = Occasion::damp_fault,
       .command =
           [](const StepOutput&, Command& command, Fault&) {
             for (auto& m : command.motor) m.kd_Nm_s_per_rad *= -1.0;
           }},
      {.name = "v3: layout of the V2 board",
       .dialect = Dialect::v3,
       .frames = altering([](can_frame& f) {
         const can_frame v = f;
         f.data[0] = v.data[3], f.data[1] = v.data[4], f.data[2] = v.data[5];
         f.data[3] = static_cast<std::uint8_t>((v.data[6] & 0xF0) | v.data[0] >> 4);
         f.data[4] = static_cast<std::uint8_t>((v.data[0] & 0x0F) << 4 | v.data[1] >> 4);
         f.data[5] = static_cast<std::uint8_t>((v.data[1] & 0x0F) << 4 | v.data[2] >> 4);
         f.data[6] = static_cast<std::uint8_t>((v.data[2] & 0x0F) << 4 | (v.data[6] & 0x0F));
       })},
      {.name = "v3: standard identifier", .dialect = Dialect::v3, .frames = altering([](can_frame& f) {
                                                                    f.can_id &= 0xFF;
                                                                  })},
      {.name = "v3: frames three times as often", .dialect = Dialect::v3, .begin_cycles = 3},
  };
}

}  // namespace

std::vector<Defect> all_defects() {
  std::vector<Defect> all;
  for (const auto& part :
       {of_the_controller_hopping(), of_the_controller_stopped(), of_the_controller_reacting(),
        of_the_mit_codec(), of_the_mit_driver(), of_the_other_drivers()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace sandhopper::faults
