#include "tools/campaign/read_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "firmware/log/csv_channels.hpp"
#include "firmware/log/csv_export.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/records.hpp"
#include "tools/campaign/column_names.hpp"
#include "tools/campaign/table_issues.hpp"
#include "tools/campaign/text_checks.hpp"
#include "tools/campaign/unit_text.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {
namespace {

namespace fs = std::filesystem;
using enum FindingSeverity;

// Words for the phases of a hop: those of `hop export`, and other states of the robot, which count as no
// sample.
std::vector<CsvWord> phase_words(const std::string& column) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<CsvWord> words;
  for (std::size_t i = 0; i < kCsvPhaseNames.size(); ++i)
    words.push_back({column, kCsvPhaseNames[i], static_cast<double>(i)});
  words.push_back({column, "stance", 1.0,
                   "\"stance\" is taken for compression: the table does not say when extension begins"});
  for (const auto name : EnumNames<State>::value)
    if (std::ranges::find(kCsvPhaseNames, name) == kCsvPhaseNames.end())
      words.push_back({column, name, kNone});
  return words;
}

class TableReader {
 public:
  TableReader(const Campaign& campaign, const CampaignTrial& trial, std::vector<Finding>& findings)
      : campaign_(campaign), trial_(trial), findings_(findings) {}

  std::optional<TrialTable> run() {
    const auto file = locate();
    if (!file) return std::nullopt;
    out_.file = file->string();
    if (!read(*file)) return std::nullopt;
    translate_issues(campaign_, trial_, out_, findings_);
    if (!out_.own_log && out_.table.rows() > 0) look_at_text(*file);
    describe_format();
    return std::move(out_);
  }

 private:
  std::optional<fs::path> locate() {
    std::error_code error;
    if (!fs::exists(trial_.file, error)) {
      complain(FindingKind::missing_file,
               fmt::format("the recording {} does not exist", trial_.file.string()), cure_for_missing());
      return std::nullopt;
    }
    if (!fs::is_directory(trial_.file, error)) return trial_.file;
    for (const auto* ending : {".mcap", ".csv"}) {
      std::vector<fs::path> found;
      for (const auto& entry : fs::directory_iterator(trial_.file, error))
        if (entry.path().extension() == ending) found.push_back(entry.path());
      if (found.size() == 1) return found.front();
      if (found.size() > 1) {
        complain(FindingKind::unreadable_file,
                 fmt::format("the folder {} holds {} recordings", trial_.file.string(), found.size()),
                 "name one of them: file = \"FOLDER/trial_001.mcap\"");
        return std::nullopt;
      }
    }
    complain(FindingKind::missing_file,
             fmt::format("the folder {} holds no .mcap or .csv recording", trial_.file.string()),
             "name a recording, or the folder that `hop trial` made");
    return std::nullopt;
  }

  // In double quotes TOML reads the backslashes of a Windows path as control characters ("\r", "\t", "\n").
  std::string cure_for_missing() const {
    constexpr std::array<std::pair<char, std::string_view>, 7> kEscapes{
        {{'\r', "/r"}, {'\n', "/n"}, {'\t', "/t"}, {'\b', "/b"}, {'\f', "/f"}, {'\x1B', "/e"}, {'\\', "/"}}};
    std::string meant;
    bool is_windows = false;
    for (const char c : trial_.name) {
      const auto found =
          std::find_if(kEscapes.begin(), kEscapes.end(), [&](const auto& e) { return e.first == c; });
      is_windows |= found != kEscapes.end();
      meant += found == kEscapes.end() ? std::string(1, c) : std::string(found->second);
    }
    if (!is_windows) return "correct file = \"…\" (it is relative to this folder) or take the trial out";
    return fmt::format(
        "a backslash in a name in double quotes makes a control character: write file = \"{}\"{}", meant,
        fs::exists(campaign_.folder / meant) ? ", which exists" : "");
  }

  bool read(const fs::path& file) {
    try {
      if (file.extension() == ".mcap") {
        read_log(file);
        return true;
      }
      std::ifstream in(file, std::ios::binary);
      if (!in) throw std::runtime_error("cannot be opened");
      if (in.peek() == std::ifstream::traits_type::eof()) {
        add(FindingKind::empty_file, trial_unusable, 1, "the file is empty",
            "record the trial again or take it out of campaign.toml");
        return false;
      }
      out_.table = parse(in);
      return true;
    } catch (const std::exception& error) {
      add(FindingKind::unreadable_file, trial_unusable, 0, fmt::format("cannot be read: {}", error.what()),
          "check the file and its permissions");
      return false;
    }
  }

  void read_log(const fs::path& file) {
    std::stringstream text;
    const auto exported = export_csv(file, text, {.optional_channels = true});
    out_.table = parse(text);
    out_.own_log = true;
    if (exported.truncated_at)
      add(FindingKind::unreadable_file, note, 0,
          fmt::format("the log is cut at byte {}", *exported.truncated_at), "what precedes the cut is used");
    if (exported.lost_records > 0) add(FindingKind::gap, note, 0, exported.lost_text, "");
  }

  // Reads the table. The time column is the mapped one, or t_s if the file does not have the mapped one.
  CsvTable parse(std::istream& in) {
    CsvReadOptions options;
    options.gap_steps = std::numeric_limits<double>::infinity();
    options.list_repeats = false;
    options.max_issues = 1000;
    options.format = trial_.format;
    options.words = phase_words(phase_column(trial_));
    const auto* time = mapping_of(trial_, "t_s");
    if (!trial_.rows.column.empty()) options.check_order = false;
    options.first_line = trial_.rows.from_line;
    options.last_line = trial_.rows.to_line;
    if (time == nullptr) return read_csv(in, options);
    options.time_column = time->column;
    options.second_time_column = time->plus.column;
    // The order is only defined for the sum of both columns.
    if (!time->plus.column.empty()) options.check_order = false;
    auto table = read_csv(in, options);
    if (table.find(time->column) != nullptr || table.names.empty()) return table;
    const auto* other = find_column(table, time->column);
    if (other == nullptr) other = table.find("t_s");
    if (other == nullptr) return table;
    in.clear();
    in.seekg(0);
    options.time_column = table.names[static_cast<std::size_t>(other - table.columns.data())];
    return read_csv(in, options);
  }

  void look_at_text(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    check_text(in, campaign_, trial_, out_, findings_);
    const auto& layout = out_.table.layout;
    constexpr std::string_view kNoCharacter = "\xEF\xBF\xBD";
    const auto& names = out_.table.names;
    const auto unread = std::ranges::find_if(
        names, [&](const std::string& name) { return name.find(kNoCharacter) != std::string::npos; });
    if (layout.encoding == TextEncoding::windows_1252 && unread != names.end())
      add(FindingKind::file_format, trial_unusable, layout.header_line,
          fmt::format(
              "the name \"{}\" holds a byte that has no character in Windows-1252: the file is neither that "
              "nor UTF-8, but perhaps Shift-JIS, GB18030 or CP1251",
              *unread),
          "save it as UTF-8, for example with iconv -f SHIFT-JIS -t UTF-8 FILE > FILE.csv, or write [format] "
          "header_line = 0 and names = […]");
  }

  // One note with everything unusual about the format.
  void describe_format() {
    const auto& layout = out_.table.layout;
    if (out_.own_log || layout.said.empty() || any_unusable(findings_)) return;
    add(FindingKind::file_format, note, std::max<std::uint64_t>(layout.header_line, 1),
        fmt::format("{}", fmt::join(layout.said, "; ")),
        is_wide(layout.encoding)
            ? "save it as CSV UTF-8 to read it everywhere; [format] in campaign.toml states it otherwise"
            : "state it otherwise with [format] in campaign.toml if that is wrong");
  }

  void add(FindingKind kind, FindingSeverity severity, std::uint64_t line, std::string what,
           std::string cure) {
    findings_.push_back({kind, severity, out_.file, line, line, "", std::move(what), std::move(cure)});
    findings_.back().column = line > 0 ? 1 : 0;
  }
  // Finding at the position of the trial's entry in campaign.toml.
  void complain(FindingKind kind, std::string what, std::string cure) {
    findings_.push_back({kind, trial_unusable, campaign_.file.string(), trial_.position.line,
                         trial_.position.column, "file", std::move(what), std::move(cure)});
  }

  const Campaign& campaign_;
  const CampaignTrial& trial_;
  std::vector<Finding>& findings_;
  TrialTable out_;
};

}  // namespace

bool is_called_time(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (lower == "t" || lower.starts_with("t ") || lower.starts_with("t(") || lower.starts_with("t[") ||
      lower.starts_with("t/"))
    return true;
  constexpr std::array<std::string_view, 10> kBegin{"time", "zeit",      "temps", "tiempo",  "tempo",
                                                    "tijd", "timestamp", "stamp", "elapsed", "uhrzeit"};
  return std::any_of(kBegin.begin(), kBegin.end(), [&](auto word) { return lower.starts_with(word); }) ||
         lower.ends_with("timestamp") || lower.ends_with("_time") || lower.ends_with(": time (s)") ||
         lower.ends_with("stamp.secs") || lower.ends_with("stamp.sec") || lower == "sec" || lower == "secs" ||
         lower == "seconds" || lower == "ms" || lower == "millis" || lower == "micros" || lower == "clock" ||
         lower == "x_value";  // LabVIEW
}

const ColumnMapping* mapping_of(const CampaignTrial& trial, std::string_view channel) {
  for (const auto& mapping : trial.columns)
    if (mapping.channel == channel) return &mapping;
  return nullptr;
}

std::string phase_column(const CampaignTrial& trial) {
  const auto* mapping = mapping_of(trial, "phase");
  return mapping == nullptr ? "phase" : mapping->column;
}

std::string phase_names() {
  std::vector<std::string_view> others;
  for (const auto& word : phase_words(""))
    if (std::ranges::find(kCsvPhaseNames, word.text) == kCsvPhaseNames.end()) others.push_back(word.text);
  return fmt::format("{}, or {}", fmt::join(kCsvPhaseNames, ", "), fmt::join(others, ", "));
}

const std::vector<double>* find_column(const CsvTable& table, std::string_view name) {
  if (const auto* column = table.find(name)) return column;
  std::string mark;
  const auto bare = without_mark(name, mark);
  return bare == name ? nullptr : table.find(bare);
}

const std::vector<double>* time_column(const CsvTable& table, const CampaignTrial& trial) {
  const auto* mapped = mapping_of(trial, "t_s");
  const auto* column = mapped == nullptr ? nullptr : find_column(table, mapped->column);
  return column != nullptr ? column : table.find("t_s");
}

std::optional<std::size_t> time_like_column(const CsvTable& table, CampaignPlant plant) {
  const auto is_in_time = [&](std::size_t i) {
    auto unit = read_unit(table.units[i], true);
    if (!unit) unit = unit_in_name(table.names[i]);
    return unit && unit->is_certain && unit->dimension == "time";
  };
  std::optional<std::size_t> called;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const auto misnamed = misnamed_unit(table.names[i], plant);
    if (misnamed && misnamed->channel == "t_s" && !called) return i;
    if (!is_called_time(table.names[i])) continue;
    // Brackets that hold no unit of time tell what else the column is: "time(not s)" before "time (s)".
    if (!called) called = i;
    if (is_in_time(i)) return i == *called || text_in_brackets(table.names[*called]) ? i : *called;
  }
  if (called) return called;
  // A name in another language, with a unit of time.
  for (std::size_t i = 0; i < table.names.size(); ++i)
    if (is_in_time(i)) return i;
  return std::nullopt;
}

std::string cure_for_time(const CsvTable& table, CampaignPlant plant) {
  const auto i = time_like_column(table, plant);
  if (!i) return "";
  auto unit = read_unit(table.units[*i], true);
  if (!unit) unit = unit_in_name(table.names[*i]);
  const bool known = unit && unit->dimension == "time" && unit->to_si > 0.0;
  return fmt::format("add t_s = {{ column = \"{}\", scale = {} }} to [columns] (scale: to seconds)",
                     table.names[*i], known ? unit->to_si : 1.0);
}

std::optional<TrialTable> read_table(const Campaign& campaign, const CampaignTrial& trial,
                                     std::vector<Finding>& findings) {
  return TableReader(campaign, trial, findings).run();
}

}  // namespace sandhopper
