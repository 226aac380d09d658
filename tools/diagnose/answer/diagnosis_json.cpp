#include "tools/diagnose/answer/diagnosis_json.hpp"

#include <cmath>

#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/answer/spread_text.hpp"

namespace sandhopper::diagnose {

using Json = nlohmann::ordered_json;

namespace {

// JSON array of object(item) for each item.
template <class Items, class ToObject>
Json list_of(const Items& items, ToObject object) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(object(item));
  return list;
}

Json before_after(const ErrorBeforeAfter& error) {
  return {{"before", error.before}, {"after", error.after}};
}

Json where_json(const Where& w) {
  return {{"channel", w.channel},
          {"port", w.port.empty() ? Json(nullptr) : Json(w.port)},
          {"phase", w.phase},
          {"from_s", w.from_s},
          {"to_s", w.to_s},
          {"trials", w.trials},
          {"coordinate", w.coordinate},
          {"range", {w.range_low, w.range_high}},
          {"share_of_excess", w.share_of_excess},
          {"p_value", w.p_value}};
}

Json effect_json(const FoundEffect& e) {
  // A number's change against the belief is written before its new value, because the recordings show the
  // change.
  Json parameters = Json::object();
  const auto put = [&](const FoundParameter& p) {
    parameters[p.name] = {{"value", p.value}, {"ci95", {p.low, p.high}}};
    if (p.limit) parameters[p.name]["at_limit"] = *p.limit;
  };
  for (std::size_t i = 0; i < e.parameters.size(); ++i) {
    if (i + 1 < e.parameters.size() && e.parameters[i + 1].is_change) put(e.parameters[i + 1]);
    if (!e.parameters[i].is_change) put(e.parameters[i]);
  }
  Json effect{{"id", e.id},
              {"statement", e.statement},
              {"equation", e.equation},
              {"parameters", parameters},
              {"probability", e.probability},
              {"posterior_mass", e.is_unknown() ? e.mass : e.posterior_mass},
              {"heldout_gain", e.heldout_gain},
              {"interval_holds_zero", e.may_be_zero()},
              {"indistinguishable_from", e.indistinguishable_from}};
  if (!e.channel.empty()) effect["channel"] = e.channel;
  return effect;
}

Json fit_json(const ChannelFit& f) {
  Json held_out = before_after(f.heldout);
  held_out["floor"] = f.floor;
  held_out["noise"] = f.noise;
  held_out["beyond_floor"] = {{"before", beyond_floor(f.heldout.before, f.floor)},
                              {"after", beyond_floor(f.heldout.after, f.floor)}};
  return {{"channel", f.channel}, {"train", before_after(f.train)}, {"heldout", held_out}};
}

Json noise_json(const SensorNoise& n) {
  return {{"channel", n.channel},  {"stated", n.stated > 0.0 ? Json(n.stated) : Json(nullptr)},
          {"source", n.source},    {"from_sample_to_sample", n.measured},
          {"used", n.used},        {"times", n.times()},
          {"raised", n.is_raised}, {"meaning", n.is_raised ? Json(n.in_words()) : Json(nullptr)}};
}

Json next_json(const NextTrial& next) {
  Json setup = Json::object();
  if (!next.kind.empty()) setup["kind"] = next.kind;
  for (const auto& [key, text] : next.words) setup[key] = text;
  for (const auto& [key, value] : next.setup) setup[key] = value;
  Json trial{{"why", next.why}, {"purpose", next.purpose}, {"setup", setup}};
  if (next.beyond_recorded) trial["beyond_recorded"] = true;
  if (next.splits > 0.0) {
    trial["probability_it_settles"] = next.settles;
    trial["probability_it_splits"] = next.splits;
  }
  return trial;
}

Json phase_json(const PhaseError& e) {
  return {{"channel", e.channel},
          {"phase", e.phase},
          {"heldout", {{"before", e.before}, {"after", e.after}, {"floor", e.floor}}},
          {"samples", e.samples}};
}

Json spread_json(const TrialToTrial& n) {
  return {{"name", n.name},
          {"believed_sd", n.believed_sd},
          {"before", {{"mean", n.mean_before}, {"sd", n.sd_before}}},
          {"after", {{"mean", n.mean_after}, {"sd", n.sd_after}}},
          {"exceeds_spread", n.exceeds_after()},
          {"goes_with", n.goes_with.empty() ? Json(nullptr) : Json(n.goes_with)},
          {"by_trial", list_of(n.values, [](const SpreadValue& value) {
             return Json{{"trial", value.trial},
                         {"before", value.before},
                         {"after", value.after},
                         {"exceeds_spread_before", value.exceeds_before},
                         {"exceeds_spread_after", value.exceeds_after}};
           })}};
}

Json unknown_json(const UnknownForce& u) {
  return {{"port", u.port},   {"p_value", u.p_value},   {"share", u.share}, {"variable", u.curve.variable},
          {"at", u.curve.at}, {"value", u.curve.value}, {"sd", u.curve.sd}};
}

Json bound_json(const Bound& b) {
  return {{"id", b.id},
          {"parameter", b.parameter},
          {b.is_lower ? "lower_bound" : "upper_bound", b.value},
          {"typicals", b.typicals}};
}

Json belief_json(const BelievedNumber& n) {
  return {{"key", n.key},
          {"low", n.low},
          {"high", n.high},
          {"unit", n.unit},
          {"source", n.source},
          {"usual_error", n.usual_error},
          {"error_that_shows", std::isfinite(n.error_that_shows) && n.error_that_shows > 0.0
                                   ? Json(n.error_that_shows)
                                   : Json(nullptr)},
          {"matters", n.error_that_shows > 0.0 && n.matters()},
          {"known_to", n.known_sd > 0.0 ? Json{{"sd", n.known_sd}, {"change", n.asked_for}} : Json(nullptr)}};
}

}  // namespace

Json to_json(const Diagnosis& d) {
  Json json;
  json["verdict"] = name_of(d.verdict);
  json["detail"] = d.detail == Detail::none ? Json(nullptr) : Json(name_of(d.detail));
  const auto beyond = beyond_spread(d), before = taken_up_before(d);
  json["only_if"] = beyond.empty() ? Json(nullptr) : Json(beyond);
  json["taken_up_before"] = before.empty() ? Json(nullptr) : Json(before);
  json["noise_floor"] = Json::object();
  for (const auto& [channel, floor] : d.noise_floor) json["noise_floor"][channel] = floor;
  json["sensor_noise"] = list_of(d.noise, noise_json);
  json["where"] = list_of(d.where, where_json);
  json["effects"] = list_of(d.effects, effect_json);
  if (!d.stopped_in.empty()) json["stopped_by_limit_in"] = d.stopped_in;
  json["gap_closed"] = d.effects.empty() || !d.stopped_in.empty() ? Json(nullptr) : Json(d.gap_closed);
  json["fit"] = d.fits.empty() ? Json(nullptr) : fit_json(d.fits.front());
  json["remainder"] = remainder_text(d).empty() ? Json(nullptr) : Json(remainder_text(d));
  json["first_answer"] = d.first ? Json(d.first->file) : Json(nullptr);
  json["corrected_model"] = d.corrected_model_file.empty() ? Json(nullptr) : Json(d.corrected_model_file);
  if (!d.fits.empty()) json["fit_by_channel"] = list_of(d.fits, fit_json);
  json["next_trial"] = next_json(d.next);
  json["fit_by_phase"] = list_of(d.phase_errors, phase_json);
  json["trial_to_trial"] = list_of(d.trial_to_trial, spread_json);
  json["unknown"] = list_of(d.unknown, unknown_json);
  json["absent"] = list_of(d.absent, bound_json);
  json["belief"] = list_of(d.belief, belief_json);
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
