#include "tools/cli/faults_pairs.hpp"

#include "tools/cli/progress.hpp"
#include "tools/faults/pair_table.hpp"

namespace sandhopper::cli {
namespace {

using namespace faults;
using Json = nlohmann::ordered_json;

Json json_of(const Pair& pair, const PairResult& r) {
  Json raised = Json::array();
  for (const auto fault : r.raised) raised.push_back(std::string(name_of(fault)));
  const auto reaction = [](Fault fault) { return std::string(name_of(entry_of(fault).reaction)); };
  return {{"first", pair.first.name()},
          {"second", pair.second.name()},
          {"phase", std::string(name_of(pair.first.phase))},
          {"together", pair.delay_cycles == kTogether},
          {"delay_cycles", std::max(0, pair.delay_cycles)},
          {"first_alone", std::string(name_of(r.first_alone))},
          {"second_alone", std::string(name_of(r.second_alone))},
          {"reaction_first_alone", reaction(r.first_alone)},
          {"reaction_second_alone", reaction(r.second_alone)},
          {"reaction", reaction(r.together)},
          {"latch", std::string(name_of(entry_of(r.together).latch))},
          {"raised", raised},
          {"end", r.end},
          {"second_cycles", r.cycles},
          {"hidden", r.hidden},
          {"problem", r.problem}};
}

Json json_of(const PairTable& table) {
  Json rows = Json::object();
  for (const auto& [first, row] : table.rows())
    for (const auto& [second, count] : row)
      rows[first][second] = {{"pairs", count.pairs}, {"hidden", count.hidden}, {"wrong", count.wrong}};
  return rows;
}

}  // namespace

ExitCode run_pairs(Session& session, const MatrixSetup& setup, const PairOptions& options) {
  const auto pairs =
      options.sample > 0 ? some_pairs(static_cast<std::size_t>(options.sample), options.seed) : all_pairs();
  if (options.sample > 0)
    session.say("{} of {} pairs, seed {}", pairs.size(), all_pairs().size(), options.seed);
  PairRunner runner(setup);
  PairTable table;
  double virtual_s = 0.0;
  int done = 0;
  session.result["pairs"] = Json::array();
  Progress progress("pairs of faults", static_cast<double>(pairs.size()));
  for (const auto& pair : pairs) {
    progress.at(done++);
    if (pair.name().find(options.only) == std::string::npos) continue;
    const auto result = runner.run(pair);
    table.add(pair, result);
    virtual_s += result.time_s;
    session.result["pairs"].push_back(json_of(pair, result));
    if (!result.problem.empty()) session.say("WRONG: {}: {}", pair.name(), result.problem);
  }
  for (const auto& line : table.lines()) session.say_line(line);
  const auto& total = table.total();
  session.say(
      "{} pairs in {:.0f} s of virtual time: {} as they must be, {} wrong; in {} the second cannot be seen",
      total.pairs, virtual_s, total.pairs - total.wrong, total.wrong, total.hidden);
  session.result["table"] = json_of(table);
  session.result["seed"] = options.seed;
  session.result["run"] = total.pairs;
  session.result["wrong"] = total.wrong;
  session.result["hidden"] = total.hidden;
  session.result["virtual_s"] = virtual_s;
  return total.wrong == 0 ? ExitCode::ok : ExitCode::no;
}

}  // namespace sandhopper::cli
