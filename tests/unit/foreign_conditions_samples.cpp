#include "foreign_conditions.hpp"

namespace sandhopper {
namespace {
using enum CampaignPlant;
}  // namespace

std::vector<ForeignCondition> conditions_of_samples() {
  return {
      {"a set-point beside the measured value",
       axis("time (s),pos_setpoint (rad),pos_estimate (rad),torque (Nm)",
            [](auto r) {
              return fmt::format("{:.2f},{:.6f},{:.6f},{:.6f}", r.t_s, 1.1 * r.angle_rad, r.angle_rad,
                                 r.torque_Nm);
            }),
       rotary_axis, true},
      {"a filtered value beside the raw one",
       plate("time (s),depth (mm),Force_filt (N),Force_raw (N)",
             [](auto r) {
               return fmt::format("{:.1f},{:.3f},{:.3f},{:.3f}", r.t_s, r.depth_mm, 0.9 * r.force_N,
                                  r.force_N);
             }),
       intruder, true},
      {"a factor in front of the unit",
       plate("time [s],Force [x10 N],Depth [0.01 mm]",
             [](auto r) {
               return fmt::format("{:.1f},{:.4f},{:.1f}", r.t_s, 0.1 * r.force_N, 100 * r.depth_mm);
             }),
       intruder, true},
      {"a clock that was not set in the first rows",
       kNamesInSi + "\n0.00,10.02,0.00001\n0.00,10.01,0.00002\n0.00,10.03,0.00001\n" +
           plate("", [](auto r) { return si_at(1716389000 + r.t_s, r); }),
       intruder, true},
      {"rows that a logger filled at the end",
       plate(
           kNamesInSi, [](auto r) { return si_at(r.t_s, plate_row(std::min(r.i, 79))); }, 100),
       intruder, true},
      {"zeros where a force had no sample",
       plate(kNamesInSi,
             [](auto r) {
               if (r.i > 10 && r.i % 9 == 4) r.force_N = 0.0;
               return si_at(r.t_s, r);
             }),
       intruder, true},
      {"a force that the logger held for a while",
       plate(kNamesInSi,
             [](auto r) {
               if (r.i > 30 && r.i < 45) r.force_N = plate_row(30).force_N;
               return si_at(r.t_s, r);
             }),
       intruder, true},
      {"a speed at its sensor's limit",
       axis("t_s,position_rad,velocity_radps,torque_Nm",
            [](auto r) {
              return fmt::format("{:.2f},{:.6f},{:.6f},{:.6f}", r.t_s, r.angle_rad,
                                 std::max(-0.08, r.speed_radps), r.torque_Nm);
            }),
       rotary_axis, true},
      {"angle and speed under each other's name",
       axis("t_s,velocity_radps,position_rad,torque_Nm",
            [](auto r) {
              return fmt::format("{:.2f},{:.6f},{:.6f},{:.6f}", r.t_s, r.angle_rad, r.speed_radps,
                                 r.torque_Nm);
            }),
       rotary_axis, false},
  };
}

}  // namespace sandhopper
