#include "foreign_conditions.hpp"

namespace sandhopper {
namespace {
using enum CampaignPlant;
const std::string kNamesOfPlate = "Time (s),Force (N),Depth (mm)";

std::string in_columns(PlateRow r, const char* format) {
  return fmt::format(fmt::runtime(format), r.t_s, r.force_N, r.depth_mm);
}
std::string vernier_set(int rows) {
  return plate(
      "Vernier Format 2\nMy rig 1/22/2002 12:51:07\nRun\nTime\tForce\tDepth\nT\tF\td\ns\tN\tmm\n",
      [](auto r) { return in_columns(r, "{:.2f}\t{:.3f}\t{:.3f}"); }, rows);
}
}  // namespace

std::vector<ForeignCondition> conditions_of_tables() {
  return {
      {"a name with a comma, in quotes", plate("\"Time, s\",\"Force, N\",\"Depth, mm\"", in_mm), intruder,
       true},
      {"a name with a comma, without quotes", plate("Time,Force, mean,Depth (mm)", in_mm), intruder, false},
      {"a line break within a name", plate("\"Time\n(s)\",\"Load\n(N)\",\"Depth\n(mm)\"", in_mm), intruder,
       true},
      {"row numbers without a name",
       plate("\"t_s\" \"force_N\" \"foot_z_m\"",
             [](auto r) {
               return fmt::format("\"{}\" {:.2f} {:.3f} {:.5f}", r.i + 1, r.t_s, r.force_N,
                                  -r.depth_mm / 1000);
             }),
       intruder, true},
      {"names by commas, rows by tabs",
       plate("Time (s), Force (N), Depth (mm)",
             [](auto r) { return in_columns(r, "{:.1f}\t{:.3f}\t{:.3f}"); }),
       intruder, true},
      {"names with blanks, divided by blanks",
       plate("Time (s) Load (N) Depth (mm)", [](auto r) { return in_columns(r, "{:.1f} {:.3f} {:.3f}"); }),
       intruder, true},
      {"bars, as in a text page",
       plate("| Time (s) | Force (N) | Depth (mm) |\n|---|---|---|",
             [](auto r) { return in_columns(r, "| {:.1f} | {:.3f} | {:.3f} |"); }),
       intruder, true},
      {"a name before every value",
       plate("", [](auto r) { return in_columns(r, "t:{:.1f},Force:{:.3f},Depth:{:.3f}"); }), intruder,
       false},
      {"JSON",
       plate("",
             [](auto r) { return in_columns(r, "{{\"t\": {:.1f}, \"force\": {:.3f}, \"depth\": {:.3f}}}"); }),
       intruder, false},
      {"a page called .xls",
       plate("<html><table><tr><td>t</td></tr>",
             [](auto r) { return in_columns(r, "<tr><td>{:.1f}</td><td>{:.3f}</td><td>{:.3f}</td></tr>"); }),
       intruder, false},
      {"no names at all", plate("", si), intruder, false},
      {"no names, and names given", plate("", si), intruder, true, {"t_s", "force_N", "foot_z_m"}},
      {"four lines above the rows of a logger",
       plate("\"TOA5\",\"6843\",\"CR3000\",\"6843\"\n\"TIMESTAMP\",\"RECORD\",\"Force\",\"Depth\"\n\"TS\","
             "\"RN\",\"N\","
             "\"mm\"\n\"\",\"\",\"Smp\",\"Avg\"",
             [](auto r) {
               return fmt::format("\"2012-06-07 13:00:{:05.2f}\",{},{:.3f},{}", r.t_s, r.i, r.force_N,
                                  r.i == 20 ? "\"NAN\"" : fmt::format("{:.3f}", r.depth_mm));
             }),
       intruder, true},
      {"numbers among the lines of names",
       plate("Format Version,1.23,Take,a\n\n,Type,Plate,Plate\n,ID,1,1\nFrame,Time (s),Force (N),Depth (mm)",
             [](auto r) { return fmt::format("{},", r.i) + in_mm(r); }),
       intruder, true},
      {"lines padded with commas",
       plate("Operator,Ann,,,,\nRig,7,,,,\n,,,,,\nTime (s),Force (N),Depth (mm),,,",
             [](auto r) { return in_mm(r) + ",,,"; }),
       intruder, true},
      {"a name for remarks that rows do not reach",
       plate("***End_of_Header***\nX_Value\tForce (N)\tDepth (mm)\tComment",
             [](auto r) { return in_columns(r, "{:.6f}\t{:.6f}\t{:.6f}"); }),
       intruder, true},
      {"largest and smallest values above the rows",
       plate(kNamesOfPlate + "\nMax,330.1,31.6\nMin,10,0", in_mm), intruder, true},
      {"means below the rows", plate(kNamesInSi, si) + "\nMaximum,330.1,0.0\nMean,101.2,-0.016\n", intruder,
       true},
      {"data sets one below the other", vernier_set(80) + vernier_set(80), intruder, false},
      {"lines that ran together",
       plate(kNamesOfPlate, [](auto r) { return in_mm(r) + (r.i == 20 ? in_mm(plate_row(21)) : ""); }),
       intruder, true},
      {"the names again and again",
       plate(kNamesOfPlate,
             [](auto r) { return r.i % 20 == 5 ? in_mm(r) + "\n" + kNamesOfPlate : in_mm(r); }),
       intruder, true},
      {"a remark between rows",
       plate(kNamesOfPlate, [](auto r) { return in_mm(r) + (r.i == 9 ? "\noperator: ah, well" : ""); }),
       intruder, true},
      {"line ends \\r\\r\\n", plate(kNamesInSi, [](auto r) { return si(r) + "\r\r"; }), intruder, true},
      {"names over the wrong columns",
       plate("t_s,force_N,foot_z_m",
             [](auto r) { return fmt::format("{:.2f},{:.2f},{:.5f}", r.t_s, r.t_s, -r.depth_mm / 1000); }),
       intruder, false},
      {"one column for the sensor's name and one for its value",
       plate("time,sensor,value",
             [](auto r) {
               return fmt::format("{:.2f},force,{:.3f}\n{:.2f},depth,{:.3f}", r.t_s, r.force_N, r.t_s + 0.01,
                                  r.depth_mm);
             }),
       intruder, false},
  };
}

std::vector<ForeignCondition> conditions_of_units() {
  const auto si_axis = [](double angle, double torque) {
    return [=](AxisRow r) {
      return fmt::format("{:.0f},{:.6f},{:.6f}", 1000 * r.t_s, angle * r.angle_rad, torque * r.torque_Nm);
    };
  };
  const double degree = 57.2957795;
  return {
      {"angleDeg, timeMs", axis("timeMs,angleDeg,torqueNm", si_axis(degree, 1)), rotary_axis, true},
      {"ANGLE_DEG, TIME_MS", axis("TIME_MS,ANGLE_DEG,TORQUE_NM", si_axis(degree, 1)), rotary_axis, true},
      {"turns without a word of it",
       axis("timestamp,POSITION,VELOCITY,TORQUE",
            [](auto r) {
              return fmt::format("{:.6f},{:.6f},{:.6f},{:.4f}", 1.7e9 + r.t_s, r.angle_rad / 6.2832,
                                 r.speed_radps / 6.2832, r.torque_Nm);
            }),
       rotary_axis, false},
      {"speed times pole pairs",
       axis("time_s,angle_deg,speed_erpm",
            [](auto r) {
              return fmt::format("{:.3f},{:.5f},{:.4f}", r.t_s, 57.29578 * r.angle_rad,
                                 21 * 9.549297 * r.speed_radps);
            }),
       rotary_axis, false},
      {"a unit with a slash behind a slash",
       axis("Time/s,Angle/rad,AngVel/rad/s,Torque/N m",
            [](auto r) {
              return fmt::format("{:.3f},{:.6f},{:.6f},{:.5f}", r.t_s, r.angle_rad, r.speed_radps,
                                 r.torque_Nm);
            }),
       rotary_axis, true},
      {"a unit that nobody knows", plate("Time (s),Force (N),Depth (div)", in_mm), intruder, false},
      {"mil",
       plate(
           "Time (s),Force (N),Depth (mil)",
           [](auto r) { return fmt::format("{:.1f},{:.3f},{:.5f}", r.t_s, r.force_N, r.depth_mm / 0.0254); }),
       intruder, true},
      {"depth as a position that grows downward", plate("Time (s),Force (N),Position (mm)", in_mm), intruder,
       false},
      {"compression counted negative",
       plate("Time (s),Load (N),Depth (mm)",
             [](auto r) { return fmt::format("{:.1f},{:.3f},{:.3f}", r.t_s, -r.force_N, r.depth_mm); }),
       intruder, false},
      {"acceleration in g",
       drop("time_s,accel_mps2", [](int i) { return i < 40 ? 1.0 + 0.002 * std::sin(i) : 0.01; }),
       falling_body, false},
      {"acceleration downward",
       drop("time_s,Acceleration (m/s^2)", [](int i) { return i < 40 ? -9.8 + 0.01 * std::sin(i) : 0.02; }),
       falling_body, false},
      {"acceleration without gravity",
       drop("\"Time (s)\",\"Linear Acceleration z (m/s^2)\"",
            [](int i) { return i < 40 ? 0.01 * std::sin(i) : -9.8; }),
       falling_body, true},
      {"readings of a converter", axis("millis,position,torque", si_axis(1000, 1000)), rotary_axis, false},
  };
}

}  // namespace sandhopper
