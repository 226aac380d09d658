#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/trial/live/pane.hpp"

namespace sandhopper {

struct PlotPoint {
  double time_s;
  double value;
};

struct BraillePlot {
  std::string title;  // including its unit
  double from_s = 0.0;
  double to_s = 1.0;
  double low = 0.0;  // the axis shows at least the values from low to high
  double high = 1.0;
};

// Draws a line through the points, with two by four dots per character and the ends of both axes. Uses the
// whole pane. Points that are not finite interrupt the line.
void draw_plot(Pane pane, const BraillePlot& plot, const std::vector<PlotPoint>& points);

}  // namespace sandhopper
