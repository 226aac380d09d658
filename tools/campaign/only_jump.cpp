#include "tools/campaign/only_jump.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {

std::vector<StepSample> step_samples(const TrialRecording& recording, std::string_view channel) {
  const auto values = recording.channel(channel);
  std::vector<StepSample> samples;
  for (std::size_t row = 0; row < values.size(); ++row)
    if (!std::isnan(values[row])) samples.push_back({recording.t_s[row], values[row], row});
  if (samples.size() < kFewestJumpRows) samples.clear();
  return samples;
}

Jump only_jump(const std::vector<StepSample>& samples) {
  if (samples.size() < 2) return {};
  std::vector<std::size_t> places;  // of the steps, the largest first
  for (std::size_t i = 1; i < samples.size(); ++i) places.push_back(i);
  const auto signed_step = [&](std::size_t i) { return samples[i].value - samples[i - 1].value; };
  const auto step = [&](std::size_t i) { return std::abs(signed_step(i)); };
  std::ranges::stable_sort(places, [&](std::size_t a, std::size_t b) { return step(a) > step(b); });
  std::size_t jumps = 1;
  while (jumps < places.size() && !(step(places[jumps - 1]) > kJumpTimes * step(places[jumps]))) ++jumps;
  if (jumps % 2 == 0 || jumps >= places.size() || !(step(places[jumps]) > 0.0)) return {};
  places.resize(jumps);
  std::ranges::sort(places);
  for (std::size_t k = 1; k < jumps; ++k)
    if (signed_step(places[k]) * signed_step(places[k - 1]) > 0.0) return {};
  const std::size_t first = places.front(), last = places.back();
  if (first < 2 || last + 2 >= samples.size()) return {};
  const double usual_s = (samples.back().t_s - samples.front().t_s) / static_cast<double>(samples.size() - 1);
  const bool in_motion = step(first - 1) > 0.0 && step(last + 1) > 0.0;
  const bool is_gap = samples[last].t_s - samples[last - 1].t_s >= kJumpGap * usual_s;
  return in_motion && !is_gap ? Jump{first - 1, last} : Jump{};
}

}  // namespace sandhopper
