#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tools/cli/bed_options.hpp"
#include "tools/cli/experiment.hpp"
#include "tools/cli/progress.hpp"
#include "tools/experiment/stride_sessions.hpp"

namespace sandhopper::cli {
namespace {

struct Options : BedOptions {
  long sessions = 200;
  bool bounds = false;
};

// "2.25 (11)"
std::string strides_text(const SessionScore& s, NextBy by) {
  return fmt::format("{:.2f} ({:.0f})", s.mean(by), s.unfinished[static_cast<std::size_t>(by)]);
}

// The scores of the beds, and their sum.
std::vector<SessionScore> with_sum(std::vector<SessionScore> scores) {
  SessionScore all{.bed = "all"};
  for (const auto& s : scores) all += s;
  scores.push_back(std::move(all));
  return scores;
}

void say_bounds(Session& session, const std::vector<SessionScore>& scores) {
  session.say(
      "\nbounds, with knowledge of the outcome: the stride that leaves the narrowest band, and the one");
  session.say(
      "set-up that ends the session first; strides (sessions not ended), the same of the narrowable part");
  session.say("  {:<17} {:>12} {:>12} {:>12}", "bed", "by outcome", "one set-up", "narrowable");
  const auto lines = with_sum(scores);
  for (const auto& s : lines)
    session.say(
        "  {:<17} {:>12} {:>12} {:>12}", s.bed, strides_text(s, NextBy::outcome),
        strides_text(s, NextBy::fixed),
        fmt::format("{:.2f} {:.2f}", s.mean_narrowable(NextBy::outcome), s.mean_narrowable(NextBy::fixed)));
  const SessionScore& all = lines.back();
  const auto outcome = all.fewer(NextBy::outcome), fixed = all.fewer(NextBy::fixed);
  session.say(
      "times fewer than by chance: by outcome {:.2f} [{:.2f}, {:.2f}], one set-up {:.2f} [{:.2f}, {:.2f}]",
      outcome.value, outcome.ci95_low, outcome.ci95_high, fixed.value, fixed.ci95_low, fixed.ci95_high);
}

void say_sessions(Session& session, const std::vector<SessionScore>& scores) {
  session.say("strides after the first until the widest part of the band is half of what it was,");
  session.say("(sessions in which it is not after {}); the same of the part that strides can narrow, without",
              kMostStrides);
  session.say("the curve's variation within a cell; rms error of the planned strides' depth");
  session.say("  {:<17} {:>8} {:>12} {:>12} {:>12} {:>17} {:>9}", "bed", "sessions", "by chance", "planned",
              "oracle", "narrowable", "depth mm");
  const auto lines = with_sum(scores);
  for (const auto& s : lines) {
    const auto narrowable = fmt::format("{:.2f} {:.2f} {:.2f}", s.mean_narrowable(NextBy::chance),
                                        s.mean_narrowable(NextBy::plan), s.mean_narrowable(NextBy::oracle));
    session.say("  {:<17} {:>8.0f} {:>12} {:>12} {:>12} {:>17} {:>9.1f}", s.bed, s.sessions,
                strides_text(s, NextBy::chance), strides_text(s, NextBy::plan),
                strides_text(s, NextBy::oracle), narrowable,
                1e3 * std::sqrt(s.reach_squared_m2 / std::max(1.0, s.planned)));
  }
  const SessionScore& all = lines.back();
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
  setup.bounds = options.bounds;
  Progress progress("sessions", 1.0);
  setup.progress = [&](long done, long total) {
    progress.at(static_cast<double>(done) / static_cast<double>(total));
  };
  const auto scores = scored_beds(score_sessions, setup);
  say_sessions(session, scores);
  if (options.bounds) say_bounds(session, scores);
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
  arguments.add_flag("--bounds", o->bounds, "also choices that know the outcome, which no plan can make");
  return [o](Session& session) { return run(session, *o); };
}

const ExperimentRegistration kNext(
    {"next-stride", "strides that halve the band's widest part: set-ups by chance, planned, and by an oracle",
     set_up});

}  // namespace
}  // namespace sandhopper::cli
