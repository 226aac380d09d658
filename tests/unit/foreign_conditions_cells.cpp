#include "foreign_conditions.hpp"

namespace sandhopper {
namespace {
using enum CampaignPlant;

// A row in which the force's cell is written as `cell`.
std::string row_with_force(PlateRow r, const std::string& cell) {
  return fmt::format("{:.2f},{},{:.5f}", r.t_s, cell, -r.depth_mm / 1000);
}
std::string plain_force(PlateRow r) { return fmt::format("{:.3f}", r.force_N); }
// Writes `other` in place of every ninth angle, except in the rows that the test checks.
std::string row_with_angle(AxisRow r, const std::string& other) {
  return fmt::format("{:.2f},{},{:.6f}", r.t_s,
                     r.i % 9 == 4 ? other : fmt::format("{:.6f}", 57.29578 * r.angle_rad), r.torque_Nm);
}
const std::string kNamesOfAxis = "time_s,position_deg,torque_Nm";
}  // namespace

std::vector<ForeignCondition> conditions_of_cells() {
  return {
      {"a date that a spreadsheet made of a number",
       plate("time_s;force_N;depth_mm",
             [](auto r) {
               return fmt::format("{:.1f};{};{:.3f}", r.t_s, r.i % 9 == 4 ? "03.01.2024" : plain_force(r),
                                  r.depth_mm);
             }),
       intruder, true},
      {"a time of day in a channel",
       plate(kNamesInSi, [](auto r) { return row_with_force(r, r.i == 30 ? "12:30" : plain_force(r)); }),
       intruder, true},
      {"##### of a column that was too narrow",
       plate(kNamesInSi, [](auto r) { return row_with_force(r, r.i > 70 ? "#######" : plain_force(r)); }),
       intruder, true},
      {"OL of a meter",
       plate(kNamesInSi, [](auto r) { return row_with_force(r, r.i > 70 ? "OL" : plain_force(r)); }),
       intruder, true},
      {"9.91E+37 of an instrument", axis(kNamesOfAxis, [](auto r) { return row_with_angle(r, "9.91E+37"); }),
       rotary_axis, true},
      {"-999 for no sample", axis(kNamesOfAxis, [](auto r) { return row_with_angle(r, "-999"); }),
       rotary_axis, false},
      {"1.#QNAN and -nan(ind)",
       axis(kNamesOfAxis, [](auto r) { return row_with_angle(r, r.i % 2 == 0 ? "1.#QNAN" : "-nan(ind)"); }),
       rotary_axis, true},
      {"--.--- of a display", axis(kNamesOfAxis, [](auto r) { return row_with_angle(r, "--.---"); }),
       rotary_axis, true},
      {"numbers of Fortran",
       plate("t_s force_N foot_z_m",
             [](auto r) {
               auto row = fmt::format("{:.5E} {:.8E} {:.8E}", r.t_s, r.force_N, -r.depth_mm / 1000);
               for (char& c : row)
                 if (c == 'E') c = 'D';
               return row;
             }),
       intruder, true},
      {"no-break spaces between thousands",
       plate("Temps (s);Force (N);Profondeur (mm)",
             [](auto r) {
               return with_commas(
                   fmt::format("{:.1f};1\xE2\x80\xAF{:07.3f};{:.3f}", r.t_s, r.force_N, r.depth_mm));
             }),
       intruder, true},
      {"a dash for a minus",
       plate("t_s;force_N;foot_z_m",
             [](auto r) {
               return fmt::format("{:.1f};{:.3f};\xE2\x80\x93{:.5f}", r.t_s, r.force_N, r.depth_mm / 1000);
             }),
       intruder, true},
      {"=\"0.5\" and '0.5",
       plate(kNamesInSi,
             [](auto r) {
               return fmt::format("=\"{:.1f}\",'{:.3f},=\"{:.5f}\"", r.t_s, r.force_N, -r.depth_mm / 1000);
             }),
       intruder, true},
      {"a unit behind every number",
       plate("time,force,depth",
             [](auto r) { return fmt::format("{:.1f} s,{:.3f} N,{:.2f}mm", r.t_s, r.force_N, r.depth_mm); }),
       intruder, false},
      {"k behind a number",
       plate(kNamesInSi, [](auto r) { return row_with_force(r, fmt::format("{:.4f}k", r.force_N / 1000)); }),
       intruder, false},
      {"decimal commas between commas",
       plate("Time(s),Force(N),Depth(mm)", [](auto r) { return with_commas(in_mm(r)); }), intruder, false},
      {"points in one column, commas in others",
       plate("Zeit (s);Kraft (N);Tiefe (mm)",
             [](auto r) {
               return fmt::format("{:.3f};", 1 + r.t_s) +
                      with_commas(fmt::format("{:.1f};{:.1f}", r.force_N, r.depth_mm));
             }),
       intruder, false},
      {"a file that was cut within its last number",
       [] {
         auto text = plate(kNamesInSi, si);
         return text.substr(0, text.size() - 4);
       }(),
       intruder, true},
      {"zeros of a card behind the table", plate(kNamesInSi, si) + std::string(2000, '\0'), intruder, true},
      {"an angle within one turn",
       axis("time (s),angle (deg),torque (Nm)",
            [](auto r) {
              return fmt::format("{:.3f},{:.3f},{:.4f}", r.t_s, std::fmod(1440 * r.t_s, 360), r.torque_Nm);
            }),
       rotary_axis, true},
  };
}

}  // namespace sandhopper
