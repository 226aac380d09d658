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
  std::string title;  // with its unit
  double from_s = 0.0;
  double to_s = 1.0;
  double low = 0.0;  // at least this much of the value's axis is shown
  double high = 1.0;
};

// A line through the points, two by four dots a character, with the ends of both axes; takes all of the pane.
// Points that are not finite interrupt the line.
void draw_plot(Pane pane, const BraillePlot& plot, const std::vector<PlotPoint>& points);

}  // namespace sandhopper
