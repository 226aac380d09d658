#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/answer/masses.hpp"
#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/model/quantity.hpp"

namespace sandhopper::diagnose {
namespace {

// Probability of findings that need no fit: faults of samples, broken rules. Set by hand.
constexpr double kSeenDirectly = 0.97;

void found_without_a_fit(Diagnosis& diagnosis, Detail detail) {
  if (diagnosis.verdict != Verdict::consistent && !is_open(diagnosis.verdict)) return;
  diagnosis.verdict = Verdict::missing_physics;
  diagnosis.detail = detail;
}

}  // namespace

void note_what_is_missing(const Prepared& prepared, Diagnosis& diagnosis) {
  for (const auto& text : prepared.left_out) diagnosis.notes.push_back("left out: " + text);
  for (const auto& channel : prepared.missing_channels)
    diagnosis.notes.push_back(fmt::format(
        "{} was not recorded: faults of that sensor, and effects that only it shows, cannot be found",
        channel));
  const auto trials = prepared.problem.trials.size();
  if (trials > 0 && trials < 5)
    diagnosis.notes.push_back(
        fmt::format("{} trials: their scatter is hardly known, so the tests take it mostly from the noise "
                    "within the trials",
                    trials));
}

void report_events(const Problem& problem, const std::vector<Event>& events, Diagnosis& diagnosis) {
  for (const auto& event : events)
    diagnosis.notes.push_back(fmt::format(
        "{}: something happened once, {:.2f} to {:.2f} s (a push, an end stop?): {} is off by up to "
        "{:.3g}, relative to its noise {:.0f} times as far as in any other stretch; left out",
        problem.trials[event.trial]->name, event.from_s, event.to_s, event.channel, event.furthest,
        event.times_others));
}

void report_unknown(const FreeGain& gain, double share, Diagnosis& diagnosis) {
  std::string port = gain.family.port;
  if (const auto dot = port.find('.'); dot != std::string::npos && !gain.family.sensor) port.resize(dot);
  const char* acts = port == "axis" || port == "joint" || port == "actuator" ? "torque_Nm" : "force_N";
  const std::string quantity = gain.family.sensor && port != "actuator" ? port : acts;
  UnknownForce unknown{port, quantity, gain.p_value, share, {gain.family.variable, {}, {}, {}}};
  const auto n = gain.family.terms.size();
  for (std::size_t i = 0; i < n; ++i) {
    // At a knot that no recording visits, the standard deviation stays at its prior: leave it out.
    if (gain.sd[static_cast<Eigen::Index>(i)] > 0.8 / std::sqrt(kFreeLawInformation)) continue;
    unknown.curve.at.push_back(gain.family.knots[i]);
    unknown.curve.value.push_back(gain.size[static_cast<Eigen::Index>(i)] * gain.family.scale);
    unknown.curve.sd.push_back(gain.sd[static_cast<Eigen::Index>(i)] * gain.family.scale);
  }
  FoundEffect effect;
  effect.id = "unknown@" + port;
  effect.port = port;
  effect.statement = fmt::format(
      "Something that is on no list acts at {}: it depends on {} and takes {:.0f} % of the gap between "
      "simulation and recordings.",
      port, gain.family.variable, 100.0 * share);
  effect.equation =
      fmt::format("{} += f({})", quantity_of(quantity).words, quantity_of(gain.family.variable).words);
  effect.mass = mass_of_unknown(gain.p_value);
  effect.heldout_gain = share;
  effect.p_value = gain.p_value;
  diagnosis.effects.push_back(std::move(effect));
  diagnosis.unknown.push_back(std::move(unknown));
}

void report_unknown_near(double gap_closed, Diagnosis& diagnosis) {
  const auto near = std::ranges::find_if(diagnosis.effects, [](const FoundEffect& effect) {
    return effect.channel.empty() && effect.port != "clock";
  });
  if (near == diagnosis.effects.end()) return;
  FoundEffect effect;
  effect.id = "unknown@" + near->port;
  effect.port = near->port;
  effect.statement =
      fmt::format("Something unlisted acts, probably at {}: {:.0f} % of the gap; {} comes nearest.",
                  near->port, 100.0 * (1.0 - gap_closed), near->id);
  effect.equation = "not known";
  effect.mass = kLikelierThanNot;
  effect.p_value = near->p_value;
  effect.heldout_gain = 1.0 - gap_closed;
  diagnosis.effects.push_back(std::move(effect));
}

void report_unknown_noise(const NoisyChannel& noisy, Diagnosis& diagnosis) {
  diagnosis.effects.push_back(
      {.id = "unknown@" + noisy.port,
       .port = noisy.port,
       .statement = fmt::format(
           "Something unlisted acts at {}: {} scatters {:.1f} times as much as the believed noise of "
           "its sensor.",
           noisy.port, noisy.channel, noisy.times),
       .equation = "not known",
       .parameters = {},
       .mass = kLikelierThanNot});
}

void report_unknown_shift(const CommonShift& shift, Diagnosis& diagnosis) {
  if (shift.port.empty()) return;
  diagnosis.effects.push_back(
      {.id = "unknown@" + shift.port,
       .port = shift.port,
       .statement =
           fmt::format("Something unlisted acts at {}: {}, which should scatter from trial to trial, is "
                       "shifted alike in all, by {:.1f} standard errors.",
                       shift.port, shift.nuisance, std::abs(shift.z)),
       .equation = "not known",
       .parameters = {},
       .mass = kLikelierThanNot});
}

void report_unknown_of_plant(const Problem& problem, Diagnosis& diagnosis) {
  const auto ports = problem.plant->free_ports(problem.context);
  if (ports.size() != 1) return;
  if (const auto quiet = problem.plant->quiet_phase())
    for (std::size_t c = 0; c < problem.channels.size(); ++c)
      if (problem.context.has(problem.channels[c]) &&
          problem.noise.channel(c).sd_of_phase[*quiet] >
              kQuietChannel *
                  std::max(believed_noise(problem.context.belief, problem.channels[c]), problem.floor_sd[c]))
        return;
  const auto port = ports.front().port.substr(0, ports.front().port.find('.'));
  diagnosis.effects.push_back(
      {.id = "unknown@" + port,
       .port = port,
       .statement = fmt::format(
           "Something unlisted acts, probably at {}: what is left is more than noise and depends on "
           "nothing that was recorded.",
           port),
       .equation = "not known",
       .parameters = {},
       .mass = kLikelierThanNot});
}

namespace {

std::string fault_statement(const DataFault& fault) {
  if (fault.limit != 0.0)
    return fmt::format("{} stays at {}{:.4g} while the quantity continues to change.", fault.channel,
                       fault.at_both_ends ? "±" : "",
                       fault.at_both_ends ? std::abs(fault.limit) : fault.limit);
  if (fault.id == "data.stuck")
    return fmt::format("{} held one value {} times while the quantity changed.", fault.channel,
                       fault.stretches);
  if (fault.channel == "t_s") return fmt::format("Rows are missing {} times.", fault.stretches);
  return fmt::format("{} lost its samples {} times.", fault.channel, fault.stretches);
}

}  // namespace

void report_broken_rules(const std::vector<BrokenRule>& rules, Diagnosis& diagnosis) {
  for (const auto& rule : rules) {
    if (std::ranges::any_of(diagnosis.effects, [&](const auto& e) { return e.id == rule.id; })) continue;
    diagnosis.effects.push_back({.id = rule.id,
                                 .port = std::string(name_of(rule.port)),
                                 .statement = rule.statement,
                                 .equation = rule.equation,
                                 .parameters = {{rule.parameter, rule.value, rule.low, rule.high}},
                                 .probability = kSeenDirectly});
    found_without_a_fit(diagnosis, Detail::known);
  }
}

void report_data_faults(const std::vector<DataFault>& faults, Diagnosis& diagnosis) {
  for (const auto& fault : faults) {
    FoundEffect effect;
    effect.id = fault.id;
    effect.port = fault.channel;
    effect.channel = fault.channel;
    effect.statement = fault_statement(fault);
    effect.probability = kSeenDirectly;
    if (fault.limit != 0.0) {
      const double limit = std::abs(fault.limit);
      effect.equation = "y = min(x, limit)";
      const double within = fault.limit_resolution + 1e-3 * limit;
      effect.parameters = {
          {fault.id == "imu.clipping" ? "limit_mps2" : "limit", limit, limit - within, limit + within}};
    } else {
      effect.equation =
          fault.id == "data.stuck" ? "y(t) = y(t_0), t_0 < t < t_0 + T" : "no y(t), t_0 < t < t_0 + T";
      // A stretch of n samples lasted between n - 1 and n + 1 steps. A stretch that fell between two samples
      // was not seen. The number of stretches is Poisson-distributed.
      const double longer_s = fault.duration_s + fault.step_s;
      const double count = static_cast<double>(fault.stretches), each_Hz = fault.rate_Hz / count;
      const double unseen = 1.0 + fault.step_s / std::max(fault.duration_s, fault.step_s);
      effect.parameters = {
          {"duration_s", fault.duration_s, std::max(0.0, fault.duration_s - fault.step_s), longer_s},
          {"rate_Hz", fault.rate_Hz, std::max(0.0, count - 2.0 * std::sqrt(count)) * each_Hz,
           unseen * (count + 2.0 * std::sqrt(count) + 2.0) * each_Hz}};
    }
    if (fault.borderline)
      effect.indistinguishable_from = {fault.id == "data.stuck" ? "data.dropout" : "data.stuck"};
    found_without_a_fit(diagnosis, Detail::data_fault);
    diagnosis.effects.push_back(std::move(effect));
  }
}

}  // namespace sandhopper::diagnose
