#include <algorithm>
#include <exception>
#include <filesystem>

#include "config/hint.hpp"
#include "firmware/fault.hpp"
#include "firmware/freeze/freeze_folders.hpp"
#include "tools/cli/freeze_folder.hpp"
#include "tools/cli/verb.hpp"
#include "tools/explain/explain_page.hpp"
#include "tools/explain/explanation_json.hpp"
#include "tools/explain/find_last.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string subject;
  std::string page;
  bool last = false;
  bool no_page = false;
};

const FaultEntry& find_fault(const std::string& code) {
  for (std::size_t i = 0; i < kFaultCount; ++i)
    if (code == std::to_string(i) || code == name_of(kFaults[i].fault)) return kFaults[i];
  const std::vector<std::string> names(EnumNames<Fault>::value.begin(), EnumNames<Fault>::value.end());
  const auto near = nearest_words(code, names);
  throw Failure(ExitCode::usage, "no fault '" + code + "'",
                (near.empty() ? "" : "did you mean " + either(near) + "? ") +
                    "'hop explain' without a code lists them all");
}

nlohmann::ordered_json as_json(const FaultEntry& entry) {
  return {{"code", static_cast<int>(entry.fault)},
          {"name", std::string(name_of(entry.fault))},
          {"reaction", std::string(name_of(entry.reaction))},
          {"latch", std::string(name_of(entry.latch))},
          {"seen_within_cycles", entry.cycles},
          {"meaning", std::string(entry.meaning)},
          {"cure", std::string(entry.cure)}};
}

ExitCode explain_code(Session& session, const std::string& code) {
  if (!code.empty()) {
    const auto& entry = find_fault(code);
    session.say(
        "fault {} {}\n  means:    {}\n  reaction: {}, lasting {}, seen within {} cycles\n  cure:     {}",
        static_cast<int>(entry.fault), name_of(entry.fault), entry.meaning, name_of(entry.reaction),
        name_of(entry.latch), entry.cycles, entry.cure);
    session.result = as_json(entry);
    return ExitCode::ok;
  }
  session.result["faults"] = nlohmann::ordered_json::array();
  for (const auto& entry : kFaults) {
    if (entry.fault == Fault::none) continue;
    session.say("{:3} {:<22} {}", static_cast<int>(entry.fault), name_of(entry.fault), entry.meaning);
    session.result["faults"].push_back(as_json(entry));
  }
  return ExitCode::ok;
}

std::filesystem::path last_frame(Session& session) {
  const auto folders = freeze::all_folders(configured_freeze_folder(session));
  if (const auto last = find_last_freeze(folders)) return *last;
  std::string names;
  for (const auto& folder : folders) names += (names.empty() ? "" : ", ") + folder.string();
  throw Failure(ExitCode::no, "there is no freeze frame in " + names,
                "name a trial's log: hop explain LOG.mcap");
}

Recording read(const std::filesystem::path& file) {
  try {
    return read_recording(file);
  } catch (const std::exception& error) {
    throw Failure(ExitCode::no, error.what(), "name a freeze frame, or the log of a trial with a fault");
  }
}

// Writes the page beside the file, or into the working directory if the former is not writable.
std::filesystem::path write_page(const Explanation& explanation, const std::filesystem::path& file,
                                 const Options& options) {
  if (!options.page.empty()) {
    write_explanation_page(explanation, options.page);
    return options.page;
  }
  auto page = std::filesystem::path(file).replace_extension(".html");
  try {
    write_explanation_page(explanation, page);
  } catch (const std::runtime_error&) {
    page = page.filename();
    write_explanation_page(explanation, page);
  }
  return page;
}

ExitCode explain_file(Session& session, const std::filesystem::path& file, const Options& options) {
  const Explanation explanation = explain(read(file));
  session.say_line(explanation_text(explanation));
  session.result = explanation_json(explanation);
  session.result["file"] = file.string();
  session.say("  file:     {}", file.string());
  if (options.no_page) return ExitCode::ok;
  const auto page = write_page(explanation, file, options);
  session.say("  page:     {}", page.string());
  session.result["page"] = page.string();
  return ExitCode::ok;
}

ExitCode run(Session& session, const Options& options) {
  if (options.last) return explain_file(session, last_frame(session), options);
  const bool is_file = options.subject.find_first_of("./") != std::string::npos;
  if (is_file && !std::filesystem::exists(options.subject))
    throw Failure(ExitCode::usage, "no file " + options.subject,
                  "name a freeze frame or a log, or use --last");
  return is_file ? explain_file(session, options.subject, options) : explain_code(session, options.subject);
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  auto subject = arguments.add_option(
      "SUBJECT", options->subject,
      "number or name of a fault, or a file: a freeze frame or a trial's log with a fault; without it all "
      "faults are listed");
  arguments.add_flag("--last", options->last, "the newest freeze frame").excludes(subject);
  arguments.add_option("--page", options->page, "page to write; default: beside the file, ending in .html");
  arguments.add_flag("--no-page", options->no_page, "text only");
  arguments.footer(
      "Of a file: what was measured in the 5 s before and the 1 s after the fault, which check fired with "
      "value "
      "and\nlimit, what was done, and the cure. Exit status: 0, 1 there is no fault to explain, 2 command "
      "line.");
  return [options](Session& session) { return run(session, *options); };
}

const VerbRegistration kExplain("explain", set_up);

}  // namespace
}  // namespace sandhopper::cli
