#pragma once
#include <cstddef>
#include <vector>

#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// The samples of a force on a pushed foot, each with the foot's height at its time. A row without a height
// gets that between the samples before and after it, because two loggers seldom write into one row. Rows
// before the first height, after the last, or within a gap of the heights are left out.
struct ForceAtDepth {
  explicit ForceAtDepth(const TrialRecording& recording);

  std::size_t size() const { return rows.size(); }

  std::vector<std::size_t> rows;  // of the recording
  std::vector<double> t_s, z_m, force_N;
};

}  // namespace sandhopper
