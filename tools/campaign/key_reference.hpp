#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"
#include "tools/campaign/plant_kind.hpp"

// Reference tables of the recording contract: keys of nominal.toml and channels, with unit, default and
// meaning. Keys, ranges and defaults come from the structs that read the files, so they always agree with the
// program. Only the meanings are written by hand.
namespace sandhopper {

struct BeliefKey {
  std::string table;  // empty: top of the file
  std::string key;
  std::string unit;           // "1" for a dimensionless number
  std::string default_value;  // As written in a file; "not set" if there is no default.
  Range range;
  std::string_view meaning;  // A test fails if it is empty.
  // False if the key has no meaning for this plant: [sensors] and [spread] of every plant accept the keys of
  // all plants.
  bool of_this_plant = true;
  bool is_needed = false;  // True if the answer depends on it and the default is only a placeholder.
  bool used = true;        // False if the key is read and checked, but not used by any tool yet.

  std::string path() const { return table.empty() ? key : table + "." + key; }
};

// in the order of the file
std::vector<BeliefKey> belief_keys(CampaignPlant plant);

// Advice for a key of [sensors] or [spread] that the plant does not use: the plant's key for the same thing,
// if there is one (same words at the end, "noise_m"), or the keys that are used.
std::string key_in_its_place(CampaignPlant plant, std::string_view table, const std::string& key);

// Keys of the plant that end as `key` does from its second word on. Empty if there is none.
std::vector<std::string> keys_alike(CampaignPlant plant, std::string_view table, std::string_view key);

// Meaning of a key of nominal.toml; empty if there is no such key. `path`: "table.key", or "key" at the top
// of the file.
std::string_view meaning_of_key(std::string_view path);

struct ChannelEntry {
  std::string_view name;
  std::string unit;
  std::string_view meaning;
};

// The first entry is `t_s`.
std::vector<ChannelEntry> channel_entries(CampaignPlant plant);

// Meaning of a kind of trial or of a plant, as a short text.
std::string_view meaning_of(TrialKind kind);
std::string_view meaning_of(CampaignPlant plant);

}  // namespace sandhopper
