#include "tools/conceal/follow_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace sandhopper::conceal {
namespace {

constexpr double kLongest_s = 60.0;

}  // namespace

Setup completed(const Case& c, const Json& asked) {
  const auto kind = asked.value("kind", c.setups.front().kind());
  const auto like =
      std::find_if(c.setups.begin(), c.setups.end(), [&](const Setup& s) { return s.kind() == kind; });
  Setup setup;
  setup.keys["kind"] = kind;
  for (const auto& [key, value] : (like == c.setups.end() ? c.setups.front() : *like).keys.items())
    setup.keys[key] = value;
  for (const auto& [key, value] : asked.items()) {
    if (value.is_number_float())
      setup.keys[key] = six_digits(value.get<double>());
    else if (value.is_primitive() && !value.is_null())
      setup.keys[key] = value;
  }
  setup.keys["kind"] = kind;
  if (setup.number("duration_s", 1.0) > kLongest_s)
    throw std::invalid_argument(fmt::format("a trial may last {} s at most", kLongest_s));
  try {
    if (record(c, *c.bench, setup, c.recording.stream("rehearsal")).rows() < 10)
      throw std::invalid_argument("the trial asked for is over before it begins");
  } catch (const Json::exception& error) {
    throw std::invalid_argument(
        fmt::format("a key of the trial asked for has the wrong type: {}", error.what()));
  }
  return setup;
}

Setup random_setup(const Case& c) {
  // Drawn without the limits of an ambiguous campaign: any trial of the plant may be the one that separates
  // the class.
  auto setups = c.plant->build(c.apparatus)->draw_setups(8, c.recording.stream("control"));
  auto random = c.recording.stream("which control");
  return setups[static_cast<std::size_t>(random.below(8))];
}

}  // namespace sandhopper::conceal
