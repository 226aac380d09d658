#include "tools/cli/diagnose_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/diagnose/model/quantity.hpp"
#include "tools/report/html.hpp"

namespace sandhopper::cli {
namespace {

using Json = nlohmann::ordered_json;
using diagnose::Candidate;
using diagnose::Effect;
using diagnose::EffectParameter;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json as_json(const EffectParameter& p, bool is_amplitude) {
  const auto quantity = diagnose::quantity_of(p.name);
  const auto typical = p.typical_size();
  const double low = p.reported(p.low), high = p.reported(p.high);
  return {{"name", p.name},
          {"words", quantity.words},
          {"unit", quantity.unit},
          {"is_size", is_amplitude},
          {"believed", p.base != 0.0 && p.scale != 0.0 && p.power == 1.0 ? Json(p.base) : Json(nullptr)},
          {"typical", is_amplitude && typical ? Json(*typical) : Json(nullptr)},
          {"low", number_or_null(std::min(low, high))},
          {"high", number_or_null(std::max(low, high))}};
}

std::string in_words(const Json& p) {
  const auto unit = p["unit"].get<std::string>();
  std::string text = p["name"].get<std::string>();
  if (!p["typical"].is_null()) text += ": typical " + diagnose::measured(p["typical"], unit);
  if (!p["believed"].is_null()) text += " more or less than " + diagnose::measured(p["believed"], unit);
  if (!p["low"].is_null() && !p["high"].is_null())
    text += fmt::format("; looked for from {} to {}", diagnose::measured(p["low"], unit),
                        diagnose::measured(p["high"], unit));
  return text;
}

// The sentence of a sensor's fault, which holds for each of its channels.
std::string sentence_of(const Effect& effect) {
  constexpr std::string_view kPlace = "{channel}";
  const std::string_view text = effect.statement;
  const bool begins = text.starts_with(kPlace);
  return (begins ? "The channel" : "") +
         html::replaced(text.substr(begins ? kPlace.size() : 0), kPlace, "the channel");
}

// `candidates`: those of this effect, one per channel of a sensor's fault.
Json as_json(const Effect& effect, const std::vector<const Candidate*>& candidates,
             diagnose::PlantKind plant) {
  Json channels = Json::array(), parameters = Json::array();
  for (const auto* candidate : candidates)
    if (!candidate->channel.empty()) channels.push_back(candidate->channel);
  if (!candidates.empty()) {
    const auto& first = candidates.front()->parameters;
    for (std::size_t i = 0; i < first.size(); ++i)
      parameters.push_back(as_json(first[i], diagnose::is_amplitude(first, i)));
  }
  return {{"id", effect.id},
          {"port", diagnose::name_of(diagnose::port_on(plant, effect.port))},
          {"statement", sentence_of(effect)},
          {"equation", effect.equation},
          {"can_be_seen", !candidates.empty()},
          {"channels", channels},
          {"parameters", parameters}};
}

// Reason why a sensor's fault is not looked for in the drive's torque; empty: it is, or no torque drives.
std::string not_looked_for(const Effect& effect, const std::vector<const Candidate*>& candidates,
                           const diagnose::Context& context) {
  const bool is_input = context.plant == diagnose::PlantKind::rotary_axis && context.facts.is_driven;
  if (!is_input || !effect.channels || effect.port != diagnose::Port::sensor ||
      std::ranges::any_of(candidates, [](const auto* one) { return one->channel == "torque_Nm"; }))
    return "";
  return candidates.empty()
             ? "not looked for: torque_Nm drives the simulation, and no other channel that can "
               "have this fault is recorded"
             : "not looked for in torque_Nm: it drives the simulation";
}

}  // namespace

ExitCode list_effects(Session& session, const diagnose::Recordings& recordings) {
  const auto prepared = diagnose::prepare(recordings);
  session.result["effects"] = Json::array();
  for (const auto& effect : prepared.problem.effects) {
    if (std::ranges::find(effect.plants, recordings.plant) == effect.plants.end()) continue;
    std::vector<const Candidate*> candidates;
    for (const auto& candidate : prepared.problem.candidates)
      if (candidate.effect == &effect) candidates.push_back(&candidate);
    auto json = as_json(effect, candidates, recordings.plant);
    const auto reason = not_looked_for(effect, candidates, prepared.problem.context);
    if (!reason.empty()) json["not_looked_for"] = reason;
    session.result["effects"].push_back(json);
    session.say("{} (port {}): {}", effect.id, json["port"].get<std::string>(),
                json["statement"].get<std::string>());
    session.say("    {}", effect.equation);
    if (!reason.empty())
      session.say("    {}", reason);
    else if (candidates.empty())
      session.say("    cannot be seen in these recordings");
    for (const auto& parameter : json["parameters"]) session.say("    {}", in_words(parameter));
  }
  return ExitCode::ok;
}

}  // namespace sandhopper::cli
