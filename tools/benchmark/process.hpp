#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace sandhopper::benchmark {

struct Outcome {
  int exit = -1;  // 128 + signal when killed
  bool timed_out = false;
  double seconds = 0.0;
};

// Runs a program with its standard output into one file and its standard error into another, and kills it
// with all it started when the limit is over. Throws std::system_error when it cannot be started.
Outcome run_limited(const std::vector<std::string>& command, const std::filesystem::path& output,
                    const std::filesystem::path& errors, double limit_s);

}  // namespace sandhopper::benchmark
