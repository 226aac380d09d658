#include "tools/campaign/setup_vocabulary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <set>

#include "config/hint.hpp"
#include "tools/campaign/belief.hpp"
#include "tools/campaign/key_reference.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {
namespace {

// Keys that terrain, diagnose and the checks read from a [[trial]] (calls of CampaignTrial::number, flag and
// text, and of Trial::setup_or).
struct ReadKey {
  std::string_view key;
  bool takes_number = true;
};
constexpr std::array kRead{ReadKey{"bed_depth_m"},
                           ReadKey{"wait_s"},
                           ReadKey{"pushes_since_preparation"},
                           ReadKey{"release_height_m"},
                           ReadKey{"release_speed_mps"},
                           ReadKey{"impact_speed_mps"},
                           ReadKey{"payload_kg"},
                           ReadKey{"compression_stiffness_N_per_m"},
                           ReadKey{"contact_settling_s"},
                           ReadKey{"friction_angle_deg"},
                           ReadKey{"loading_from_s"},
                           ReadKey{"loading_to_s"},
                           ReadKey{"mass_min_kg"},
                           ReadKey{"mass_max_kg"},
                           ReadKey{"stance_position_gain_Nm_per_rad"},
                           ReadKey{"stance_velocity_gain_Nm_s_per_rad"},
                           ReadKey{"stance_target_rad"},
                           ReadKey{"flight_position_gain_Nm_per_rad"},
                           ReadKey{"flight_velocity_gain_Nm_s_per_rad"},
                           ReadKey{"flight_target_rad"},
                           ReadKey{"motor_enabled", false},
                           ReadKey{"held_out", false}};

std::vector<std::string> words_in(std::string_view name) {
  std::vector<std::string> words(1);
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!words.back().empty())
      words.emplace_back();
  return words;
}

std::string usual_word(const std::string& word) {
  if (word == "diam" || word == "dia" || word == "diametre") return "diameter";
  return word == "velocity" ? "speed" : word;
}

SetupWord word_for(std::string_view key, const std::string& table, bool takes_number) {
  const auto parts = parts_of_key(key);
  SetupWord word{std::string(key), {plain_name(parts.quantity)}, parts.dimension, parts.to_si};
  if (!table.empty()) word.names.push_back(plain_name(fmt::format("{}_{}", table, parts.quantity)));
  if (!table.empty()) word.path = fmt::format("{}.{}", table, word.key);
  if (word.names.front() == "rate") word.names.erase(word.names.begin());  // may be that of any instrument
  word.takes_number = takes_number;
  return word;
}

}  // namespace

std::string plain_name(std::string_view quantity) {
  auto words = words_in(quantity);
  for (auto& word : words) word = usual_word(word);
  std::ranges::sort(words);
  std::string plain;
  for (const auto& word : words) plain += word;
  return plain;
}

KeyParts parts_of_key(std::string_view key) {
  KeyParts parts{std::string(key)};
  if (const auto unit = split_unit(key))
    parts = {std::string(unit->quantity), std::string(unit->suffix), std::string(unit->dimension),
             unit->to_si};
  // The longest end that is a unit: "mm_s" before "s".
  for (auto at = key.find('_'); at != std::string_view::npos; at = key.find('_', at + 1)) {
    if (at == 0 || at >= parts.quantity.size()) break;
    std::string tail(key.substr(at + 1));
    if (const auto per = tail.find("_per_"); per != std::string::npos) tail.erase(per, 4)[per] = '/';
    if (tail.find('/') == std::string::npos && tail.find('_') != std::string::npos)
      tail[tail.find('_')] = '/';
    const auto unit = read_unit(tail, false);
    if (!unit || unit->dimension.empty() || unit->to_si == 0.0) continue;
    return {std::string(key.substr(0, at)), unit->text, unit->dimension, unit->to_si};
  }
  return parts;
}

std::vector<SetupWord> setup_words(CampaignPlant plant) {
  std::vector<SetupWord> words;
  std::set<std::string, std::less<>> taken;  // A set-up key means the first key of its name.
  for (const auto& key : belief_keys(plant))
    if (key.table != "spread" && key.of_this_plant && taken.insert(key.key).second)
      words.push_back(word_for(key.key, key.table, key.unit != "true or false"));
  if (plant != CampaignPlant::rotary_axis)
    for (const auto key : kDiameterKeys) words.push_back(word_for(key, "", true));
  for (const auto& [key, takes_number] : kRead)
    if (taken.insert(std::string(key)).second) words.push_back(word_for(key, "", takes_number));
  return words;
}

std::optional<WrittenNumber> number_in_text(std::string_view text) {
  const std::string copy(text);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  if (end == copy.c_str()) return std::nullopt;
  std::string_view rest(end);
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  if (rest.empty()) return WrittenNumber{value};
  const auto unit = read_unit(rest, false);
  if (!unit || unit->dimension.empty() || unit->to_si == 0.0) return std::nullopt;
  return WrittenNumber{value, unit->dimension, unit->to_si};
}

}  // namespace sandhopper
