#pragma once
#include <string>
#include <vector>

#include "tools/conceal/core/plant_of.hpp"

namespace sandhopper::conceal {

// Clock and data faults of any of the given channels. `World` has a map `faults` from channel to
// ChannelFaults.
template <class World>
std::vector<Recipe<World>> data_fault_recipes(std::function<std::vector<std::string>(const World&)> channels,
                                              double typical_skew_s) {
  const auto pick = [channels](const World& w, Random& random) {
    const auto all = channels(w);
    return all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))];
  };
  return {
      {{"clock.skew", "", "clock"},
       [=](World& w, double size, Random& random) -> Json {
         const auto channel = pick(w, random);
         const double late_s = random.sign() * size * typical_skew_s;
         w.faults[channel].late_s += late_s;
         return {{"channel", channel}, {"skew_s", late_s}};
       }},
      {{"clock.drift", "", "clock"},
       [=](World& w, double size, Random& random) -> Json {
         const auto channel = pick(w, random);
         const double drift = random.sign() * size * 2e-3;
         w.faults[channel].drift += drift;
         return {{"channel", channel}, {"drift", drift}};
       }},
      {{"data.dropout", "", "data"},
       [=](World& w, double size, Random& random) -> Json {
         const auto channel = pick(w, random);
         w.faults[channel].dropout_rate_Hz = 4.0 * size;
         w.faults[channel].dropout_s = 0.012;
         return {{"channel", channel}, {"rate_Hz", 4.0 * size}, {"duration_s", 0.012}};
       }},
      {{"data.stuck", "", "data"},
       [=](World& w, double size, Random& random) -> Json {
         const auto channel = pick(w, random);
         w.faults[channel].stuck_rate_Hz = 1.5;
         w.faults[channel].stuck_s = 0.08 * size;
         return {{"channel", channel}, {"rate_Hz", 1.5}, {"duration_s", 0.08 * size}};
       }},
  };
}

template <class T>
void append(std::vector<T>& to, std::vector<T> more) {
  for (auto& one : more) to.push_back(std::move(one));
}

}  // namespace sandhopper::conceal
