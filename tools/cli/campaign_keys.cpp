#include "tools/cli/campaign_keys.hpp"

#include <algorithm>
#include <cmath>

#include "tools/campaign/key_reference.hpp"

namespace sandhopper::cli {
namespace {

CampaignPlant plant_of(const std::string& word) {
  const auto& names = EnumNames<CampaignPlant>::value;
  return static_cast<CampaignPlant>(std::ranges::find(names, word) - names.begin());
}

nlohmann::ordered_json bound(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json as_json(const BeliefKey& key) {
  return {{"table", key.table},
          {"key", key.key},
          {"unit", key.unit},
          {"default", key.default_value},
          {"low", bound(key.range.low)},
          {"high", bound(key.range.high)},
          {"of_this_plant", key.of_this_plant},
          {"needed", key.is_needed},
          {"used", key.used},
          {"meaning", key.meaning}};
}

void say_channels(Session& session, CampaignPlant plant) {
  session.say("\nChannels of a recording, all but t_s optional:");
  auto channels = nlohmann::ordered_json::array();
  for (const auto& channel : channel_entries(plant)) {
    session.say("  {:28} {:10} {}", channel.name, channel.unit, channel.meaning);
    channels.push_back({{"name", channel.name}, {"unit", channel.unit}, {"meaning", channel.meaning}});
  }
  session.result["channels"] = channels;
}

void say_kinds(Session& session) {
  session.say("\nKinds of trial:");
  auto kinds = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < EnumNames<TrialKind>::value.size(); ++k) {
    const auto kind = static_cast<TrialKind>(k);
    session.say("  {:28} {}", name_of(kind), meaning_of(kind));
    kinds.push_back({{"name", name_of(kind)}, {"meaning", meaning_of(kind)}});
  }
  session.result["kinds"] = kinds;
}

void say_keys(Session& session, CampaignPlant plant, bool every_key) {
  session.say(
      "\nKeys of nominal.toml (unit, default, meaning). State those that are needed; the others are "
      "optional:");
  auto keys = nlohmann::ordered_json::array();
  std::string table;
  for (const auto& key : belief_keys(plant)) {
    keys.push_back(as_json(key));
    if (!every_key && !key.of_this_plant) continue;
    if (key.table != table) session.say("[{}]", table = key.table);
    session.say("  {:32} {:10} {:10} {}{}", key.key, key.unit, key.default_value, key.meaning,
                key.is_needed                    ? " (needed)"
                : key.used || !key.of_this_plant ? ""
                                                 : " (not used so far)");
  }
  session.result["keys"] = keys;
}

}  // namespace

ExitCode print_campaign_keys(Session& session, const std::string& plant_name, bool every_key) {
  const auto plant = plant_of(plant_name);
  session.result = {
      {"plant", plant_name}, {"meaning", meaning_of(plant)}, {"usual_kind", name_of(usual_kind(plant))}};
  session.say("plant \"{}\": {}", plant_name, meaning_of(plant));
  say_channels(session, plant);
  say_kinds(session);
  say_keys(session, plant, every_key);
  return ExitCode::ok;
}

}  // namespace sandhopper::cli
