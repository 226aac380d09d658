#pragma once
#include <string>
#include <vector>

namespace sandhopper {

// What a lab opens our logs with elsewhere: layouts for PlotJuggler and Foxglove, loaders for Python, MATLAB
// and Octave. The files of this folder, inside the program.
struct LayoutFile {
  std::string name;
  std::string text;
};
const std::vector<LayoutFile>& layout_files();

}  // namespace sandhopper
