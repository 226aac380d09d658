#include "tools/diagnose/recordings/events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/fit/linearise.hpp"

namespace sandhopper::diagnose {
namespace {

// The limits were set by hand.
constexpr std::uint32_t kStretchesOfATrial = 4;  // least number of stretches of a trial
constexpr std::size_t kStretches = 40;           // stretches for each possible event
// Least mean square over the noise; the event itself has raised the noise.
constexpr double kFarFromEvent = 9.0;
constexpr double kFartherThanAny = 25.0;  // least ratio to the mean square of the next stretch
constexpr double kFewestRows = 10.0;      // rows of a stretch

struct EventStretch {
  Event event;
  double mean_square = 0.0;
};

std::vector<EventStretch> stretches_of(const Problem& problem, const Point& point) {
  const auto linear = linearise_all(problem, point, {});
  std::vector<EventStretch> all;
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    const auto& trial = *problem.trials[t];
    if (trial.blocks < kStretchesOfATrial) continue;
    std::vector<EventStretch> own(trial.blocks);
    std::vector<double> rows(trial.blocks, 0.0), worst(trial.blocks, 0.0);
    for (auto& stretch : own) stretch.event.trial = t;
    for (std::size_t k = 0; k < trial.rows.size(); ++k) {
      if (!problem.used[t][k]) continue;
      const auto& row = trial.rows[k];
      auto& [event, mean_square] = own[row.block];
      const double off = linear[t].residual[static_cast<Eigen::Index>(k)];
      const double over_noise = std::abs(off) / problem.noise.sd(trial, row);
      mean_square += over_noise * over_noise;
      ++rows[row.block];
      event.from_s = std::min(event.from_s, row.time_s);
      event.to_s = std::max(event.to_s, row.time_s);
      if (over_noise > worst[row.block]) {
        worst[row.block] = over_noise;
        event.channel = problem.channels[row.channel];
        event.furthest = std::abs(off);
      }
    }
    for (std::uint32_t b = 0; b < trial.blocks; ++b) {
      if (rows[b] < kFewestRows) continue;
      own[b].mean_square /= rows[b];
      all.push_back(std::move(own[b]));
    }
  }
  return all;
}

}  // namespace

std::vector<Event> find_events(const Problem& problem, const Point& point) {
  auto all = stretches_of(problem, point);
  std::ranges::sort(all, std::ranges::greater{}, &EventStretch::mean_square);
  for (std::size_t n = all.size() / kStretches; n > 0; --n) {
    const double others = all[n].mean_square;
    if (all[n - 1].mean_square < std::max(kFarFromEvent, kFartherThanAny * others)) continue;
    std::vector<Event> events;
    for (std::size_t i = 0; i < n; ++i) {
      events.push_back(all[i].event);
      events.back().times_others = std::sqrt(all[i].mean_square / others);
    }
    return events;
  }
  return {};
}

void leave_out(const std::vector<Event>& events, const Problem& problem, Recordings& recordings) {
  for (const auto& event : events) {
    const auto recorded =
        std::ranges::find(recordings.trials, problem.trials[event.trial]->name, &Trial::name);
    if (recorded == recordings.trials.end()) continue;
    for (auto& [channel, values] : recorded->channels)
      for (std::size_t i = 0; i < values.size(); ++i)
        if (recorded->time_s[i] >= event.from_s && recorded->time_s[i] <= event.to_s)
          values[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace sandhopper::diagnose
