#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/node.hpp"
#include "firmware/log/csv_layout.hpp"
#include "tools/campaign/available.hpp"
#include "tools/campaign/belief.hpp"
#include "tools/campaign/finding.hpp"
#include "tools/campaign/plant_kind.hpp"

namespace sandhopper {

// A second column of the same quantity: seconds and nanoseconds, a date and a time of day.
struct AddedColumn {
  std::string column{};  // empty: none
  double scale = 1.0;
};

// channel = scale x column + offset, and for the time + the scaled second column
struct ColumnMapping {
  std::string channel{};
  std::string column{};
  double scale = 1.0;
  double offset = 0.0;
  ConfigPosition position{};  // in campaign.toml
  std::string unit{};         // of the column's numbers, as the experimenter states it; empty: not stated
  bool has_scale = false;     // `scale` is written down
  AddedColumn plus{};

  bool is_stated() const { return !unit.empty() && has_scale; }  // its experimenter knows what it holds
};

// Rows that count: where `column` holds `value`, between two times in s, as t_s is after its mapping.
struct RowSelection {
  std::string column{};  // empty: every row
  double value = 0.0;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  std::uint64_t from_line = 0;  // of the file, from 1
  std::uint64_t to_line = std::numeric_limits<std::uint64_t>::max();

  bool selects() const { return *this != RowSelection{}; }
  bool operator==(const RowSelection&) const = default;
};

// A second recording of the same trial on the same clock, e.g. of a force plate with its own rate.
struct CompanionFile {
  std::filesystem::path file;
  std::vector<ColumnMapping> columns;  // its own, t_s among them where its time has another name
  CsvFormat format{};
};

using SetupValue = std::variant<double, std::string, bool>;
struct SetupEntry {
  std::string key;  // as written, its unit in its name
  SetupValue value;
  ConfigNode node;  // with its place in campaign.toml
};

struct CampaignTrial {
  std::string name;  // the file as written
  std::filesystem::path file;
  TrialKind kind{};
  std::vector<SetupEntry> setup;       // everything else the experimenter wrote down
  std::vector<ColumnMapping> columns;  // the campaign's, with the trial's own in front
  RowSelection rows{};
  CsvFormat format{};  // how its file is written
  std::vector<CompanionFile> companions{};
  ConfigPosition position{};  // of its [[trial]]
  // What its recording is read against: the campaign's belief with the set-up's own values.
  Belief belief{};
  // Numbers that the model leaves at "?" and the set-up does not state; their places in `belief` hold a
  // default.
  std::vector<UnstatedNumber> unstated{};

  bool states(std::string_view path) const;  // "body.mass_kg", or a set-up value that gives it
  bool is_unstated(std::string_view path) const;
  std::optional<double> number(std::string_view key) const;  // a set-up value
  bool states_diameter() const;                              // by one of kDiameterKeys
  std::optional<std::string> text(std::string_view key) const;
  std::optional<bool> flag(std::string_view key) const;
  // The same recording may be named by several trials that select different rows.
  std::size_t index = 0;  // place in the campaign
  std::size_t entry = 0;  // its [[trial]] in campaign.toml, from 1
};

// A folder of recordings and what its experimenter says about them. Only names and set-ups are held; a
// recording is read when it is asked for (read_trial), so a campaign of thousands takes little memory.
struct Campaign {
  std::filesystem::path folder;
  std::filesystem::path file;        // campaign.toml
  std::filesystem::path recordings;  // the trials' files are relative to it: `folder`, unless `data` is given
  std::string name;
  CampaignPlant plant{};
  Belief belief{};
  std::filesystem::path model{};  // empty: the plant's default
  std::vector<UnstatedNumber> unstated;
  Available available;                // [available]: what the lab can set for its next trial
  std::vector<CampaignTrial> trials;  // those that campaign.toml describes well enough to be read
  std::vector<Finding> findings;      // what is wrong with campaign.toml itself; such trials are left out
};

// Reads FOLDER/campaign.toml (or that file itself) and its model. Beyond name, plant, model, [columns] and
// [[trial]] with file, kind and set-up, a trial may have:
//   columns = { foot_z_m = { column = "Z", scale = 0.001, offset = -0.01 } }   its own mapping
//   columns = { t_s = { column = "secs", plus = { column = "nsecs", scale = 1e-9 } } }
//   select  = { column = "drop", value = 2, from_s = 1.0, to_s = 3.0 }         some rows of its file,
//             or { from_line = 2, to_line = 41 }
//   also    = { file = "plate.csv", columns = { t_s = "t" } }                  a second file of the trial
//   format  = { decimal = ",", header_line = 4 }                               how its file is written
// [format] says the last for all trials (table_format.hpp), [every_trial] holds keys that each [[trial]] has
// unless it says otherwise, and [available] what the next trial can be (available.hpp).
// `data` names the folder of recordings that are kept elsewhere (recordings_folder.hpp), `source` says how to
// get them. Throws ConfigError where nothing can be read at all: no campaign.toml, not TOML, no or an unknown
// plant, no trial, a model that is not right in every key, a `data` folder that is not on this computer.
Campaign load_campaign(const std::filesystem::path& folder);

}  // namespace sandhopper
