#include "tools/campaign/setup_keys.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "config/hint.hpp"

namespace sandhopper {
namespace {

using Words = std::vector<std::string_view>;

Words words_of(std::string_view name) {
  Words words;
  while (!name.empty()) {
    const auto end = std::min(name.find('_'), name.size());
    if (end > 0) words.push_back(name.substr(0, end));
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return words;
}

template <std::size_t N>
bool any_of(const Words& words, const std::array<std::string_view, N>& wanted) {
  return std::ranges::any_of(words,
                             [&](auto word) { return std::ranges::find(wanted, word) != wanted.end(); });
}

constexpr std::array<std::string_view, 9> kOfBed{"bed",    "fill",      "filling", "sand", "grain",
                                                 "grains", "container", "box",     "bead"};
constexpr std::array<std::string_view, 4> kHowDeep{"depth", "height", "level", "thickness"};
constexpr std::array<std::string_view, 8> kNotDeep{"surface", "target", "switch", "start",
                                                   "release", "crater", "drop",   "diameter"};
constexpr std::array<std::string_view, 8> kWait{"wait",   "waiting", "waited", "rest",
                                                "rested", "resting", "pause",  "idle"};
constexpr std::array<std::string_view, 4> kSince{"since", "after", "preparation", "prepared"};
constexpr std::array<std::string_view, 10> kPush{"push",        "pushes",      "intrusion", "intrusions",
                                                 "hop",         "hops",        "press",     "presses",
                                                 "penetration", "penetrations"};
constexpr std::array<std::string_view, 4> kOrdinal{"number", "index", "nr", "no"};
constexpr std::array<std::string_view, 5> kBefore{"since", "before", "after", "previous", "prior"};

bool says_wait(const Words& words) { return any_of(words, kWait) || any_of(words, kSince); }

}  // namespace

std::optional<SetupMeaning> meaning_of_setup(std::string_view key) {
  if (key == "wait_s" || key == "bed_depth_m" || key == "pushes_since_preparation") return std::nullopt;
  if (const auto unit = split_unit(key)) {
    const Words words = words_of(unit->quantity);
    if (unit->dimension == "length" && any_of(words, kOfBed) && any_of(words, kHowDeep) &&
        !any_of(words, kNotDeep))
      return SetupMeaning{.key = "bed_depth_m", .scale = unit->to_si};
    if (unit->dimension == "time" && says_wait(words))
      return SetupMeaning{.key = "wait_s", .scale = unit->to_si};
    return std::nullopt;
  }
  const Words words = words_of(key);
  // _min and _h are not unit suffixes of the configuration (its keys end in _min for "minimum"), so handle
  // them here.
  if (says_wait(words) && (words.back() == "min" || words.back() == "h"))
    return SetupMeaning{.key = "wait_s", .scale = words.back() == "h" ? 3600.0 : 60.0};
  if (!any_of(words, kPush)) return std::nullopt;
  if (any_of(words, kBefore)) return SetupMeaning{.key = "pushes_since_preparation"};
  if (any_of(words, kOrdinal)) return SetupMeaning{.key = "pushes_since_preparation", .is_ordinal = true};
  return std::nullopt;
}

}  // namespace sandhopper
