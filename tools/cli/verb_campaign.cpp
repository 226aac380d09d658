#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "config/files.hpp"
#include "config/load.hpp"
#include "firmware/log/log_content.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/campaign_draft.hpp"
#include "tools/campaign/lost_channels.hpp"
#include "tools/campaign/repeated_recordings.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/campaign/unlisted_recordings.hpp"
#include "tools/campaign/unstated_unloading.hpp"
#include "tools/cli/campaign_keys.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/diagnose/recordings/given_effects.hpp"
#include "tools/plant/load_world.hpp"
#include "tools/trial/campaign_maker.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string folder;
  std::string plant = "hopper";
  std::string output;
  int trials = 15;
  std::uint64_t seed = 1;
  bool every_key = false;
  std::vector<std::string> files;  // to import
  std::string import_plant;
  std::string import_output;
  std::string import_names;
};

nlohmann::ordered_json as_json(const Finding& f) {
  return {{"kind", name_of(f.kind)}, {"severity", name_of(f.severity)},
          {"file", f.file},          {"line", f.line},
          {"column", f.column},      {"channel", f.channel},
          {"what", f.what},          {"cure", f.cure}};
}

nlohmann::ordered_json to_json(const UsedNumber& n) {
  return {{"key", n.key}, {"low", n.low}, {"high", n.high}, {"unit", n.unit}, {"source", n.source_text}};
}

ExitCode check(Session& session, const Options& options) {
  const auto campaign = load_campaign(options.folder);
  sandhopper::diagnose::refuse_unknown_effects(campaign);
  std::size_t usable = 0;
  std::vector<Finding> found;
  std::set<std::string> seen;  // Trials may share a finding.
  const auto add = [&](const std::vector<Finding>& more) {
    for (const auto& finding : more)
      if (seen.insert(to_string(finding)).second) found.push_back(finding);
  };
  add(campaign.findings);
  const auto missing = missing_numbers(campaign);
  add(missing);
  UnstatedUnloading unloading(campaign);
  LostChannels lost(campaign.plant);
  RepeatedRecordings repeated;
  Progress progress("reading", static_cast<double>(campaign.trials.size()));
  for (const auto& trial : campaign.trials) {
    auto recording = read_trial(campaign, trial);
    if (auto twice = repeated.add(trial, fingerprint_of(recording)))
      recording.findings.push_back(std::move(*twice));
    add(recording.findings);
    unloading.add(trial, recording);
    lost.add(trial, recording);
    usable += recording.usable() && std::ranges::all_of(missing, [&](const Finding& number) {
                return number.severity == FindingSeverity::note || trial.states(number.channel);
              });
    progress.at(static_cast<double>(trial.index));
  }
  if (const auto note = unloading.finding()) add({*note});
  add(unused_key_notes(campaign));
  add(unlisted_recordings(campaign));
  auto findings = nlohmann::ordered_json::array();
  for (const auto& finding : found) findings.push_back(as_json(finding));
  for (const auto& line : in_lines(found, true)) session.say_line(line);
  const auto used = used_numbers(campaign);
  auto numbers = nlohmann::ordered_json::array();
  for (const auto& number : used.numbers) {
    if (is_listed(number)) session.say("  {}", to_string(number));
    numbers.push_back(to_json(number));
  }
  const auto effects = stated_effects(campaign);
  for (const auto& effect : effects) session.say("  {}", effect);
  if (const auto defaults = defaults_of_sensors(used); !defaults.empty()) session.say("  {}", defaults);
  session.say("  {} more numbers are 0 by default: what they stand for is not assumed", used.off);
  session.say("{}: plant {}, {} trials, {} usable{}", campaign.name, name_of(campaign.plant),
              campaign.trials.size(), usable, lost.words());
  session.result = {{"campaign", campaign.name},
                    {"plant", name_of(campaign.plant)},
                    {"trials", campaign.trials.size()},
                    {"usable", usable},
                    {"without", lost.trials()},
                    {"findings", findings},
                    {"belief", numbers},
                    {"effects", effects}};
  return usable == campaign.trials.size() && campaign.findings.empty() && !any_unusable(missing)
             ? ExitCode::ok
             : ExitCode::no;
}

ExitCode make(Session& session, const Options& options) {
  CampaignMakerSetup setup;
  setup.robot = load_robot_file(session.config_file("robot.toml"));
  setup.world = load_world(session.config_directory(), setup.robot);
  setup.folder = options.output;
  setup.trials = options.trials;
  setup.seed = options.seed;
  if (std::filesystem::exists(setup.folder / "campaign.toml"))
    throw Failure(ExitCode::usage, options.output + " holds a campaign already and is not overwritten",
                  "name another folder with --output");
  Progress progress("trials", options.trials);
  setup.progress = [&](int done) { progress.at(done); };
  try {
    options.plant == "hopper" ? make_hop_campaign(setup) : make_intrusion_campaign(setup);
  } catch (const std::exception& error) {
    throw Failure(ExitCode::fault, error.what(), "name a folder you may write with --output");
  }
  session.say("{}: {} simulated trials; look at them with 'hop terrain {}'", options.output, options.trials,
              options.output);
  session.result = {{"folder", options.output}, {"plant", options.plant}, {"trials", options.trials}};
  return ExitCode::ok;
}

void write_new(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  if (!(out << text).flush())
    throw Failure(ExitCode::fault, file.string() + " cannot be written",
                  "name a folder you may write with --output");
}

std::optional<CampaignPlant> plant_named(const std::string& name) {
  const auto& names = EnumNames<CampaignPlant>::value;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<CampaignPlant>(found - names.begin());
}

// Splits a list such as "t_s,force_N".
std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < list.size();) {
    const auto end = std::min(list.find(',', begin), list.size());
    parts.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

// A log is not a table: its topics are not columns.
void refuse_log(const std::filesystem::path& file) {
  if (!is_mcap(file)) return;
  LogContent content;
  try {
    content = content_of_log(file);
  } catch (const mcap::Error&) {
    content.topics = "records that cannot be read";
  }
  const auto table = std::filesystem::path(file).replace_extension(".csv").string();
  throw Failure(
      ExitCode::no,
      fmt::format("{} is an MCAP log with {}, not a table", file.string(),
                  content.topics.empty() ? "no topic" : content.topics),
      content.is_of_this_firmware
          ? fmt::format("a log of this robot needs no import: name it in campaign.toml, [[trial]] file "
                        "= \"{0}\"; or write it as a table and import that: hop export {1} --output {2}",
                        file.filename().string(), file.string(), table)
          : "write the topic as a table with the program that recorded it (PlotJuggler: save as CSV; "
            "ROS 2: ros2 bag play while ros2 topic echo --csv /TOPIC > FILE.csv), and import that");
}

ExitCode import_files(Session& session, const Options& options) {
  const std::vector<std::filesystem::path> files(options.files.begin(), options.files.end());
  for (const auto& file : files) refuse_log(file);
  const auto folder = options.import_output.empty() ? std::filesystem::absolute(files.front()).parent_path()
                                                    : std::filesystem::path(options.import_output);
  CampaignDraft draft;
  try {
    draft = draft_campaign(files, plant_named(options.import_plant), folder, parts_of(options.import_names));
  } catch (const PlantNotTold& error) {
    for (const auto& line : error.seen) session.say_line(line);
    throw Failure(ExitCode::usage, error.what(),
                  fmt::format("nothing was written; go on with 'hop campaign import {} --plant PLANT', PLANT "
                              "as above; 'hop campaign keys PLANT' lists its channels",
                              fmt::join(options.files, " ")));
  } catch (const std::runtime_error& error) {
    throw Failure(ExitCode::no, error.what(),
                  "name a table: rows of numbers under the names of their columns");
  }
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  for (const auto* name : {"campaign.toml", "nominal.toml"})  // Both or none.
    if (std::filesystem::exists(folder / name))
      throw Failure(ExitCode::usage, (folder / name).string() + " exists already and is not overwritten",
                    "name another folder with --output, or remove the file; nothing was written");
  write_new(folder / "campaign.toml", draft.campaign_toml);
  write_new(folder / "nominal.toml", draft.nominal_toml);
  session.say("{} is taken for:", files.front().string());
  for (const auto& line : draft.said) session.say("  {}", line);
  const auto campaign = load_campaign(folder);
  auto found = campaign.findings;
  for (const auto& trial : campaign.trials)
    for (auto& finding : read_trial(campaign, trial).findings) found.push_back(std::move(finding));
  for (const auto& line : in_lines(found, true)) session.say_line(line);
  session.say("wrote {} and nominal.toml: correct what is wrong there, then 'hop campaign check {}'",
              (folder / "campaign.toml").string(), folder.string());
  for (const auto& line : draft.wrong) session.say("wrong: {}", line);
  session.result = {{"folder", folder.string()},
                    {"plant", name_of(draft.plant)},
                    {"taken_for", draft.said},
                    {"wrong", draft.wrong}};
  return draft.wrong.empty() ? ExitCode::ok : ExitCode::no;
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.require_verb();
  auto checking =
      arguments.add_verb("check", "read every recording and say what is wrong, where, and the cure");
  checking.add_option("FOLDER", options->folder, "a campaign: the folder of its campaign.toml, or that file")
      .required();
  auto keys = arguments.add_verb(
      "keys", "what a recording and nominal.toml may hold: channels, keys, units, defaults");
  keys.add_option("PLANT", options->plant, "hopper, intruder, falling_body or rotary_axis")
      .one_of({"hopper", "intruder", "falling_body", "rotary_axis"})
      .required();
  keys.add_flag("--all", options->every_key,
                "also keys of [sensors] and [spread] that belong to another plant");
  auto making = arguments.add_verb("make", "write a campaign of simulated recordings to try the tools on");
  making.add_option("--plant", options->plant, "hopper: first strides; intruder: a plate moved into the bed")
      .one_of({"hopper", "intruder"})
      .show_default();
  making
      .add_option("--trials", options->trials, "how many, over heights and stiffnesses, or speeds and plates")
      .in_range(1, 100000)
      .show_default();
  making.add_option("--seed", options->seed, "of the first trial; the next ones count up").show_default();
  making.add_option("--output", options->output, "folder to write").required();
  auto importing =
      arguments.add_verb("import", "look at a table of another program and write a campaign for it");
  importing.add_option("FILE", options->files, "recordings, all written alike (.csv, .txt)")
      .required()
      .existing_file();
  importing.add_option("--plant", options->import_plant, "default: guessed from the columns")
      .one_of({"hopper", "intruder", "falling_body", "rotary_axis"});
  importing.add_option("--names", options->import_names,
                       "of the columns, in order and divided by commas, for a file that has none");
  importing.add_option("--output", options->import_output,
                       "folder for campaign.toml and nominal.toml; default: that of the first file");
  return [options, checking, keys, importing](Session& session) {
    if (keys.parsed()) return print_campaign_keys(session, options->plant, options->every_key);
    if (importing.parsed()) return import_files(session, *options);
    return checking.parsed() ? check(session, *options) : make(session, *options);
  };
}

const VerbRegistration kCampaign("campaign", set_up);

}  // namespace
}  // namespace sandhopper::cli
