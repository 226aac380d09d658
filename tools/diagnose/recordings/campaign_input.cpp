#include "tools/diagnose/recordings/campaign_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/repeated_recordings.hpp"
#include "tools/campaign/setup_keys.hpp"
#include "tools/campaign/unstated_unloading.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/plants/rotary_axis/free_axis.hpp"
#include "tools/diagnose/recordings/given_effects.hpp"

namespace sandhopper::diagnose {

PlantKind kind_of(CampaignPlant plant) {
  switch (plant) {
    case CampaignPlant::hopper:
      return PlantKind::hopper;
    case CampaignPlant::intruder:
      return PlantKind::intruder;
    case CampaignPlant::falling_body:
      return PlantKind::falling_body;
    case CampaignPlant::rotary_axis:
      return PlantKind::rotary_axis;
  }
  return PlantKind::hopper;
}

namespace {

// Restores channels that read_trial() left out because they stay at one value, if they do so in all trials.
// The diagnosis then finds and reports the fault.
void take_what_is_at_one_value(const std::vector<std::vector<TrialRecording::Channel>>& of_trials,
                               std::vector<Trial>& trials) {
  std::map<std::string, std::size_t> count;
  for (const auto& channels : of_trials)
    for (const auto& channel : channels) ++count[channel.name];
  for (std::size_t t = 0; t < trials.size(); ++t)
    for (const auto& channel : of_trials[t])
      if (count[channel.name] == trials.size() && channel.values.size() == trials[t].time_s.size())
        trials[t].channels[channel.name] = channel.values;
}

// Adds set-up values under the names that plants use, if the experimenter used other names.
void translate_setups(const Campaign& campaign, CampaignInput& input) {
  auto& trials = input.recordings.trials;
  std::map<std::string, SetupMeaning> meanings;
  for (const auto& trial : trials)
    for (const auto& [key, value] : trial.setup)
      if (const auto meaning = meaning_of_setup(key)) meanings.emplace(key, *meaning);
  for (const auto& [key, meaning] : meanings) {
    const std::string& usual = meaning.key;
    const bool is_told =
        std::ranges::any_of(trials, [&](const Trial& trial) { return trial.setup.contains(usual); });
    if (is_told) continue;
    double least = 0.0;
    if (meaning.is_ordinal) {
      least = std::numeric_limits<double>::infinity();
      for (const auto& trial : trials) least = std::min(least, trial.setup_or(key, least));
    }
    for (auto& trial : trials)
      if (const auto it = trial.setup.find(key); it != trial.setup.end())
        trial.setup[usual] = meaning.scale * (it->second - least);
    input.findings.push_back({.kind = FindingKind::set_up,
                              .severity = FindingSeverity::note,
                              .file = campaign.file.string(),
                              .channel = key,
                              .what = fmt::format("is used as {}", usual),
                              .cure = fmt::format("write {} in place of it", usual)});
  }
}

// Shifts the times so that a trial begins at 0 with its first row. A body falls from the start of its trial,
// which may be up to one camera row before the first row. If the first rows of all falling-body trials are
// within 1.5 rows of each other, one start holds for all: 0, or the earliest first row if the clock began
// elsewhere.
void begin_at_zero(Recordings& recordings) {
  constexpr double kRows = 1.5;
  auto& trials = recordings.trials;
  double earliest_s = 1e300, latest_s = -1e300, row_s = 0.0;
  for (const auto& trial : trials) {
    if (trial.time_s.empty()) continue;
    earliest_s = std::min(earliest_s, trial.time_s.front());
    latest_s = std::max(latest_s, trial.time_s.front());
    row_s = std::max(row_s, kRows * median_step_s(trial.time_s));
  }
  const bool together = recordings.plant == PlantKind::falling_body && latest_s - earliest_s <= row_s;
  const double shared_s = earliest_s >= 0.0 && earliest_s <= row_s ? 0.0 : earliest_s;
  for (auto& trial : trials) {
    if (trial.time_s.empty()) continue;
    const double start_s = together ? shared_s : trial.time_s.front();
    for (double& t : trial.time_s) t -= start_s;
  }
}

// True for an axis without inertia that is not clamped: its motion cannot be simulated.
bool is_locked_only(const CampaignTrial& trial) {
  const auto* axis = std::get_if<RotaryAxisBelief>(&trial.belief);
  return axis != nullptr && axis->axis.inertia_kg_m2 == 0.0 && trial.kind != TrialKind::clamped;
}

// `name`, or "name (2)" and so on: several trials may come from one file.
std::string name_among(const std::string& name, const std::vector<Trial>& trials) {
  std::string own = name;
  for (int i = 2; std::ranges::find(trials, own, &Trial::name) != trials.end(); ++i)
    own = fmt::format("{} ({})", name, i);
  return own;
}

void take_trial(const CampaignTrial& described, const TrialRecording& recording, Recordings& recordings) {
  Trial trial;
  trial.name = name_among(std::filesystem::path(described.name).stem().string(), recordings.trials);
  trial.kind = name_of(described.kind);
  for (const auto& entry : described.setup)
    if (const auto* number = std::get_if<double>(&entry.value))
      trial.setup[entry.key] = *number;
    else if (const auto* word = std::get_if<std::string>(&entry.value))
      recordings.words[entry.key].insert(*word);
  trial.time_s = recording.t_s;
  for (const auto& channel : recording.channels) trial.channels[channel.name] = channel.values;
  // If a range ends too early, it does so in each trial; the samples within it still show the quantity.
  for (const auto& channel : recording.at_one_value)
    if (recording.saturation(channel.name) != nullptr && channel.values.size() == trial.time_s.size())
      trial.channels[channel.name] = channel.values;
  recordings.trials.push_back(std::move(trial));
}

void tell_free_axes(const Campaign& campaign, const FreeAxes& free, CampaignInput& input) {
  const auto tell = [&](std::string what, std::string cure) {
    input.findings.push_back({.kind = FindingKind::set_up,
                              .severity = FindingSeverity::note,
                              .file = campaign.file.string(),
                              .channel = "torque_Nm",
                              .what = std::move(what),
                              .cure = std::move(cure)});
  };
  const std::size_t all = input.recordings.trials.size();
  if (free.without_torque > 0)
    tell(fmt::format("is not recorded in {} of {} trials: the axis is assumed to run free there (0 N m)",
                     free.without_torque, all),
         free.unstated > 0
             ? "record it, or write motor_enabled = true for a trial that is driven, which is then left out"
             : "");
  if (free.held > 0)
    tell(fmt::format("is unknown at the start of {} of {} trials, where something holds the axis for at most "
                     "{:.2f} s; these rows are not used",
                     free.held, all, free.longest_held_s),
         "cut the recording where the axis is let go");
}

// Takes out the spreads that are 0 because nobody states them, so that a plant uses its own default for them.
void forget_unstated_spreads(const std::set<std::string>& stated, Belief& belief) {
  std::erase_if(belief.numbers, [&](const auto& number) {
    return number.first.starts_with("spread.") && number.second == 0.0 && !stated.contains(number.first);
  });
}

}  // namespace

Belief flattened(const sandhopper::Belief& belief) {
  Belief flat;
  flat.numbers = numbers_of(belief);
  std::visit(
      [&](const auto& plant) {
        flat.effects = plant.effects;
        flat.key_spreads = plant.key_spreads;
        flat.known_to = plant.known_to;
      },
      belief);
  return flat;
}

CampaignInput read_campaign(const Campaign& campaign) {
  refuse_unknown_effects(campaign);
  CampaignInput input;
  std::stringstream model;
  if (!campaign.model.empty()) model << std::ifstream(campaign.model).rdbuf();
  input.recordings.model_text = model.str();
  input.recordings.plant = kind_of(campaign.plant);
  input.recordings.belief = flattened(campaign.belief);
  std::set<std::string> stated;
  for (const auto& number : used_numbers(campaign).numbers)
    if (number.source != UsedNumber::Source::plant_default) stated.insert(number.key);
  forget_unstated_spreads(stated, input.recordings.belief);
  input.recordings.available = campaign.available;
  input.findings = campaign.findings;
  for (auto& note : placeholder_notes(campaign, [](std::string_view) { return true; }))
    input.findings.push_back(std::move(note));
  UnstatedUnloading unloading(campaign);
  RepeatedRecordings repeated;
  std::vector<std::vector<TrialRecording::Channel>> at_one_value;
  std::vector<std::optional<bool>> motor_on;
  for (const auto& described : campaign.trials) {
    TrialRecording recording = read_trial(campaign, described);
    if (auto twice = repeated.add(described, fingerprint_of(recording)))
      recording.findings.push_back(std::move(*twice));
    unloading.add(described, recording);
    for (const auto& finding : recording.findings)  // trials that share a file repeat its findings
      if (std::ranges::find(input.findings, finding) == input.findings.end())
        input.findings.push_back(finding);
    if (!recording.has_time)
      input.findings.push_back(
          {.kind = FindingKind::no_time,
           .severity = FindingSeverity::trial_unusable,
           .file = described.file.string(),
           .what = "has no time, which a diagnosis needs",
           .cure = "add a column of the time; hop terrain gives the depth law without one"});
    if (!recording.usable() || !recording.has_time) {
      ++input.unusable;
      continue;
    }
    if (is_locked_only(described)) {
      input.findings.push_back({.kind = FindingKind::set_up,
                                .severity = FindingSeverity::trial_unusable,
                                .file = described.file.string(),
                                .channel = "axis.inertia_kg_m2",
                                .what = "is 0, which is right only for an axis that is locked",
                                .cure = "write kind = \"clamped\" for such a trial, or state the inertia"});
      ++input.unusable;
      continue;
    }
    take_trial(described, recording, input.recordings);
    at_one_value.push_back(recording.at_one_value);
    motor_on.push_back(described.flag("motor_enabled"));
    input.recordings.beliefs.push_back(flattened(described.belief));
    forget_unstated_spreads(stated, input.recordings.beliefs.back());
  }
  if (auto note = unloading.finding()) input.findings.push_back(std::move(*note));
  take_what_is_at_one_value(at_one_value, input.recordings.trials);
  if (input.recordings.plant == PlantKind::rotary_axis) {
    const FreeAxes free = take_free_axes(input.recordings.trials, motor_on);
    tell_free_axes(campaign, free, input);
  }
  begin_at_zero(input.recordings);
  translate_setups(campaign, input);
  return input;
}

}  // namespace sandhopper::diagnose
