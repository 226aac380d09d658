#include <cmath>
#include <stdexcept>
#include <thread>

#include "config/files.hpp"
#include "tools/cli/experiment.hpp"
#include "tools/cli/progress.hpp"
#include "tools/experiment/stride_sessions.hpp"
#include "tools/plant/load_world.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  long sessions = 200;
  std::uint64_t seed = 1;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::string> beds;
};

void say_sessions(Session& session, const std::vector<SessionScore>& scores) {
  session.say("strides after the first until the widest part of the band is half of what it was,");
  session.say("(sessions in which it is not after {}); rms error of the planned strides' depth",
              kMostStrides);
  session.say("  {:<17} {:>8} {:>12} {:>12} {:>12} {:>9}", "bed", "sessions", "by chance", "planned",
              "oracle", "depth mm");
  SessionScore all{.bed = "all"};
  const auto line = [&](const SessionScore& s) {
    const auto cell = [&](NextBy by) {
      return fmt::format("{:.2f} ({:.0f})", s.mean(by), s.unfinished[static_cast<std::size_t>(by)]);
    };
    session.say("  {:<17} {:>8.0f} {:>12} {:>12} {:>12} {:>9.1f}", s.bed, s.sessions, cell(NextBy::chance),
                cell(NextBy::plan), cell(NextBy::oracle),
                1e3 * std::sqrt(s.reach_squared_m2 / std::max(1.0, s.planned)));
  };
  for (const auto& s : scores) {
    line(s);
    all.sessions += s.sessions;
    all.reach_squared_m2 += s.reach_squared_m2;
    all.planned += s.planned;
    for (std::size_t arm = 0; arm < kNextBy; ++arm) {
      all.strides[arm] += s.strides[arm];
      all.unfinished[arm] += s.unfinished[arm];
    }
  }
  line(all);
  session.say("planned against by chance: {:.2f} times fewer; the oracle: {:.2f} times",
              all.mean(NextBy::chance) / all.mean(NextBy::plan),
              all.mean(NextBy::chance) / all.mean(NextBy::oracle));
}

ExitCode run(Session& session, const Options& options) {
  const auto robot = load_robot(session.config_directory());
  SessionSetup setup;
  setup.cycle = cycle_config(robot);
  setup.world = load_world(session.config_directory(), robot);
  setup.beds = options.beds;
  setup.sessions = options.sessions;
  setup.first_seed = options.seed;
  setup.threads = options.threads;
  Progress progress("sessions", 1.0);
  setup.progress = [&](long done, long total) {
    progress.at(static_cast<double>(done) / static_cast<double>(total));
  };
  std::vector<SessionScore> scores;
  try {
    scores = score_sessions(setup);
  } catch (const std::invalid_argument& error) {
    std::string names;
    for (const auto& bed : bed_cases()) names += (names.empty() ? "" : ", ") + bed.name;
    throw Failure(ExitCode::usage, error.what(), "name some of " + names);
  }
  say_sessions(session, scores);
  auto& json = session.result["sessions"] = nlohmann::ordered_json::array();
  for (const auto& score : scores) json.push_back(score);
  return ExitCode::ok;
}

Run set_up(Arguments& arguments) {
  auto o = std::make_shared<Options>();
  arguments.add_option("--sessions", o->sessions, "altogether, evenly over the beds")
      .in_range(1L, 1'000'000L)
      .show_default();
  arguments.add_option("--seed", o->seed, "of the first session").show_default();
  arguments.add_option("--threads", o->threads, "default: one a core").in_range(1U, 1024U);
  arguments.add_option("--beds", o->beds, "only these families").type_name("NAMES");
  return [o](Session& session) { return run(session, *o); };
}

const ExperimentRegistration kNext(
    {"next-stride", "strides that halve the band's widest part: set-ups by chance, planned, and by an oracle",
     set_up});

}  // namespace
}  // namespace sandhopper::cli
