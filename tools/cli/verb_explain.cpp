#include <algorithm>

#include "config/hint.hpp"
#include "firmware/fault.hpp"
#include "tools/cli/verb.hpp"

namespace sandhopper::cli {
namespace {

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

ExitCode explain(Session& session, const std::string& code) {
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

Run set_up(Arguments& arguments) {
  auto code = std::make_shared<std::string>();
  arguments.add_option("CODE", *code, "number or name of a fault; without it all are listed");
  return [code](Session& session) { return explain(session, *code); };
}

const VerbRegistration kExplain("explain", set_up);

}  // namespace
}  // namespace sandhopper::cli
