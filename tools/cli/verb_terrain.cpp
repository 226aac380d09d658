#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tools/cli/output_folder.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/terrain/campaign_analysis.hpp"
#include "tools/terrain/figure_text.hpp"

namespace sandhopper::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Options {
  std::string folder;
  std::string output;
  std::string part;
  std::vector<std::string> merge;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  bool report = true;
};

// Parses "2/4" as part 2 of 4.
std::pair<std::size_t, std::size_t> part_of(const std::string& text) {
  if (text.empty()) return {1, 1};
  const auto slash = text.find('/');
  std::size_t part = 0, parts = 0;
  try {
    part = std::stoul(text.substr(0, slash));
    parts = slash == std::string::npos ? 0 : std::stoul(text.substr(slash + 1));
  } catch (const std::exception&) {
    parts = 0;
  }
  if (part < 1 || part > parts)
    throw Failure(ExitCode::usage, "'" + text + "' is no part of a campaign",
                  "write --part 1/4, --part 2/4, …");
  return {part, parts};
}

fs::path output_folder(const Options& options) {
  const fs::path folder = !options.output.empty()  ? fs::path(options.output)
                          : options.folder.empty() ? fs::path("terrain")
                                                   : fs::path(options.folder) / "terrain";
  return made(folder);
}

CampaignResults analyse(const Options& options) {
  const auto [part, parts] = part_of(options.part);
  const auto campaign = load_campaign(options.folder);
  Progress progress("trials", static_cast<double>(campaign.trials.size() / parts + 1));
  return analyse_campaign(
      campaign, {.part = part,
                 .parts = parts,
                 .threads = options.threads,
                 .progress = [&](std::size_t done, std::size_t) { progress.at(static_cast<double>(done)); }});
}

CampaignResults merge(const Options& options) {
  std::vector<CampaignResults> parts;
  for (const auto& file : options.merge) {
    try {
      std::ifstream in(file);
      parts.push_back(campaign_results_from_json(Json::parse(in)));
    } catch (const Json::exception& error) {
      throw Failure(ExitCode::usage, file + " is no result of a part: " + error.what(),
                    "name the .json files that 'hop terrain FOLDER --part i/n' wrote");
    }
  }
  try {
    return merge_parts(std::move(parts));
  } catch (const std::invalid_argument& error) {
    throw Failure(ExitCode::usage, error.what(), "name every part of one campaign once");
  }
}

void write_json(const Json& head, const CampaignResults& results, const fs::path& file) {
  std::ofstream out(file);
  write_results(out, head, results);
  if (!out.flush())
    throw Failure(ExitCode::fault, "cannot write " + file.string(), "check the folder and the free space");
}

std::vector<std::string> write_tables(const CampaignReport& report, const fs::path& folder,
                                      const std::string& stem) {
  std::vector<std::string> files;
  for (const auto& [name, text] : report.tables) {
    const auto file = folder / (stem + "_" + name + ".csv");
    std::ofstream out(file);
    out << text;
    if (!out.flush())
      throw Failure(ExitCode::fault, "cannot write " + file.string(), "check the folder and the free space");
    files.push_back(file.string());
  }
  return files;
}

// Prints each finding once, even if many trials share it.
void tell_findings(Session& session, const CampaignResults& results) {
  constexpr std::size_t kMostLines = 100;
  const auto groups = all_findings(results);
  for (std::size_t i = 0; i < std::min(groups.size(), kMostLines); ++i) {
    const auto& [finding, trials] = groups[i];
    const auto cost = finding->severity == FindingSeverity::note
                          ? std::string("note")
                          : "unusable " + std::string(cost_text(finding->severity).substr(4));
    session.say("  {}: {}{}", cost, to_string(*finding),
                trials > 1 ? fmt::format(" (in {} trials)", trials) : "");
  }
  if (groups.size() > kMostLines)
    session.say("  … and {} more; all of them are in the report", groups.size() - kMostLines);
}

void tell_ruled_out(Session& session, const CampaignResults& results) {
  constexpr std::size_t kMostLines = 12;
  const auto reasons = all_ruled_out(results);
  for (std::size_t i = 0; i < std::min(reasons.size(), kMostLines); ++i)
    session.say("  cannot be said: {} ({} of {} trials)", reasons[i].reason, reasons[i].trials,
                results.results.size());
  if (reasons.size() > kMostLines)
    session.say("  … and {} more; all of them are in the report", reasons.size() - kMostLines);
}

ExitCode terrain(Session& session, const Options& options) {
  if (options.folder.empty() == options.merge.empty())
    throw Failure(ExitCode::usage, "nothing to analyse",
                  "name a campaign's folder, or parts of one with --merge");
  const auto [part, parts] = part_of(options.part);
  const auto start = std::chrono::steady_clock::now();
  const auto results = options.merge.empty() ? analyse(options) : merge(options);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  auto report = report_on(results);
  const auto folder = output_folder(options);
  const std::string stem = parts > 1 ? fmt::format("terrain_part_{}_of_{}", part, parts) : "terrain";
  const auto json_file = folder / (stem + ".json"), page = folder / (stem + ".html");
  write_json(report.json, results, json_file);
  if (options.report) write_study_page(report.study, page);
  const auto tables = write_tables(report, folder, stem);

  tell_findings(session, results);
  std::size_t usable = 0;
  for (const auto& result : results.results) usable += result.usable;
  session.say("{}: {} of {} trials can be used; {:.1f} s", results.campaign, usable, results.results.size(),
              spent.count());
  for (const auto& line : report.lines) session.say_line(line);
  tell_ruled_out(session, results);
  session.say("  figures {}", json_file.string());
  for (const auto& table : tables) session.say("  table   {}", table);
  if (options.report) session.say("  report  {}", page.string());
  report.json["files"] = {
      {"json", json_file.string()}, {"report", options.report ? page.string() : ""}, {"tables", tables}};
  session.result = std::move(report.json);
  if (session.json) {
    auto& trials = session.result["trials"] = Json::array();
    for (const auto& result : results.results) trials.push_back(to_json(result));
  }
  return usable > 0 ? ExitCode::ok : ExitCode::no;
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("FOLDER", options->folder,
                       "a campaign: the folder of its campaign.toml, or that file");
  arguments.add_option(
      "--output", options->output,
      "folder for terrain.json, terrain_profile.csv and terrain.html; default FOLDER/terrain");
  arguments.add_option(
      "--part", options->part,
      "analyse one part of the trials, e.g. 2/4; writes terrain_part_2_of_4.json for --merge");
  arguments.add_option("--merge", options->merge, "put the JSON files of every part together")
      .existing_file();
  arguments.add_option("--threads", options->threads, "trials analysed at a time")
      .in_range(1U, 1024U)
      .show_default();
  arguments.add_off_flag("--no-report", options->report, "write no page");
  arguments.footer(
      "First comes the strength profile: the ground's quasi-static force at each depth. \"mean of the "
      "ground\" is "
      "the mean over\ntrials with its 95 % interval; \"one new trial\" is where the next trial's force will "
      "lie, "
      "95 % of the time. The trial is\nthe unit of every interval.\n"
      "Broken recordings are named with file, line, column and cure; the good trials are analysed all the "
      "same.\n"
      "Exit status 1: no trial could be used. A campaign to try it on: hop campaign make --output FOLDER");
  return [options](Session& session) { return terrain(session, *options); };
}

const VerbRegistration kTerrain("terrain", set_up);

}  // namespace
}  // namespace sandhopper::cli
