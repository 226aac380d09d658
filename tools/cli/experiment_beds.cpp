#include <cmath>
#include <stdexcept>
#include <thread>

#include "config/files.hpp"
#include "tools/cli/experiment.hpp"
#include "tools/cli/progress.hpp"
#include "tools/experiment/bed_score.hpp"
#include "tools/plant/load_world.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  long strides = 200;
  std::uint64_t seed = 1;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::string> beds;
};

std::string share(double count, double of) {
  return of == 0.0 ? "-" : fmt::format("{:.1f} %", 100.0 * count / of);
}

std::string alarms(const EventScore& s) { return fmt::format("{:.0f}/{:.0f}", s.false_alarms, s.absent); }

void say_events(Session& session, const std::vector<BedScore>& scores) {
  session.say(
      "\nevents: found where there was one (depth: rms error, share within 2 mm); false alarms elsewhere");
  session.say("  {:<17} {:>8} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9}", "bed", "strides", "found", "rms mm",
              "in 2 mm", "rupture", "boundary", "floor", "suction");
  for (const auto& s : scores) {
    const EventScore* own = nullptr;
    for (const auto* event : {&s.rupture, &s.boundary, &s.floor, &s.suction})
      if (event->possible > 0.0) own = event;
    const auto rms = own != nullptr && own->found > 0.0
                         ? fmt::format("{:.2f}", 1e3 * std::sqrt(own->depth_error_squared_m2 / own->found))
                         : std::string("-");
    session.say("  {:<17} {:>8.0f} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9}", s.bed,
                s.strides - s.incomplete, own != nullptr ? share(own->found, own->possible) : "-", rms,
                own != nullptr ? share(own->within_2mm, own->possible) : "-", alarms(s.rupture),
                alarms(s.boundary), alarms(s.floor), alarms(s.suction));
  }
}

void say_profile(Session& session, const std::vector<BedScore>& scores, const std::string& name,
                 std::size_t p) {
  session.say("\n{}: 95 % band against the true force at the depths visited", name);
  session.say("  {:<17} {:>8} {:>9} {:>11} {:>14} {:>12}", "bed", "claims", "coverage", "rms error",
              "width at 20 mm", "line valid");
  for (const auto& s : scores) {
    const auto& profile = s.profile[p];
    session.say("  {:<17} {:>8.0f} {:>9} {:>9.1f} % {:>12.1f} % {:>12}", s.bed, profile.claims,
                share(profile.covered, profile.depths),
                100.0 * std::sqrt(profile.squared_error / profile.depths),
                100.0 * profile.median_width_20mm(), share(profile.lines_valid, profile.claims));
  }
}

ExitCode run(Session& session, const Options& options) {
  const auto robot = load_robot(session.config_directory());
  BedScoreSetup setup;
  setup.cycle = cycle_config(robot);
  setup.world = load_world(session.config_directory(), robot);
  setup.events.noise = setup.cycle.stiffness.joint;
  setup.providers = {joint_line_provider(setup.cycle.stiffness),
                     strength_profile_provider(setup.cycle.stiffness)};
  setup.beds = options.beds;
  setup.strides = options.strides;
  setup.first_seed = options.seed;
  setup.threads = options.threads;
  const auto beds = options.beds.empty() ? bed_cases().size() : options.beds.size();
  Progress progress("hopping", static_cast<double>(options.strides) * static_cast<double>(beds));
  setup.progress = [&](long done, long) { progress.at(static_cast<double>(done)); };
  std::vector<BedScore> scores;
  try {
    scores = score_beds(setup);
  } catch (const std::invalid_argument& error) {
    std::string names;
    for (const auto& bed : bed_cases()) names += (names.empty() ? "" : ", ") + bed.name;
    throw Failure(ExitCode::usage, error.what(), "name some of " + names);
  }
  for (std::size_t p = 0; p < setup.providers.size(); ++p)
    say_profile(session, scores, setup.providers[p].name, p);
  say_events(session, scores);
  auto& beds_json = session.result["beds"] = nlohmann::ordered_json::array();
  for (const auto& score : scores) beds_json.push_back(score);
  return ExitCode::ok;
}

Run set_up(Arguments& arguments) {
  auto o = std::make_shared<Options>();
  arguments.add_option("--strides", o->strides, "first strides on fresh beds, of each family")
      .in_range(1L, 10'000'000L)
      .show_default();
  arguments.add_option("--seed", o->seed, "of the first stride").show_default();
  arguments.add_option("--threads", o->threads, "default: one a core").in_range(1U, 1024U);
  arguments.add_option("--beds", o->beds, "only these families").type_name("NAMES");
  return [o](Session& session) { return run(session, *o); };
}

const ExperimentRegistration kBeds(
    {"beds",
     "first strides on beds of every family: coverage of the force profile, events found and false alarms",
     set_up});

}  // namespace
}  // namespace sandhopper::cli
