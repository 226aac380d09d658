#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <sstream>

#include "config/hint.hpp"
#include "firmware/log/csv_export.hpp"
#include "firmware/log/csv_import.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/column_names.hpp"
#include "tools/campaign/companion.hpp"
#include "tools/campaign/position_loop.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/campaign/trial_rows.hpp"

namespace sandhopper {
namespace {

namespace fs = std::filesystem;
using enum FindingSeverity;

constexpr std::uint64_t kMostSlips = 3;

struct FaultMeaning {
  FindingKind kind;
  FindingSeverity severity;
};

FaultMeaning meaning_of(CsvFault fault) {
  using enum CsvFault;
  switch (fault) {
    case no_header:
      return {FindingKind::no_header, trial_unusable};
    case no_rows:
      return {FindingKind::empty_file, trial_unusable};
    case no_time_column:
      return {FindingKind::no_time, trial_unusable};
    case duplicate_column:
      return {FindingKind::duplicate_column, channel_unusable};
    case ragged_row:
      return {FindingKind::ragged_row, note};
    case not_a_number:
      return {FindingKind::non_numeric_cell, note};
    case not_finite:
      return {FindingKind::nan_cell, note};
    case no_time:
      return {FindingKind::no_time, note};
    case time_backwards:
      return {FindingKind::time_backwards, note};
    case time_stands_still:
      return {FindingKind::time_stands_still, note};
    case gap:
      return {FindingKind::gap, note};
  }
  return {FindingKind::unreadable_file, trial_unusable};
}

class Reader {
 public:
  Reader(const Campaign& campaign, const CampaignTrial& trial) : campaign_(campaign), trial_(trial) {}

  TrialRecording run() {
    const auto file = locate();
    if (!file) return std::move(out_);
    file_ = places_.file = file->string();
    if (!read_table(*file)) return std::move(out_);
    translate_issues();
    if (!any_unusable(out_.findings)) take_columns();
    if (!any_unusable(out_.findings)) forget_unused_columns();
    if (!any_unusable(out_.findings)) judge_plant();
    if (!any_unusable(out_.findings)) select_rows();
    if (!any_unusable(out_.findings)) {
      join_equal_times(out_, places_);
      note_gaps(out_, places_);
      check_channels(out_, campaign_.plant, places_);
    }
    return std::move(out_);
  }

 private:
  std::optional<fs::path> locate() {
    std::error_code error;
    if (!fs::exists(trial_.file, error)) {
      complain(FindingKind::missing_file, trial_unusable,
               fmt::format("the recording {} does not exist", trial_.file.string()),
               "correct file = \"…\" (it is relative to this folder) or take the trial out");
      return std::nullopt;
    }
    if (!fs::is_directory(trial_.file, error)) return trial_.file;
    for (const auto* ending : {".mcap", ".csv"}) {
      std::vector<fs::path> found;
      for (const auto& entry : fs::directory_iterator(trial_.file, error))
        if (entry.path().extension() == ending) found.push_back(entry.path());
      if (found.size() == 1) return found.front();
      if (found.size() > 1) {
        complain(FindingKind::unreadable_file, trial_unusable,
                 fmt::format("the folder {} holds {} recordings", trial_.file.string(), found.size()),
                 "name one of them: file = \"FOLDER/trial_001.mcap\"");
        return std::nullopt;
      }
    }
    complain(FindingKind::missing_file, trial_unusable,
             fmt::format("the folder {} holds no .mcap or .csv recording", trial_.file.string()),
             "name a recording, or the folder that `hop trial` made");
    return std::nullopt;
  }

  bool read_table(const fs::path& file) {
    try {
      if (file.extension() == ".mcap") {
        std::stringstream text;
        const auto exported = export_csv(file, text, {.optional_channels = true});
        table_ = parse(text);
        out_.own_log = true;
        if (exported.truncated_at)
          add(FindingKind::unreadable_file, note, 0, 0, "",
              fmt::format("the log is cut at byte {}", *exported.truncated_at),
              "what precedes the cut is used");
        if (exported.lost_records > 0)
          add(FindingKind::gap, note, 0, 0, "",
              fmt::format("{} records were lost when it was logged", exported.lost_records), "");
        return true;
      }
      std::ifstream in(file);
      if (!in) throw std::runtime_error("cannot be opened");
      if (in.peek() == std::ifstream::traits_type::eof()) {
        add(FindingKind::empty_file, trial_unusable, 1, 1, "", "the file is empty",
            "record the trial again or take it out of campaign.toml");
        return false;
      }
      table_ = parse(in);
      return true;
    } catch (const std::exception& error) {
      add(FindingKind::unreadable_file, trial_unusable, 0, 0, "",
          fmt::format("cannot be read: {}", error.what()), "check the file and its permissions");
      return false;
    }
  }

  // By the mapped name of the time, or by t_s where the file has no such column.
  CsvTable parse(std::istream& in) {
    CsvReadOptions options;
    options.gap_steps = std::numeric_limits<double>::infinity();
    options.list_repeats = false;
    options.max_issues = 1000;
    const auto* time = mapping_of("t_s");
    if (!trial_.rows.column.empty()) options.check_order = false;
    if (time == nullptr) return read_csv(in, options);
    options.time_column = time->column;
    auto table = read_csv(in, options);
    if (table.find(time->column) != nullptr || table.find("t_s") == nullptr) return table;
    in.clear();
    in.seekg(0);
    options.time_column = "t_s";
    return read_csv(in, options);
  }

  void translate_issues() {
    std::uint64_t dropped = 0, line = 0;
    for (const auto& issue : table_.issues) {
      auto meaning = meaning_of(issue.fault);
      const std::uint64_t count = issue.repeats + 1;
      if (issue.fault == CsvFault::no_time_column && !table_.names.empty()) suggest_time(issue);
      if (issue.fault == CsvFault::no_time_column && !table_.names.empty()) continue;
      if (issue.fault == CsvFault::not_a_number || issue.fault == CsvFault::not_finite)
        if (const auto* column = table_.find(issue.name);
            column != nullptr && count * 5 > samples_in(*column) + count)
          meaning.severity = channel_unusable;
      if (issue.fault == CsvFault::duplicate_column) {
        unusable_columns_.push_back(issue.name);
        if (table_.find(issue.name) == time_column()) meaning.severity = trial_unusable;
      }
      // A few rows out of order are slips; a clock set back leaves nothing to count time by.
      if (issue.fault == CsvFault::time_backwards && count > kMostSlips + table_.rows() / 100)
        meaning.severity = trial_unusable;
      if (meaning.severity == channel_unusable) unusable_columns_.push_back(issue.name);
      const bool drops = issue.fault == CsvFault::ragged_row || issue.fault == CsvFault::no_time ||
                         issue.fault == CsvFault::time_backwards;
      if (drops) dropped += count;
      if (drops && line == 0) line = issue.line;
      add(meaning.kind, meaning.severity, issue.line, issue.column, issue.name, issue.text + repeats(issue),
          cure_for(issue.fault));
    }
    if (dropped * 5 > table_.rows())
      add(FindingKind::unreadable_file, trial_unusable, line, 1, "",
          fmt::format("{} of {} rows had to be left out, too many to trust the rest", dropped,
                      dropped + table_.rows()),
          "repair the file");
  }

  static std::string repeats(const CsvIssue& issue) {
    if (issue.repeats == 0) return "";
    return fmt::format(" (and {} more like it, the last in line {})", issue.repeats, issue.last_line);
  }

  static std::uint64_t samples_in(const std::vector<double>& column) {
    return static_cast<std::uint64_t>(
        std::count_if(column.begin(), column.end(), [](double value) { return !std::isnan(value); }));
  }

  // No t_s: what the file calls its time, or the whole file belongs to something else.
  void suggest_time(const CsvIssue& issue) {
    std::string cure = "name the column of the time: [columns] t_s = { column = \"NAME\", scale = 1.0 }";
    for (const auto& name : table_.names) {
      const auto misnamed = misnamed_unit(name, campaign_.plant);
      const bool is_time = name == "t" || name == "time" || name == "Time" || name.starts_with("time") ||
                           (misnamed && misnamed->channel == "t_s");
      if (!is_time) continue;
      const auto unit = split_unit(name);
      const bool known = unit && unit->dimension == "time" && unit->to_si > 0.0;
      const double scale = known ? unit->to_si : 1.0;
      cure = fmt::format("add t_s = {{ column = \"{}\", scale = {} }} to [columns] (scale: to seconds)", name,
                         scale);
      break;
    }
    add(FindingKind::no_time, trial_unusable, issue.line, 1, issue.name,
        fmt::format("no column is called \"{}\"; the columns are {}", issue.name,
                    fmt::join(table_.names, ", ")),
        cure);
  }

  const ColumnMapping* mapping_of(std::string_view channel) const {
    for (const auto& mapping : trial_.columns)
      if (mapping.channel == channel) return &mapping;
    return nullptr;
  }

  const std::vector<double>* time_column() const {
    const auto* mapped = mapping_of("t_s");
    const auto* column = mapped == nullptr ? nullptr : table_.find(mapped->column);
    return column != nullptr ? column : table_.find("t_s");
  }

  void take_columns() {
    used_.assign(table_.names.size(), false);
    take_time();
    std::vector<std::string_view> taken{"t_s"};
    for (const auto& mapping : trial_.columns) {
      if (std::find(taken.begin(), taken.end(), mapping.channel) != taken.end()) continue;
      const bool plain = table_.find(mapping.column) == nullptr && table_.find(mapping.channel) != nullptr;
      if (plain) continue;  // this file already bears the channel's own name
      taken.push_back(mapping.channel);
      take_mapped(mapping);
    }
    for (std::size_t i = 0; i < table_.names.size(); ++i) {
      const auto& name = table_.names[i];
      if (used_[i] || name == trial_.rows.column) continue;
      const bool mapped = std::find(taken.begin(), taken.end(), name) != taken.end();
      if (find_channel(campaign_.plant, name) != nullptr && !mapped)
        take(i, name, 1.0, 0.0);
      else
        leave(i);
    }
  }

  void take_time() {
    const auto* mapping = mapping_of("t_s");
    const auto* column = time_column();
    if (column == nullptr) return;  // said already
    const auto i = index_of(*column);
    const bool mapped = mapping != nullptr && table_.names[i] == mapping->column;
    const double scale = mapped ? mapping->scale : 1.0;
    const double offset = mapped ? mapping->offset : 0.0;
    if (!(scale > 0.0)) {
      complain_at(mapping->position, FindingKind::set_up, trial_unusable, "t_s",
                  "the scale of the time must be positive",
                  "write scale = 1.0 for seconds, 0.001 for milliseconds");
      return;
    }
    used_[i] = true;
    out_.t_s = *column;
    for (double& time_s : out_.t_s) time_s = scale * time_s + offset;
    places_.lines = table_.lines;
  }

  void take_mapped(const ColumnMapping& mapping) {
    const auto* column = table_.find(mapping.column);
    if (column == nullptr) {
      const auto near = nearest_words(mapping.column, table_.names, 1);
      add(FindingKind::missing_column, channel_unusable, 1, 1, mapping.column,
          fmt::format("no such column for channel {}; the columns are {}", mapping.channel,
                      fmt::join(table_.names, ", ")),
          near.empty() ? "correct [columns] or export that column"
                       : fmt::format("did you mean \"{}\"? correct [columns]", near.front()));
      return;
    }
    take(index_of(*column), mapping.channel, mapping.scale, mapping.offset);
  }

  void take(std::size_t i, const std::string& channel, double scale, double offset) {
    used_[i] = true;
    if (std::find(unusable_columns_.begin(), unusable_columns_.end(), table_.names[i]) !=
        unusable_columns_.end())
      return;
    auto values = table_.columns[i];
    const bool empty =
        std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
    if (empty) return;  // as if it were not there
    for (double& value : values) value = scale * value + offset;
    out_.channels.push_back({channel, std::move(values)});
    places_.numbers.push_back(table_.numbers[i]);
  }

  void leave(std::size_t i) {
    const auto& name = table_.names[i];
    out_.unused_columns.push_back(name);
    const auto misnamed = misnamed_unit(name, campaign_.plant);
    if (!misnamed || table_.find(misnamed->channel) != nullptr || mapping_of(misnamed->channel) != nullptr)
      return;
    const auto cure =
        misnamed->scale
            ? fmt::format("add {} = {{ column = \"{}\", scale = {:.10g} }} to [columns]", misnamed->channel,
                          name, *misnamed->scale)
            : fmt::format("say what it is in SI units: {} = {{ column = \"{}\", scale = … }} in [columns]",
                          misnamed->channel, name);
    add(FindingKind::unknown_unit, channel_unusable, 1, header_character(i), name,
        fmt::format("looks like channel {} in the unit \"{}\", which is not the channel's; column left out",
                    misnamed->channel, misnamed->unit),
        cure);
  }

  // What is wrong in a column that nobody reads costs nothing.
  void forget_unused_columns() {
    std::erase_if(out_.findings, [&](const Finding& finding) {
      const bool in_cells = finding.kind == FindingKind::non_numeric_cell ||
                            finding.kind == FindingKind::nan_cell ||
                            finding.kind == FindingKind::duplicate_column;
      return in_cells && std::find(out_.unused_columns.begin(), out_.unused_columns.end(), finding.channel) !=
                             out_.unused_columns.end();
    });
  }

  void judge_plant() {
    const bool own = std::any_of(out_.channels.begin(), out_.channels.end(), [&](const auto& channel) {
      return find_channel(campaign_.plant, channel.name) != nullptr;
    });
    if (own) return;
    std::vector<std::string> foreign;
    std::optional<CampaignPlant> plant;
    std::uint64_t place = 1;
    for (std::size_t i = 0; i < table_.names.size(); ++i) {
      const auto owner = plant_with_channel(table_.names[i]);
      if (!owner || *owner == campaign_.plant) continue;
      if (!plant) place = header_character(i);
      plant = owner;
      foreign.push_back(table_.names[i]);
    }
    if (plant)
      add(FindingKind::wrong_plant, trial_unusable, 1, place, foreign.front(),
          fmt::format("{} {} of plant \"{}\", the campaign's is \"{}\"", fmt::join(foreign, ", "),
                      foreign.size() == 1 ? "is a channel" : "are channels", name_of(*plant),
                      name_of(campaign_.plant)),
          "correct plant in campaign.toml, or put this trial into a campaign of its own");
    else
      add(FindingKind::unknown_column, trial_unusable, 1, 1, "",
          fmt::format("no column is a channel of plant \"{}\"; the columns are {}", name_of(campaign_.plant),
                      fmt::join(table_.names, ", ")),
          "say in [columns] which column is which channel");
  }

  void select_rows() {
    const auto& rows = trial_.rows;
    const auto* column = rows.column.empty() ? nullptr : table_.find(rows.column);
    if (!rows.column.empty() && column == nullptr) {
      complain(FindingKind::missing_column, trial_unusable,
               fmt::format("the column \"{}\" to select rows by is not in {}", rows.column, file_),
               "correct select in this trial");
      return;
    }
    std::vector<std::size_t> keep;
    const auto* file_time_s = time_column();
    if (file_time_s == nullptr) return;
    const auto time_s = *file_time_s;
    for (std::size_t row = 0; row < out_.t_s.size(); ++row)
      if ((column == nullptr || (*column)[row] == rows.value) && time_s[row] >= rows.from_s &&
          time_s[row] <= rows.to_s)
        keep.push_back(row);
    table_ = {};
    if (keep.empty()) {
      complain(FindingKind::empty_file, trial_unusable, fmt::format("select leaves no row of {}", file_),
               "correct select in this trial");
      return;
    }
    if (keep.size() != out_.t_s.size()) keep_rows(out_, places_, keep);
  }

  std::uint64_t header_character(std::size_t i) const { return places_.character(1, table_.numbers[i]); }

  std::size_t index_of(const std::vector<double>& column) const {
    return static_cast<std::size_t>(&column - table_.columns.data());
  }

  void add(FindingKind kind, FindingSeverity severity, std::uint64_t line, std::uint64_t column,
           std::string channel, std::string what, std::string_view cure) {
    out_.findings.push_back(
        {kind, severity, file_, line, column, std::move(channel), std::move(what), std::string(cure)});
  }
  void complain_at(ConfigPosition at, FindingKind kind, FindingSeverity severity, std::string key,
                   std::string what, std::string cure) {
    out_.findings.push_back({kind, severity, campaign_.file.string(), at.line, at.column, std::move(key),
                             std::move(what), std::move(cure)});
  }
  // What the trial's entry in campaign.toml asks for and cannot have.
  void complain(FindingKind kind, FindingSeverity severity, std::string what, std::string cure) {
    complain_at(trial_.position, kind, severity, "file", std::move(what), std::move(cure));
  }

  const Campaign& campaign_;
  const CampaignTrial& trial_;
  TrialRecording out_;
  CsvTable table_;
  std::string file_;
  RecordingPlaces places_;
  std::vector<bool> used_;  // columns that became a channel
  std::vector<std::string> unusable_columns_;
};

}  // namespace

TrialRecording read_trial(const Campaign& campaign, const CampaignTrial& trial) {
  auto recording = Reader(campaign, trial).run();
  for (const auto& companion : trial.companions) {
    CampaignTrial other;
    other.name = companion.file.string();
    other.file = companion.file;
    other.kind = trial.kind;
    other.columns = companion.columns;
    other.position = trial.position;
    other.belief = trial.belief;
    join_companion(recording, Reader(campaign, other).run());
  }
  if (recording.usable()) add_position_loop(recording, trial);
  return recording;
}

}  // namespace sandhopper
