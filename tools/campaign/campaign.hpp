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

// A second column with another part of the same time: seconds and nanoseconds, or date and time of day.
struct AddedColumn {
  std::string column{};  // empty: none
  double scale = 1.0;
};

// channel = scale x column + offset; for the time also + plus.scale x plus.column; for other channels also +
// the `added` columns, each in its own unit.
struct ColumnMapping {
  std::string channel{};
  std::string column{};
  double scale = 1.0;
  double offset = 0.0;
  ConfigPosition position{};  // in campaign.toml
  std::string unit{};         // Unit of the column's numbers as the user states it; empty if not stated.
  bool has_scale = false;     // True if the mapping states a scale.
  AddedColumn plus{};
  std::vector<std::string> added{};  // further columns of the same quantity: two load cells below one plate

  // The user states both, so values are taken as stated even if they are implausible.
  bool is_stated() const { return !unit.empty() && has_scale; }
};

// Rows to read: those in which `column` holds `value`, between two times in s (t_s after its mapping),
// between two lines.
struct RowSelection {
  std::string column{};  // empty: every row
  double value = 0.0;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  std::uint64_t from_line = 0;  // line of the file, from 1
  std::uint64_t to_line = std::numeric_limits<std::uint64_t>::max();

  bool selects() const { return *this != RowSelection{}; }
  bool operator==(const RowSelection&) const = default;
};

// A second recording of the same trial on the same clock, for example of a force plate with its own rate.
struct CompanionFile {
  std::filesystem::path file;
  // Its own mappings; t_s is among them if its time column has another name.
  std::vector<ColumnMapping> columns;
  CsvFormat format{};
};

using SetupValue = std::variant<double, std::string, bool>;
struct SetupEntry {
  std::string key;  // As written, with its unit in the name.
  SetupValue value;
  ConfigNode node;  // for its position in campaign.toml
};

// One [[trial]] of campaign.toml.
struct CampaignTrial {
  std::string name;  // the file name as written
  std::filesystem::path file;
  TrialKind kind{};
  std::vector<SetupEntry> setup;       // All other keys of the [[trial]].
  std::vector<ColumnMapping> columns;  // Mappings of the trial, then those of the campaign.
  RowSelection rows{};
  CsvFormat format{};  // format of its file
  std::vector<CompanionFile> companions{};
  ConfigPosition position{};  // position of its [[trial]]
  // The campaign's belief with the values of this set-up.
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

// A folder of recordings and its description. Only names and set-ups are kept in memory; read_trial reads one
// recording at a time, so memory use stays small for thousands of trials.
struct Campaign {
  std::filesystem::path folder;
  std::filesystem::path file;  // campaign.toml
  // The trials' files are relative to it: `folder`, or the folder that `data` names.
  std::filesystem::path recordings;
  std::string name;
  CampaignPlant plant{};
  Belief belief{};
  std::filesystem::path model{};  // empty: the plant's default
  std::vector<UnstatedNumber> unstated;
  Available available;                // [available]: what the lab can set for its next trial
  std::vector<CampaignTrial> trials;  // those that campaign.toml describes well enough to be read
  std::vector<Finding> findings;      // what is wrong with campaign.toml itself; such trials are left out
};

// Reads FOLDER/campaign.toml (or that file itself) and its model. Besides name, plant, model, [columns] and
// [[trial]] with file, kind and set-up, a trial may have:
//   columns = { foot_z_m = { column = "Z", scale = 0.001, offset = -0.01 } }   its own mapping
//   columns = { force_N = { column = ["A (N)", "B (N)"] } }                    the sum of two load cells
//   columns = { t_s = { column = "secs", plus = { column = "nsecs", scale = 1e-9 } } }
//   select  = { column = "drop", value = 2, from_s = 1.0, to_s = 3.0 }         some rows of its file,
//             or { from_line = 2, to_line = 41 }
//   also    = { file = "plate.csv", columns = { t_s = "t" } }                  a second file of the trial
//   format  = { decimal = ",", header_line = 4 }                               format of its file
// [format] applies to all trials (table_format.hpp). [every_trial] holds keys for each [[trial]] that does
// not set them itself. [available] lists set-ups of the next trial (available.hpp). `data` names a folder of
// recordings kept elsewhere (recordings_folder.hpp), `source` says how to get them.
// Throws ConfigError if nothing can be read: no campaign.toml, not TOML, no plant or an unknown one, no
// trial, an error in the model, or a `data` folder that is not on this computer.
Campaign load_campaign(const std::filesystem::path& folder);

}  // namespace sandhopper
