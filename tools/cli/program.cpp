#include "tools/cli/program.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "config/problem.hpp"
#include "drivers/device_error.hpp"
#include "tools/cli/command_line.hpp"

namespace sandhopper::cli {
namespace {

struct Complaint {
  ExitCode exit;
  std::string message;
  std::string cure;
  nlohmann::ordered_json problems = nullptr;
};

void print_json(const nlohmann::ordered_json& object) {
  // Replaces bytes that are no UTF-8 (from a file name, a device's answer).
  const auto text = object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::fputs((text + "\n").c_str(), stdout);
}

int complain(const Session& session, const std::string& who, const Complaint& complaint) {
  std::fputs(fmt::format("{}: {}\n", who, complaint.message).c_str(), stderr);
  if (!complaint.cure.empty()) std::fputs(fmt::format("{}: {}\n", who, complaint.cure).c_str(), stderr);
  if (session.json) {
    nlohmann::ordered_json error{{"command", who},
                                 {"message", complaint.message},
                                 {"cure", complaint.cure},
                                 {"exit", static_cast<int>(complaint.exit)}};
    if (!complaint.problems.is_null()) error["problems"] = complaint.problems;
    print_json({{"error", error}});
  }
  return static_cast<int>(complaint.exit);
}

// Verbs that read a campaign: the configuration that is wrong is its campaign.toml or its model.
bool reads_campaign(const std::string& who) {
  return who.starts_with("hop campaign") || who.starts_with("hop diagnose") || who.starts_with("hop terrain");
}

Complaint about(const ConfigError& error, const std::string& who) {
  auto problems = nlohmann::ordered_json::array();
  for (const auto& p : error.problems())
    problems.push_back({{"file", p.file},
                        {"line", p.position.line},
                        {"column", p.position.column},
                        {"key", p.key},
                        {"text", p.text}});
  const auto count = error.problems().size();
  return {ExitCode::usage,
          fmt::format("{} in the configuration; nothing was started\n{}",
                      count == 1 ? "one problem" : fmt::format("{} problems", count), error.what()),
          reads_campaign(who)
              ? "the guide's page 'The recording contract' explains campaign.toml and nominal.toml; 'hop "
                "campaign "
                "keys PLANT' lists their keys"
              : "config/README.md explains the files; 'hop config check' looks at all of them",
          problems};
}

int run(const std::vector<Verb>& verbs, int argc, char** argv) {
  Session session;
  // Set before parsing, because a wrong command line must be reported as JSON, too.
  for (int i = 1; i < argc; ++i) session.json |= std::string_view(argv[i]) == "--json";
  CommandLine command_line(session, verbs);
  try {
    const auto verb = command_line.parse(argc, argv);
    const auto exit = verb(session);
    if (session.json) print_json(session.result);
    return static_cast<int>(exit);
  } catch (const CommandLine::Help& help) {
    session.say_line(help.text);
    if (session.json) print_json({{"help", help.text}});
    return static_cast<int>(ExitCode::ok);
  } catch (const Failure& failure) {
    return complain(session, command_line.understood(), {failure.exit(), failure.what(), failure.cure()});
  } catch (const ConfigError& error) {
    return complain(session, command_line.understood(), about(error, command_line.understood()));
  } catch (const DeviceError& error) {
    const auto message = std::string_view(error.what());
    return complain(session, command_line.understood(),
                    {ExitCode::fault, std::string(message.substr(0, message.size() - error.cure().size())),
                     error.cure()});
  } catch (const std::exception& error) {
    return complain(session, command_line.understood(), {ExitCode::fault, error.what(), ""});
  }
}

}  // namespace

int run_program(const std::vector<Verb>& verbs, int argc, char** argv) try {
  return run(verbs, argc, argv);
} catch (const std::exception& error) {
  std::fputs(fmt::format("hop: {}\n", error.what()).c_str(), stderr);
  return static_cast<int>(ExitCode::fault);
}

}  // namespace sandhopper::cli
