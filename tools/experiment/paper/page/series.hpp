#pragma once
#include <cmath>
#include <string>

#include "tools/report/study.hpp"

// Functions to fill the page's figures.
namespace sandhopper::paper {

enum class Style { line, dashed, points, bars };  // bars: points with error bars

inline StudySeries curve(std::string label, std::string color, Style style = Style::line) {
  const bool pen = style == Style::line || style == Style::dashed;
  return {.label = std::move(label),
          .x = {},
          .y = {},
          .mark = pen ? StudySeries::Mark::line : StudySeries::Mark::points,
          .color = std::move(color),
          .dashed = style == Style::dashed};
}

inline void add(StudySeries& s, double x, double y) {
  s.x.push_back(x);
  s.y.push_back(y);
}

// Adds a point with an error bar of `half` in both directions.
inline void add(StudySeries& s, double x, double y, double half) {
  add(s, x, y);
  s.low.push_back(y - half);
  s.high.push_back(y + half);
}

// Ends a line; the next value begins a new one.
inline void lift_pen(StudySeries& s, double x) { add(s, x, std::nan("")); }

}  // namespace sandhopper::paper
