#include <filesystem>
#include <fstream>

#include "config/json.hpp"
#include "firmware/log/csv_export.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/trial_sheet.hpp"
#include "tools/cli/log_cure.hpp"
#include "tools/cli/verb.hpp"
#include "tools/trial/ground_export.hpp"
#include "tools/trial/layouts/layouts.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string log;
  std::string output;
  bool all = false;
  bool phase_numbers = false;
  std::string layouts;
};

std::optional<TrialSheet> read_sheet(const std::filesystem::path& log) {
  return sheet_of(mcap::Reader(log, {.check_crc = false}));
}

// A table has no place for facts about the whole trial, so they go into a file of their own.
std::filesystem::path write_sheet_beside(const std::filesystem::path& log, std::filesystem::path csv) {
  const auto sheet = read_sheet(log);
  if (!sheet) return {};
  csv.replace_extension(".sheet.toml");
  std::ofstream out(csv);
  out << to_toml(*sheet);
  if (!out.flush())
    throw Failure(ExitCode::fault, "cannot write " + csv.string(),
                  "check the free space and who may write there");
  return csv;
}

// Ground results have one row per stride, not per cycle, so they get tables of their own. Returns the files
// written.
std::vector<std::string> write_ground_beside(const std::filesystem::path& log,
                                             const std::filesystem::path& csv) {
  std::vector<std::string> files;
  const auto records = ground_records(log);
  const auto write = [&](const char* ending, const auto& rows, auto&& table) {
    if (rows.empty()) return;
    auto path = csv;
    path.replace_extension(ending);
    std::ofstream out(path);
    table(rows, out);
    if (!out.flush())
      throw Failure(ExitCode::fault, "cannot write " + path.string(),
                    "check the free space and who may write there");
    files.push_back(path.string());
  };
  write(".profile.csv", records.profiles, write_profile_csv);
  write(".ground.csv", records.summaries, write_ground_csv);
  return files;
}

void write_layouts(Session& session, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  auto names = nlohmann::ordered_json::array();
  for (const auto& file : layout_files()) {
    std::ofstream out(folder / file.name);
    out << file.text;
    if (!out.flush())
      throw Failure(ExitCode::usage, "cannot write " + (folder / file.name).string(),
                    "name a folder you may write with --layouts");
    session.say_line((folder / file.name).string());
    names.push_back((folder / file.name).string());
  }
  session.result["layouts"] = names;
}

// Refuses to write the table over its source, and to empty the output file for an input that is no log.
void check_log(const std::filesystem::path& log, const std::filesystem::path& csv) {
  std::error_code error;
  if (std::filesystem::equivalent(log, csv, error))
    throw Failure(ExitCode::usage, "the table would be written over its source, " + log.string(),
                  "name the .mcap file of a trial, and another file with --output");
  try {
    const mcap::Reader reader(log, {.check_crc = false});
  } catch (const mcap::Error& problem) {
    throw Failure(ExitCode::usage, problem.what(), cure_of(problem, log, "name the .mcap file of a trial"));
  }
}

ExitCode export_log(Session& session, const Options& options) {
  std::filesystem::path path = options.output;
  if (path.empty()) path = std::filesystem::path(options.log).replace_extension(".csv");
  check_log(options.log, path);
  std::ofstream out(path);
  if (!out)
    throw Failure(ExitCode::usage, "cannot write " + path.string(),
                  "name a file you may write with --output");
  CsvExportResult result;
  try {
    result = export_csv(options.log, out,
                        {.optional_channels = options.all, .phase_names = !options.phase_numbers});
  } catch (const mcap::Error& error) {
    throw Failure(ExitCode::usage, error.what(),
                  cure_of(error, options.log, "name the .mcap file of a trial"));
  }
  if (!out.flush()) throw Failure(ExitCode::fault, "cannot write " + path.string(), "check the free space");
  session.say("{}: {} rows, {} columns", path.string(), result.rows, result.columns.size());
  if (result.truncated_at)
    session.say("the log is cut at byte {}; exported up to there", *result.truncated_at);
  if (result.lost_records > 0) session.say_line(result.lost_text);
  const auto ground = write_ground_beside(options.log, path);
  for (const auto& file : ground) session.say("ground: {}", file);
  const auto sheet = write_sheet_beside(options.log, path);
  if (!sheet.empty()) session.say("trial sheet: {}", sheet.string());
  session.result.update(nlohmann::ordered_json{{"csv", path.string()},
                                               {"rows", result.rows},
                                               {"columns", result.columns},
                                               {"ground", ground},
                                               {"lost_records", result.lost_records}});
  if (const auto kept = read_sheet(options.log)) session.result["sheet"] = to_json(*kept);
  return ExitCode::ok;
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  auto log = arguments.add_option("LOG", options->log, "a trial's .mcap file").existing_file();
  arguments.add_option("--output", options->output,
                       "CSV file, a row a cycle; default: beside the log. The ground, a row a stride, goes "
                       "into .profile.csv and "
                       ".ground.csv beside it");
  arguments.add_flag("--all", options->all, "gyroscopes, bus voltage and the firmware's estimates besides");
  arguments.add_flag("--phase-numbers", options->phase_numbers,
                     "write `phase` as 0, 1, 2 in place of flight, compression, extension");
  arguments.add_option(
      "--layouts", options->layouts,
      "write into this folder: layouts for PlotJuggler and Foxglove, loaders for Python and MATLAB or "
      "Octave; without LOG only these");
  return [options, log](Session& session) {
    if (!options->layouts.empty()) write_layouts(session, options->layouts);
    if (log.given()) return export_log(session, *options);
    if (options->layouts.empty())
      throw Failure(ExitCode::usage, "LOG is required: a trial's .mcap file",
                    "name it, or a folder for --layouts; see 'hop export --help'");
    return ExitCode::ok;
  };
}

const VerbRegistration kExport("export", set_up);

}  // namespace
}  // namespace sandhopper::cli
