#include "tools/trial/live/trial_screen.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/trial/live/history_plots.hpp"
#include "tools/trial/live/operator_key.hpp"
#include "tools/trial/live/status_panes.hpp"
#include "tools/trial/live/stride_table.hpp"

namespace sandhopper {
namespace {

constexpr int kWide = 120;
constexpr int kNumbersColumns = 80;
constexpr int kFootRows = 2;

void draw_title(Canvas& canvas, const TrialModel& model) {
  canvas.fill(0, Style::bar);
  const auto clock =
      model.status && model.released_ns
          ? fmt::format("{:+.1f} s ", static_cast<double>(model.status->time_ns - *model.released_ns) * 1e-9)
          : std::string();
  const int end = canvas.size().columns - static_cast<int>(clock.size());
  canvas.put_within(0, 1, end - 1, fmt::format("{} · {} · {}", model.title, model.place, model.log),
                    Style::bar);
  canvas.put(0, end, clock, Style::bar);
}

// Each key with its meaning. Keys without effect now are faint and in parentheses.
void draw_keys(Canvas& canvas, const TrialModel& model) {
  const int row = canvas.size().rows - 1;
  int column = 1;
  for (const auto& key : kOperatorKeys) {
    const bool works = !why_not(key.word, model);
    const auto name = key.word == "stop" ? std::string("s or space") : std::string(1, key.key);
    column = canvas.put(row, column, works ? " " + name + " " : "(" + name + ")",
                        works ? Style::key : Style::faint);
    const auto meaning = key.word == "quit" && model.quitting ? std::string_view("at once!") : key.meaning;
    column = canvas.put(row, column + 1, meaning, works ? Style::plain : Style::faint) + 3;
  }
}

void draw_hint(Canvas& canvas, const TrialModel& model) {
  const int row = canvas.size().rows - 2;
  const auto& [text, style] = hint(model);
  canvas.put_within(row, 1, canvas.size().columns - 1, text, style);
}

void draw_messages(Pane pane, const TrialModel& model) {
  pane.heading("Messages, the newest last");
  // As many whole messages as fit, newest first.
  int room = pane.left();
  auto first = model.messages.end();
  while (first != model.messages.begin()) {
    const auto lines = wrap(*std::prev(first), pane.columns() - 1, 2).size();
    if (static_cast<int>(lines) > room) break;
    room -= static_cast<int>(lines);
    --first;
  }
  for (; first != model.messages.end(); ++first)
    for (const auto& line : wrap(*first, pane.columns() - 1, 2)) {
      pane.line();
      pane.put(1, line);
    }
}

// A fault comes first, then everything else that fits.
void draw_below_numbers(Pane& pane, const TrialModel& model, bool wide) {
  constexpr int kLatencyRows = 14, kMessageRows = 2;
  const int fault = fault_rows(model, pane.columns());
  const int room = pane.left() - 2 - ground_rows(model, pane.columns()) - (fault > 0 ? fault : kMessageRows);
  draw_strides(pane, model, wide ? std::clamp(room - kLatencyRows - 8, 3, 20) : std::clamp(room, 1, 5));
  if (fault > 0)
    draw_fault(pane, model);
  else if (!wide)
    draw_messages(pane.below(), model);
  if (!wide) return;
  draw_sheet(pane, model);
  if (pane.left() >= kLatencyRows) draw_latency(pane, model);
}

}  // namespace

Canvas trial_screen(const TrialModel& model, ScreenSize size) {
  Canvas canvas(size);
  const auto [rows, columns] = canvas.size();
  draw_title(canvas, model);
  const bool wide = columns >= kWide;
  const int left_columns = wide ? kNumbersColumns : columns;
  Pane numbers(canvas, {1, 1, rows - 1 - kFootRows, left_columns - 2});
  draw_state(numbers, model);
  draw_leg_and_forces(numbers, model);
  draw_motors(numbers, model);
  // On a small screen the fault and its cure use the room of the cycle's numbers and of the strides' heading.
  constexpr int kCycleAndStrides = 4 + 6;
  const int fault = fault_rows(model, numbers.columns());
  if (fault == 0 || numbers.left() >= fault + kCycleAndStrides) draw_cycle(numbers, model);
  draw_below_numbers(numbers, model, wide);
  if (wide) {
    const int body = rows - 1 - kFootRows;
    const int plots = std::min(2 * 14, body * 2 / 3);
    const int column = left_columns + 1;
    draw_history(canvas, {2, column, plots, columns - column - 1}, model);
    draw_messages(Pane(canvas, {2 + plots, column, body - plots - 1, columns - column - 1}), model);
  }
  draw_hint(canvas, model);
  draw_keys(canvas, model);
  return canvas;
}

}  // namespace sandhopper
