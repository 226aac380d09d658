#include <cmath>

#include "tools/cli/bed_options.hpp"
#include "tools/cli/experiment.hpp"
#include "tools/cli/progress.hpp"
#include "tools/experiment/stride_sessions.hpp"

namespace sandhopper::cli {
namespace {

struct Options : BedOptions {
  long sessions = 200;
};

void say_sessions(Session& session, const std::vector<SessionScore>& scores) {
  session.say("strides after the first until the widest part of the band is half of what it was,");
  session.say("(sessions in which it is not after {}); the same of the part that strides can narrow, without",
              kMostStrides);
  session.say("the curve's variation within a cell; rms error of the planned strides' depth");
  session.say("  {:<17} {:>8} {:>12} {:>12} {:>12} {:>17} {:>9}", "bed", "sessions", "by chance", "planned",
              "oracle", "narrowable", "depth mm");
  SessionScore all{.bed = "all"};
  const auto line = [&](const SessionScore& s) {
    const auto cell = [&](NextBy by) {
      return fmt::format("{:.2f} ({:.0f})", s.mean(by), s.unfinished[static_cast<std::size_t>(by)]);
    };
    const auto narrowable = fmt::format("{:.2f} {:.2f} {:.2f}", s.mean_narrowable(NextBy::chance),
                                        s.mean_narrowable(NextBy::plan), s.mean_narrowable(NextBy::oracle));
    session.say("  {:<17} {:>8.0f} {:>12} {:>12} {:>12} {:>17} {:>9.1f}", s.bed, s.sessions,
                cell(NextBy::chance), cell(NextBy::plan), cell(NextBy::oracle), narrowable,
                1e3 * std::sqrt(s.reach_squared_m2 / std::max(1.0, s.planned)));
  };
  for (const auto& s : scores) {
    line(s);
    all += s;
  }
  line(all);
  const auto plan = all.fewer(NextBy::plan), oracle = all.fewer(NextBy::oracle);
  session.say(
      "planned against by chance: {:.2f} [{:.2f}, {:.2f}] times fewer; the oracle: {:.2f} [{:.2f}, {:.2f}]",
      plan.value, plan.ci95_low, plan.ci95_high, oracle.value, oracle.ci95_low, oracle.ci95_high);
  session.say("the narrowable part: {:.2f} times fewer; the oracle: {:.2f}",
              all.mean_narrowable(NextBy::chance) / all.mean_narrowable(NextBy::plan),
              all.mean_narrowable(NextBy::chance) / all.mean_narrowable(NextBy::oracle));
}

ExitCode run(Session& session, const Options& options) {
  auto setup = options.setup<SessionSetup>(session);
  setup.sessions = options.sessions;
  Progress progress("sessions", 1.0);
  setup.progress = [&](long done, long total) {
    progress.at(static_cast<double>(done) / static_cast<double>(total));
  };
  const auto scores = scored_beds(score_sessions, setup);
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
  o->add_to(arguments, "session");
  return [o](Session& session) { return run(session, *o); };
}

const ExperimentRegistration kNext(
    {"next-stride", "strides that halve the band's widest part: set-ups by chance, planned, and by an oracle",
     set_up});

}  // namespace
}  // namespace sandhopper::cli
