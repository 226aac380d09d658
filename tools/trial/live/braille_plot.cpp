#include "tools/trial/live/braille_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sandhopper {
namespace {

constexpr int kGutter = 8;

class Dots {
 public:
  Dots(int rows, int columns)
      : rows_(rows), columns_(columns), cells_(static_cast<std::size_t>(rows * columns)) {}
  int height() const { return 4 * rows_; }
  int width() const { return 2 * columns_; }
  void set(int x, int y) {
    // Unicode 15, section 21.1: bits of a Braille pattern, by column and row of the dot.
    static constexpr std::array<std::array<unsigned, 4>, 2> kBit{
        {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};
    if (x < 0 || y < 0 || x >= width() || y >= height()) return;
    cells_[static_cast<std::size_t>((y / 4) * columns_ + x / 2)] |=
        kBit[static_cast<std::size_t>(x % 2)][static_cast<std::size_t>(y % 4)];
  }
  void line(double x0, double y0, double x1, double y1) {
    const int steps = static_cast<int>(std::ceil(std::max({1.0, std::abs(x1 - x0), std::abs(y1 - y0)})));
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      set(static_cast<int>(std::lround(x0 + share * (x1 - x0))),
          static_cast<int>(std::lround(y0 + share * (y1 - y0))));
    }
  }
  std::string row(int row) const {
    std::string out;
    for (int column = 0; column < columns_; ++column) {
      const auto bits = cells_[static_cast<std::size_t>(row * columns_ + column)];
      append_utf8(out, bits == 0 ? U' ' : 0x2800U + bits);
    }
    return out;
  }

 private:
  int rows_, columns_;
  std::vector<unsigned> cells_;
};

}  // namespace

void draw_plot(Pane pane, const BraillePlot& plot, const std::vector<PlotPoint>& points) {
  pane.heading(plot.title);
  const int rows = pane.left() - 1;
  const int columns = pane.columns() - kGutter;
  if (rows < 2 || columns < 10) return;
  double low = plot.low, high = plot.high;
  for (const auto& p : points) {
    if (!std::isfinite(p.value) || p.time_s < plot.from_s) continue;
    low = std::min(low, p.value);
    high = std::max(high, p.value);
  }
  Dots dots(rows, columns);
  const auto x = [&](double t) { return (t - plot.from_s) / (plot.to_s - plot.from_s) * (dots.width() - 1); };
  const auto y = [&](double v) { return (high - v) / (high - low) * (dots.height() - 1); };
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto &a = points[i - 1], &b = points[i];
    if (std::isfinite(a.value) && std::isfinite(b.value) && b.time_s >= plot.from_s)
      dots.line(x(a.time_s), y(a.value), x(b.time_s), y(b.value));
  }
  for (int row = 0; row < rows; ++row) {
    pane.line();
    if (row == 0) pane.put_right(kGutter - 2, fmt::format("{:.0f}", high));
    if (row == rows - 1) pane.put_right(kGutter - 2, fmt::format("{:.0f}", low));
    pane.put(kGutter - 1, "│", Style::faint);
    pane.put(kGutter, dots.row(row));
  }
  pane.line();
  pane.put(kGutter, fmt::format("{:.1f} s", plot.from_s), Style::faint);
  pane.put_right(pane.columns(), fmt::format("{:.1f} s", plot.to_s), Style::faint);
}

}  // namespace sandhopper
