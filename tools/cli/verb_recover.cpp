#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include "firmware/cycle.hpp"
#include "firmware/freeze/freeze_folders.hpp"
#include "firmware/freeze/newest_cycles.hpp"
#include "firmware/log/candump.hpp"
#include "firmware/log/log_recovery.hpp"
#include "firmware/log/mcap_parts.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "tools/cli/freeze_folder.hpp"
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

struct Recovered {
  LogRecovery log;
  std::string restored_from;  // freeze ring, dump or freeze frame that supplied the end
  // If the end of the log is unknown: least number of missing cycles, from the CAN traffic beside the log.
  std::optional<std::uint64_t> seen_on_bus;
};

// The CAN text is written more often than the log, so frames after the log's end prove missing cycles.
std::optional<std::uint64_t> cycles_on_bus_after(const std::filesystem::path& log, std::int64_t last_ns) {
  const auto beside = std::filesystem::path(log).replace_extension(".candump");
  if (!std::filesystem::exists(beside)) return std::nullopt;
  std::int64_t newest_ns = last_ns;
  try {
    CandumpReader reader(beside);
    CandumpFrame frame;
    for (std::string_view interface; reader.next(frame, interface);)
      newest_ns = std::max(newest_ns, frame.time_ns);
  } catch (const CandumpError&) {
    // A torn last line ends the search.
  }
  return static_cast<std::uint64_t>((newest_ns - last_ns) / kCyclePeriod_ns);
}

Recovered recover_log(Session& session, const Options& options, const std::filesystem::path& output) {
  Recovered result;
  const LogRecovery seen = look_at_mcap(options.log);
  std::optional<NewestCycles> newest;
  if (seen.cut_at && seen.cycles)
    newest = find_newest_cycles(*seen.cycles, freeze::all_folders(configured_freeze_folder(session)));
  result.log = recover_mcap(options.log, output, newest ? newest->cycles : std::vector<FreezeCycle>{});
  if (newest && result.log.end_is_known()) result.restored_from = newest->source.string();
  if (!result.log.end_is_known()) result.seen_on_bus = cycles_on_bus_after(options.log, result.log.last_ns);
  return result;
}

// Recognises the ending .candump, or the first character of `candump -L` text.
bool is_candump(const std::filesystem::path& file) {
  const int first = std::ifstream(file, std::ios::binary).peek();
  return file.extension() == ".candump" || first == '(' || first == '#';
}

Recovered recover(Session& session, const Options& options, const std::filesystem::path& output) {
  if (std::filesystem::exists(output))
    throw Failure(ExitCode::usage, output.string() + " exists and is not overwritten",
                  "name another file with --output");
  const bool is_can = is_candump(options.log);
  try {
    return is_can ? Recovered{recover_candump(options.log, output), "", {}}
                  : recover_log(session, options, output);
  } catch (const mcap::SeveralLogs& error) {
    throw Failure(ExitCode::no, error.what(), error.cure);
  } catch (const mcap::Error& error) {
    throw Failure(ExitCode::no, error.what(),
                  "name a trial's .mcap file, or CAN text (.candump, candump -L)");
  } catch (const CandumpError& error) {
    throw Failure(ExitCode::no, error.what(),
                  "name a trial's .mcap file, or CAN text (.candump, candump -L)");
  } catch (const std::system_error& error) {
    throw Failure(ExitCode::fault, error.what(), "name a file you may write, with free space, with --output");
  }
}

void tell_cycles(Session& session, const Recovered& recovered) {
  const auto& cycles = recovered.log.cycles;
  if (!cycles) return;
  session.say("  cycles {} to {}: {} missing between them, {} skipped by overruns", cycles->first,
              cycles->last, cycles->missing_inside, cycles->skipped);
  if (cycles->restored > 0)
    session.say("  the {} cycles after them were not in the log and come from {}", cycles->restored,
                recovered.restored_from);
  else if (!recovered.restored_from.empty())
    session.say("  the log's last cycle is the last that ran, by {}", recovered.restored_from);
  if (cycles->missing_at_end && *cycles->missing_at_end > 0)
    session.say("  {} cycles are missing between the log's last and those", *cycles->missing_at_end);
}

void tell_rest_of_file(Session& session, const LogRecovery& found) {
  if (found.copies > 1)
    session.say("  the file holds this log {} times, one behind the other; it is taken once", found.copies);
  if (found.bytes_behind_end > 0)
    session.say(
        "  the log was closed; {} bytes behind its end are {} and left out, nothing of it is missing there",
        found.bytes_behind_end, found.zeros_behind_end ? "zeros" : "no part of it");
}

void tell_end(Session& session, const Recovered& recovered) {
  const auto& found = recovered.log;
  if (!found.cut_at) return;
  session.say("  the log was not closed: it ends at byte {}", *found.cut_at);
  if (found.end_is_known()) return;
  session.say(
      "  its newest records are missing, and no freeze frame of this trial says how many: usually the last "
      "0.1 s (one chunk), after a power cut up to 1 s");
  if (recovered.seen_on_bus)
    session.say("  by the CAN traffic beside it at least {} cycles are missing at the end",
                *recovered.seen_on_bus);
}

void tell(Session& session, const Recovered& recovered, const std::string& log, const std::string& output) {
  const auto& found = recovered.log;
  if (found.whole)
    session.say("{} is whole; nothing to recover", log);
  else
    session.say("{}: {} of {} bytes unreadable", log, found.unreadable_bytes, found.file_bytes);
  for (const auto& [name, topic] : found.topics)
    session.say("  {:<12} {:8} saved, {}{} lost{}", name, topic.saved,
                found.loses_at_least ? "at least " : "", topic.lost,
                found.end_is_known() ? "" : " before the end");
  if (found.saved() > 0)
    session.say("  saved from {:.3f} s to {:.3f} s (since 1970)", 1e-9 * static_cast<double>(found.first_ns),
                1e-9 * static_cast<double>(found.last_ns));
  tell_cycles(session, recovered);
  if (found.gaps > 0)
    session.say("  {} gaps were recorded while logging: {} records missing in them", found.gaps,
                found.lost_in_gaps);
  for (const auto& damage : found.damage)
    session.say("  bytes {} to {}: {}", damage.from_byte, damage.to_byte, damage.what);
  tell_rest_of_file(session, found);
  tell_end(session, recovered);
  if (!found.whole) session.say("  written to {}", output);
}

template <class Number>
nlohmann::ordered_json or_null(const std::optional<Number>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json cycles_json(const Recovered& recovered) {
  const auto& cycles = recovered.log.cycles;
  if (!cycles) return nullptr;
  nlohmann::ordered_json json{{"first", cycles->first},
                              {"last", cycles->last},
                              {"missing_inside", cycles->missing_inside},
                              {"skipped_by_overruns", cycles->skipped},
                              {"restored", cycles->restored},
                              {"restored_from", nullptr},
                              {"missing_at_end", or_null(cycles->missing_at_end)},
                              {"missing_at_end_at_least_by_can", or_null(recovered.seen_on_bus)}};
  if (!recovered.restored_from.empty()) json["restored_from"] = recovered.restored_from;
  return json;
}

nlohmann::ordered_json as_json(const Recovered& recovered, const std::string& output) {
  const auto& found = recovered.log;
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
                                {"lost", nullptr},
                                {"lost_at_least", found.lost()},
                                {"topics", topics},
                                {"first_ns", found.first_ns},
                                {"last_ns", found.last_ns},
                                {"cycles", cycles_json(recovered)},
                                {"gaps", found.gaps},
                                {"lost_in_gaps", found.lost_in_gaps},
                                {"damage", damage},
                                {"copies", found.copies},
                                {"bytes_behind_end", found.bytes_behind_end},
                                {"cut_at_byte", or_null(found.cut_at)}};
  if (!found.whole) result["output"] = output;
  // A cycle has two records: frame and output.
  const std::uint64_t end = found.cycles ? found.cycles->missing_at_end.value_or(0) : 0;
  if (found.end_is_known() && !found.loses_at_least) result["lost"] = found.lost() + 2 * end;
  return result;
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("LOG", options->log, "a trial's .mcap or .candump file").required().existing_file();
  arguments.add_option("--output", options->output,
                       "where to write what was saved; default: LOG with .recovered");
  arguments.footer(
      "The log itself is not changed. A whole one is not copied. The end of a log whose hopperd was killed "
      "comes "
      "from its\nfreeze ring or freeze frame where there is one; \"lost\" is null where nobody knows what "
      "the end "
      "took. Exit status: 0 the log is whole or what can "
      "be\n"
      "read of it was written, 1 nothing can be read of it, 2 command line, 3 a file cannot be read or "
      "written.");
  return [options](Session& session) {
    const auto output = output_path(*options);
    const auto recovered = recover(session, *options, output);
    tell(session, recovered, options->log, output.string());
    session.result = as_json(recovered, output.string());
    return ExitCode::ok;
  };
}

const VerbRegistration kRecover("recover", set_up);

}  // namespace
}  // namespace sandhopper::cli
