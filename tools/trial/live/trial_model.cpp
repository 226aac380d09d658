#include "tools/trial/live/trial_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "firmware/event.hpp"
#include "firmware/fault_check.hpp"
#include "firmware/request_box.hpp"
#include "terrain/ground_events.hpp"
#include "terrain/ground_summary.hpp"
#include "tools/trial/profile_text.hpp"
#include "tools/trial/trial_text.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::json;

double number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

template <NamedEnum E>
E enum_named(const std::string& name, E otherwise) {
  for (std::size_t i = 0; i < EnumNames<E>::value.size(); ++i)
    if (EnumNames<E>::value[i] == name) return static_cast<E>(i);
  return otherwise;
}

template <class T>
void read(const Json& json, T& value) {
  if constexpr (NamedEnum<T>) {
    value = enum_named(json.get<std::string>(), value);
  } else if constexpr (std::floating_point<T>) {
    value = static_cast<T>(number(json));
  } else if constexpr (std::integral<T>) {
    value = json.get<T>();
  } else if constexpr (HasFields<T>) {
    T::fields(value, [&](std::string_view key, auto& member) {
      if (const auto found = json.find(std::string(key)); found != json.end()) read(*found, member);
    });
  } else {  // array
    for (std::size_t i = 0; i < value.size(); ++i) read(json.at(i), value[i]);
  }
}

template <HasFields Record>
Record record_of(const Json& json) {
  Record record;
  read(json, record);
  return record;
}

LiveStride::Stiffness stiffness_of(const Json& json) {
  return {number(json.at("value")), number(json.at("ci95").at(0)), number(json.at("ci95").at(1)),
          json.at("valid").get<bool>(), readable(json.at("reason").get<std::string>())};
}

// Text on the ground after the newest stride, in the words of the trial's final line. A stride that reached
// no new ground has no result of its own.
void take_ground(TrialModel& model, const Json& json) {
  constexpr double kDepth_m = 0.020;
  if (model.strides.empty()) return;
  const auto profile = record_of<StrengthProfile>(json.at("profile"));
  const auto ground = record_of<GroundSummary>(json.at("ground"));
  auto& text = model.strides.back().ground;
  if (profile.samples == 0 && profile.stride > 1)
    text = "in its crater: no new ground";
  else if (ground.shape == GroundShape::unknown)
    text = "too little new ground";
  else if (!ground.line_valid)
    text = readable(std::string(name_of(ground.shape)));
  else if (!model.strides.back().joint.valid)
    text = fmt::format("line {:.0f} [{:.0f}, {:.0f}] N/m", ground.line_N_per_m.value,
                       ground.line_N_per_m.ci95_low, ground.line_N_per_m.ci95_high);
  const bool deep_enough =
      !text.empty() && !ground.line_valid && profile.samples > 0 && profile.depth_max_m >= kDepth_m;
  if (const auto force = force_at(profile, kDepth_m); deep_enough)
    text += fmt::format("; at 20 mm {:.1f} [{:.1f}, {:.1f}] N", force.value, force.low(), force.high());
  if (profile.depth_max_m > 0.0)
    model.known_ground = fmt::format("known from {:.0f} to {:.0f} mm: {}", 1e3 * profile.depth_min_m,
                                     1e3 * profile.depth_max_m, headline(ground));
}

// Reports only events that were found.
void take_ground_events(TrialModel& model, const Json& json) {
  const auto found = record_of<GroundEvents>(json);
  for (const auto* event : found_in(found))
    model.say(fmt::format("stride {}: {}", found.stride, in_words(*event)));
}

LiveStride stride_of(const Json& json) {
  const auto& stiffness = json.at("stiffness_N_per_m");
  return {json.at("stride").get<std::uint32_t>(),
          number(json.at("touchdown_speed_mps")),
          number(json.at("peak_force_N")),
          number(json.at("max_depth_m")),
          stiffness_of(stiffness.at("mo_wls")),
          stiffness_of(stiffness.at("joint")),
          {}};
}

std::string time_text(const TrialModel& model, std::int64_t time_ns) {
  if (!model.released_ns) return "";
  return fmt::format("{:+.3f} s  ", static_cast<double>(time_ns - *model.released_ns) * 1e-9);
}

std::string values_of_fault(const Json& json, Fault fault, const ConfigNode& robot) {
  Event event;
  event.kind = EventKind::fault_raised;
  event.fault = fault;
  for (std::size_t i = 0; i < event.values.size(); ++i) event.values[i] = number(json.at("values").at(i));
  return in_words(read_fault(event, &robot));
}

std::string event_text(EventKind kind, const Json& json, Fault fault) {
  const auto value = [&](std::size_t i) { return number(json.at("values").at(i)); };
  switch (kind) {
    case EventKind::armed:
      return "armed: the drives hold the leg, the encoders agree; release when ready";
    case EventKind::zero_check:
      return "";  // the next event reports it
    case EventKind::released:
      return fmt::format("released from {:.1f} mm", 1e3 * value(1));
    case EventKind::touchdown:
      return json.at("reason") == name_of(Reason::strides_done)
                 ? std::string("touchdown, soft stop")
                 : fmt::format("touchdown {}", json.at("stride").get<int>());
    case EventKind::stance_switch:
      return fmt::format("extending from {:.1f} mm", 1e3 * value(0));
    case EventKind::liftoff:
      return fmt::format("liftoff {}", json.at("stride").get<int>());
    case EventKind::stop_requested:
      return "stop requested: soft stop at the next touchdown";
    case EventKind::stopped:
      return "stopped: the drives are off";
    case EventKind::fault_raised:
      return fmt::format("FAULT {} {}", static_cast<int>(fault), name_of(fault));
    case EventKind::disarmed:
      return "disarmed: the drives are off";
    case EventKind::arming_refused:
      return "arming refused: " + json.value("text", readable(json.at("reason").get<std::string>()));
    case EventKind::disarm_refused:
      return fmt::format("disarming refused: {} must end first", name_of(fault));
    case EventKind::clock_stepped:
      return fmt::format("the date was set by {:+.3f} s; nothing depends on it", value(0));
  }
  return "";
}

void take_event(TrialModel& model, const Json& json) {
  const auto kind = enum_named(json.at("event").get<std::string>(), EventKind::armed);
  const auto time_ns = json.at("time_ns").get<std::int64_t>();
  const auto fault = enum_named(json.at("fault").get<std::string>(), Fault::none);
  if (kind == EventKind::armed) model.zero_checked = true;
  if (kind == EventKind::released) model.released_ns = time_ns;
  if (kind == EventKind::stopped && model.released_ns) model.over = true;
  if (kind == EventKind::fault_raised) {
    model.fault = fault;
    model.fault_values = values_of_fault(json, fault, model.robot);
  }
  if (kind == EventKind::disarmed) model.fault = Fault::none;
  const bool drives_go_off =
      kind == EventKind::stopped || kind == EventKind::disarmed || kind == EventKind::fault_raised;
  if (drives_go_off) model.zero_checked = false;
  auto text = event_text(kind, json, fault);
  if (kind == EventKind::fault_raised) text += ": " + model.fault_values;
  if (!text.empty()) model.say(time_text(model, time_ns) + text);
}

void take_status(TrialModel& model, const Json& json) {
  model.status = record_of<LiveStatus>(json);
  if (model.status->fault != model.fault) model.fault_values.clear();
  model.fault = model.status->fault;
  if (model.status->state == State::idle) model.zero_checked = false;
  model.history.push_back(*model.status);
  if (model.history.size() > TrialModel::kHistory) model.history.pop_front();
}

void take_end(TrialModel& model, const Json& end) {
  model.ended = true;
  model.last_state = enum_named(end.at("state").get<std::string>(), State::idle);
  model.fault = enum_named(end.at("fault").get<std::string>(), Fault::none);
  if (model.status) model.status->state = model.last_state;
  const auto& late = end.at("latency_us");
  model.ending = fmt::format(
      "{} cycles, {} overruns, {} records lost; woke late by {:.0f} us (median), "
      "{:.0f} us (99.9 %), {:.0f} us (worst)",
      end.at("cycles").get<std::int64_t>(), end.at("overruns").get<std::int64_t>(),
      end.at("lost_records").get<std::int64_t>(), number(late.at("p50")), number(late.at("p99_9")),
      number(late.at("max")));
  if (const auto trouble = end.at("log_error").get<std::string>(); !trouble.empty()) model.error = trouble;
}

// A word that was served is reported by its events.
void take_answer(TrialModel& model, const Json& answer) {
  if (answer.at("outcome") != name_of(RequestOutcome::served))
    model.say(answer.at("text").get<std::string>());
}

void take_json(TrialModel& model, const Json& json) {
  if (json.contains("status")) return take_status(model, json["status"]);
  if (json.contains("event")) return take_event(model, json);
  if (json.contains("stiffness_N_per_m")) return model.strides.push_back(stride_of(json));
  if (json.contains("ground")) return take_ground(model, json);
  if (json.contains("ground_events")) return take_ground_events(model, json["ground_events"]);
  if (json.contains("end")) return take_end(model, json["end"]);
  if (json.contains("request")) return take_answer(model, json["request"]);
  if (json.contains("ready")) {
    model.ready = true;
    return model.say("the cycle runs, the drives are off");
  }
  if (json.contains("warning")) return model.say("warning: " + json["warning"].get<std::string>());
  if (json.contains("error")) {
    model.error = json["error"].get<std::string>();
    return model.say("ERROR: " + model.error);
  }
  model.say(json.dump());
}

}  // namespace

void TrialModel::take(const std::string& line) {
  const auto json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return say(line);
  try {
    take_json(*this, json);
  } catch (const Json::exception&) {
    say(line);  // a line of another version
  }
}

void TrialModel::say(std::string message) {
  messages.push_back(std::move(message));
  if (messages.size() > kMessages) messages.pop_front();
}

}  // namespace sandhopper
