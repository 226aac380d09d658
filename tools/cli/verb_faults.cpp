#include <unistd.h>

#include <filesystem>
#include <map>

#include "config/files.hpp"
#include "tools/cli/faults_pairs.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/faults/run_cell.hpp"
#include "tools/plant/load_world.hpp"

namespace sandhopper::cli {
namespace {

using namespace faults;

struct Options {
  std::string only;
  std::string without;
  bool pairs = false;
  int sample = 0;
  std::uint64_t seed = 1;
};

class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("hop-faults." + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

Fault fault_named(const std::string& name) {
  for (const auto& entry : kFaults)
    if (entry.name == name && entry.fault != Fault::none) return entry.fault;
  throw Failure(ExitCode::usage, "no fault '" + name + "'", "'hop explain' lists them all");
}

void say_cell(Session& session, const Cell& cell, const CellResult& r) {
  session.say("{:<26} {:<12} {:<27} {:>4} {:<10} {:<31} {:<4} {}", cell.name(), name_of(cell.phase),
              cell.expected == Fault::none ? "- (cannot be seen)" : name_of(r.found),
              r.cycles < 0 ? "-" : std::to_string(r.cycles), name_of(r.state), r.torque,
              r.logged ? "yes" : "-", r.problem.empty() ? cell.note : "WRONG: " + r.problem);
  if (!r.message.empty()) session.say("{:<26} {}", "", r.message);
  session.result["cells"].push_back({{"device", std::string(name_of(cell.device))},
                                     {"kind", std::string(name_of(cell.kind))},
                                     {"phase", std::string(name_of(cell.phase))},
                                     {"expected", std::string(name_of(cell.expected))},
                                     {"found", std::string(name_of(r.found))},
                                     {"cycles", r.cycles},
                                     {"allowed_cycles", entry_of(cell.expected).cycles},
                                     {"state", std::string(name_of(r.state))},
                                     {"torque", r.torque},
                                     {"logged", r.logged},
                                     {"message", r.message},
                                     {"problem", r.problem}});
}

ExitCode run_matrix(Session& session, const MatrixSetup& setup, const Options& options) {
  const auto cells = all_cells();
  std::map<Fault, int> slowest;
  int run = 0, wrong = 0, unseen = 0;
  session.result["cells"] = nlohmann::ordered_json::array();
  session.say("{:<26} {:<12} {:<27} {:>4} {:<10} {:<31} {:<4}", "what breaks", "when", "found", "N", "state",
              "torque after", "log");
  Progress progress("fault matrix", static_cast<int>(cells.size()));
  for (const auto& cell : cells) {
    progress.at(run);
    if (cell.name().find(options.only) == std::string::npos &&
        name_of(cell.expected).find(options.only) == std::string_view::npos)
      continue;
    const auto result = run_cell(cell, setup);
    say_cell(session, cell, result);
    ++run;
    wrong += !result.problem.empty();
    unseen += cell.expected == Fault::none;
    if (result.cycles >= 0) slowest[cell.expected] = std::max(slowest[cell.expected], result.cycles);
  }
  session.say("");
  for (const auto& [fault, cycles] : slowest)
    session.say("{:<27} at most {:>3} cycles, allowed {:>3}", name_of(fault), cycles, entry_of(fault).cycles);
  session.say("{} cells: {} as they must be, {} wrong; {} cannot be seen and are listed", run, run - wrong,
              wrong, unseen);
  session.result["run"] = run;
  session.result["wrong"] = wrong;
  session.result["unseen"] = unseen;
  return wrong == 0 ? ExitCode::ok : ExitCode::no;
}

ExitCode run_faults(Session& session, const Options& options) {
  const auto directory = session.config_directory();
  const Folder folder;
  MatrixSetup setup;
  setup.robot = load_robot(directory);
  setup.world = load_world(directory, setup.robot);
  setup.folder = folder.path();
  if (!options.without.empty()) setup.without = fault_named(options.without);
  if (!options.pairs) return run_matrix(session, setup, options);
  return run_pairs(session, setup, {.only = options.only, .sample = options.sample, .seed = options.seed});
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("--only", options->only,
                       "cells whose name or fault, pairs whose name contains this text");
  arguments.add_option("--without", options->without,
                       "with this fault's detector switched off: the matrix must fail");
  const auto pairs = arguments.add_flag("--pairs", options->pairs,
                                        "pairs of faults: a second one during the reaction to the first");
  const auto sample =
      arguments
          .add_option("--sample", options->sample, "of the pairs, so many drawn at random (default: all)")
          .non_negative()
          .needs(pairs);
  arguments.add_option("--seed", options->seed, "of the draw").show_default().needs(sample);
  return [options](Session& session) { return run_faults(session, *options); };
}

const VerbRegistration kFaults("faults", set_up);

}  // namespace
}  // namespace sandhopper::cli
