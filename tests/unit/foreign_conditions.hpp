#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/plant_kind.hpp"

// Tables as in public reports about other programs, reduced to 80 rows: a plate that sinks 0.4 mm every 0.1
// s, or a swinging axis every 10 ms.
namespace sandhopper {

struct PlateRow {
  int i;
  double t_s, depth_mm, force_N;
};
struct AxisRow {
  int i;
  double t_s, angle_rad, speed_radps, torque_Nm;
};
inline PlateRow plate_row(int i) {
  return {i, 0.1 * i, 0.4 * i, 10.0 + 0.05 * i * i + 0.01 * std::sin(7.0 * i)};
}
inline AxisRow axis_row(int i) {
  const double t = 0.01 * i;
  return {i, t, 0.3 * std::cos(4.0 * t), -1.2 * std::sin(4.0 * t), 0.7 * std::sin(11.0 * t)};
}

inline std::string plate(const std::string& head, const std::function<std::string(PlateRow)>& row,
                         int rows = 80) {
  std::string text = head.empty() ? "" : head + "\n";
  for (int i = 0; i < rows; ++i) text += row(plate_row(i)) + "\n";
  return text;
}
inline std::string axis(const std::string& head, const std::function<std::string(AxisRow)>& row,
                        int rows = 80) {
  std::string text = head.empty() ? "" : head + "\n";
  for (int i = 0; i < rows; ++i) text += row(axis_row(i)) + "\n";
  return text;
}
inline std::string drop(const std::string& head, const std::function<double(int)>& value) {
  std::string text = head + "\n";
  for (int i = 0; i < 80; ++i) text += fmt::format("{:.3f},{:.4f}\n", 0.005 * i, value(i));
  return text;
}

inline std::string with_commas(std::string text) {
  for (char& c : text)
    if (c == '.') c = ',';
  return text;
}
inline std::string si_at(double t_s, PlateRow r) {
  return fmt::format("{:.2f},{:.3f},{:.5f}", t_s, r.force_N, -r.depth_mm / 1000);
}
inline std::string si(PlateRow r) { return si_at(r.t_s, r); }
inline std::string in_mm(PlateRow r) {
  return fmt::format("{:.1f},{:.3f},{:.3f}", r.t_s, r.force_N, r.depth_mm);
}

inline const std::string kNamesInSi = "t_s,force_N,foot_z_m";

struct ForeignCondition {
  std::string id;
  std::string text;
  CampaignPlant plant;
  bool is_usable;                    // true: then the numbers must be right
  std::vector<std::string> names{};  // names that the user gives to the import
  bool is_as_written = false;        // usable with its own numbers, and the words say what is in doubt
};
std::vector<ForeignCondition> conditions_of_times();
std::vector<ForeignCondition> conditions_of_cells();
std::vector<ForeignCondition> conditions_of_tables();
std::vector<ForeignCondition> conditions_of_units();
std::vector<ForeignCondition> conditions_of_samples();
std::vector<ForeignCondition> conditions_of_sampling();
std::vector<ForeignCondition> conditions_of_clocks();
std::vector<ForeignCondition> conditions_of_texts();
std::vector<ForeignCondition> conditions_of_forms();

}  // namespace sandhopper
