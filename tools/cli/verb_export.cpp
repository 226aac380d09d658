#include <filesystem>
#include <fstream>

#include "firmware/log/csv_export.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "tools/cli/verb.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string log;
  std::string output;
  bool all = false;
};

ExitCode export_log(Session& session, const Options& options) {
  std::filesystem::path path = options.output;
  if (path.empty()) path = std::filesystem::path(options.log).replace_extension(".csv");
  std::ofstream out(path);
  if (!out)
    throw Failure(ExitCode::usage, "cannot write " + path.string(),
                  "name a file you may write with --output");
  CsvExportResult result;
  try {
    result = export_csv(options.log, out, {.optional_channels = options.all});
  } catch (const mcap::Error& error) {
    throw Failure(ExitCode::usage, error.what(), "name the .mcap file of a trial");
  }
  if (!out.flush()) throw Failure(ExitCode::fault, "cannot write " + path.string(), "check the free space");
  session.say("{}: {} rows, {} columns", path.string(), result.rows, result.columns.size());
  if (result.truncated_at)
    session.say("the log is cut at byte {}; exported up to there", *result.truncated_at);
  if (result.lost_records > 0) session.say("{} records were lost when it was logged", result.lost_records);
  session.result = {{"csv", path.string()},
                    {"rows", result.rows},
                    {"columns", result.columns},
                    {"lost_records", result.lost_records}};
  return ExitCode::ok;
}

Run set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("LOG", options->log, "a trial's .mcap file")->required()->check(CLI::ExistingFile);
  app.add_option("--output", options->output, "CSV file; default: beside the log");
  app.add_flag("--all", options->all, "gyroscopes, bus voltage and the firmware's estimates besides");
  return [options](Session& session) { return export_log(session, *options); };
}

const VerbRegistration kExport({"export", "write a log as CSV, one row per cycle", set_up});

}  // namespace
}  // namespace sandhopper::cli
