#include "firmware/operator_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "config/json.hpp"
#include "firmware/fault_check.hpp"
#include "firmware/refusal_text.hpp"

namespace sandhopper {
namespace {

std::string json_string(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// JSON has no NaN: write null.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

// Text such as "release: overruled by stop".
std::string in_words(const RequestRecord& r) {
  const auto word = name_of(r.word);
  switch (r.outcome) {
    case RequestOutcome::served:
      return fmt::format("{}: {}", word, r.word == Word::unknown ? "soft stop" : "served");
    case RequestOutcome::no_effect:
      return fmt::format("{}: no effect in state {}", word, name_of(r.state));
    case RequestOutcome::overruled:
      return fmt::format("{}: overruled by {}", word, name_of(r.overruled_by));
    case RequestOutcome::refused:
      return fmt::format("{}: refused with {} words in all, {} are waiting", word, r.count,
                         RequestBox::kMost);
  }
  return {};
}

template <class Estimate>
std::string stiffness(const Estimate& k) {
  return fmt::format(R"({{"value":{},"ci95":[{},{}],"valid":{},"reason":"{}"}})", number(k.value_N_per_m),
                     number(k.ci95_low_N_per_m), number(k.ci95_high_N_per_m), k.validity == Validity::valid,
                     name_of(k.validity));
}

}  // namespace

std::string operator_text(const Event& e, const ConfigNode* robot) {
  const bool is_fault = e.kind == EventKind::fault_raised || e.kind == EventKind::disarm_refused;
  const auto text = is_fault ? in_words(read_fault(e, robot)) : refusal_text(e);
  return fmt::format(
      R"({{"event":"{}","reason":"{}","fault":"{}","stride":{},"time_ns":{},"values":[{},{},{},{}]{}}})",
      name_of(e.kind), name_of(e.reason), name_of(e.fault), e.stride, e.time_ns, number(e.values[0]),
      number(e.values[1]), number(e.values[2]), number(e.values[3]),
      text.empty() ? "" : R"(,"text":)" + json_string(text));
}

std::string operator_text(const StrideResult& r) {
  return fmt::format(R"({{"stride":{},"touchdown_speed_mps":{},"peak_force_N":{},"max_depth_m":{},)"
                     R"("stiffness_N_per_m":{{"qs_ols":{},"mo_ols":{},"mo_wls":{},"joint":{}}}}})",
                     r.summary.stride, number(r.summary.touchdown_speed_mps), number(r.summary.peak_force_N),
                     number(r.summary.max_depth_m), stiffness(r.quasi_static_ols), stiffness(r.observer_ols),
                     stiffness(r.observer_wls), stiffness(r.joint));
}

std::string operator_text(const StrengthProfile& p, const GroundSummary& ground) {
  return nlohmann::ordered_json{{"profile", to_json(p)}, {"ground", to_json(ground)}}.dump();
}

std::string operator_text(const GroundEvents& found) {
  return nlohmann::ordered_json{{"ground_events", to_json(found)}}.dump();
}

std::string operator_text(const RequestRecord& r) {
  auto json = to_json(r);
  json["text"] = in_words(r);
  return nlohmann::ordered_json{{"request", json}}.dump();
}

std::string operator_text(const SessionResult& r) {
  return fmt::format(R"({{"end":{{"state":"{}","fault":"{}","cycles":{},"overruns":{},"lost_records":{},)"
                     R"("lost_can_frames":{},"log_error":{},"clock_steps":{},"watchdog_trips":{},)"
                     R"("longest_stall_ms":{:.1f},)"
                     R"("latency_us":{{"p50":{},"p99":{},"p99_9":{},"max":{},"histogram":{}}}}}}})",
                     name_of(r.last_state), name_of(r.last_fault), r.cycles, r.overruns, r.lost_records,
                     r.lost_can_frames, json_string(r.log_error), r.clock_steps, r.watchdog_trips,
                     1e3 * r.longest_stall_s, r.latency.quantile_us(0.5), r.latency.quantile_us(0.99),
                     r.latency.quantile_us(0.999), r.latency.largest_us(), r.latency.as_json());
}

std::string operator_text(const std::string& key, const std::string& text) {
  return fmt::format("{{{}:{}}}", json_string(key), json_string(text));
}

std::string operator_text(const LiveStatus& status) {
  return fmt::format(R"({{"status":{}}})", to_json(status).dump());
}

}  // namespace sandhopper
