#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/cli/bed_options.hpp"
#include "tools/cli/experiment.hpp"
#include "tools/cli/progress.hpp"
#include "tools/experiment/bed_score.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::cli {
namespace {

struct Options : BedOptions {
  long strides = 200;
  std::vector<int> places;
  std::string ground{name_of(GroundDraw::prior)};
  bool null = false;
};

std::string share(double count, double of) {
  return of == 0.0 ? "-" : fmt::format("{:.1f}", 100.0 * count / of);
}

std::string percent(double value) {
  return std::isfinite(value) ? fmt::format("{:.1f}", 100.0 * value) : std::string("-");
}

std::string number(const NumberScore& s) {
  return s.count == 0.0
             ? "-"
             : fmt::format("{:.2f} {:.1f}", 100.0 * s.absolute_error / s.count, 100.0 * s.covered / s.count);
}

void say_first(Session& session, const std::vector<BedScore>& scores) {
  session.say(
      "first strides [%]: depths whose truth the 95 % band holds, the same where the drawn steady drag is");
  session.say(
      "below and above zero, median width of the band at 20 mm, lines called valid, slope of a line: mean");
  session.say("error and coverage, by the profile and the joint fit");
  session.say("  {:<17} {:>7} {:>8} {:>6} {:>6} {:>6} {:>6} {:>8} {:>11} {:>11} {:>9}", "bed", "strides",
              "coverage", "below", "above", "width", "line", "joint l.", "profile", "joint fit", "compared");
  for (const auto& s : scores)
    session.say("  {:<17} {:>7.0f} {:>8} {:>6} {:>6} {:>6} {:>6} {:>8} {:>11} {:>11} {:>9.0f}", s.bed,
                s.first.strides, percent(s.first.band.share()), percent(s.first.less_drag.share()),
                percent(s.first.more_drag.share()), percent(median(s.first.width_20mm)),
                share(s.first.line_valid, s.first.strides), share(s.first.joint_valid, s.first.strides),
                number(s.first.slope), number(s.first.joint_slope), s.first.slope.count);
}

void say_later(Session& session, const std::vector<BedScore>& scores) {
  session.say(
      "\nstrides 2 and 3 in the crater [%]: reloading stiffness given with an interval of two ends, its");
  session.say("coverage and median width, a lower bound alone; strides that went deeper, curve given there,");
  session.say(
      "its coverage at the new depths and at all depths; rms error of the depth that a landing adds [mm]");
  session.say("  {:<17} {:>7} {:>8} {:>8} {:>6} {:>6} {:>7} {:>6} {:>9} {:>8} {:>8}", "bed", "strides",
              "reloading", "coverage", "width", "bound", "deeper", "curve", "new depths", "band", "landing");
  for (const auto& s : scores) {
    const auto& c = s.crater;
    session.say("  {:<17} {:>7.0f} {:>9} {:>8} {:>6} {:>6} {:>7.0f} {:>6} {:>10} {:>8} {:>8.2f}", s.bed,
                c.strides, share(c.reloading.count, c.strides), share(c.reloading.covered, c.reloading.count),
                percent(median(c.reloading_width)), share(c.bounds, c.strides), c.deeper,
                share(c.curves, c.deeper), percent(c.fresh.share()), percent(c.band.share()),
                1e3 * c.landing_rms_m());
  }
}

void say_depth_errors(Session& session, const std::vector<BedScore>& scores) {
  session.say(
      "\nerrors of the estimated depth in first strides, standard deviations: surface at contact [mm],");
  session.say("height filter [mm], lag [ms], rest [mm]; mean time at contact that is not expected [ms]");
  session.say("  {:<17} {:>8} {:>8} {:>8} {:>8} {:>8}", "bed", "surface", "filter", "lag", "rest", "contact");
  std::vector<StrideDepthErrors> all;
  ContactTimeScore all_contacts;
  const auto line = [&](const std::string& name, const std::vector<StrideDepthErrors>& errors,
                        const ContactTimeScore& contacts) {
    const auto s = depth_error_spread(errors);
    session.say("  {:<17} {:>8.2f} {:>8.2f} {:>8.2f} {:>8.2f} {:>8.3f}", name, 1e3 * s.surface_sd_m,
                1e3 * s.filter_sd_m, 1e3 * s.lag_sd_s, 1e3 * s.rest_sd_m, 1e3 * contacts.remaining_s());
  };
  for (const auto& s : scores) {
    line(s.bed, s.depth_errors, s.contact_time);
    all.insert(all.end(), s.depth_errors.begin(), s.depth_errors.end());
    all_contacts.error_speed_m2_per_s += s.contact_time.error_speed_m2_per_s;
    all_contacts.speed_squared_m2_per_s2 += s.contact_time.speed_squared_m2_per_s2;
  }
  line("all", all, all_contacts);
}

std::string alarms(const EventScore& s) { return fmt::format("{:.0f}/{:.0f}", s.false_alarms, s.absent); }

void say_events(Session& session, const std::vector<BedScore>& scores, bool first) {
  session.say(
      "\nevents of {}: found where there was one, rms error of its depth [mm] and share within 2 mm [%];",
      first ? "first strides" : "strides 2 and 3");
  session.say("false alarms in strides without one");
  session.say("  {:<17} {:>9} {:>6} {:>7} {:>9} {:>9} {:>9} {:>9}", "bed", "found", "rms mm", "in 2 mm",
              "rupture", "boundary", "floor", "suction");
  for (const auto& s : scores) {
    const auto& events = first ? s.first_events : s.later_events;
    const EventScore* own = nullptr;
    for (const auto* event : {&events.rupture, &events.boundary, &events.floor, &events.suction})
      if (event->possible > 0.0) own = event;
    const bool any = own != nullptr && own->found > 0.0;
    session.say("  {:<17} {:>9} {:>6} {:>7} {:>9} {:>9} {:>9} {:>9}", s.bed,
                own != nullptr ? fmt::format("{:.0f}/{:.0f}", own->found, own->possible) : "-",
                any ? fmt::format("{:.2f}", 1e3 * std::sqrt(own->depth_error_squared_m2 / own->found)) : "-",
                own != nullptr ? share(own->within_2mm, own->possible) : "-", alarms(events.rupture),
                alarms(events.boundary), alarms(events.floor), alarms(events.suction));
  }
}

double quantile(std::vector<double> values, double probability) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::ceil(probability * last));
  std::ranges::nth_element(values, at);
  return *at;
}

// Checks the threshold: T / u must exceed 1 in no more strides than the stated false-alarm probability.
void say_null(Session& session, const std::vector<BedScore>& scores) {
  session.say(
      "\nstatistic over its threshold in first strides without the event: median, 99 and 99.8 %; above 1");
  session.say("  {:<17} {:<10} {:>7} {:>7} {:>7} {:>7} {:>9}", "bed", "event", "strides", "50 %", "99 %",
              "99.8 %", "above 1");
  for (const auto& s : scores) {
    const auto& e = s.first_events;
    for (const auto& [name, event] :
         {std::pair{"rupture", &e.rupture}, {"boundary", &e.boundary}, {"suction", &e.suction}}) {
      const auto& values = event->absent_statistics;
      session.say("  {:<17} {:<10} {:>7} {:>7.2f} {:>7.2f} {:>7.2f} {:>9}", s.bed, name, values.size(),
                  quantile(values, 0.5), quantile(values, 0.99), quantile(values, 0.998),
                  std::ranges::count_if(values, [](double t) { return t > 1.0; }));
    }
  }
}

void say_places(Session& session, const std::vector<BedScore>& scores) {
  session.say("\nfirst strides on several places of one ground [%]: depths whose mean curve the band holds");
  for (const auto& s : scores) {
    std::string row;
    for (const auto& p : s.places)
      row += p.sessions == 0.0
                 ? fmt::format("  {}: too few strides", p.places)
                 : fmt::format("  {}: {} ({:.0f} sessions)", p.places, percent(p.band.share()), p.sessions);
    session.say("  {:<17}{}", s.bed,
                row.empty() ? "  -  its form differs from place to place, so there is no common curve" : row);
  }
}

ExitCode run(Session& session, const Options& options) {
  auto setup = options.setup<BedScoreSetup>(session);
  setup.trials = options.strides;
  setup.places = options.places;
  const auto& grounds = EnumNames<GroundDraw>::value;
  setup.ground = static_cast<GroundDraw>(std::ranges::find(grounds, options.ground) - grounds.begin());
  double total = 0.0;
  Progress progress("hopping", 1.0);
  setup.progress = [&](long done, long all) {
    total = static_cast<double>(all);
    progress.at(static_cast<double>(done) / total);
  };
  setup.finished = [&](const BedScore& score) {
    fmt::print(stderr, "{}: {:.0f} trials\n", score.bed, score.trials);
  };
  const auto scores = scored_beds(score_beds, setup);
  say_first(session, scores);
  say_later(session, scores);
  if (!options.places.empty()) say_places(session, scores);
  say_depth_errors(session, scores);
  say_events(session, scores, true);
  say_events(session, scores, false);
  if (options.null) say_null(session, scores);
  std::vector<double> solve_s, search_s;
  for (const auto& s : scores) {
    solve_s.insert(solve_s.end(), s.solve_s.begin(), s.solve_s.end());
    search_s.insert(search_s.end(), s.search_s.begin(), s.search_s.end());
  }
  session.say("\nafter a stride: profile and summary {:.2f} ms, events {:.2f} ms (median, with {} at once)",
              1e3 * median(solve_s), 1e3 * median(search_s), options.threads);
  auto& beds_json = session.result["beds"] = nlohmann::ordered_json::array();
  for (const auto& score : scores) beds_json.push_back(score);
  return ExitCode::ok;
}

Run set_up(Arguments& arguments) {
  auto o = std::make_shared<Options>();
  arguments.add_option("--strides", o->strides, "trials of three strides on fresh beds, of each family")
      .in_range(1L, 10'000'000L)
      .show_default();
  o->add_to(arguments, "stride");
  arguments
      .add_option("--places", o->places, "numbers of places that first strides are joined to, e.g. 1 2 4 10")
      .in_range(1, 10'000);
  arguments
      .add_option("--ground", o->ground,
                  "added mass and steady drag: drawn from the fit's prior, none, or those of world.toml")
      .one_of({EnumNames<GroundDraw>::value.begin(), EnumNames<GroundDraw>::value.end()})
      .show_default();
  arguments.add_flag("--null", o->null, "quantiles of the event statistics in strides without the event");
  return [o](Session& session) { return run(session, *o); };
}

const ExperimentRegistration kBeds(
    {"beds",
     "strides on beds of every family: strength profile, slope, crater and events against the true bed",
     set_up});

}  // namespace
}  // namespace sandhopper::cli
