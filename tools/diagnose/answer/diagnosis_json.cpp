#include "tools/diagnose/answer/diagnosis_json.hpp"

#include <cmath>

namespace sandhopper::diagnose {

using Json = nlohmann::ordered_json;

Json to_json(const Diagnosis& d) {
  Json json;
  json["verdict"] = d.verdict;
  json["detail"] = d.detail.empty() || d.detail == "null" ? Json(nullptr) : Json(d.detail);
  json["noise_floor"] = Json::object();
  for (const auto& [channel, floor] : d.noise_floor) json["noise_floor"][channel] = floor;
  json["where"] = Json::array();
  for (const auto& w : d.where)
    json["where"].push_back({{"channel", w.channel},
                             {"port", w.port.empty() ? Json(nullptr) : Json(w.port)},
                             {"phase", w.phase},
                             {"from_s", w.from_s},
                             {"to_s", w.to_s},
                             {"trials", w.trials},
                             {"coordinate", w.coordinate},
                             {"range", {w.range_low, w.range_high}},
                             {"share_of_excess", w.share_of_excess},
                             {"p_value", w.p_value}});
  json["effects"] = Json::array();
  for (const auto& e : d.effects) {
    Json parameters = Json::object();
    for (const auto& p : e.parameters) parameters[p.name] = {{"value", p.value}, {"ci95", {p.low, p.high}}};
    Json effect{{"id", e.id},
                {"statement", e.statement},
                {"equation", e.equation},
                {"parameters", parameters},
                {"probability", e.probability},
                {"heldout_gain", e.heldout_gain},
                {"interval_holds_zero", e.may_be_zero()},
                {"indistinguishable_from", e.indistinguishable_from}};
    if (!e.channel.empty()) effect["channel"] = e.channel;
    json["effects"].push_back(std::move(effect));
  }
  json["gap_closed"] = d.effects.empty() ? Json(nullptr) : Json(d.gap_closed);
  if (!d.fits.empty()) {
    const auto one = [](const ChannelFit& f) {
      return Json{
          {"channel", f.channel},
          {"train", {{"before", f.train.before}, {"after", f.train.after}}},
          {"heldout", {{"before", f.heldout.before}, {"after", f.heldout.after}, {"floor", f.floor}}}};
    };
    json["fit"] = one(d.fits.front());
    json["fit_by_channel"] = Json::array();
    for (const auto& fit : d.fits) json["fit_by_channel"].push_back(one(fit));
  } else {
    json["fit"] = nullptr;
  }
  Json setup = Json::object();
  if (!d.next.kind.empty()) setup["kind"] = d.next.kind;
  for (const auto& [key, text] : d.next.words) setup[key] = text;
  for (const auto& [key, value] : d.next.setup) setup[key] = value;
  json["next_trial"] = {{"why", d.next.why}, {"purpose", d.next.purpose}, {"setup", setup}};
  if (d.next.splits > 0.0) {
    json["next_trial"]["probability_it_settles"] = d.next.settles;
    json["next_trial"]["probability_it_splits"] = d.next.splits;
  }
  json["fit_by_phase"] = Json::array();
  for (const auto& e : d.phase_errors)
    json["fit_by_phase"].push_back(
        {{"channel", e.channel},
         {"phase", e.phase},
         {"heldout", {{"before", e.before}, {"after", e.after}, {"floor", e.floor}}},
         {"samples", e.samples}});
  json["trial_to_trial"] = Json::array();
  for (const auto& n : d.trial_to_trial)
    json["trial_to_trial"].push_back({{"name", n.name},
                                      {"believed_sd", n.believed_sd},
                                      {"before", {{"mean", n.mean_before}, {"sd", n.sd_before}}},
                                      {"after", {{"mean", n.mean_after}, {"sd", n.sd_after}}}});
  json["unknown"] = Json::array();
  for (const auto& u : d.unknown)
    json["unknown"].push_back({{"port", u.port},
                               {"p_value", u.p_value},
                               {"share", u.share},
                               {"variable", u.curve.variable},
                               {"at", u.curve.at},
                               {"value", u.curve.value},
                               {"sd", u.curve.sd}});
  json["absent"] = Json::array();
  for (const auto& b : d.absent)
    json["absent"].push_back(
        {{"id", b.id}, {"parameter", b.parameter}, {"upper_bound", b.value}, {"typicals", b.typicals}});
  json["belief"] = Json::array();
  for (const auto& n : d.belief)
    json["belief"].push_back(
        {{"key", n.key},
         {"low", n.low},
         {"high", n.high},
         {"unit", n.unit},
         {"said_by", n.said_by},
         {"usual_error", n.usual_error},
         {"error_that_shows", std::isfinite(n.error_that_shows) ? Json(n.error_that_shows) : Json(nullptr)},
         {"matters", n.matters()}});
  json["baselines"] = {
      {"largest_correlation", {{"id", d.simple.largest_correlation}, {"correlation", d.simple.correlation}}},
      {"fit_every_parameter", {{"id", d.simple.fit_every_parameter}, {"typicals", d.simple.typicals}}}};
  json["notes"] = d.notes;
  json["trials"] = d.trials;
  json["simulations"] = d.simulations;
  json["seconds"] = d.seconds;
  return json;
}

}  // namespace sandhopper::diagnose
