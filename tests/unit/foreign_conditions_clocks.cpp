#include "foreign_conditions.hpp"

namespace sandhopper {
namespace {
using enum CampaignPlant;

std::string in_deg(AxisRow r, const std::string& torque) {
  return fmt::format("{:.2f},{:.5f},{}", r.t_s, 57.29577951 * r.angle_rad, torque);
}
std::string rows_twice() {
  std::string text = kNamesInSi + "\n";
  for (int i = 0; i < 50; ++i) text += si(plate_row(i)) + "\n";
  for (int i = 30; i < 80; ++i) text += si(plate_row(i)) + "\n";
  return text;
}
}  // namespace

std::vector<ForeignCondition> conditions_of_clocks() {
  return {
      {"a column of times for each sensor",
       plate("Force_t (s),Force (N),Depth_t (s),Depth (mm)",
             [](auto r) {
               return fmt::format("{:.2f},{:.3f},{:.2f},{:.3f}", r.t_s, r.force_N, 1.5 * r.t_s,
                                  1.5 * r.depth_mm);
             }),
       intruder, false},
      {.id = "a counter that is called a time",
       .text = plate("time(not s),Time (s),Force (N),Depth (mm)",
                     [](auto r) {
                       return fmt::format("{},{:.2f},{:.3f},{:.3f}", 14368 + 2 * r.i + r.i * r.i / 40, r.t_s,
                                          r.force_N, r.depth_mm);
                     }),
       .plant = intruder,
       .is_usable = true},
      {"two columns of times with one name",
       plate("Time,Force (N),Time,Depth (mm)",
             [](auto r) {
               return fmt::format("{:.2f},{:.3f},{:.2f},{:.3f}", r.t_s, r.force_N, 1.5 * r.t_s,
                                  1.5 * r.depth_mm);
             }),
       intruder, false},
      {"time of arrival beside the stamp",
       axis("%time,field.header.seq,field.header.stamp,angle (rad),torque (Nm)",
            [](auto r) {
              const auto ns = 1423155837204827070LL + 10000000LL * r.i;
              return fmt::format("{},{},{},{:.6f},{:.6f}", ns, r.i, ns - 300000 - 50000 * (r.i % 7),
                                 r.angle_rad, r.torque_Nm);
            }),
       rotary_axis, true},
      {"a clock that is set forward",
       plate(kNamesInSi, [](auto r) { return si_at(r.t_s + (r.i < 40 ? 0 : 2), r); }), intruder, false},
      {"a clock that begins again at zero",
       plate(kNamesInSi, [](auto r) { return si_at(r.t_s - (r.i < 25 ? 0 : 2.5), r); }), intruder, false},
      {"time since the row before",
       plate("dt (s),force_N,depth (mm)",
             [](auto r) {
               return fmt::format("{:.5f},{:.3f},{:.3f}", 0.1 + 0.001 * std::sin(r.i * r.i), r.force_N,
                                  r.depth_mm);
             }),
       intruder, false},
      {"rows a little out of order",
       plate(kNamesInSi,
             [](auto r) {
               return si(plate_row(r.i % 10 == 4 ? r.i + 1 : r.i % 10 == 5 ? r.i - 1 : r.i));
             }),
       intruder, false},
      {"a block of rows that was written twice", rows_twice(), intruder, false},
      {"minutes from the first minute on",
       plate("Time,Force (N),Depth (mm)",
             [](auto r) {
               const double t = 55 + r.t_s;
               return (t < 59.95 ? fmt::format("{:.1f}", t) : fmt::format("1:{:04.1f}", t - 60)) +
                      fmt::format(",{:.3f},{:.3f}", r.force_N, r.depth_mm);
             }),
       intruder, true},
      {"a speed whose counter is full",
       axis("time_s,position_deg,velocity_dps",
            [](auto r) {
              const double t = r.t_s, v = 600 * std::cos(6 * t);
              return fmt::format("{:.2f},{:.4f},{:.3f}", t, 100 * std::sin(6 * t),
                                 v - 1024 * std::round(v / 1024));
            }),
       rotary_axis, false},
      {"counts in hexadecimal",
       axis("time_ms,position,torque (Nm)",
            [](auto r) {
              return fmt::format("{:.0f},0x{:04X},{:.5f}", 1000 * r.t_s,
                                 static_cast<int>(8192 + 2607 * r.angle_rad), r.torque_Nm);
            }),
       rotary_axis, false},
      {"a torque in ounces times inches",
       axis("Time (s),Angle (deg),Torque (ozf-in)",
            [](auto r) { return in_deg(r, fmt::format("{:.6f}", r.torque_Nm / 0.00706155)); }),
       rotary_axis, true},
      {"the sign for micro in two alphabets",
       plate("Time (\xCE\xBCs),Force (N),Depth (\xC2\xB5m)",
             [](auto r) {
               return fmt::format("{:.0f},{:.3f},{:.1f}", 1e6 * r.t_s, r.force_N, 1000 * r.depth_mm);
             }),
       intruder, true},
      {"names of groups above the names",
       plate(",Load cell,,Laser\nTime,Force,Temp,Position\ns,N,C,mm",
             [](auto r) { return fmt::format("{:.2f},{:.3f},21.5,{:.3f}", r.t_s, r.force_N, -r.depth_mm); }),
       intruder, true},
  };
}

}  // namespace sandhopper
