#include "tools/campaign/setup_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/campaign/setup_vocabulary.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {
namespace {

// Names of the one thing that meets the bed. A rod or a shaft may also carry a plate of another size.
constexpr std::array<std::string_view, 9> kFoot{"plate", "foot",   "intruder",   "disc",    "disk",
                                                "body",  "sphere", "projectile", "cylinder"};
constexpr std::array<std::string_view, 9> kMaybeFoot{"rod", "probe",        "cone",   "ball", "indenter",
                                                     "tip", "penetrometer", "piston", "puck"};

struct Size {
  const SetupEntry* entry;
  double diameter_m;
  bool is_read;
  bool is_foot;  // False for a part that may carry the foot.
};

template <std::size_t N>
bool holds(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

double of_area_m(double area_m2) { return std::sqrt(4.0 * area_m2 / std::numbers::pi); }

bool is_read(CampaignPlant plant, std::string_view key) {
  switch (plant) {
    case CampaignPlant::hopper:
      return key == "foot_radius_m" || holds(kDiameterKeys, key);
    case CampaignPlant::intruder:
      return key == "radius_m" || holds(kDiameterKeys, key);
    case CampaignPlant::falling_body:
      return key == "frontal_area_m2" || holds(kDiameterKeys, key);
    case CampaignPlant::rotary_axis:
      return false;
  }
  return false;
}

// Sides of a foot that is no disc. The tools take the disc of the same area.
constexpr std::array<std::string_view, 4> kSides{"width", "side", "edge", "breadth"};
constexpr std::array<std::string_view, 2> kFlat{"plate", "foot"};

// The square metres of one unit of an area: "plate_area_cm2".
std::optional<double> unit_of_area_m2(std::string_view key) {
  struct Area {
    std::string_view ending;
    double in_m2;
  };
  for (const auto& [ending, in_m2] : {Area{"_mm2", 1e-6}, Area{"_cm2", 1e-4}, Area{"_m2", 1.0}})
    if (key.ends_with(ending)) return in_m2;
  return std::nullopt;
}

// The size that "plate_area_cm2", "plate_width_mm" or plate = "80 mm" states.
std::optional<Size> size_in_other_words(const SetupEntry& entry) {
  if (const auto* text = std::get_if<std::string>(&entry.value)) {
    const auto number = number_in_text(*text);
    const bool is_length = number && number->dimension == "length" && number->value > 0.0;
    if (!is_length || !holds(kFoot, plain_name(entry.key))) return std::nullopt;
    return Size{&entry, number->value * number->to_si, false, true};
  }
  const auto* value = std::get_if<double>(&entry.value);
  if (value == nullptr || !(*value > 0.0)) return std::nullopt;
  const auto last = entry.key.rfind('_');
  const auto kind_at = last == std::string::npos ? last : entry.key.rfind('_', last - 1);
  const std::string thing = kind_at == std::string::npos ? "" : plain_name(entry.key.substr(0, kind_at));
  const auto begin = kind_at == std::string::npos ? 0 : kind_at + 1;
  const auto kind = plain_name(entry.key.substr(begin, last == std::string::npos ? last : last - begin));
  if (const auto unit_m2 = unit_of_area_m2(entry.key)) {
    if (kind != "area" || (!thing.empty() && !holds(kFoot, thing))) return std::nullopt;
    return Size{&entry, of_area_m(*value * *unit_m2), false, true};
  }
  const auto parts = parts_of_key(entry.key);
  if (parts.dimension != "length" || !holds(kSides, kind) || !holds(kFlat, thing)) return std::nullopt;
  const double side_m = *value * parts.to_si;
  return Size{&entry, of_area_m(side_m * side_m), false, false};
}

// The size that an entry states: "<thing>_diameter_<length>", "radius_mm", "frontal_area_m2".
std::optional<Size> size_of(const SetupEntry& entry, CampaignPlant plant) {
  if (const auto size = size_in_other_words(entry); size && !is_read(plant, entry.key)) return size;
  const auto* value = std::get_if<double>(&entry.value);
  if (value == nullptr || !(*value > 0.0)) return std::nullopt;
  if (entry.key == "frontal_area_m2" && plant == CampaignPlant::falling_body)
    return Size{&entry, of_area_m(*value), true, true};
  const auto parts = parts_of_key(entry.key);
  if (parts.dimension != "length") return std::nullopt;
  const auto last = parts.quantity.rfind('_');
  const auto kind = plain_name(last == std::string::npos ? parts.quantity : parts.quantity.substr(last + 1));
  const auto thing = last == std::string::npos ? "" : plain_name(parts.quantity.substr(0, last));
  if (kind != "diameter" && kind != "radius") return std::nullopt;
  const bool foot = thing.empty() || holds(kFoot, thing);
  if (!foot && !holds(kMaybeFoot, thing)) return std::nullopt;
  return Size{&entry, *value * parts.to_si * (kind == "radius" ? 2.0 : 1.0), is_read(plant, entry.key), foot};
}

bool is_side(const Size& size) {
  return std::ranges::any_of(
      kSides, [&](std::string_view side) { return size.entry->key.find(side) != std::string::npos; });
}

bool is_same(double a_m, double b_m) { return std::abs(a_m - b_m) <= kSameScale * std::abs(b_m); }

std::string_view usual_key(CampaignPlant plant) {
  if (plant == CampaignPlant::falling_body) return "diameter_m";
  return plant == CampaignPlant::hopper ? "foot_diameter_m" : "plate_diameter_m";
}

Finding complaint(const Size& size, const std::string& file, std::string what, std::string cure) {
  const auto at = size.entry->node.key_position;
  return {FindingKind::set_up,
          FindingSeverity::trial_unusable,
          file,
          at.line,
          at.column,
          size.entry->key,
          std::move(what),
          std::move(cure)};
}

}  // namespace

std::optional<double> believed_diameter_m(const Belief& belief) {
  if (const auto* hopper = std::get_if<HopperBelief>(&belief)) return 2.0 * hopper->robot.leg.foot_radius_m;
  if (const auto* intruder = std::get_if<IntruderBelief>(&belief)) return 2.0 * intruder->foot.radius_m;
  if (const auto* body = std::get_if<FallingBodyBelief>(&belief))
    if (body->body.frontal_area_m2 > 0.0) return of_area_m(body->body.frontal_area_m2);
  return std::nullopt;
}

std::optional<Finding> contradicting_sizes(const CampaignTrial& trial, CampaignPlant plant,
                                           const std::string& file) {
  if (plant == CampaignPlant::rotary_axis) return std::nullopt;
  std::vector<Size> sizes;
  for (const auto& entry : trial.setup)
    if (const auto size = size_of(entry, plant)) sizes.push_back(*size);
  const auto read = std::ranges::find(sizes, true, &Size::is_read);
  if (read != sizes.end()) {
    for (const auto& size : sizes)
      if (size.is_foot && !is_same(size.diameter_m, read->diameter_m))
        return complaint(size, file,
                         fmt::format("is a diameter of {:.6g} m, and {} is one of {:.6g} m: they contradict "
                                     "each other",
                                     size.diameter_m, read->entry->key, read->diameter_m),
                         "state one of them");
    return std::nullopt;
  }
  const auto believed = believed_diameter_m(trial.belief);
  const auto* body = std::get_if<FallingBodyBelief>(&trial.belief);
  // A body without drag needs no size.
  if (!believed && body != nullptr && body->medium.density_kg_per_m3 == 0.0) return std::nullopt;
  for (const auto& size : sizes)
    if (!believed || !is_same(size.diameter_m, *believed))
      return complaint(
          size, file,
          fmt::format("is not read{}", believed ? fmt::format(", and a diameter of {:.6g} m is "
                                                              "used instead",
                                                              *believed)
                                                : ""),
          fmt::format("write {} = {:.6g}{}", usual_key(plant), size.diameter_m,
                      is_side(size) ? ", of the disc of the same area, if the foot is a square" : ""));
  return std::nullopt;
}

}  // namespace sandhopper
