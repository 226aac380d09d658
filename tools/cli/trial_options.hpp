#pragma once
#include <cstdint>
#include <string>

namespace sandhopper::cli {

// The command line of `hop trial`.
struct TrialOptions {
  std::string board = "sim";
  int trials = 1;
  int strides = 3;
  double release_height_m = 0.0618;
  bool release_height_given = false;
  double compression_stiffness_N_per_m = 0.0;  // 0: the value of robot.toml
  std::uint64_t seed = 1;
  std::string noise = "on";
  std::string output;
  std::string devices;
  bool report = true;
  bool plain = false;  // true: no live view
  int series = 0;      // number of trials with prompts between them; 0: no series
  std::string sheet;   // file of the trial sheet
  std::string who;
  std::string bed;
  std::string bed_preparation;
  std::string notes;
  double payload_kg = -1.0;  // negative: not given
  // Time after the trial at which the live view closes, s; 0: never. Until then the log grows by 1.05 MB/s:
  // 32 MB in 30 s, nine times the 3.47 MB of a trial of 3.3 s.
  double close_after_s = 30.0;
  double speed = 1.0;  // of the simulated board in the live view, relative to real time
};

}  // namespace sandhopper::cli
