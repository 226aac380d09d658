#include "foreign_conditions.hpp"

namespace sandhopper {
namespace {
using enum CampaignPlant;

// A plate that goes in for 60 rows from 4 mm above the bed, and out again, its depth counted on.
std::string depth_counted_one_way() {
  return plate(
      kNamesInSi,
      [](auto r) {
        r.depth_mm -= 4.0;
        r.force_N = (r.i < 60 ? 5.0 * std::max(0.0, r.depth_mm) : 0.0) + 0.01 * std::sin(7.0 * r.i * r.i);
        return si(r);
      },
      120);
}

// The depth is set to 0 when it is 24 mm.
std::string depth_zeroed_in_the_bed() {
  return plate(
      kNamesInSi,
      [](auto r) {
        if (r.i >= 60) r.depth_mm -= 24.0;
        r.depth_mm += 0.01 * std::sin(5.0 * r.i * r.i);
        return si(r);
      },
      120);
}

// A body that hangs for 0.5 s before it falls; its accelerometer reads half.
std::string fall_of_half_range() {
  std::string text = "t_s,height_m,accel_mps2\n";
  for (int i = 0; i < 150; ++i) {
    const double t = 0.01 * i, fallen_s = std::max(0.0, t - 0.5);
    text += fmt::format("{:.2f},{:.4f},{:.4f}\n", t,
                        12.0 - 4.905 * fallen_s * fallen_s + 0.002 * std::sin(7.0 * i * i),
                        (i < 50 ? 4.905 : 0.0) + 0.05 * std::sin(5.0 * i * i));
  }
  return text;
}

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
      {"rows that a column marks as bad",
       plate(kNamesInSi + ",Force_valid", [](auto r) { return si(r) + (r.i % 9 == 4 ? ",0" : ",1"); }),
       intruder, true},
      {"a depth that ends before the force",
       plate(kNamesInSi,
             [](auto r) { return r.i < 40 ? si(r) : fmt::format("{:.2f},{:.3f},", r.t_s, r.force_N); }),
       intruder, true},
      {"a speed without a sign",
       axis("t_s,position_rad,velocity_radps",
            [](auto r) {
              return fmt::format("{:.2f},{:.6f},{:.6f}", r.t_s, 0.3 * std::cos(12.0 * r.t_s),
                                 std::abs(3.6 * std::sin(12.0 * r.t_s)));
            }),
       rotary_axis, false},
      {"a depth that counts the way back as further depth", depth_counted_one_way(), intruder, false},
      {"a depth that was set to zero in the bed", depth_zeroed_in_the_bed(), intruder, false},
      {"an accelerometer of half the range", fall_of_half_range(), falling_body, false},
  };
}

}  // namespace sandhopper
