#include "foreign_conditions.hpp"

namespace sandhopper {
namespace {
using enum CampaignPlant;

// A plate that comes from 200 mm above depth 0; the bed begins at `surface_mm` and has 10 N/mm. The import
// makes it 2 m wide, so the distances are large.
std::string plate_onto_bed(double surface_mm) {
  return plate(
      "Time (s),Force (N),Position (mm)",
      [=](auto r) {
        const double depth_mm = 4.0 * r.i - 200.0 + 0.01 * std::sin(5.0 * r.i * r.i);
        return fmt::format("{:.1f},{:.3f},{:.3f}", r.t_s,
                           10.0 * std::max(0.0, depth_mm - surface_mm) + 0.1 * std::sin(7.0 * r.i * r.i),
                           -depth_mm);
      },
      200);
}
}  // namespace

std::vector<ForeignCondition> conditions_of_sampling() {
  return {
      {.id = "depth 0 below the bed's surface",
       .text = plate_onto_bed(-120.0),
       .plant = intruder,
       .is_usable = true,
       .is_as_written = true},
      {.id = "depth 0 above the bed's surface",
       .text = plate_onto_bed(120.0),
       .plant = intruder,
       .is_usable = true,
       .is_as_written = true},
      {"centimetres without a word of it",
       plate("Time (s),Force (N),Depth",
             [](auto r) { return fmt::format("{:.1f},{:.3f},{:.4f}", r.t_s, r.force_N, r.depth_mm / 10); }),
       intruder, false},
      {"frames that are missing in an even time",
       plate(kNamesInSi,
             [](auto r) {
               auto sample = plate_row(r.i + r.i / 9);
               sample.depth_mm += 0.02 * std::sin(7.0 * r.i * r.i);
               return si_at(r.t_s, sample);
             }),
       intruder, false},
      {"samples put onto a finer grid by straight lines",
       plate(
           kNamesInSi,
           [](auto r) {
             const auto before = plate_row(r.i / 10 * 10), after = plate_row(r.i / 10 * 10 + 10);
             r.force_N = before.force_N + 0.1 * (r.i % 10) * (after.force_N - before.force_N);
             return si(r);
           },
           180),
       intruder, true},
      {.id = "a height that the logger held for a while",
       .text = drop("time (s),z (m)",
                    [](int i) {
                      const double t_s = 0.005 * (i % 5 < 2 ? i - i % 5 : i - i % 5 + 2);
                      return 2.0 - 4.905 * t_s * t_s;
                    }),
       .plant = falling_body,
       .is_usable = true,
       .is_as_written = true},
  };
}

}  // namespace sandhopper
