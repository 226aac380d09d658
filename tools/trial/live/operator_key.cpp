#include "tools/trial/live/operator_key.hpp"

#include <fmt/format.h>

namespace sandhopper {
namespace {

bool in_flight_or_stance(State state) {
  return state == State::flight || state == State::compression || state == State::extension;
}

std::optional<std::string> why_not_arm(const TrialModel& model) {
  const auto state = model.state();
  if (state == State::fault) {
    return fmt::format("arm: there is a fault ({}); do what its cure says, then d to disarm",
                       name_of(model.fault));
  }
  if (model.over) return "arm: this trial is over and a log holds one trial; q closes the log";
  if (state != State::idle) return "arm: is armed already";
  return std::nullopt;
}

std::optional<std::string> why_not_release(const TrialModel& model) {
  const auto state = model.state();
  if (state == State::idle && model.over) return "release: this trial is over; q closes the log";
  if (state == State::idle || state == State::fault) return "release: arm first (a)";
  if (state != State::armed) return "release: is released already";
  if (!model.zero_checked) return "release: the zero check still runs; wait for 'armed' below";
  return std::nullopt;
}

std::optional<std::string> why_not_stop(const TrialModel& model) {
  const auto state = model.state();
  if (state == State::idle) return "stop: nothing to stop, the drives are off";
  if (state == State::soft_stop) return "stop: is stopping already; q q switches the drives off at once";
  if (state == State::fault) return "stop: the fault's own reaction runs or has ended; d disarms";
  return std::nullopt;
}

std::optional<std::string> why_not_disarm(const TrialModel& model) {
  const auto state = model.state();
  if (state == State::idle) return "disarm: is disarmed already";
  if (in_flight_or_stance(state))
    return "disarm: would drop the hopping robot; s stops it softly, q q lets go at once";
  if (state == State::soft_stop)
    return "disarm: is stopping; the drives go off when it rests, q q lets go at once";
  return std::nullopt;
}

}  // namespace

const OperatorKey* operator_key(char32_t typed) {
  constexpr char32_t kCtrl_C = 3;
  if (typed == U' ') typed = U's';
  if (typed == kCtrl_C) typed = U'q';
  if (typed >= U'A' && typed <= U'Z') typed += U'a' - U'A';
  for (const auto& key : kOperatorKeys)
    if (static_cast<char32_t>(key.key) == typed) return &key;
  return nullptr;
}

std::optional<std::string> why_not(std::string_view word, const TrialModel& model) {
  if (word == "quit") return std::nullopt;
  if (model.quitting) return fmt::format("{}: is quitting; q again switches the drives off at once", word);
  if (!model.ready) return fmt::format("{}: the cycle does not run yet", word);
  if (word == "arm") return why_not_arm(model);
  if (word == "release") return why_not_release(model);
  if (word == "stop") return why_not_stop(model);
  return why_not_disarm(model);
}

}  // namespace sandhopper
