#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace sandhopper::benchmark {

// Result of a finished program.
struct Outcome {
  int exit = -1;  // 128 + signal if killed
  bool timed_out = false;
  double seconds = 0.0;
};

// Runs a program with its standard output and standard error in two files. After `limit_s` the program and
// its children are killed. Throws std::system_error if it cannot be started.
Outcome run_limited(const std::vector<std::string>& command, const std::filesystem::path& output,
                    const std::filesystem::path& errors, double limit_s);

}  // namespace sandhopper::benchmark
