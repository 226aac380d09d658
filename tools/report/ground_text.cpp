#include "tools/report/ground_text.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace sandhopper {
namespace {

std::string names_of(const std::vector<std::uint32_t>& numbers) {
  std::string text = numbers.size() == 1 ? "stride " : "strides ";
  for (std::size_t i = 0; i < numbers.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i + 1 == numbers.size() ? " and " : ", ", numbers[i]);
  return text;
}

}  // namespace

bool adds_nothing(const ReportData& data, std::size_t i) {
  return i > 0 && data.strides[i].profile.stride > 0 &&
         data.strides[i].profile.depth_max_m == data.strides[i - 1].profile.depth_max_m &&
         data.strides[i].profile.observations == data.strides[i - 1].profile.observations;
}

std::string headline(const GroundSummary& g) {
  const auto line =
      fmt::format("{:.0f} N/m  [{:.0f}, {:.0f}] from {:.1f} to {:.1f} mm", g.line_N_per_m.value,
                  g.line_N_per_m.ci95_low, g.line_N_per_m.ci95_high, 1e3 * g.from_m, 1e3 * g.to_m);
  const auto no_line =
      fmt::format("no line fits (chi-squared {:.0f}, limit {:.0f}): ", g.line.statistic, g.line.limit);
  switch (g.shape) {
    case GroundShape::unknown:
      return "too little new ground for one number";
    case GroundShape::line:
      return (g.line_valid ? "a line, " : "a line deeper than the foot is high, ") + line;
    case GroundShape::power_law:
      return no_line + fmt::format("a power law, exponent {:.2f}  [{:.2f}, {:.2f}]", g.exponent.value,
                                   g.exponent.ci95_low, g.exponent.ci95_high);
    case GroundShape::crusted:
      return "something broke on the way (a crust); beside it a line, " + line;
    case GroundShape::layered:
      return no_line + "layers";
    case GroundShape::other:
      return no_line + "neither a power law nor two layers; use the profile";
  }
  return {};
}

std::vector<const GroundEvent*> found_in(const GroundEvents& found) {
  std::vector<const GroundEvent*> events;
  for (const auto* event : {&found.rupture, &found.boundary, &found.suction})
    if (event->kind != GroundEventKind::none) events.push_back(event);
  return events;
}

std::string_view unit_of_size(GroundEventKind kind) {
  return kind == GroundEventKind::layer_boundary || kind == GroundEventKind::box_floor ? "N/m" : "N";
}

// Decimal places that show one or two digits of a standard deviation below 10; none above.
int decimals_for(double sd) {
  if (!(sd < 10.0)) return 0;
  return sd < 0.1 ? 2 : 1;
}

std::string in_words(const GroundEvent& e) {
  static constexpr std::array<std::string_view, 5> kWords{"nothing", "a crust broke", "another layer begins",
                                                          "the floor of the box",
                                                          "suction while the foot leaves"};
  return fmt::format("{} at {:.1f} mm: {:.1f} N at {:.2f} m/s, size {:.{}f} +- {:.{}f} {}",
                     kWords[static_cast<std::size_t>(e.kind)], 1e3 * e.depth_m, e.force_N, e.speed_mps,
                     e.size, decimals_for(e.size_sd), e.size_sd, decimals_for(e.size_sd),
                     unit_of_size(e.kind));
}

std::string trial_line(const ReportData& data) {
  if (data.strides.empty() || data.strides.back().profile.stride == 0) return "";
  const auto& last = data.strides.back();
  std::string text =
      last.profile.depth_max_m > 0.0
          ? fmt::format("ground: {}; its strength profile is known from {:.0f} to {:.0f} mm of depth",
                        headline(last.ground), 1e3 * last.profile.depth_min_m, 1e3 * last.profile.depth_max_m)
          : std::string("ground: no stride gives a value");
  std::vector<std::uint32_t> nothing;
  for (std::size_t i = 0; i < data.strides.size(); ++i)
    if (adds_nothing(data, i)) nothing.push_back(data.strides[i].number);
  if (!nothing.empty())
    text += fmt::format(
        ". No new ground in {}, which landed in the crater: prepare the bed anew, or `--strides {}`",
        names_of(nothing), nothing.front() - 1);
  return text + ".";
}

}  // namespace sandhopper
