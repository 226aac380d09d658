#include "foreign_conditions.hpp"

namespace sandhopper {
namespace {
using enum CampaignPlant;

std::string rows_of_text(const std::string& name, const std::function<std::string(PlateRow)>& value) {
  std::string text = name;
  for (int i = 0; i < 80; ++i) text += "," + value(plate_row(i));
  return text + "\n";
}
std::string with_zeros(const std::string& text, std::size_t zeros) {
  std::string out;
  for (const char c : text) out += c + std::string(zeros, '\0');
  return out;
}
std::string plain(PlateRow r) { return fmt::format("{:.1f},{:.3f},{:.3f}", r.t_s, r.force_N, -r.depth_mm); }
std::string share_of(PlateRow r, double share, double period) {
  return fmt::format("{:.4f}", share * r.force_N + 0.02 * std::sin(period * r.i));
}
}  // namespace

std::vector<ForeignCondition> conditions_of_forms() {
  return {
      {"an array in each cell, as Python prints it",
       plate("Time (s),Force (N),Depth (mm)",
             [](auto r) { return fmt::format("{:.1f},[{:.3f}],[{:.3f}]", r.t_s, r.force_N, r.depth_mm); }),
       intruder, false},
      {"a pointer of git LFS", "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a21\nsize 12345\n",
       intruder, false},
      {"channels in rows",
       rows_of_text("Time (s)", [](auto r) { return fmt::format("{:.1f}", r.t_s); }) +
           rows_of_text("Force (N)", [](auto r) { return fmt::format("{:.3f}", r.force_N); }) +
           rows_of_text("Depth (mm)", [](auto r) { return fmt::format("{:.3f}", r.depth_mm); }),
       intruder, false},
      {"a time code of a camera",
       plate("Timecode,force_N,foot_z_m",
             [](auto r) {
               return fmt::format("10:00:{:02}:{:02},{:.3f},{:.5f}", r.i / 25, r.i % 25, r.force_N,
                                  -r.depth_mm / 1000);
             }),
       intruder, false},
      {"seconds of a minute",
       plate("Time (s),force_N,foot_z_m", [](auto r) { return si_at(std::fmod(57.0 + r.t_s, 60.0), r); }),
       intruder, false},
      {"names in Windows-1251",
       plate("\xC2\xF0\xE5\xEC\xFF (\xF1),\xD1\xE8\xEB\xE0 (\xCD),\xC3\xEB\xF3\xE1\xE8\xED\xE0 (\xEC\xEC)",
             plain),
       intruder, true},
      {"names in Mac Roman", plate("Temps \x8E\x63oul\x8E (s),Force (N),D\x8Eplacement (mm)", plain),
       intruder, true},
      {"UTF-32", with_zeros(plate(kNamesInSi, si), 3), intruder, true},
      {"two load cells below one plate",
       plate("t_s,Load cell A (N),Load cell B (N),foot_z_m",
             [](auto r) {
               return fmt::format("{:.1f},{},{},{:.5f}", r.t_s, share_of(r, 0.6, 5.0), share_of(r, 0.4, 3.0),
                                  -r.depth_mm / 1000);
             }),
       intruder, false},
      {"a code that a sensor repeats where it has no sample",
       plate("t_s,force_N,Position (mm)",
             [](auto r) {
               return fmt::format("{:.1f},{:.3f},{:.2f}", r.t_s, r.force_N,
                                  r.i % 9 == 4 ? 8190.0 : -r.depth_mm);
             }),
       intruder, false},
  };
}

}  // namespace sandhopper
