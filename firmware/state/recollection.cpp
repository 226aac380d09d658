#include "firmware/state/recollection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "drivers/clock.hpp"
#include "firmware/supervision/thermal_model.hpp"

namespace sandhopper {
namespace {

constexpr double kHotShare = 0.8;
constexpr int kCoolingSteps = 1000;
constexpr double kHeatingStep_s = 1e-2;  // time step; the time constants exceed 0.4 s
                                         // (config/consistency.hpp)

struct Age {
  double seconds = 0.0;
  std::string by;  // method, for the message
};

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

bool of_boot(const StateRead& read, const StateClock& now) {
  return read.state && read.state->boot_id == now.boot_id && !now.boot_id.empty();
}

// Age of a lasting state of an earlier boot; empty if the date went backwards.
std::optional<Age> age_across_boots(const KeptState& state, const StateClock& now) {
  const Age since_boot{seconds(now.boottime_ns), "since this boot, the clocks are not synchronised"};
  const double elapsed_s = seconds(now.realtime_ns) - seconds(state.realtime_ns);
  if (elapsed_s < 0.0) return std::nullopt;
  if (!now.synchronised || !state.clock_synchronised) return since_boot;
  return Age{elapsed_s, "by the date"};
}

// Heats winding and housing at the torque limit, because a run that did not end in order may have gone on
// after its last write.
void heat(const RobotConfig& robot, std::size_t motor, double time_s, double& winding_C, double& housing_C) {
  ThermalModel model(robot.supervision, winding_C, housing_C);
  const auto& m = robot.motor[motor];
  const double current_A = robot.limits.motor_torque_Nm / (m.torque_constant_Nm_per_A * m.gear_ratio);
  for (double t = 0.0; t < time_s; t += kHeatingStep_s) model.step(current_A, kHeatingStep_s);
  winding_C = model.winding_C();
  housing_C = model.housing_C();
}

Recollection remembered(const KeptState& state, const Age& age, const RobotConfig& robot) {
  Recollection out;
  out.trusted = true;
  out.start.temperatures_known = true;
  out.start.winding_C = state.winding_C;
  out.start.housing_C = state.housing_C;
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    auto& winding = out.start.winding_C[i];
    auto& housing = out.start.housing_C[i];
    if (!state.closed) heat(robot, i, state.period_s, winding, housing);
    cool(robot.supervision, age.seconds, winding, housing);
  }
  out.text = fmt::format(
      "windings {:.1f} and {:.1f} C, housings {:.1f} and {:.1f} C, from a state of {:.0f} s ago "
      "({}){}",
      out.start.winding_C[0], out.start.winding_C[1], out.start.housing_C[0], out.start.housing_C[1],
      age.seconds, age.by, state.closed ? "" : "; that run did not end in order");
  return out;
}

Recollection assumed_hot(const RobotConfig& robot, const std::string& because) {
  Recollection out;
  out.start.temperatures_known = true;
  out.start.winding_C.fill(hot_C(robot.supervision));
  out.start.housing_C.fill(hot_C(robot.supervision));
  out.text = fmt::format(
      "{}: the motors are assumed to be hot, {:.0f} C; where they are at room temperature by "
      "touch, start hopperd with --motors-cold",
      because, hot_C(robot.supervision));
  return out;
}

Recollection temperatures(const StateRead& boot, const StateRead& lasting, const StateClock& now,
                          const RobotConfig& robot) {
  if (of_boot(boot, now)) {
    const double age_s = seconds(now.boottime_ns - boot.state->boottime_ns);
    if (age_s >= 0.0) return remembered(*boot.state, {age_s, "in this boot"}, robot);
    return assumed_hot(robot, "the state is younger than now");
  }
  if (boot.there && !boot.state)
    return assumed_hot(robot, "this boot's state cannot be read: " + boot.problem);
  if (of_boot(lasting, now)) return assumed_hot(robot, "this boot's newest state is gone");
  if (!lasting.state)
    return assumed_hot(
        robot, lasting.there ? "the state cannot be read: " + lasting.problem : "no state was kept yet");
  const auto age = age_across_boots(*lasting.state, now);
  if (!age) return assumed_hot(robot, "the date is earlier than the state's");
  return remembered(*lasting.state, *age, robot);
}

// True if a time server synchronised the date or a battery-backed clock set it at boot.
bool date_can_be_trusted() {
  std::error_code error;
  if (std::filesystem::exists("/run/systemd/timesync/synchronized", error)) return true;
  for (const auto& clock : std::filesystem::directory_iterator("/sys/class/rtc", error)) {
    int sets_date = 0;
    std::ifstream(clock.path() / "hctosys") >> sets_date;
    if (sets_date == 1) return true;
  }
  return false;
}

std::string turned_over(const KeptState& state, const RobotConfig& robot) {
  for (std::size_t i = 0; state.positions_known && i < kMotorCount; ++i) {
    const auto& m = robot.motor[i];
    const double drive_rad = (state.position_rad[i] - m.zero_offset_rad) * m.gear_ratio;
    if (std::abs(drive_rad) > m.position_range_rad)
      return fmt::format(
          "motor {} stood at {:.2f} rad, past the end of its drive's range, when the state was "
          "kept: its drive now counts from another turn; zero it again",
          m.name, state.position_rad[i]);
  }
  return {};
}

}  // namespace

StateClock state_clock() {
  StateClock clock;
  // A sandboxed service cannot read /proc/sys, so its unit passes the boot id.
  if (const char* given = std::getenv("SANDHOPPER_BOOT_ID"); given != nullptr)
    clock.boot_id = given;
  else
    std::ifstream("/proc/sys/kernel/random/boot_id") >> clock.boot_id;
  std::erase(clock.boot_id, '-');
  clock.boottime_ns = clock_ns(CLOCK_BOOTTIME);
  clock.realtime_ns = clock_ns(CLOCK_REALTIME);
  clock.synchronised = date_can_be_trusted();
  return clock;
}

Recollection recollect(const StateRead& boot, const StateRead& lasting, const StateClock& now,
                       const RobotConfig& robot) {
  auto out = temperatures(boot, lasting, now, robot);
  // Counts and faults do not depend on age: take them from the newer readable state.
  const auto* newest = lasting.state ? &*lasting.state : nullptr;
  if (boot.state && (newest == nullptr || boot.state->touchdowns >= newest->touchdowns))
    newest = &*boot.state;
  if (newest == nullptr) return out;
  out.start.touchdowns = newest->touchdowns;
  // An orderly restart ends this fault, as its entry says. After a crash it stays, because it may not have
  // been noticed.
  if (!newest->closed && entry_of(newest->fault).latch == Latch::until_restart)
    out.start.fault = newest->fault;
  out.positions = turned_over(*newest, robot);
  return out;
}

double hot_C(const SupervisionConfig& c) noexcept {
  return c.ambient_C + kHotShare * (c.winding_temperature_C - c.ambient_C);
}

// Implicit Euler step of the two-body thermal model:
// (1 + dt a) w - dt a h = w0,  -dt b w + (1 + dt (b + g)) h = h0 + dt g ambient
void cool(const SupervisionConfig& c, double age_s, double& winding_C, double& housing_C) noexcept {
  const double dt = age_s / kCoolingSteps;
  const double a = 1.0 / (c.winding_resistance_K_per_W * c.winding_capacity_J_per_K);
  const double b = 1.0 / (c.winding_resistance_K_per_W * c.housing_capacity_J_per_K);
  const double g = 1.0 / (c.housing_resistance_K_per_W * c.housing_capacity_J_per_K);
  const double m11 = 1.0 + dt * a, m12 = -dt * a, m21 = -dt * b, m22 = 1.0 + dt * (b + g);
  const double determinant = m11 * m22 - m12 * m21;
  double winding = winding_C - c.ambient_C, housing = housing_C - c.ambient_C;
  for (int step = 0; step < kCoolingSteps; ++step) {
    const double next = (m22 * winding - m12 * housing) / determinant;
    housing = (m11 * housing - m21 * winding) / determinant;
    winding = next;
  }
  winding_C = c.ambient_C + winding;
  housing_C = c.ambient_C + housing;
}

}  // namespace sandhopper
