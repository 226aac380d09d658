#pragma once
#include <unistd.h>

#include <filesystem>
#include <string>

#include "config/files.hpp"
#include "tools/faults/run_cell.hpp"

namespace sandhopper::faults {

// The shipped robot in the default world, and a log folder of this process.
inline MatrixSetup shipped_setup() {
  MatrixSetup setup;
  setup.robot = load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config");
  setup.folder = std::filesystem::temp_directory_path() / ("fault_tests." + std::to_string(::getpid()));
  std::filesystem::create_directories(setup.folder);
  return setup;
}

}  // namespace sandhopper::faults
