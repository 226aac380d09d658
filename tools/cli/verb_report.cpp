#include <filesystem>

#include "firmware/log/log_content.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "tools/cli/log_cure.hpp"
#include "tools/cli/verb.hpp"
#include "tools/report/log_report.hpp"
#include "tools/report/trial_page.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string log;
  std::string output;
};

// A page without a cycle would show nothing.
Failure no_cycle(const std::filesystem::path& log) {
  if (std::filesystem::file_size(log) == 0)
    return {ExitCode::no, log.string() + " is empty (0 bytes)", "name the .mcap file of a trial"};
  const auto content = content_of_log(log);
  if (content.topics.empty())
    return {ExitCode::no, log.string() + " holds no topic; it may have been cut before its first record",
            fmt::format("see what can be saved of it: hop recover {}", log.string())};
  const auto what = fmt::format("{} holds no cycle of a trial, but {}", log.string(), content.topics);
  if (content.is_of_this_firmware)
    return {ExitCode::no, what,
            fmt::format("it may be a recording of hop calibrate: hop export {} writes it as a table",
                        log.string())};
  return {
      ExitCode::no, what,
      "name the .mcap file of a trial of this robot; of another program's log, write the topic as a table "
      "with that program and take it with hop campaign import"};
}

ReportData read(const std::filesystem::path& log) {
  try {
    auto data = report_data_from_log(log);
    if (data.time_s.empty()) throw no_cycle(log);
    return data;
  } catch (const mcap::Error& error) {
    throw Failure(ExitCode::usage, error.what(),
                  cure_of(error, log, "name the .mcap file of a trial made by this build"));
  }
}

ExitCode report(Session& session, const Options& options) {
  const std::filesystem::path log = options.log;
  std::filesystem::path page = options.output;
  if (page.empty()) page = std::filesystem::path(log).replace_extension(".html");
  std::error_code error;
  if (std::filesystem::equivalent(log, page, error))
    throw Failure(ExitCode::usage, "the page would be written over its source, " + log.string(),
                  "name the .mcap file of a trial, and another file with --output");
  const ReportData data = read(log);
  write_trial_report(data, page);
  for (const std::string& note : data.notes) session.say_line(note);
  session.say("{} strides, {} cycles: {}", data.strides.size(), data.time_s.size(), page.string());
  session.result["report"] = page.string();
  session.result["strides"] = data.strides.size();
  session.result["cycles"] = data.time_s.size();
  session.result["notes"] = data.notes;
  return ExitCode::ok;
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("LOG", options->log, "a trial's .mcap file").required().existing_file();
  arguments.add_option("--output", options->output,
                       "page to write; default: beside the log, ending in .html");
  return [options](Session& session) { return report(session, *options); };
}

const VerbRegistration kReport("report", set_up);

}  // namespace
}  // namespace sandhopper::cli
