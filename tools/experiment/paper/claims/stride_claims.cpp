#include <fmt/format.h>

#include <cmath>

#include "tools/experiment/paper/claims/claims.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

using Trials = std::vector<const HopResult*>;

ClaimFigure share_figure(double share) { return {"trials in which it holds", 100.0 * share, "%", 1}; }

// Adds the mean of a feature with its smallest and largest value, each multiplied by `scale`.
void add_range(Claim& c, const std::string& name, const std::string& unit, double scale, int digits,
               const std::vector<double>& values) {
  c.figures.push_back(
      {name, scale * mean(values), unit, digits, scale * smallest(values), scale * largest(values)});
}

Claim event_times(const ProgrammeResults& r) {
  const auto trials = complete_trials(r, [](const HopCell& cell) {
    return cell.touchdown_speed_mps == 1.0 && cell.compression_stiffness_N_per_m == 375.0;
  });
  const double contact = mean(over(trials, [](const HopResult& h) { return h.shape.contact_s; }));
  const double compression = mean(over(trials, [](const HopResult& h) { return h.shape.compression_s; }));
  const double extension = mean(over(trials, [](const HopResult& h) { return h.shape.extension_s; }));
  Claim c{17, "Touchdown, switch and liftoff at 0.13, 0.28 and 0.47 s", "intervals 0.15 and 0.19 s, ± 20 %"};
  c.figures = {{"touchdown", contact, "s", 4},
               {"touchdown to switch", compression, "s", 4},
               {"switch to liftoff", extension, "s", 4}};
  c.verdict =
      comes_out_if(std::abs(compression / 0.15 - 1.0) <= 0.2 && std::abs(extension / 0.19 - 1.0) <= 0.2);
  c.why =
      fmt::format("1.0 m/s, 375 N/m, {} trials; extension is short by {:.0f} %: a stronger push shortens it",
                  trials.size(), 100.0 * (1.0 - extension / 0.19));
  return c;
}

Claim deceleration_time(const ProgrammeResults& r) {
  const auto trials = complete_trials(r);
  const double share =
      share_of(trials, [](const HopResult& h) { return h.shape.rest_s >= 0.035 && h.shape.rest_s <= 0.060; });
  Claim c{18, "The foot is stopped in about 50 ms", "35 to 60 ms to 5 % of the touchdown speed"};
  c.figures = {share_figure(share)};
  add_range(c, "time", "ms", 1e3, 1, over(trials, [](const HopResult& h) { return h.shape.rest_s; }));
  c.verdict = verdict_of_share(share);
  c.why = "nearly independent of the touchdown speed";
  return c;
}

Claim second_penetration(const ProgrammeResults& r) {
  const auto trials = complete_trials(r);
  const double share = share_of(trials, [](const HopResult& h) { return h.shape.plateau_s >= 0.020; });
  const double slow_leg = share_of(
      complete_trials(r, [](const HopCell& cell) { return cell.compression_stiffness_N_per_m < 500.0; }),
      [](const HopResult& h) { return h.shape.plateau_s >= 0.020; });
  Claim c{19, "The foot's height stays on a plateau, then it penetrates again",
          "two phases of penetration with at least 20 ms below 0.02 m/s between"};
  c.figures = {share_figure(share), {"with 250 and 375 N/m", 100.0 * slow_leg, "%", 1}};
  add_range(c, "plateau", "ms", 1e3, 1, over(trials, [](const HopResult& h) { return h.shape.plateau_s; }));
  c.verdict = verdict_of_share(share);
  c.why =
      "the leg is softer in compression than the bed is strong: with 500 N/m and a fast touchdown the "
      "plateau is short";
  return c;
}

Claim early_peak(const ProgrammeResults& r) {
  const auto trials = complete_trials(r);
  const double share = share_of(trials, [](const HopResult& h) { return h.shape.early_drop >= 0.05; });
  const auto quiet = stride_shape(r.quiet);
  const auto rigid = stride_shape(r.rigid);
  const double ratio = rigid.early_peak_N / quiet.early_peak_N;
  Claim c{20, "An early force peak, lower and broader than on rigid ground",
          "a maximum in the first 60 ms, then a drop of at least 5 %; a bed 100 times as stiff gives at "
          "least 3 times the peak"};
  c.figures = {share_figure(share),
               {"drop after it, mean",
                100.0 * mean(over(trials, [](const HopResult& h) { return h.shape.early_drop; })), "%", 0},
               {"peak at 1.0 m/s", quiet.early_peak_N, "N", 1},
               {"peak on the stiff bed", rigid.early_peak_N, "N", 1},
               {"foot stopped after", 1e3 * quiet.rest_s, "ms", 1},
               {"foot stopped on the stiff bed after", 1e3 * rigid.rest_s, "ms", 1}};
  c.verdict = ratio >= 3.0 ? verdict_of_share(share) : Verdict::does_not;
  c.why = fmt::format("{:.1f} times the peak in {:.1f} times shorter on the stiff bed", ratio,
                      quiet.rest_s / rigid.rest_s);
  return c;
}

Claim switch_is_shortest_leg(const ProgrammeResults& r) {
  const auto trials = complete_trials(r);
  const double share = share_of(trials, [](const HopResult& h) {
    return std::abs(h.shape.shortest_leg_s) <= 0.003 && std::abs(h.shape.switch_foot_mps) <= 0.35 &&
           std::abs(h.shape.switch_body_mps) <= 0.35;
  });
  Claim c{21, "At the switch the leg is shortest and both velocities are near zero",
          "shortest within 3 ms of it; foot and body at most 0.35 m/s"};
  c.figures = {share_figure(share)};
  add_range(c, "foot's speed down", "m/s", 1.0, 3,
            over(trials, [](const HopResult& h) { return h.shape.switch_foot_mps; }));
  add_range(c, "shortest leg after the switch", "ms", 1e3, 1,
            over(trials, [](const HopResult& h) { return h.shape.shortest_leg_s; }));
  c.verdict = verdict_of_share(share);
  const auto sinking = over(trials, [](const HopResult& h) { return h.shape.switch_foot_mps; });
  c.why = fmt::format("equal rather than zero: fast, stiff strides sink with up to {:.2f} m/s as one body",
                      largest(sinking));
  return c;
}

Claim opposed_motion(const ProgrammeResults& r) {
  const auto trials = complete_trials(r);
  const double share = share_of(trials, [](const HopResult& h) { return h.shape.opposed_s >= 0.020; });
  Claim c{22, "After the switch the foot still descends while the body rises", "for at least 20 ms"};
  c.figures = {share_figure(share)};
  add_range(c, "duration", "ms", 1e3, 1, over(trials, [](const HopResult& h) { return h.shape.opposed_s; }));
  c.verdict = verdict_of_share(share);
  c.why = "the stiffer leg pushes both apart";
  return c;
}

Claim deepest_is_strongest(const ProgrammeResults& r) {
  const auto trials = complete_trials(r);
  const auto apart_s = [](const HopResult& h) { return h.shape.peak_force_s - h.shape.max_depth_s; };
  const double share = share_of(trials, [&](const HopResult& h) {
    return std::abs(apart_s(h)) <= 0.005 && h.shape.peak_force_s > h.shape.compression_s;
  });
  Claim c{23, "The largest force coincides with the largest depth, in extension",
          "within 5 ms, after the switch"};
  c.figures = {share_figure(share)};
  add_range(c, "force after depth", "ms", 1e3, 1, over(trials, apart_s));
  c.verdict = verdict_of_share(share);
  const double late = share_of(trials, [&](const HopResult& h) { return std::abs(apart_s(h)) > 0.005; });
  c.why = fmt::format("in {:.1f} % they lie farther apart", 100.0 * late);
  return c;
}

Claim liftoff_depth(const ProgrammeResults& r) {
  const auto trials = complete_trials(r);
  const auto ratio = [](const HopResult& h) { return h.shape.liftoff_depth_m / h.shape.max_depth_m; };
  const double share = share_of(trials, [&](const HopResult& h) { return ratio(h) > 0.8; });
  Claim c{24, "Liftoff is below the original surface", "depth at liftoff over 0.8 of the largest"};
  c.figures = {share_figure(share)};
  add_range(c, "share of the largest depth", "", 1.0, 3, over(trials, ratio));
  c.verdict = verdict_of_share(share);
  const auto rise_m =
      over(trials, [](const HopResult& h) { return h.shape.max_depth_m - h.shape.liftoff_depth_m; });
  c.why = fmt::format("the bed unloads within {:.1f} to {:.1f} mm; the crater stays", 1e3 * smallest(rise_m),
                      1e3 * largest(rise_m));
  return c;
}

Claim three_transients(const ProgrammeResults& r) {
  constexpr double kSeen_mps2 = 3.0;
  const auto holds = [](const HopResult& h) {
    return h.shape.touchdown_transient_mps2 > kSeen_mps2 && h.shape.switch_transient_mps2 < -kSeen_mps2 &&
           h.shape.liftoff_transient_mps2 > kSeen_mps2;
  };
  const auto softer = [](const HopCell& cell) { return cell.compression_stiffness_N_per_m < 500.0; };
  const auto equal = [](const HopCell& cell) { return cell.compression_stiffness_N_per_m >= 500.0; };
  const auto stepped = complete_trials(r, softer);
  const double share = share_of(stepped, holds);
  const double share_equal = share_of(complete_trials(r, equal), holds);
  const auto average = [&](double StrideShape::*feature) {
    return mean(over(stepped, [&](const HopResult& h) { return h.shape.*feature; }));
  };
  Claim c{25, "Three transients of the acceleration: touchdown, switch, liftoff",
          "foot's acceleration departs by over 3 m/s² within 20 ms of each: up, down, up"};
  c.figures = {{"trials with 250 and 375 N/m in which it holds", 100.0 * share, "%", 1},
               {"trials with 500 N/m", 100.0 * share_equal, "%", 1},
               {"touchdown, mean", average(&StrideShape::touchdown_transient_mps2), "m/s²", 1},
               {"switch, mean", average(&StrideShape::switch_transient_mps2), "m/s²", 1},
               {"liftoff, mean", average(&StrideShape::liftoff_transient_mps2), "m/s²", 1}};
  c.verdict =
      share >= 0.95 ? (share_equal >= 0.95 ? Verdict::comes_out : Verdict::only_if) : verdict_of_share(share);
  c.why =
      "the leg's stiffness changes at the switch: with 500 N/m in both phases only the neutral length does, "
      "and at the motors' limit not even that shows";
  return c;
}

}  // namespace

std::vector<Claim> stride_claims(const ProgrammeResults& results) {
  return {event_times(results),          deceleration_time(results),      second_penetration(results),
          early_peak(results),           switch_is_shortest_leg(results), opposed_motion(results),
          deepest_is_strongest(results), liftoff_depth(results),          three_transients(results)};
}

}  // namespace sandhopper::paper
