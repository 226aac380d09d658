#pragma once
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "config/files.hpp"
#include "tools/cli/experiment.hpp"
#include "tools/cli/failure.hpp"
#include "tools/experiment/bed_strides.hpp"
#include "tools/plant/load_world.hpp"

namespace sandhopper::cli {

// Options common to all experiments on families of beds.
struct BedOptions {
  std::uint64_t seed = 1;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::string> beds;

  // `first`: the thing that the seed belongs to, for the help text.
  void add_to(Arguments& arguments, const std::string& first) {
    arguments.add_option("--seed", seed, "of the first " + first).show_default();
    arguments.add_option("--threads", threads, "default: one a core").in_range(1U, 1024U);
    arguments.add_option("--beds", beds, "only these families").type_name("NAMES");
  }

  // Setup of the experiment from these options and the configuration's robot and world.
  template <class Setup>
  Setup setup(Session& session) const {
    const auto robot = load_robot(session.config_directory());
    Setup out;
    out.cycle = cycle_config(robot);
    out.world = load_world(session.config_directory(), robot);
    out.beds = beds;
    out.first_seed = seed;
    out.threads = threads;
    return out;
  }
};

// Calls scored(setup). An unknown bed family is reported as a wrong command line.
template <class Scored, class Setup>
auto scored_beds(Scored&& scored, const Setup& setup) {
  try {
    return scored(setup);
  } catch (const std::invalid_argument& error) {
    std::string names;
    for (const auto& bed : bed_cases()) names += (names.empty() ? "" : ", ") + bed.name;
    throw Failure(ExitCode::usage, error.what(), "name some of " + names);
  }
}

}  // namespace sandhopper::cli
