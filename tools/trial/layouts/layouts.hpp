#pragma once
#include <string>
#include <vector>

namespace sandhopper {

// Files for opening logs in other programs: layouts for PlotJuggler and Foxglove, loaders for Python, MATLAB
// and Octave. The files of this folder are embedded in the program.
struct LayoutFile {
  std::string name;
  std::string text;
};
const std::vector<LayoutFile>& layout_files();

}  // namespace sandhopper
