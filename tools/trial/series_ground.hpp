#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "config/robot_config.hpp"
#include "terrain/next_stride.hpp"

namespace sandhopper {

// What the trials of a series have shown of the ground so far, each on ground that was prepared alike and
// that no trial had touched, and the drop that would show most of the rest.
class SeriesGround {
 public:
  explicit SeriesGround(const RobotConfig& robot);

  // The strides of one more trial, from its log. Throws mcap::Error.
  void add(const std::filesystem::path& log);

  // None before a stride was measured. The leg's stiffness is that of the series.
  std::optional<NextStride> next() const;

 private:
  HopModel robot_;
  double leg_stiffness_N_per_m_;
  ProfileSolver solver_;
  bool known_ = false;
};

// "Tells most about the ground next: a drop from 60 mm ..."
std::string to_text(const NextStride& next);

}  // namespace sandhopper
