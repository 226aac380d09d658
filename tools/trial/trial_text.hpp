#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "terrain/joint_config.hpp"
#include "tools/report/ground_text.hpp"
#include "tools/report/report_data.hpp"

namespace sandhopper {

// Name of an enumeration value as words: "too_shallow" becomes "too shallow".
std::string readable(std::string name);

// Results of a trial for people: a block of lines per stride.
std::vector<std::string> stride_lines(const ReportData& data);

// The same for programs: touchdown_speed_mps, times, peak force, depth,
// stiffness_N_per_m.{qs_ols,mo_ols,mo_wls,joint}, profile (profile_text.hpp).
nlohmann::ordered_json stride_json(const ReportStride& stride);

// Joint fit of all valid strides together; empty text and null for fewer than two.
struct PooledText {
  std::string line;
  nlohmann::ordered_json json;
};
PooledText pooled_text(const std::vector<ReportStride>& strides, const JointConfig& config);

}  // namespace sandhopper
