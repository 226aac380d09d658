#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"
#include "tools/campaign/plant_kind.hpp"

// The recording contract as tables: every key of a plant's nominal.toml and every channel of its recordings,
// with unit, default and meaning. Keys, ranges and defaults are read from the structs that read the files, so
// that they cannot differ from what the program does; only the meanings are written here.
namespace sandhopper {

struct BeliefKey {
  std::string table;  // empty: at the top of the file
  std::string key;
  std::string unit;           // "1" for a pure number
  std::string default_value;  // as one would write it; "not set" where the key has no default
  Range range;
  std::string_view meaning;  // empty: nobody has written one (a test fails)
  // Every plant's [sensors] and [spread] take every plant's keys: false where the key says nothing of this
  // plant.
  bool of_this_plant = true;
  bool used = true;  // false: read and checked, but no tool uses it so far

  std::string path() const { return table.empty() ? key : table + "." + key; }
};

// In the order of the file.
std::vector<BeliefKey> belief_keys(CampaignPlant plant);

// Meaning of a key of nominal.toml; `path` is "table.key", or "key" at the top of the file. Empty: no such
// key.
std::string_view meaning_of_key(std::string_view path);

struct ChannelEntry {
  std::string_view name;
  std::string unit;
  std::string_view meaning;
};

// `t_s` first.
std::vector<ChannelEntry> channel_entries(CampaignPlant plant);

std::string_view meaning_of(TrialKind kind);
std::string_view meaning_of(CampaignPlant plant);

}  // namespace sandhopper
