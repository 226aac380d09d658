#include <algorithm>

#include "tools/cli/experiment.hpp"

namespace sandhopper::cli {
namespace {

std::vector<Verb>& experiments() {
  static std::vector<Verb> known;
  return known;
}

Run set_up(Arguments& arguments) {
  arguments.require_verb();
  auto known = experiments();
  std::sort(known.begin(), known.end(), [](const Verb& a, const Verb& b) { return a.name < b.name; });
  auto runs = std::make_shared<std::vector<std::pair<Arguments, Run>>>();
  for (const auto& experiment : known) {
    auto sub = arguments.add_verb(experiment.name, experiment.summary);
    runs->emplace_back(sub, experiment.set_up(sub));
  }
  return [runs](Session& session) {
    for (const auto& [sub, run] : *runs)
      if (sub.parsed()) return run(session);
    return ExitCode::usage;  // not reached: the parser requires a sub-verb
  };
}

const VerbRegistration kExperiment("experiment", set_up);

}  // namespace

ExperimentRegistration::ExperimentRegistration(Verb experiment) {
  experiments().push_back(std::move(experiment));
}

}  // namespace sandhopper::cli
