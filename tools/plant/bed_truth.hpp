#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "terrain/bed.hpp"

// True bed of one simulated trial, for pages and for scoring.
namespace sandhopper {

// `force_N[i]` is the quasi-static force of the virgin bed on the foot at the depth `depth_m[i]` below the
// undisturbed surface. Depths increase from zero.
struct BedTruth {
  std::string family;
  double foot_radius_m = 0.0;
  double unloading_stiffness_N_per_m = 0.0;  // stiffness of the line on which a foot leaves its crater and
                                             // returns
  std::optional<double> rupture_depth_m{};   // rupture of a crust
  std::optional<double> boundary_depth_m{};  // boundary between two layers
  std::optional<double> floor_depth_m{};     // floor of the box
  std::optional<double> suction_N{};         // largest pull on a foot that leaves
  // Slope of the curve below the intercept at the surface, if the curve is a straight line. Not in a log's
  // attachment.
  std::optional<double> line_N_per_m{};
  std::vector<double> depth_m{};
  std::vector<double> force_N{};

  // Linear between the depths; NaN outside of them.
  double force_at_N(double depth) const noexcept;
};

// Curve at every half millimetre to 120 mm.
BedTruth bed_truth_of(const Bed& bed);

// The truth in a log: an attachment with this name, one JSON object with the fields above (null if absent),
// and the bed's parameters drawn for the trial in `bed` and `bed_family`.
inline constexpr std::string_view kBedTruthAttachment = "bed_truth.json";
std::string bed_truth_text(const Bed& bed);
// Throws std::runtime_error if `text` was not written by bed_truth_text.
BedTruth read_bed_truth(std::string_view text);

}  // namespace sandhopper
