#include "tools/campaign/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "config/hint.hpp"
#include "config/load.hpp"
#include "tools/campaign/column_mapping.hpp"
#include "tools/campaign/config_number.hpp"
#include "tools/campaign/plausible.hpp"
#include "tools/campaign/recordings_folder.hpp"
#include "tools/campaign/setup_doubts.hpp"
#include "tools/campaign/table_format.hpp"

namespace sandhopper {
namespace {

namespace fs = std::filesystem;
using Kind = ConfigNode::Kind;

[[noreturn]] void refuse(const fs::path& file, ConfigPosition position, const std::string& key,
                         const std::string& text) {
  throw ConfigError({{file.string(), position, key, text}});
}

template <NamedEnum E>
std::optional<E> enum_of(const ConfigNode& node) {
  if (node.kind != Kind::text) return std::nullopt;
  const auto& names = EnumNames<E>::value;
  const auto found = std::find(names.begin(), names.end(), node.text);
  if (found == names.end()) return std::nullopt;
  return static_cast<E>(found - names.begin());
}

template <NamedEnum E>
std::string names_of() {
  return fmt::format("\"{}\"", fmt::join(EnumNames<E>::value, "\", \""));
}

class Loader {
 public:
  explicit Loader(const fs::path& folder) {
    campaign_.file = fs::is_directory(folder) ? folder / "campaign.toml" : folder;
    campaign_.folder = campaign_.file.parent_path();
  }

  Campaign run() {
    const auto document = parse_config_file(campaign_.file.string());
    const auto& root = document.root;
    read_head(root);
    if (const auto* columns = root.find("columns"))
      columns_ = read_columns(*columns, are_columns_understood_);
    if (const auto* available = root.find("available"))
      campaign_.available = read_available(*available, campaign_.file.string(), campaign_.findings);
    if (const auto* format = root.find("format")) take_format(*format, format_);
    read_trials(root);
    for (const auto& child : root.children) note_unknown(child);
    for (auto& finding : implausible_beliefs(campaign_)) campaign_.findings.push_back(std::move(finding));
    return std::move(campaign_);
  }

 private:
  void read_head(const ConfigNode& root) {
    campaign_.name = campaign_.folder.filename().string();
    if (const auto* name = root.find("name"); name != nullptr && name->kind == Kind::text)
      campaign_.name = name->text;
    const auto* plant = root.find("plant");
    if (plant == nullptr)
      refuse(campaign_.file, {1, 1}, "plant",
             fmt::format("key 'plant' is missing: add plant = one of {}", names_of<CampaignPlant>()));
    const auto known = enum_of<CampaignPlant>(*plant);
    if (!known)
      refuse(campaign_.file, plant->position, "plant",
             fmt::format("key 'plant' has no such value: expected one of {}", names_of<CampaignPlant>()));
    campaign_.plant = *known;
    campaign_.belief = belief_of_silence(campaign_.plant);
    find_recordings(root);
    if (const auto* model = root.find("model")) {
      if (model->kind != Kind::text)
        refuse(campaign_.file, model->position, "model",
               "key 'model' has the wrong type: expected the name of a .toml file in quotes");
      campaign_.model = campaign_.folder / model->text;
      if (!fs::exists(campaign_.model))
        refuse(
            campaign_.file, model->position, "model",
            fmt::format("the model {} does not exist: name a file in this folder, or leave the key out for "
                        "the plant's default",
                        campaign_.model.string()));
      campaign_.belief =
          load_belief(campaign_.model, campaign_.plant, campaign_.findings, campaign_.unstated);
    }
  }

  // Sets the recordings' folder. `data` names it if it is not the campaign's own folder.
  void find_recordings(const ConfigNode& root) {
    campaign_.recordings = campaign_.folder;
    const auto* data = root.find("data");
    if (data == nullptr) return;
    if (data->kind != Kind::text || data->text.empty())
      refuse(campaign_.file, data->position, "data",
             "key 'data' has the wrong type: expected the name of the recordings' folder in quotes");
    const auto* source = root.find("source");
    const auto found = recordings_folder(campaign_.folder, data->text);
    if (!found)
      refuse(campaign_.file, data->position, "data",
             how_to_get_recordings(data->text, source && source->kind == Kind::text ? source->text : ""));
    campaign_.recordings = *found;
  }

  // `understood` becomes false if a mapping is not.
  std::vector<ColumnMapping> read_columns(const ConfigNode& table, bool& understood) {
    auto read = read_column_table(table, campaign_.plant, campaign_.file.string());
    if (any_unusable(read.findings)) understood = false;
    std::ranges::move(read.findings, std::back_inserter(campaign_.findings));
    return std::move(read.columns);
  }

  bool take_format(const ConfigNode& table, CsvFormat& format) {
    auto problems = read_format(table, format);
    for (auto& problem : problems)
      add(FindingKind::file_format, FindingSeverity::trial_unusable, problem.position, problem.key,
          std::move(problem.text), "see [format] in tools/campaign/README.md");
    return problems.empty();
  }

  void read_trials(const ConfigNode& root) {
    const auto* trials = root.find("trial");
    if (trials == nullptr || trials->kind != Kind::array || trials->children.empty())
      refuse(campaign_.file, {1, 1}, "trial",
             "there is no trial: add one [[trial]] with file = \"…\" and kind = \"…\" for each recording");
    const auto* every = root.find("every_trial");
    if (every != nullptr) refuse_shared_file(*every, *trials);
    std::size_t entry = 0;
    for (const auto& node : trials->children)
      read_trial(every == nullptr ? node : completed(node, *every), ++entry);
  }

  // A file of [every_trial] beside files of the trials would be used by none of them.
  void refuse_shared_file(const ConfigNode& every, const ConfigNode& trials) {
    const auto* file = every.find("file");
    const auto names_file = [](const ConfigNode& trial) { return trial.find("file") != nullptr; };
    if (file == nullptr || std::ranges::none_of(trials.children, names_file)) return;
    refuse(campaign_.file, file->key_position, "every_trial.file",
           "key 'file' of [every_trial] is a recording that no trial would use: write [[trial]] above it, or "
           "take the files of all trials away");
  }

  // The trial with the keys of [every_trial] that it does not have itself.
  static ConfigNode completed(ConfigNode trial, const ConfigNode& every) {
    for (const auto& child : every.children)
      if (trial.find(child.key) == nullptr) trial.children.push_back(child);
    return trial;
  }

  void read_trial(const ConfigNode& node, std::size_t entry) {
    const auto* file = node.find("file");
    if (file == nullptr || file->kind != Kind::text || file->text.empty()) {
      add(FindingKind::set_up, FindingSeverity::trial_unusable, node.position, "file",
          "this trial names no recording", "add file = \"trials/001.csv\" to its [[trial]]");
      return;
    }
    CampaignTrial trial;
    trial.name = file->text;
    trial.file = (campaign_.recordings / file->text).lexically_normal();
    trial.kind = usual_kind(campaign_.plant);
    trial.position = file->position;
    trial.belief = campaign_.belief;
    trial.index = campaign_.trials.size();
    trial.entry = entry;
    trial.format = format_;
    bool usable = are_columns_understood_;
    std::vector<ConfigProblem> problems;
    for (const auto& child : node.children) {
      if (child.key == "file") continue;
      if (child.key == "kind")
        usable &= read_kind(child, trial);
      else if (child.key == "columns" && child.kind == Kind::table)
        trial.columns = read_columns(child, usable);
      else if (child.key == "select" && child.kind == Kind::table)
        usable &= read_selection(child, trial);
      else if (child.key == "also" && child.kind == Kind::table)
        usable &= read_companion(child, trial);
      else if (child.key == "format" && child.kind == Kind::table)
        usable &= take_format(child, trial.format);
      else
        read_setup(child, trial, problems);
    }
    for (const auto& problem : problems)
      add(FindingKind::set_up, FindingSeverity::trial_unusable, problem.position, problem.key, problem.text,
          "correct the value in this [[trial]]");
    usable &= judge_setup(trial);
    if (!usable || !problems.empty()) return;
    for (const auto& number : campaign_.unstated)
      if (!trial.states(number.key)) trial.unstated.push_back(number);
    trial.columns.insert(trial.columns.end(), columns_.begin(), columns_.end());
    campaign_.trials.push_back(std::move(trial));
  }

  bool read_kind(const ConfigNode& node, CampaignTrial& trial) {
    const auto kind = enum_of<TrialKind>(node);
    if (kind) trial.kind = *kind;
    if (!kind)
      add(FindingKind::set_up, FindingSeverity::trial_unusable, node.position, "kind", "is no kind of trial",
          fmt::format("write one of {}", names_of<TrialKind>()));
    return kind.has_value();
  }

  bool read_selection(const ConfigNode& table, CampaignTrial& trial) {
    for (const auto& part : table.children) {
      const auto number = number_of(part);
      if (part.key == "column" && part.kind == Kind::text)
        trial.rows.column = part.text;
      else if (part.key == "value" && number)
        trial.rows.value = *number;
      else if (part.key == "from_s" && number)
        trial.rows.from_s = *number;
      else if (part.key == "to_s" && number)
        trial.rows.to_s = *number;
      else if (part.key == "from_line" && number && *number >= 1.0)
        trial.rows.from_line = static_cast<std::uint64_t>(*number);
      else if (part.key == "to_line" && number && *number >= 1.0)
        trial.rows.to_line = static_cast<std::uint64_t>(*number);
      else {
        add(FindingKind::set_up, FindingSeverity::trial_unusable, part.key_position, "select." + part.key,
            "cannot be understood",
            "write select = { column = \"NAME\", value = 1, from_s = 0.0, to_s = 1.0, from_line = 2, to_line "
            "= "
            "41 }, any of them");
        return false;
      }
    }
    return true;
  }

  bool read_companion(const ConfigNode& table, CampaignTrial& trial) {
    const auto* file = table.find("file");
    if (file == nullptr || file->kind != Kind::text || file->text.empty()) {
      add(FindingKind::set_up, FindingSeverity::trial_unusable, table.position, "also",
          "names no second recording", "write also = { file = \"plate.csv\", columns = { t_s = \"t\" } }");
      return false;
    }
    CompanionFile companion{(campaign_.recordings / file->text).lexically_normal(), {}, format_};
    if (const auto* format = table.find("format");
        format != nullptr && !take_format(*format, companion.format))
      return false;
    bool understood = true;
    if (const auto* columns = table.find("columns")) companion.columns = read_columns(*columns, understood);
    trial.companions.push_back(std::move(companion));
    return understood;
  }

  void read_setup(const ConfigNode& node, CampaignTrial& trial, std::vector<ConfigProblem>& problems) {
    SetupEntry entry{node.key, SetupValue{}, node};
    if (const auto number = number_of(node))
      entry.value = *number;
    else if (node.kind == Kind::text)
      entry.value = node.text;
    else if (node.kind == Kind::boolean)
      entry.value = node.boolean;
    else
      return add(FindingKind::set_up, FindingSeverity::note, node.key_position, node.key,
                 "is neither number, text nor true/false and is left out",
                 "write one value, its unit in the key");
    if (node.kind == Kind::text && node.text == kUnknownNumber)
      problems.push_back({campaign_.file.string(), node.key_position, node.key,
                          fmt::format("is \"{}\": write your own number", kUnknownNumber)});
    else
      override_belief(trial.belief, node, campaign_.file.string(), problems);
    trial.setup.push_back(std::move(entry));
  }

  // Adds what is doubtful in the set-up; keys of [every_trial] are told once.
  bool judge_setup(const CampaignTrial& trial) {
    if (!doubts_) doubts_.emplace(campaign_.plant, campaign_.file.string());
    const auto found = doubts_->of(trial);
    for (const auto& finding : found)
      if (std::ranges::find(campaign_.findings, finding) == campaign_.findings.end())
        campaign_.findings.push_back(finding);
    return found.empty();
  }

  void note_unknown(const ConfigNode& node) {
    static const std::vector<std::string> kKnown{"name",      "plant",   "model",  "data",        "source",
                                                 "available", "columns", "format", "every_trial", "trial"};
    if (std::find(kKnown.begin(), kKnown.end(), node.key) != kKnown.end()) return;
    add(FindingKind::set_up, FindingSeverity::note, node.key_position, node.key,
        "is not used at the top of a campaign", cure_for_unknown_key(node.key, std::nullopt, kKnown));
  }

  void add(FindingKind kind, FindingSeverity severity, ConfigPosition position, const std::string& key,
           std::string what, std::string cure) {
    campaign_.findings.push_back({kind, severity, campaign_.file.string(), position.line, position.column,
                                  key, std::move(what), std::move(cure)});
  }

  Campaign campaign_;
  std::vector<ColumnMapping> columns_;
  bool are_columns_understood_ = true;
  std::optional<SetupDoubts> doubts_;
  CsvFormat format_{};
};

}  // namespace

bool CampaignTrial::states_diameter() const {
  return std::ranges::any_of(kDiameterKeys, [&](std::string_view key) { return number(key).has_value(); });
}

bool CampaignTrial::states(std::string_view path) const {
  const auto key = last_key(path);
  if (number(key)) return true;
  if (key == "radius_m" || key == "foot_radius_m") return states_diameter();
  return key == "stiffness_N_per_m" && number("stiffness_per_area_N_per_m");
}

bool CampaignTrial::is_unstated(std::string_view path) const {
  return std::ranges::find(unstated, path, &UnstatedNumber::key) != unstated.end();
}

std::optional<double> CampaignTrial::number(std::string_view key) const {
  for (const auto& entry : setup)
    if (entry.key == key)
      if (const auto* value = std::get_if<double>(&entry.value)) return *value;
  return std::nullopt;
}

std::optional<std::string> CampaignTrial::text(std::string_view key) const {
  for (const auto& entry : setup)
    if (entry.key == key)
      if (const auto* value = std::get_if<std::string>(&entry.value)) return *value;
  return std::nullopt;
}

std::optional<bool> CampaignTrial::flag(std::string_view key) const {
  for (const auto& entry : setup)
    if (entry.key == key)
      if (const auto* value = std::get_if<bool>(&entry.value)) return *value;
  return std::nullopt;
}

Campaign load_campaign(const fs::path& folder) { return Loader(folder).run(); }

}  // namespace sandhopper
