#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "config/robot_config.hpp"
#include "terrain/next_stride.hpp"

namespace sandhopper {

// Knowledge of the ground from the trials of a series so far, and the drop that is expected to add most to
// it. Every trial must be on untouched ground that was prepared alike.
class SeriesGround {
 public:
  explicit SeriesGround(const RobotConfig& robot);

  // Adds the strides of one more trial from its log. Throws mcap::Error.
  void add(const std::filesystem::path& log);

  // Next drop; empty before a stride was measured. The leg's stiffness is that of the series.
  std::optional<NextStride> next() const;

 private:
  HopModel robot_;
  double leg_stiffness_N_per_m_;
  ProfileSolver solver_;
  bool known_ = false;
};

// Text such as "Tells most about the ground next: a drop from 60 mm ...".
std::string to_text(const NextStride& next);

}  // namespace sandhopper
