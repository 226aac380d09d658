#include "tools/campaign/campaign_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/read_table.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {
namespace {

namespace fs = std::filesystem;
using enum CampaignPlant;

struct Naming {
  std::string_view channel;
  CampaignPlant plant;
  std::string_view dimension;
  std::array<std::string_view, 12> words;  // lower case; any of them in the column's name
  bool is_downward = false;                // the words mean a depth: the channel counts upward
};
constexpr std::array kNamings{
    Naming{"foot_z_m",
           intruder,
           "length",
           {"sinkage", "depth", "penetration", "einsink", "tiefe", "indent", "enfonc"},
           true},
    Naming{"foot_z_m",
           intruder,
           "length",
           {"foot_z", "position", "displacement", "extension", "crosshead", "travel", "height", "weg", "z"},
           false},
    Naming{"force_N", intruder, "force", {"force", "load", "kraft", "fz", "last"}, false},
    Naming{"foot_velocity_mps", intruder, "speed", {"velocity", "speed", "geschwindigkeit"}, false},
    Naming{"foot_accel_mps2", intruder, "acceleration", {"accel", "acc", "beschl"}, false},
    Naming{"height_m",
           falling_body,
           "length",
           {"height", "altitude", "hoehe", "höhe", "position", "y", "z", "h"},
           false},
    Naming{"accel_mps2", falling_body, "acceleration", {"accel", "acc", "beschl"}, false},
    Naming{"pressure_Pa", falling_body, "pressure", {"pressure", "druck", "pore"}, false},
    Naming{"position_rad",
           rotary_axis,
           "angle",
           {"angle", "position", "theta", "phi", "winkel", "encoder", "pos"},
           false},
    Naming{"velocity_radps",
           rotary_axis,
           "angular rate",
           {"speed", "velocity", "omega", "drehzahl", "rpm", "vel"},
           false},
    Naming{"torque_Nm", rotary_axis, "torque", {"torque", "moment", "tau", "drehmoment"}, false}};

struct Guess {
  std::size_t column = 0;
  std::string channel{};
  std::optional<WrittenUnit> unit{};
  double scale = 1.0;
  bool is_downward = false;
};

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return out;
}

// One letter must be the whole quantity: "z (mm)", not the z in "size".
bool has_word(const std::string& lower, std::string_view word) {
  if (word.empty()) return false;
  if (word.size() > 1) return lower.find(word) != std::string::npos;
  return lower.starts_with(word) &&
         (lower.size() == 1 || std::string_view(" _[(").find(lower[1]) != std::string_view::npos);
}

class Drafter {
 public:
  Drafter(const std::vector<fs::path>& files, std::optional<CampaignPlant> plant, const fs::path& folder)
      : files_(files), plant_(plant), folder_(folder) {}

  CampaignDraft run() {
    look();
    out_.plant = plant_ ? *plant_ : guessed_plant();
    guess_columns();
    describe();
    out_.campaign_toml = campaign();
    out_.nominal_toml = draft_nominal(out_.plant);
    return std::move(out_);
  }

 private:
  void look() {
    std::ifstream in(files_.front(), std::ios::binary);
    if (!in) throw std::runtime_error(files_.front().string() + " cannot be opened");
    table_ = read_csv(in, {.time_column = "", .list_repeats = false});
    for (const auto& issue : table_.issues)
      if (issue.fault == CsvFault::not_a_text || issue.fault == CsvFault::no_header)
        throw std::runtime_error(describe_issue(issue));
    if (table_.names.empty()) throw std::runtime_error(files_.front().string() + " holds no table");
  }
  std::string describe_issue(const CsvIssue& issue) const {
    return files_.front().string() + ": " + issue.text +
           (issue.fault == CsvFault::no_header
                ? "; write them above the numbers, or [format] header_line = 0 and names = […]"
                : "");
  }

  std::optional<WrittenUnit> unit_of(std::size_t i) const {
    if (const auto unit = read_unit(table_.units[i], true)) return unit;
    return unit_in_name(table_.names[i]);
  }

  CampaignPlant guessed_plant() const {
    for (const auto& name : table_.names)
      if (const auto plant = plant_with_channel(name)) return *plant;
    std::array<int, 4> votes{};
    for (std::size_t i = 0; i < table_.names.size(); ++i) {
      const auto unit = unit_of(i);
      const auto lower = lower_case(table_.names[i]);
      const auto is = [&](std::string_view dimension) { return unit && unit->dimension == dimension; };
      votes[static_cast<std::size_t>(rotary_axis)] +=
          3 * (is("angle") || is("angular rate") || is("torque")) + has_word(lower, "torque") +
          has_word(lower, "angle");
      votes[static_cast<std::size_t>(intruder)] +=
          3 * is("force") + has_word(lower, "force") + has_word(lower, "sinkage") + has_word(lower, "depth");
      votes[static_cast<std::size_t>(falling_body)] += 2 * (is("acceleration") || is("pressure")) +
                                                       has_word(lower, "height") +
                                                       has_word(lower, "altitude");
    }
    return static_cast<CampaignPlant>(std::max_element(votes.begin(), votes.end()) - votes.begin());
  }

  void guess_columns() {
    time_ = time_like_column(table_, out_.plant);
    for (std::size_t i = 0; i < table_.names.size(); ++i) {
      if (time_ == i || table_.names[i] == "t_s") continue;
      if (const auto guess = guess_of(i)) guesses_.push_back(*guess);
    }
  }

  bool is_taken(std::string_view channel) const {
    return std::any_of(guesses_.begin(), guesses_.end(),
                       [&](const Guess& g) { return g.channel == channel; });
  }

  std::optional<Guess> guess_of(std::size_t i) const {
    const auto& name = table_.names[i];
    const auto unit = unit_of(i);
    if (find_channel(out_.plant, name) != nullptr) return made(i, name, unit, false);
    const auto lower = lower_case(name);
    for (const bool by_word : {true, false})
      for (const auto& naming : kNamings) {
        if (naming.plant != out_.plant || is_taken(naming.channel)) continue;
        const bool word = std::any_of(naming.words.begin(), naming.words.end(),
                                      [&](std::string_view w) { return has_word(lower, w); });
        const auto wanted = unit_of_channel(naming.channel);
        const bool fits = unit && wanted && factor_between(*unit, *wanted);
        if (by_word ? word && (fits || !unit) : fits)
          return made(i, naming.channel, unit, word && naming.is_downward);
      }
    return std::nullopt;
  }

  static Guess made(std::size_t i, std::string_view channel, const std::optional<WrittenUnit>& unit,
                    bool downward) {
    const auto wanted = unit_of_channel(channel);
    const auto factor = unit && wanted ? factor_between(*unit, *wanted) : std::nullopt;
    return {i, std::string(channel), factor ? unit : std::nullopt,
            factor.value_or(1.0) * (downward ? -1.0 : 1.0), downward};
  }

  void describe() {
    auto& said = out_.said;
    const auto& layout = table_.layout;
    said.push_back(fmt::format("a table of {} rows and {} columns, {} text, cells divided by {}",
                               table_.rows(), table_.names.size(), name_of(layout.encoding),
                               separator_word()));
    for (const auto& text : layout.said) said.push_back(text);
    said.push_back(
        fmt::format("plant \"{}\"{}", name_of(out_.plant), plant_ ? "" : ", guessed from its columns"));
    for (const auto& guess : guesses_)
      said.push_back(fmt::format("{} is column \"{}\" in {}{}", guess.channel, table_.names[guess.column],
                                 guess.unit ? guess.unit->text : "an unknown unit: state it",
                                 guess.is_downward ? ", counted downward" : ""));
    if (!time_ && table_.find("t_s") == nullptr) said.emplace_back("no column is a time");
  }

  std::string separator_word() const {
    switch (table_.layout.separator) {
      case '\t':
        return "tabs";
      case ' ':
        return "blanks";
      case ';':
        return "semicolons";
      default:
        return "commas";
    }
  }

  std::string campaign() const {
    std::string text = fmt::format(
        "# Written by `hop campaign import` from {}. Correct what is wrong, then run `hop campaign check` on "
        "this folder.\n"
        "name  = \"{}\"\nplant = \"{}\"   # hopper, intruder, falling_body or rotary_axis\nmodel = "
        "\"nominal.toml\"\n",
        files_.front().filename().string(), files_.front().stem().string(), name_of(out_.plant));
    return text + format() + columns() + trials();
  }

  std::string format() const {
    const auto& l = table_.layout;
    const std::string separator = l.separator == '\t'  ? "tab"
                                  : l.separator == ' ' ? "blank"
                                                       : std::string(1, l.separator);
    std::string text = "\n[format]   # how the files are written; found by looking\n";
    text += fmt::format("separator   = \"{}\"   # \",\", \";\", \"tab\" or \"blank\"\n", separator);
    text += fmt::format("decimal     = \"{}\"\n", l.numbers.decimal);
    text += fmt::format("thousands   = \"{}\"   # \"\": none\n",
                        l.numbers.thousands == '\0' ? std::string() : std::string(1, l.numbers.thousands));
    text += fmt::format("encoding    = \"{}\"   # utf-8, utf-16, utf-16-be or windows-1252\n",
                        name_of(l.encoding));
    text += fmt::format("header_line = {}   # of the columns' names; 0: none, and `names` gives them\n",
                        l.header_line);
    text += fmt::format("units_line  = {}   # 0: none\n", l.units_line);
    text += "# names        = [\"t_s\", \"force_N\"]\n";
    text +=
        "# no_sample    = [\"OVER\", \"-999\"]   # further cells without a sample; NaN, -, #N/A are known\n";
    text += "# spread_times = true   # rows that share a time came evenly\n";
    return text;
  }

  std::string mapping(const std::string& channel, const std::string& column, const std::string& unit,
                      double scale) const {
    std::string literal = column;
    std::string escaped;
    for (const char c : literal) {
      if (c == '"' || c == '\\') escaped += '\\';
      escaped += c;
    }
    const std::string number = fmt::format("{:.12g}", scale);
    const bool real = number.find_first_of(".e") != std::string::npos;
    return fmt::format("{} = {{ column = \"{}\", unit = \"{}\", scale = {}{} }}\n", channel, escaped, unit,
                       number, real ? "" : ".0");
  }

  std::string columns() const {
    std::string text =
        "\n[columns]   # channel = column of the file, its unit, and the scale from that unit to the "
        "channel's\n";
    if (time_) text += time_line();
    for (const auto& g : guesses_) {
      const auto wanted = unit_of_channel(g.channel);
      text += mapping(g.channel, table_.names[g.column],
                      g.unit   ? g.unit->text
                      : wanted ? wanted->text
                               : "",
                      g.scale);
      if (!g.unit) text.insert(text.size() - 1, "   # the file states no unit: check it");
    }
    for (const auto& channel : known_channels())
      if (channel.plant == out_.plant && !is_taken(channel.name)) {
        const auto wanted = unit_of_channel(channel.name);
        text += "# " + mapping(std::string(channel.name), "NAME", wanted ? wanted->text : "", 1.0);
      }
    for (std::size_t i = 0; i < table_.names.size(); ++i)
      if (time_ != i &&
          std::none_of(guesses_.begin(), guesses_.end(), [&](const Guess& g) { return g.column == i; }))
        text += fmt::format("# not used: column \"{}\"\n", table_.names[i]);
    return text;
  }

  std::string time_line() const {
    const auto unit = unit_of(*time_);
    const auto& values = table_.columns[*time_];
    const bool known = unit && unit->dimension == "time" && unit->to_si > 0.0;
    double scale = known ? unit->to_si : 1.0;
    const double first = values.empty() ? 0.0 : std::abs(values.front());
    for (const double epoch : {1e3, 1e6, 1e9})  // 1.7e9 s is 2023
      if (!known && first > 0.8e9 * epoch && first < 4e9 * epoch) scale = 1.0 / epoch;
    const std::string name = known           ? unit->text
                             : scale == 1e-3 ? "ms"
                             : scale == 1e-6 ? "us"
                             : scale == 1e-9 ? "ns"
                                             : "s";
    return mapping("t_s", table_.names[*time_], name, scale);
  }

  std::string trials() const {
    std::string text = "\n[every_trial]   # what holds for every trial; a [[trial]] may say otherwise\n";
    text += fmt::format("kind = \"{}\"   # {}\n", name_of(usual_kind(out_.plant)),
                        fmt::join(EnumNames<TrialKind>::value, ", "));
    if (out_.plant == intruder)
      text +=
          "# plate_diameter_m = 0.05   # m\n# bed_depth_m = 0.30   # m\n# pushes_since_preparation = 0\n# "
          "loading_from_s = 0.0   # s\n# loading_to_s = 1.0   # s\n";
    if (out_.plant == falling_body)
      text += "# diameter_m = 0.05   # m\n# mass_kg = 1.0   # kg\n# impact_speed_mps = 1.0   # m/s\n";
    if (out_.plant == rotary_axis) text += "# motor_enabled = false   # the axis runs free\n";
    text +=
        "# select  = { column = \"NAME\", value = 1, from_s = 0.0, to_s = 1.0 }   # some rows of the file\n";
    text +=
        "# also    = { file = \"other.csv\", columns = { t_s = \"t\" } }   # a second file on the same "
        "clock\n";
    for (const auto& file : files_) {
      std::error_code error;
      auto name = fs::proximate(fs::absolute(file), fs::absolute(folder_), error);
      text +=
          fmt::format("\n[[trial]]\nfile = \"{}\"\n", (error ? fs::absolute(file) : name).generic_string());
    }
    return text;
  }

  const std::vector<fs::path>& files_;
  std::optional<CampaignPlant> plant_;
  fs::path folder_;
  CsvTable table_;
  std::optional<std::size_t> time_;
  std::vector<Guess> guesses_;
  CampaignDraft out_;
};

}  // namespace

CampaignDraft draft_campaign(const std::vector<fs::path>& files, std::optional<CampaignPlant> plant,
                             const fs::path& folder) {
  if (files.empty()) throw std::runtime_error("no file to look at");
  return Drafter(files, plant, folder).run();
}

}  // namespace sandhopper
