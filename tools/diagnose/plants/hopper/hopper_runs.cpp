#include "tools/diagnose/plants/hopper/hopper_runs.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <utility>

namespace sandhopper::diagnose {
namespace {

constexpr std::uint64_t kStay = 200;  // askings that a run stays longer which was asked for again

bool acts_on_plant(const std::string& channel) {
  return channel == "actuator" || channel.ends_with("position_rad");
}

// Bit by bit: a nuisance that is not a number is equal to itself.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// False where nothing tells its law apart from others.
bool append(const SensorEdit& edit, std::vector<double>& key) {
  key.push_back(static_cast<double>(edit.kind));
  key.push_back(edit.value);
  key.push_back(std::bit_cast<double>(edit.law_key));
  return edit.kind != SensorEdit::Kind::law || edit.law_key != 0;
}

// The depth law's numbers act in the ground alone. A rigid bed is another plant.
bool acts_in_ground(const BeliefEdit& edit) {
  return edit.key.starts_with("terrain.") && edit.key != "terrain.rigid";
}

}  // namespace

bool HopperRuns::Key::operator==(const Key& other) const {
  return known() && other.known() && same(always, other.always) && same(in_ground, other.in_ground) &&
         same(by_depth, other.by_depth);
}

double HopperRuns::Key::differs_below_m(const Key& other) const {
  if (in_ground.empty() || !same(in_ground, other.in_ground) || by_depth.size() != other.by_depth.size())
    return 0.0;
  std::size_t i = 0;
  while (i < by_depth.size() && by_depth[i] == other.by_depth[i]) ++i;
  // A little less, for a depth that is rounded on its way to a knot.
  constexpr double kRounding = 1e-9;
  return std::max(0.0, static_cast<double>(i) - 1.0 - kRounding) * knot_spacing_m;
}

HopperRuns::Key HopperRuns::key(const Edits& edits, RunNuisances nuisances) {
  Key key{std::move(nuisances.always), std::move(nuisances.in_ground), std::move(nuisances.by_depth),
          nuisances.knot_spacing_m};
  for (const auto& edit : edits.belief) {
    auto& part = acts_in_ground(edit) ? key.in_ground : key.always;
    part.push_back(static_cast<double>(std::hash<std::string>{}(edit.key) >> 12));
    part.push_back(edit.factor);
    part.push_back(edit.addend);
  }
  key.always.push_back(std::bit_cast<double>(edits.laws_key));
  key.in_ground.push_back(std::bit_cast<double>(edits.ground_laws_key));
  bool known = edits.laws_key != 0;
  for (const auto& edit : edits.sensors)
    if (acts_on_plant(edit.channel)) known = append(edit, key.always) && known;
  if (!known) key.always.clear();
  if (edits.ground_laws_key == 0) key.in_ground.clear();
  return key;
}

HopperRuns::ReadingKey HopperRuns::reading_key(const Edits& edits, std::string_view channel,
                                               std::span<const double> own_nuisances) {
  ReadingKey key{static_cast<double>(own_nuisances.size())};
  key.insert(key.end(), own_nuisances.begin(), own_nuisances.end());
  for (const auto& edit : edits.sensors)
    if (edit.channel == channel && !append(edit, key)) return {};
  return key;
}

bool HopperRuns::Run::Reading::copied(const ReadingKey& wanted, std::span<double> out) const {
  if (wanted.empty() || values.size() != out.size() || !same(key, wanted)) return false;
  std::ranges::copy(values, out.begin());
  return true;
}

HopperRuns::Run* HopperRuns::find(const Key& key, std::uint32_t block) {
  ++clock_;
  if (!key.known()) return nullptr;
  for (auto& run : runs_) {
    if (run.block_ != block || !run.key_.known() || !same(run.key_.always, key.always) ||
        !same(run.key_.in_ground, key.in_ground))
      continue;
    // The foot never reached the depth at which the bed differs.
    const bool as_deep =
        run.traces.bed_reached_m > 0.0 && run.traces.bed_reached_m < run.key_.differs_below_m(key);
    if (!as_deep && !same(run.key_.by_depth, key.by_depth)) continue;
    run.worth_ = clock_ + kStay;
    return &run;
  }
  return nullptr;
}

HopperResumed HopperRuns::resumed(const Key& key, std::uint32_t block) {
  HopperResumed latest;
  Run* of = nullptr;
  if (key.always.empty()) return latest;
  for (auto& run : runs_) {
    if (run.block_ != block || run.traces.moments.empty() || !same(run.key_.always, key.always)) continue;
    const double below_m = key.differs_below_m(run.key_);
    const HopperMoment* at = nullptr;
    for (const auto& moment : run.traces.moments)
      if (moment.plant.bed_reached_m <= below_m) at = &moment;
    if (at == nullptr || (latest.at != nullptr && at->step <= latest.at->step)) continue;
    latest = {&run.traces, at};
    of = &run;
  }
  if (of != nullptr) of->worth_ = clock_ + kStay;
  return latest;
}

HopperRuns::Run& HopperRuns::keep(const Key& key, std::uint32_t block, HopperTraces traces) {
  Run& least = *std::ranges::min_element(runs_, {}, &Run::worth_);
  least.traces = std::move(traces);
  least.key_ = key;
  least.block_ = block;
  least.worth_ = clock_;
  for (auto& reading : least.readings_) reading.key.clear();
  return least;
}

}  // namespace sandhopper::diagnose
