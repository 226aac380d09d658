#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace sandhopper::diagnose {

// insufficient_data: too few trials. consistent: no effect is needed. missing_physics: listed effects, or
// faults of the data, explain the difference. unknown_physics: something unlisted is needed, and the listed
// effects explain less than half of the difference or are not probable.
// insufficient_time: a limit of time ended the search before an effect was found needed.
enum class Verdict : std::uint8_t {
  insufficient_data,
  consistent,
  missing_physics,
  unknown_physics,
  insufficient_time
};

// True if nothing is said about the physics.
constexpr bool is_open(Verdict verdict) {
  return verdict == Verdict::insufficient_data || verdict == Verdict::insufficient_time;
}

// Kind of a verdict. known: listed effects only. one_of_class: listed effects of which some cannot be
// distinguished from others. known_and_rest: listed effects, and something unlisted. data_fault: only the
// recording is faulty. unknown_at_port: a law of free form was found at a port. unknown_not_localised: no
// such law was found. only_beyond_spread: consistent only if numbers vary more between trials than believed.
enum class Detail : std::uint8_t {
  none,
  too_little_data,
  known,
  one_of_class,
  known_and_rest,
  data_fault,
  unknown_at_port,
  unknown_not_localised,
  only_beyond_spread
};

// Their names in diagnosis.json, text and page, in the order of the enumerators.
inline constexpr std::array<std::string_view, 5> kVerdictNames{
    "insufficient_data", "consistent", "missing_physics", "unknown_physics", "insufficient_time"};
inline constexpr std::array<std::string_view, 9> kDetailNames{"null",
                                                              "too_little_data",
                                                              "known",
                                                              "one_of_class",
                                                              "known_and_rest",
                                                              "data_fault",
                                                              "unknown_at_port",
                                                              "unknown_not_localised",
                                                              "only_beyond_spread"};

constexpr std::string_view name_of(Verdict verdict) {
  return kVerdictNames[static_cast<std::size_t>(verdict)];
}
constexpr std::string_view name_of(Detail detail) { return kDetailNames[static_cast<std::size_t>(detail)]; }

// "missing_physics, known"; without a detail only the verdict.
inline std::string name_of(Verdict verdict, Detail detail) {
  std::string text(name_of(verdict));
  if (detail != Detail::none) text.append(", ").append(name_of(detail));
  return text;
}

}  // namespace sandhopper::diagnose
