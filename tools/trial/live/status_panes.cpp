#include "tools/trial/live/status_panes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>

#include "estimation/leg.hpp"

namespace sandhopper {
namespace {

constexpr std::array<std::string_view, 9> kBlocks{" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};

// Right-aligned in eight columns; a dash if the value is unknown.
std::string value_text(double value, int decimals, bool known = true) {
  if (!known || !std::isfinite(value)) return fmt::format("{:>8}", "–");
  return fmt::format("{:8.{}f}", value + 0.0, decimals);
}

std::string upper(std::string_view name) {
  std::string out;
  for (const char c : name)
    out += c == '_' ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

struct StateText {
  std::string text;
  Style style;
};

StateText state_text(const TrialModel& model) {
  if (model.ended) return {"the log is closed", Style::good};
  if (!model.status) return {"", Style::caution};
  switch (model.state()) {
    case State::idle:
      return {model.over ? "the trial is over" : "", Style::plain};
    case State::armed:
      return model.zero_checked ? StateText{"ready to release", Style::good}
                                : StateText{"zero check, keep still", Style::caution};
    case State::flight:
      return {"in the air", Style::good};
    case State::compression:
      return {"the leg shortens", Style::good};
    case State::extension:
      return {"the leg pushes off", Style::good};
    case State::soft_stop:
      return {"coming to rest", Style::caution};
    case State::fault:
      return {"see below", Style::alarm};
  }
  return {};
}

Style state_style(const TrialModel& model) { return model.fault != Fault::none ? Style::alarm : Style::key; }

// Bar for a force between 0 and full scale.
std::string bar(double value, double full, int columns) {
  const double eighths = std::clamp(value / full, 0.0, 1.0) * columns * 8.0;
  static constexpr std::array<std::string_view, 8> kLeft{"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const int whole = static_cast<int>(eighths) / 8;
  std::string out;
  for (int i = 0; i < whole; ++i) out += "█";
  if (std::isfinite(value) && whole < columns) out += kLeft[static_cast<std::size_t>(eighths) % 8];
  return out;
}

constexpr int kIndent = 2;

// The fault, then its cure; empty if there is none.
std::vector<std::string> fault_text(const TrialModel& model) {
  if (!model.error.empty()) return {"ERROR " + model.error};
  if (model.fault == Fault::none) return {};
  const auto& entry = entry_of(model.fault);
  std::vector<std::string> lines{
      fmt::format("FAULT {} {}: {}", static_cast<int>(model.fault), entry.name, entry.meaning)};
  if (!model.fault_values.empty()) lines.push_back(model.fault_values);
  lines.push_back(fmt::format("cure: {}", entry.cure));
  return lines;
}

double leg_length_m(const TrialModel& model) {
  const auto& s = *model.status;
  if (s.estimating) return s.leg_length_m;
  const double angle = 0.5 * (s.motor_position_rad[0] + s.motor_position_rad[1]);
  return Leg(model.config.robot).kinematics(angle).length_m;
}

}  // namespace

Hint hint(const TrialModel& model) {
  if (!model.refusal.empty()) return {model.refusal, Style::caution};
  if (model.ended) return {"", Style::plain};
  if (model.quitting)
    return {"quitting: stopping softly, then the log is closed; q again lets go at once", Style::caution};
  if (!model.ready) return {"starting …", Style::plain};
  if (model.state() == State::fault)
    return {"do what the cure says, then d to disarm, or q to close the log", Style::caution};
  if (model.over)
    return {model.close_after_s > 0.0
                ? fmt::format(
                      "the trial is over: q closes the log, which closes itself after {:g} s without a key",
                      model.close_after_s)
                : "the trial is over: q closes the log, which grows until then",
            Style::good};
  if (model.state() == State::idle) return {model.to_do, Style::plain};
  if (model.state() == State::armed && model.zero_checked)
    return {"hands off the robot, then r releases it", Style::good};
  return {"", Style::plain};
}

void draw_state(Pane& pane, const TrialModel& model) {
  pane.line();
  pane.line();
  const std::string_view state = model.status ? name_of(model.state()) : std::string_view("starting");
  const auto name = fmt::format(" {} ", upper(model.ended ? "ended" : state));
  pane.put(0, name, state_style(model));
  const auto [text, style] = state_text(model);
  pane.put(static_cast<int>(name.size()) + 1, text, style);
  if (!model.status) return;
  const auto& s = *model.status;
  const auto right = fmt::format("drives {:<3}  e-stop {}  bus {}", s.drives_on ? "ON" : "off",
                                 s.emergency_stop ? "PRESSED" : "clear", name_of(s.bus));
  const bool sound = !s.emergency_stop && s.bus == BusState::active;
  pane.put_right(pane.columns(), right, sound ? Style::plain : Style::alarm);
}

void draw_leg_and_forces(Pane& pane, const TrialModel& model) {
  constexpr int kRight = 36;
  const auto s = model.status.value_or(LiveStatus{});
  const bool known = model.status.has_value(), estimated = s.estimating;
  const double full_N = 100.0;
  const int bar_columns = std::max(0, pane.columns() - kRight - 25);
  const auto row = [&](std::string_view left, const std::string& value, std::string_view unit) {
    pane.line();
    pane.put(1, left);
    pane.put(14, value, Style::bold);
    pane.put(23, unit);
  };
  const auto force = [&](std::string_view name, const std::string& value, double force_N) {
    pane.put(kRight, name);
    pane.put(kRight + 13, value, Style::bold);
    pane.put(kRight + 22, "N");
    pane.put(kRight + 25, bar(force_N, full_N, bar_columns), Style::faint);
  };
  pane.heading("Leg and forces");
  row("leg length", value_text(known ? 1e3 * leg_length_m(model) : 0.0, 1, known), "mm");
  force("bed force", value_text(s.bed_force_N, 1, estimated), estimated ? s.bed_force_N : 0.0);
  row("foot height", value_text(1e3 * s.foot_z_m, 1, estimated), "mm");
  force("load cell", value_text(s.load_cell_N, 1, known), s.load_cell_N);
  row("foot speed", value_text(s.foot_velocity_mps, 2, estimated), "m/s");
  pane.put(kRight, "bed force: momentum observer", Style::faint);
}

void draw_motors(Pane& pane, const TrialModel& model) {
  const auto s = model.status.value_or(LiveStatus{});
  const bool known = model.status.has_value();
  pane.heading("Motors");
  pane.put(10, "  angle     current     torque    temperature    supply ", Style::heading);
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    pane.line();
    const double torque_Nm = s.motor_current_A[i] * model.config.torque_constant_Nm_per_A[i];
    const double limit_C = model.config.limits.motor_temperature_C;
    const bool hot = s.motor_temperature_C[i] > limit_C - 10.0;
    pane.put(1, i == 0 ? "left" : "right");
    pane.put(8, value_text(s.motor_position_rad[i] * 180.0 / std::numbers::pi, 1, known) + "°");
    pane.put(20, value_text(s.motor_current_A[i], 2, known) + " A");
    pane.put(31, value_text(torque_Nm, 2, known) + " N m");
    pane.put(44, value_text(s.motor_temperature_C[i], 0, known).substr(3) + " °C",
             hot ? Style::alarm : Style::plain);
    pane.put(53, fmt::format("≤ {:.0f}", limit_C), Style::faint);
    if (hot) pane.put(53, "HOT!", Style::alarm);
    pane.put(59, value_text(s.bus_voltage_V[i], 1, known).substr(2) + " V");
  }
}

std::string log_histogram(const std::array<std::uint64_t, LatencyHistogram::kOctaves>& counts) {
  const double most = static_cast<double>(std::max<std::uint64_t>(2, *std::ranges::max_element(counts)));
  std::string out;
  for (const auto count : counts) {
    const double share =
        count == 0 ? 0.0 : (1.0 + std::log(static_cast<double>(count)) / std::log(most) * 7.0);
    out += kBlocks[static_cast<std::size_t>(std::lround(share))];
  }
  return out;
}

void draw_cycle(Pane& pane, const TrialModel& model) {
  const auto s = model.status.value_or(LiveStatus{});
  const bool known = model.status.has_value();
  pane.heading("Cycle, 1 kHz");
  pane.line();
  pane.put(1, "woke late by");
  pane.put(14, value_text(s.late_us, 0, known), Style::bold);
  pane.put(23, "us now");
  pane.put(31, value_text(s.worst_us, 0, known), Style::bold);
  pane.put(40, "us worst");
  if (known) pane.put(50, fmt::format("1 us {} 1 ms", log_histogram(s.late_octaves)));
  pane.put_right(pane.columns(), "");
  pane.line();
  pane.put(1, "overruns");
  pane.put(14, known ? fmt::format("{:8}", s.overruns) : value_text(0, 0, false),
           s.overruns > 0 ? Style::caution : Style::bold);
  pane.put(31, known ? fmt::format("{:8}", s.cycle) : value_text(0, 0, false));
  pane.put(40, "cycles");
}

// Lines such as "below 128 us ████ 1234", one per octave.
void draw_latency(Pane& pane, const TrialModel& model) {
  if (!model.status) return;
  const auto& counts = model.status->late_octaves;
  pane.blank();
  pane.heading("How late the cycle woke: cycles, bars by their logarithm");
  const double most = std::log(1.0 + static_cast<double>(*std::ranges::max_element(counts)));
  for (std::size_t i = 0; i < counts.size() && pane.left() > 0; ++i) {
    pane.line();
    const bool last = i + 1 == counts.size();
    pane.put(1, last ? fmt::format("1024 us and more") : fmt::format("below {:5} us", 1U << i));
    pane.put(18, fmt::format("{:9}", counts[i]), last && counts[i] > 0 ? Style::caution : Style::plain);
    if (counts[i] > 0)
      pane.put(29, bar(std::log(1.0 + static_cast<double>(counts[i])), most, pane.columns() - 29),
               Style::faint);
  }
}

void draw_sheet(Pane& pane, const TrialModel& model) {
  if (model.sheet.empty() || pane.left() < static_cast<int>(model.sheet.size()) + 2) return;
  pane.blank();
  pane.heading("Trial sheet");
  for (const auto& [name, text] : model.sheet) {
    pane.line();
    pane.put(1, name);
    pane.put(20, text);
  }
}

int fault_rows(const TrialModel& model, int columns) {
  int rows = 0;
  for (const auto& text : fault_text(model)) rows += static_cast<int>(wrap(text, columns, kIndent).size());
  return rows;
}

void draw_fault(Pane& pane, const TrialModel& model) {
  Style style = Style::alarm;
  for (const auto& text : fault_text(model)) {
    pane.paragraph(text, kIndent, pane.left(), style);
    style = Style::bold;
  }
}

}  // namespace sandhopper
