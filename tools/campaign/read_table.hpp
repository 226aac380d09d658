#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// A trial's file as a table, before its columns become channels.
struct TrialTable {
  CsvTable table{};
  std::string file{};
  bool own_log = false;
  // Columns that cannot be used: most cells are no numbers, or the name stands twice.
  std::vector<std::string> unusable_columns{};
};

// Finds the file (a recording, or the folder of a hop that holds one), reads it and adds what is wrong to
// `findings`. Nothing where there is no table at all.
std::optional<TrialTable> read_table(const Campaign& campaign, const CampaignTrial& trial,
                                     std::vector<Finding>& findings);

const ColumnMapping* mapping_of(const CampaignTrial& trial, std::string_view channel);
// The column of a name as written, or as it stands behind the mark of a remark ("# t_s"). Null where there is
// none.
const std::vector<double>* find_column(const CsvTable& table, std::string_view name);
// The mapped column of the time, else t_s; null where the file has neither.
const std::vector<double>* time_column(const CsvTable& table, const CampaignTrial& trial);

// The column of a hop's phase, and the words that it may hold in place of 0, 1, 2, in one sentence.
std::string phase_column(const CampaignTrial& trial);
std::string phase_names();

// "Time (s)", "timestamp", "t", "millis", "Zeit".
bool is_called_time(std::string_view name);
// The column that looks like a time, by its name; t_s is not looked for.
std::optional<std::size_t> time_like_column(const CsvTable& table, CampaignPlant plant);
// Advice for a file in which no column is the time: the column that looks like it, with its scale. Empty
// where no column looks like a time.
std::string cure_for_time(const CsvTable& table, CampaignPlant plant);

}  // namespace sandhopper
