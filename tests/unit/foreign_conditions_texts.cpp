#include "foreign_conditions.hpp"

// Tables whose numbers alone do not show how they are meant: names that come again, digits in groups, units
// beside or above the numbers.
namespace sandhopper {
namespace {
using enum CampaignPlant;

std::string whole_in_groups(double value, char mark) {
  auto digits = fmt::format("{:.0f}", value);
  for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), 1, mark);
  return digits;
}

std::string names_again(const std::string& names, const std::function<std::string(PlateRow)>& row) {
  std::string text = "Time (s),Force (N),Depth (mm)\n";
  for (int i = 0; i < 40; ++i) text += in_mm(plate_row(i)) + "\n";
  text += names + "\n";
  for (int i = 40; i < 80; ++i) text += row(plate_row(i)) + "\n";
  return text;
}

std::string sorted_as_text() {
  std::vector<std::string> rows;
  for (int i = 0; i < 120; ++i) {
    const auto r = plate_row(i);
    rows.push_back(fmt::format("{:.6g},{:.3f},{:.5f}", r.t_s, r.force_N, -r.depth_mm / 1000));
  }
  std::ranges::sort(rows, {}, [](const std::string& row) { return row.substr(0, row.find(',')); });
  return fmt::format("{}\n{}\n", kNamesInSi, fmt::join(rows, "\n"));
}

std::string in_full_width(std::string text) {
  std::string out;
  for (const char c : text)
    if ((c >= '0' && c <= '9') || c == '.')
      out += {'\xEF', '\xBC', static_cast<char>(static_cast<unsigned char>(c - '+' + 0x8B))};
    else
      out += c;
  return out;
}

std::vector<ForeignCondition> conditions_of_names() {
  return {
      {"the names again, with another unit",
       names_again(
           "Time (s),Force (lbf),Depth (mm)",
           [](auto r) { return fmt::format("{:.1f},{:.3f},{:.3f}", r.t_s, r.force_N / 4.448, r.depth_mm); }),
       intruder, false},
      {"the names again, in another order",
       names_again("Time (s),Depth (mm),Force (N)",
                   [](auto r) { return fmt::format("{:.1f},{:.3f},{:.3f}", r.t_s, r.depth_mm, r.force_N); }),
       intruder, false},
      {"a factor beside the unit",
       plate("Time (s),\"Force (N, x1000)\",Depth (mm)",
             [](auto r) { return fmt::format("{:.1f},{:.6f},{:.3f}", r.t_s, r.force_N / 1000, r.depth_mm); }),
       intruder, false},
      {"brackets of full width",
       plate(
           "時間（秒）,荷重（kN）,変位（mm）",
           [](auto r) { return fmt::format("{:.1f},{:.6f},{:.3f}", r.t_s, r.force_N / 1000, -r.depth_mm); }),
       intruder, true},
      {"names in Shift-JIS",
       plate("\x8E\x9E\x8A\xD4(s),\x89\xD7\x8F\x64(N),\x95\xCF\x88\xCA(mm)",
             [](auto r) { return fmt::format("{:.1f},{:.3f},{:.3f}", r.t_s, r.force_N, -r.depth_mm); }),
       intruder, false},
      {"a time in a unit that nobody knows",
       plate("Time (milli),Force (N),Depth (mm)",
             [](auto r) { return fmt::format("{:.1f},{:.3f},{:.3f}", 1000 * r.t_s, r.force_N, r.depth_mm); }),
       intruder, false}};
}

std::vector<ForeignCondition> conditions_of_digits() {
  return {{"points between the thousands of whole numbers",
           plate("Time (ms);Force (mN);Depth (um)",
                 [](auto r) {
                   return fmt::format("{};{};{}", whole_in_groups(1000 * r.t_s, '.'),
                                      whole_in_groups(1000 * r.force_N, '.'),
                                      whole_in_groups(1000 * r.depth_mm, '.'));
                 }),
           intruder, false},
          {"commas between thousands from 1000 on",
           plate(
               "Time (ms),Force (N),Depth (mm)",
               [](auto r) {
                 return fmt::format("\"{}\",{:.3f},{:.3f}", whole_in_groups(10.0 * r.i, ','), r.force_N,
                                    r.depth_mm);
               },
               180),
           intruder, false},
          {"digits in groups of two",
           plate("Time (us),Force (N),Depth (mm)",
                 [](auto r) {
                   return fmt::format("\"{},00,000\",{:.3f},{:.3f}", r.i + 1, r.force_N, r.depth_mm);
                 }),
           intruder, true},
          {"a minus behind the number",
           plate("Time (s),Force (N),Position (mm)",
                 [](auto r) { return fmt::format("{:.1f},{:.3f},{:.3f}-", r.t_s, r.force_N, r.depth_mm); }),
           intruder, true},
          {"a negative number in brackets",
           plate("Time (s),Force (N),Position (mm)",
                 [](auto r) {
                   return fmt::format("{:.1f},{:.3f},({:.3f})", r.t_s, r.force_N, r.depth_mm + 0.1);
                 }),
           intruder, false},
          {"digits of full width", plate(kNamesInSi, [](auto r) { return in_full_width(si(r)); }), intruder,
           true}};
}

std::vector<ForeignCondition> conditions_of_units_elsewhere() {
  return {{"a column of units that change",
           plate("Time (s),Force,Unit,Depth (mm)",
                 [](auto r) {
                   const bool is_small = r.i < 40;
                   return fmt::format("{:.1f},{:.3f},{},{:.3f}", r.t_s, r.force_N * (is_small ? 1000 : 1),
                                      is_small ? "mN" : "N", r.depth_mm);
                 }),
           intruder, false},
          {"a column with one unit throughout",
           plate("Time (s),Force,Unit,Depth (mm)",
                 [](auto r) {
                   return fmt::format("{:.1f},{:.6f},kN,{:.3f}", r.t_s, r.force_N / 1000, r.depth_mm);
                 }),
           intruder, true},
          {"units above the names",
           plate("Force unit: kN\nDepth unit: mm\nTime unit: ms\nTime,Force,Depth",
                 [](auto r) {
                   return fmt::format("{:.1f},{:.6f},{:.3f}", 1000 * r.t_s, r.force_N / 1000, r.depth_mm);
                 }),
           intruder, true}};
}

std::vector<ForeignCondition> conditions_of_time_texts() {
  return {{"milliseconds behind a point, unpadded",
           plate(kNamesInSi,
                 [](auto r) {
                   const int ms = 50 * r.i;
                   return fmt::format("{}.{},{:.3f},{:.5f}", ms / 1000, ms % 1000, r.force_N,
                                      -r.depth_mm / 1000);
                 }),
           intruder, false},
          {"rows sorted as text", sorted_as_text(), intruder, false},
          {"a clock of 12 hours",
           plate("Time,force_N,foot_z_m",
                 [](auto r) {
                   const bool is_one = r.i >= 40;
                   return fmt::format("{}:{:04.1f},{:.3f},{:.5f}", is_one ? "1:00" : "12:59",
                                      is_one ? 0.1 * (r.i - 40) : 56.0 + 0.1 * r.i, r.force_N,
                                      -r.depth_mm / 1000);
                 }),
           intruder, false},
          {"a counter of 16 bits that is full",
           plate("Time (ms),force_N,foot_z_m",
                 [](auto r) {
                   return fmt::format("{},{:.3f},{:.5f}", (62000 + 100 * r.i) % 65536, r.force_N,
                                      -r.depth_mm / 1000);
                 }),
           intruder, false}};
}

}  // namespace

std::vector<ForeignCondition> conditions_of_texts() {
  auto all = conditions_of_names();
  for (const auto& more :
       {conditions_of_digits(), conditions_of_units_elsewhere(), conditions_of_time_texts()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace sandhopper
