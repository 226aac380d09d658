#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "terrain/bed.hpp"

// The true bed of one simulated trial, for pages and for scoring.
namespace sandhopper {

// `force_N[i]` is the quasi-static force of the virgin bed on the foot at `depth_m[i]` under the undisturbed
// surface, ascending from zero.
struct BedTruth {
  std::string family;
  double foot_radius_m = 0.0;
  double unloading_stiffness_N_per_m = 0.0;  // of the line on which a foot leaves and returns to its crater
  std::optional<double> rupture_depth_m{};   // of a crust
  std::optional<double> boundary_depth_m{};  // between two layers
  std::optional<double> floor_depth_m{};     // of the box
  std::optional<double> suction_N{};         // greatest pull on a foot that leaves
  // Slope of the curve below the surface's intercept, where it is a straight line; not in a log's attachment.
  std::optional<double> line_N_per_m{};
  std::vector<double> depth_m{};
  std::vector<double> force_N{};

  // Linear between the depths, NaN outside of them.
  double force_at_N(double depth) const noexcept;
};

// At every half millimetre to 120 mm.
BedTruth bed_truth_of(const Bed& bed);

// In a log: the attachment of this name, one JSON object with the fields above, null where a value is absent,
// and with the bed's parameters as drawn for the trial in `bed` and `bed_family`.
inline constexpr std::string_view kBedTruthAttachment = "bed_truth.json";
std::string bed_truth_text(const Bed& bed);
// Throws std::runtime_error where `text` is not what bed_truth_text writes.
BedTruth read_bed_truth(std::string_view text);

}  // namespace sandhopper
