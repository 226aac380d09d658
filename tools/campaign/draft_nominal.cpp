#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <type_traits>

#include "config/hint.hpp"
#include "tools/campaign/belief.hpp"
#include "tools/campaign/belief_notes.hpp"
#include "tools/campaign/campaign_draft.hpp"
#include "tools/campaign/key_reference.hpp"

namespace sandhopper {
namespace {

// Text of a number that TOML reads as a float.
std::string toml_real(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

// Another statement that makes a key of an intruder unnecessary.
std::string_view replacement_of(CampaignPlant plant, std::string_view path) {
  if (plant != CampaignPlant::intruder) return "";
  if (path == "foot.radius_m") return "not needed if each trial states plate_diameter_m";
  if (path == "terrain.stiffness_N_per_m") return "not needed if stiffness_per_area_N_per_m3 is stated";
  return "";
}

class NominalWriter {
 public:
  NominalWriter(CampaignPlant plant, bool commands_recorded)
      : plant_(plant), commands_recorded_(commands_recorded), keys_(belief_keys(plant)) {}

  template <class Table>
  void write(const Table& table, const std::string& name) {
    Table::fields(table, [&]<class Member>(std::string_view key, const Member& member, Range range = {}) {
      if constexpr (!HasFields<const Member>) line(name, key, member, range);
    });
    Table::fields(table, [&]<class Member>(std::string_view key, const Member& member, Range = {}) {
      if constexpr (HasFields<const Member>) {
        text_ += fmt::format("\n[{}]\n", key);
        write(member, std::string(key));
        if (key == "spread") text_ += example_of_uncertainty();
      }
    });
  }
  std::string take() { return std::move(text_); }

 private:
  // A number of the plant that differs from trial to trial, or that is known to some per cent only.
  std::string example_of_uncertainty() const {
    constexpr std::array<std::string_view, EnumNames<CampaignPlant>::value.size()> kNumbers{
        "body_mass", "bulk_density", "mass", "inertia"};
    return fmt::format(
        "# {0}_relative = 0.02   # differs by 2 % from trial to trial; any other number above likewise: its "
        "name "
        "without the unit\n\n"
        "# How well a number is known that is the same in all trials\n"
        "# [known_to]\n"
        "# {0}_relative = 0.02   # known to 2 %\n",
        kNumbers[static_cast<std::size_t>(plant_)]);
  }

  template <class Member>
  void line(const std::string& table, std::string_view key, const Member& member, Range range) {
    if (key.ends_with("_name")) return;
    std::string value = "0.0";
    if constexpr (std::is_same_v<Member, bool>)
      value = member ? "true" : "false";
    else if constexpr (std::is_arithmetic_v<Member>)
      value = toml_real(static_cast<double>(member));
    else if constexpr (std::is_same_v<Member, std::optional<double>>)
      value = member ? toml_real(*member) : toml_real(std::max(0.0, range.low));
    else
      return;
    const std::string path = table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
    // Every plant accepts the sensors of all plants. A draft holds those of its own.
    const auto entry = std::ranges::find(keys_, path, &BeliefKey::path);
    if (entry != keys_.end() && !entry->used) return;
    const bool of_controller =
        std::ranges::find(hopper_controller_keys(), path) != hopper_controller_keys().end();
    const bool needed = decides_answer(plant_, path) && !(of_controller && commands_recorded_);
    if (needed && key != "gravity_mps2") value = fmt::format("\"{}\"", kUnknownNumber);
    const auto meaning = meaning_of_key(path);
    std::string comment = unit_of_key(key);
    if (!meaning.empty()) comment += (comment.empty() ? "" : "; ") + std::string(meaning);
    if (const auto other = replacement_of(plant_, path); !other.empty())
      comment += fmt::format("; {}", other);
    text_ += fmt::format("{}{} = {}{}\n", needed ? "" : "# ", key, value,
                         comment.empty() ? "" : "   # " + comment);
  }

  const CampaignPlant plant_;
  const bool commands_recorded_;
  const std::vector<BeliefKey> keys_;
  std::string text_;
};

}  // namespace

std::string draft_nominal(CampaignPlant plant, bool commands_recorded) {
  NominalWriter writer(plant, commands_recorded);
  std::visit([&](const auto& belief) { writer.write(belief, ""); }, belief_of_silence(plant));
  return fmt::format(
             "# What the simulation believes of plant \"{}\". Lines without # are needed: write your number "
             "for each \"?\".\n"
             "# Take the # away from what you know besides; what stays a remark is not there, or has the "
             "value that stands "
             "here.\n",
             name_of(plant)) +
         writer.take();
}

}  // namespace sandhopper
