#include "tools/campaign/campaign_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/column_checks.hpp"
#include "tools/campaign/column_guess.hpp"
#include "tools/campaign/column_rivals.hpp"
#include "tools/campaign/draft_format.hpp"
#include "tools/campaign/draft_mappings.hpp"
#include "tools/campaign/draft_setups.hpp"
#include "tools/campaign/plant_guess.hpp"
#include "tools/campaign/read_table.hpp"
#include "tools/campaign/side_by_side.hpp"
#include "tools/campaign/text_checks.hpp"
#include "tools/campaign/unit_check.hpp"
#include "tools/campaign/used_column.hpp"
#include "tools/campaign/vector_axes.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {
namespace {

namespace fs = std::filesystem;
using enum CampaignPlant;

class Drafter {
 public:
  Drafter(const std::vector<fs::path>& files, std::optional<CampaignPlant> plant, const fs::path& folder,
          const std::vector<std::string>& names)
      : files_(files), plant_(plant), folder_(folder), names_(names) {}

  CampaignDraft run() {
    look();
    out_.plant = plant_ ? *plant_ : guessed_plant();
    guess_columns();
    describe();
    find_faults();
    out_.campaign_toml = campaign();
    out_.nominal_toml = draft_nominal(out_.plant, is_taken("command_left_torque_Nm"));
    return std::move(out_);
  }

 private:
  void look() {
    std::ifstream in(files_.front(), std::ios::binary);
    if (!in) throw std::runtime_error(files_.front().string() + " cannot be opened");
    CsvFormat format;
    if (!names_.empty()) format.names = names_, format.header_line = 0;
    table_ = read_csv(in, {.time_column = "", .list_repeats = false, .format = format});
    for (const auto& issue : table_.issues)
      if (issue.fault == CsvFault::not_a_text || issue.fault == CsvFault::no_header ||
          issue.fault == CsvFault::names_do_not_fit)
        throw std::runtime_error(describe_issue(issue));
    if (table_.names.empty()) throw std::runtime_error(files_.front().string() + " holds no table");
    look_again(format);
    sides_ = recordings_side_by_side(table_);
  }
  // Takes what only the text shows: units outside the names, and a sign that may divide thousands.
  void look_again(const CsvFormat& format) {
    std::ifstream in(files_.front(), std::ios::binary);
    const auto text = look_at_text(in, table_, format, {});
    take_units_of_text(text, table_, std::vector<std::string>(table_.names.size()));
    table_.layout.is_ambiguous |=
        std::ranges::any_of(text.grouped, [](const std::string& cell) { return !cell.empty(); });
  }
  std::string describe_issue(const CsvIssue& issue) const {
    return files_.front().string() + ": " + issue.text +
           (issue.fault == CsvFault::not_a_text
                ? ""
                : "; write them above the numbers, or give --names t_s,force_N,…");
  }

  std::optional<WrittenUnit> unit_of(std::size_t i) const { return unit_of_column(table_, i); }

  CampaignPlant guessed_plant() const {
    if (const auto plant = guess_plant(table_)) return *plant;
    throw PlantNotTold(
        fmt::format("{}: could not tell the plant from these columns", files_.front().string()),
        describe_columns(table_));
  }

  void guess_columns() {
    time_ = time_like_column(table_, out_.plant);
    for (const auto i : in_order_of_choice(table_.names)) {
      if (time_ == i || table_.names[i] == "t_s" || is_of_other_side(i)) continue;
      if (auto guess = guess_column(table_.names[i], unit_of(i), out_.plant, guesses_)) {
        guess->column = i;
        choose_axis(*guess);
        guesses_.push_back(*guess);
      }
    }
    if (out_.plant != rotary_axis) return;
    std::vector<std::optional<WrittenUnit>> units;
    for (std::size_t i = 0; i < table_.names.size(); ++i)
      units.push_back(is_of_other_side(i) ? std::nullopt : unit_of(i));
    if (auto guess = guess_torque_by_current(table_.names, units, guesses_)) guesses_.push_back(*guess);
  }

  // Takes the one of three axes that reads most: gravity, a drop and a push show along one of them. A length
  // has no zero of its own, so there the first that fits stays.
  void choose_axis(ColumnGuess& guess) {
    auto axes = axes_of(table_, guess.column);
    if (!axes.found()) return;
    const auto unit = unit_of_channel(guess.channel);
    if (!unit || unit->dimension != "length") {
      const auto most = std::ranges::max_element(axes.mean_size);
      axes.taken = static_cast<std::size_t>(most - axes.mean_size.begin());
      guess.column = axes.columns[axes.taken];
    }
    axes_of_channel_[guess.channel] = axes;
  }

  // Other columns that fit a channel, for the owner to choose; for an axis of three the other two:
  // "axis z of three (x, y, z)…". Empty if there is no choice.
  std::string choice_words(const std::string& channel) const {
    const auto found = axes_of_channel_.find(channel);
    if (found == axes_of_channel_.end()) {
      const auto guess = std::ranges::find(guesses_, channel, &ColumnGuess::channel);
      auto rivals = rivals_of_column(table_, out_.plant, channel, guess->column);
      std::erase_if(rivals, [&](std::size_t i) { return !is_unused(i); });
      return rivals_in_words(table_, rivals);
    }
    const auto& axes = found->second;
    const auto& size = axes.mean_size;
    return fmt::format(
        "axis {} of three (x, y, z), which read {:.3g}, {:.3g}, {:.3g} on average; to take another, name "
        "another column{}",
        axes.letter(), size[0], size[1], size[2],
        channel != "accel_mps2"
            ? ""
            : ". The axis along the fall is needed: it reads 9.8 m/s2 at rest. The norm of the "
              "three is no substitute: it has no sign and takes a turning body for a force");
  }

  // True for a column of another recording than the first of those side by side.
  bool is_of_other_side(std::size_t i) const {
    return !sides_.empty() &&
           std::ranges::find(sides_.front(), i, &SideColumn::column) == sides_.front().end();
  }

  bool is_taken(std::string_view channel) const {
    return std::ranges::find(guesses_, channel, &ColumnGuess::channel) != guesses_.end();
  }

  void describe() {
    auto& said = out_.said;
    const auto& layout = table_.layout;
    said.push_back(fmt::format("a table of {} rows and {} columns, {} text, cells divided by {}",
                               table_.rows(), table_.names.size(), name_of(layout.encoding),
                               separator_word(layout)));
    for (const auto& text : layout.said) said.push_back(text);
    said.push_back(fmt::format("plant \"{}\"{}", name_of(out_.plant), plant_ ? "" : plant_words()));
    for (const auto& guess : guesses_)
      said.push_back(fmt::format("{} is column \"{}\" in {}{}", guess.channel, table_.names[guess.column],
                                 guess.unit ? guess.unit->text : "an unknown unit: state it",
                                 guess.asks_scale       ? ", a current: state its torque constant as scale"
                                 : guess.is_downward    ? ", counted downward"
                                 : offset_of(guess) > 0 ? ", without gravity: 9.81 m/s2 are added"
                                 : is_setpoint_by_name(table_.names[guess.column])
                                     ? ", a set-point by its name and no measurement"
                                     : ""));
    for (const auto& guess : guesses_)
      if (const auto words = choice_words(guess.channel); !words.empty())
        said.push_back(fmt::format("{}: {}", guess.channel, words));
    if (time_) said.push_back(time_words());
    if (!time_ && table_.find("t_s") == nullptr) said.emplace_back("no column is a time");
    std::vector<std::string> unused;
    for (std::size_t i = 0; i < table_.names.size(); ++i)
      if (is_unused(i)) unused.push_back(table_.names[i]);
    if (!unused.empty()) said.push_back(fmt::format("not used: {}", fmt::join(unused, ", ")));
    const auto times = std::ranges::count_if(table_.names, is_called_time);
    if (!sides_.empty())
      said.push_back(fmt::format("{} recordings side by side: a [[trial]] with columns of its own for each",
                                 sides_.size()));
    else if (times > 1)
      said.push_back(
          fmt::format("{} columns are called a time: recordings side by side need a [[trial]] each with "
                      "`columns` of its own",
                      times));
  }

  std::string plant_words() const {
    const auto reason = out_.plant == falling_body ? why_falling_body(table_) : std::string();
    return fmt::format(", {}; --plant says another", reason.empty() ? "guessed from its columns" : reason);
  }

  // A force against a depth needs no time.
  void find_faults() {
    const std::string header =
        fmt::format("; line {} is taken for the names: if that is wrong, state header_line in [format]",
                    table_.layout.header_line);
    if (!time_ && table_.find("t_s") == nullptr && !(is_taken("foot_z_m") && is_taken("force_N")))
      out_.wrong.push_back(
          "no column is a time: write t_s = { column = \"NAME\", unit = \"s\" } into [columns], or "
          "row_every_s into [format]" +
          header);
    if (2 * cells_without_number() > table_.rows() * table_.names.size())
      out_.wrong.push_back("most cells are not numbers" + header);
  }

  std::uint64_t cells_without_number() const {
    std::uint64_t cells = 0;
    for (const auto& issue : table_.issues)
      if (issue.fault == CsvFault::not_a_number) cells += issue.repeats + 1;
    return cells;
  }

  std::string time_words() const {
    const auto& name = table_.names[*time_];
    if (const auto other = other_part_of_time())
      return fmt::format("t_s is column \"{}\" and column \"{}\"", name, table_.names[other->first]);
    const auto rivals = sides_.empty() ? rivals_in_words(table_, rivals_of_time(table_, *time_)) : "";
    return fmt::format("t_s is column \"{}\"{}", name, rivals.empty() ? "" : "; " + rivals);
  }

  bool is_unused(std::size_t i) const {
    const auto other = time_ ? other_part_of_time() : std::nullopt;
    return time_ != i && !is_of_other_side(i) && (!other || other->first != i) && table_.names[i] != "t_s" &&
           std::none_of(guesses_.begin(), guesses_.end(),
                        [&](const ColumnGuess& g) { return g.column == i; });
  }

  std::string folder_name() const {
    return fs::weakly_canonical(fs::absolute(files_.front())).parent_path().filename().string();
  }

  std::string campaign() const {
    std::string text = fmt::format(
        "# Written by `hop campaign import` from {}. Correct what is wrong, then run `hop campaign check` on "
        "this folder.\n"
        "name  = \"{}\"\nplant = \"{}\"   # hopper, intruder, falling_body or rotary_axis\nmodel = "
        "\"nominal.toml\"\n",
        files_.front().filename().string(), folder_name(), name_of(out_.plant));
    return text + draft_format(table_.layout, names_) + columns() + trials() + draft_available(out_.plant);
  }

  // Phones record the acceleration without gravity. A specific force includes it, so add g.
  double offset_of(const ColumnGuess& g) const {
    const auto lower = in_lower_case(table_.names[g.column]);
    const bool without =
        lower.find("linear acc") != std::string::npos || lower.find("without g") != std::string::npos;
    return without && g.channel == "accel_mps2" ? 9.81 : 0.0;
  }

  std::string columns() const {
    std::string text =
        "\n[columns]   # channel = column of the file, its unit, and the scale from that unit to the "
        "channel's\n";
    if (!sides_.empty()) text += "# recordings side by side: each [[trial]] names its own columns\n";
    if (time_ && sides_.empty()) text += time_line();
    for (const auto& g : guesses_) {
      if (!sides_.empty()) break;
      const auto wanted = unit_of_channel(g.channel);
      if (const auto words = choice_words(g.channel); !words.empty())
        text += fmt::format("# {}: {}\n", g.channel, words);
      text += mapping_line_of(g);
      if (!g.asks_scale && has_unknown_unit(g))
        text.insert(text.size() - 1,
                    fmt::format("   # the file states no unit: write \"{}\" if it is so, and the scale to it",
                                wanted->text));
    }
    for (const auto& channel : known_channels())
      if (channel.plant == out_.plant && !is_taken(channel.name)) {
        const auto wanted = unit_of_channel(channel.name);
        text += "# " + draft_mapping(std::string(channel.name), "NAME", wanted ? wanted->text : "", 1.0);
      }
    for (std::size_t i = 0; i < table_.names.size(); ++i)
      if (is_unused(i)) text += fmt::format("# not used: column \"{}\"\n", table_.names[i]);
    return text;
  }

  bool has_unknown_unit(const ColumnGuess& g) const {
    return !g.unit && unit_of_channel(g.channel) && g.channel != table_.names[g.column];
  }

  std::string mapping_line_of(const ColumnGuess& g) const {
    const auto wanted = unit_of_channel(g.channel);
    if (g.asks_scale) return draft_torque(table_.names[g.column], g.unit->text);
    return draft_mapping(g.channel, table_.names[g.column],
                         g.unit                ? g.unit->text
                         : has_unknown_unit(g) ? kUnknownUnit
                         : wanted              ? wanted->text
                                               : "",
                         g.scale, offset_of(g));
  }

  std::string time_line() const {
    const auto unit = unit_of(*time_);
    const auto& values = table_.columns[*time_];
    const bool known = unit && unit->dimension == "time" && unit->to_si > 0.0;
    double scale = known ? unit->to_si : 1.0;
    const double first = values.empty() ? 0.0 : std::abs(values.front());
    for (const double epoch : {1e3, 1e6, 1e9})  // As s since 1970, 1.7e9 is the year 2023.
      if (!known && first > 0.8e9 * epoch && first < 4e9 * epoch) scale = 1.0 / epoch;
    const std::string name = known           ? unit->text
                             : scale == 1e-3 ? "ms"
                             : scale == 1e-6 ? "us"
                             : scale == 1e-9 ? "ns"
                                             : "s";
    const bool is_clock = std::ranges::find(table_.clocks, table_.names[*time_]) != table_.clocks.end();
    const bool is_unknown = unit ? !known : doubt_time(values, "").has_value();
    const bool is_doubtful = !is_clock && scale == 1.0 && is_unknown;
    return draft_mapping("t_s", table_.names[*time_], is_doubtful ? kUnknownUnit : name, scale, 0.0,
                         second_time());
  }

  // The column with the other part of the time and its scale: "header.stamp.nsecs" for "header.stamp.secs",
  // "Time" for "Date".
  std::optional<std::pair<std::size_t, std::string>> other_part_of_time() const {
    const auto lower = in_lower_case(table_.names[*time_]);
    const bool is_seconds = lower.ends_with("secs") || lower.ends_with("sec");
    const bool is_date = lower.starts_with("date");
    for (std::size_t i = 0; i < table_.names.size(); ++i) {
      const auto other = in_lower_case(table_.names[i]);
      if (i == *time_) continue;
      if (is_date && other.starts_with("time")) return std::pair{i, std::string()};
      if (is_seconds && (other.ends_with("nsecs") || other.ends_with("nanosec") || other.ends_with("nsec")))
        return std::pair{i, std::string(", scale = 1e-9")};
      if (is_seconds && (other.ends_with("usecs") || other.ends_with("usec")))
        return std::pair{i, std::string(", scale = 1e-6")};
    }
    return std::nullopt;
  }

  std::string second_time() const {
    if (const auto other = other_part_of_time())
      return fmt::format(", plus = {{ column = \"{}\"{} }}", table_.names[other->first], other->second);
    return "";
  }

  std::string trials() const {
    std::string text = "\n[every_trial]   # what holds for every trial; a [[trial]] may say otherwise\n";
    text += fmt::format("kind = \"{}\"   # {}\n", name_of(usual_kind(out_.plant)),
                        fmt::join(EnumNames<TrialKind>::value, ", "));
    text += draft_setups(out_.plant);
    text +=
        "# select  = { column = \"NAME\", value = 1, from_s = 0.0, to_s = 1.0 }   # some rows of the file\n";
    text +=
        "# also    = { file = \"other.csv\", columns = { t_s = \"t\" } }   # a second file on the same "
        "clock\n";
    for (const auto& file : files_) {
      std::error_code error;
      auto name = fs::proximate(fs::absolute(file), fs::absolute(folder_), error);
      const auto entry =
          fmt::format("\n[[trial]]\nfile = \"{}\"\n", (error ? fs::absolute(file) : name).generic_string());
      if (sides_.empty()) text += entry;
      for (const auto& side : sides_) text += entry + columns_of(side);
    }
    return text;
  }

  // The mappings of the first recording with the columns of another one, if it has them.
  std::string columns_of(const SideRecording& side) const {
    std::string text;
    const auto column_like = [&](std::size_t i) {
      const auto own = std::ranges::find(sides_.front(), i, &SideColumn::column);
      const auto found = std::ranges::find(side, own->base, &SideColumn::base);
      return found == side.end() ? std::string() : table_.names[found->column];
    };
    const auto add = [&](std::string line, std::size_t i) {
      const auto name = column_like(i);
      if (name.empty()) return;
      const auto own = toml_text(table_.names[i]);
      line.replace(line.find(own), own.size(), toml_text(name));
      line.erase(line.rfind('}') + 1);  // the end of the line, and a remark
      text += (text.empty() ? "" : ", ") + line;
    };
    if (time_ && !is_of_other_side(*time_)) add(time_line(), *time_);
    for (const auto& g : guesses_) add(mapping_line_of(g), g.column);
    return "columns = { " + text + " }\n";
  }

  const std::vector<fs::path>& files_;
  std::optional<CampaignPlant> plant_;
  fs::path folder_;
  const std::vector<std::string>& names_;  // Names of the columns if the file has none.
  CsvTable table_;
  std::vector<SideRecording> sides_;  // empty: one recording
  std::optional<std::size_t> time_;
  std::vector<ColumnGuess> guesses_;
  std::map<std::string, VectorAxes> axes_of_channel_;
  CampaignDraft out_;
};

}  // namespace

CampaignDraft draft_campaign(const std::vector<fs::path>& files, std::optional<CampaignPlant> plant,
                             const fs::path& folder, const std::vector<std::string>& names) {
  if (files.empty()) throw std::runtime_error("no file to look at");
  return Drafter(files, plant, folder, names).run();
}

}  // namespace sandhopper
