#include <filesystem>
#include <system_error>

#include "firmware/log/candump.hpp"
#include "firmware/log/log_recovery.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "tools/cli/verb.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string log;
  std::string output;
};

std::filesystem::path output_path(const Options& options) {
  if (!options.output.empty()) return options.output;
  const std::filesystem::path log = options.log;
  return std::filesystem::path(log).replace_extension(".recovered" + log.extension().string());
}

LogRecovery recover(const Options& options, const std::filesystem::path& output) {
  if (std::filesystem::exists(output))
    throw Failure(ExitCode::usage, output.string() + " exists and is not overwritten",
                  "name another file with --output");
  const bool is_can = std::filesystem::path(options.log).extension() == ".candump";
  try {
    return is_can ? recover_candump(options.log, output) : recover_mcap(options.log, output);
  } catch (const mcap::Error& error) {
    throw Failure(ExitCode::no, error.what(), "name a trial's .mcap or .candump file");
  } catch (const CandumpError& error) {
    throw Failure(ExitCode::no, error.what(), "name a trial's .mcap or .candump file");
  } catch (const std::system_error& error) {
    throw Failure(ExitCode::fault, error.what(), "name a file you may write, with free space, with --output");
  }
}

void tell(Session& session, const LogRecovery& found, const std::string& log, const std::string& output) {
  if (found.whole)
    session.say("{} is whole; nothing to recover", log);
  else
    session.say("{}: {} of {} bytes unreadable", log, found.unreadable_bytes, found.file_bytes);
  for (const auto& [name, topic] : found.topics)
    session.say("  {:<12} {:8} saved, {} lost", name, topic.saved, topic.lost);
  if (found.saved() > 0)
    session.say("  saved from {:.3f} s to {:.3f} s (since 1970)", 1e-9 * static_cast<double>(found.first_ns),
                1e-9 * static_cast<double>(found.last_ns));
  if (found.gaps > 0)
    session.say("  {} gaps were recorded while logging: {} records missing in them", found.gaps,
                found.lost_in_gaps);
  for (const auto& damage : found.damage)
    session.say("  bytes {} to {}: {}", damage.from_byte, damage.to_byte, damage.what);
  if (found.cut_at)
    session.say("  the log was not closed: it ends at byte {}; how much followed, nobody knows",
                *found.cut_at);
  if (!found.whole) session.say("  written to {}", output);
}

nlohmann::ordered_json as_json(const LogRecovery& found, const std::string& output) {
  auto topics = nlohmann::ordered_json::object();
  for (const auto& [name, topic] : found.topics)
    topics[name] = {{"saved", topic.saved}, {"lost", topic.lost}};
  auto damage = nlohmann::ordered_json::array();
  for (const auto& d : found.damage)
    damage.push_back({{"from_byte", d.from_byte}, {"to_byte", d.to_byte}, {"what", d.what}});
  nlohmann::ordered_json result{{"whole", found.whole},
                                {"output", nullptr},
                                {"file_bytes", found.file_bytes},
                                {"unreadable_bytes", found.unreadable_bytes},
                                {"saved", found.saved()},
                                {"lost", found.lost()},
                                {"topics", topics},
                                {"first_ns", found.first_ns},
                                {"last_ns", found.last_ns},
                                {"gaps", found.gaps},
                                {"lost_in_gaps", found.lost_in_gaps},
                                {"damage", damage},
                                {"cut_at_byte", nullptr}};
  if (!found.whole) result["output"] = output;
  if (found.cut_at) result["cut_at_byte"] = *found.cut_at;
  return result;
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("LOG", options->log, "a trial's .mcap or .candump file").required().existing_file();
  arguments.add_option("--output", options->output,
                       "where to write what was saved; default: LOG with .recovered");
  arguments.footer(
      "The log itself is not changed. A whole one is not copied. Exit status: 0 the log is whole or what can "
      "be\n"
      "read of it was written, 1 nothing can be read of it, 2 command line, 3 a file cannot be read or "
      "written.");
  return [options](Session& session) {
    const auto output = output_path(*options);
    const auto found = recover(*options, output);
    tell(session, found, options->log, output.string());
    session.result = as_json(found, output.string());
    return ExitCode::ok;
  };
}

const VerbRegistration kRecover("recover", set_up);

}  // namespace
}  // namespace sandhopper::cli
