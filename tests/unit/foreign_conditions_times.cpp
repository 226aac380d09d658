#include "foreign_conditions.hpp"

namespace sandhopper {
namespace {
using enum CampaignPlant;
const std::string kNamesBehindTime = ",Force (N),Depth (mm)";

std::string timed_row(const std::string& time, PlateRow r) {
  return fmt::format("{},{:.3f},{:.3f}", time, r.force_N, r.depth_mm);
}
std::string late_on(int i, const std::string& date, int second_before) {
  return fmt::format("{} {:02}:{:02}:{:04.1f}", date, 23, 59, second_before + 0.1 * i);
}
}  // namespace

std::vector<ForeignCondition> conditions_of_times() {
  return {
      {"date and time in two columns",
       plate("Date,Time" + kNamesBehindTime,
             [](auto r) { return timed_row(fmt::format("2026-01-01,10:30:{:06.3f}", 25 + r.t_s), r); }),
       intruder, true},
      {"seconds and nanoseconds in two columns",
       plate("header.stamp.secs,header.stamp.nsecs" + kNamesBehindTime,
             [](auto r) {
               const long ns = std::lround(r.t_s * 1e9);
               return timed_row(fmt::format("{},{}", 1700000000 + ns / 1000000000, ns % 1000000000), r);
             }),
       intruder, true},
      {"minutes and seconds",
       plate("Time" + kNamesBehindTime,
             [](auto r) { return timed_row(fmt::format("{:02}:{:02}", r.i / 60, r.i % 60), r); }),
       intruder, false},
      {"milliseconds behind a colon, unpadded",
       plate("Time" + kNamesBehindTime,
             [](auto r) { return timed_row(fmt::format("10:00:{:02}:{}", r.i / 10, 100 * (r.i % 10)), r); }),
       intruder, false},
      {"day or month first",
       plate("Time" + kNamesBehindTime,
             [](auto r) {
               return timed_row(r.i < 40 ? late_on(r.i, "03/04/2023", 56)
                                         : fmt::format("04/04/2023 00:00:{:04.1f}", 0.1 * (r.i - 40)),
                                r);
             }),
       intruder, false},
      {"month by name",
       plate("Time" + kNamesBehindTime,
             [](auto r) { return timed_row(fmt::format("13-Sep-2023 20:41:{:06.3f}", 10 + r.t_s), r); }),
       intruder, true},
      {"days and time of day",
       plate("Elapsed" + kNamesBehindTime,
             [](auto r) { return timed_row(fmt::format("0 days 00:00:{:06.3f}", r.t_s), r); }),
       intruder, true},
      {"end of summer time",
       plate("Time" + kNamesBehindTime,
             [](auto r) {
               return timed_row(r.i < 40 ? fmt::format("2025-10-26 02:59:{:02}", 20 + r.i)
                                         : fmt::format("2025-10-26 02:00:{:02}", r.i - 40),
                                r);
             }),
       intruder, false},
      {"counter of 32 bits that is full",
       axis("time_us,angle_deg,torque_Nm",
            [](auto r) {
              const auto us = (4294967296LL - 300000 + 10000LL * r.i) % 4294967296LL;
              return fmt::format("{},{:.6f},{:.6f}", us, 57.29578 * r.angle_rad, r.torque_Nm);
            }),
       rotary_axis, true},
      {"microseconds without a unit",
       axis("timestamp,angle (rad),torque (Nm)",
            [](auto r) {
              return fmt::format("{},{:.6f},{:.6f}", 120000000 + 10000 * r.i, r.angle_rad, r.torque_Nm);
            }),
       rotary_axis, false},
      {"days of a spreadsheet",
       axis("Time,angle (rad),torque (Nm)",
            [](auto r) {
              return fmt::format("{:.10f},{:.6f},{:.6f}", 45210.5 + r.t_s / 86400, r.angle_rad, r.torque_Nm);
            }),
       rotary_axis, false},
      {"days of MATLAB",
       axis("Time,angle (rad),torque (Nm)",
            [](auto r) {
              return fmt::format("{:.10f},{:.6f},{:.6f}", 738910.5 + r.t_s / 86400, r.angle_rad, r.torque_Nm);
            }),
       rotary_axis, false},
      {"time that falls", plate(kNamesInSi, [](auto r) { return si_at(8 - r.t_s, r); }), intruder, false},
      {"several recordings in one file",
       plate(kNamesInSi, si, 40) + plate(kNamesInSi, si, 40) + plate(kNamesInSi, si, 40), intruder, false},
      {"runs side by side",
       plate("Run 1: Time (s),Run 1: Force (N),Run 1: Depth (mm),Run 2: Time (s),Run 2: Force (N)",
             [](auto r) { return in_mm(r) + fmt::format(",{:.1f},{:.3f}", r.t_s, 1.1 * r.force_N); }),
       intruder, true},
      {"no time, a row's number",
       axis("sample,angle (deg),torque (Nm)",
            [](auto r) { return fmt::format("{},{:.6f},{:.6f}", r.i, 57.29578 * r.angle_rad, r.torque_Nm); }),
       rotary_axis, false},
      {"time in another language", plate("\xE6\x99\x82\xE9\x96\x93(s),force_N,depth (mm)", in_mm), intruder,
       true},
  };
}

}  // namespace sandhopper
