#include "tools/diagnose/plants/hopper_runs.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>

namespace sandhopper::diagnose {
namespace {

bool acts_on_plant(const std::string& channel) {
  return channel == "actuator" || channel.ends_with("position_rad");
}

// Bit by bit: a nuisance that is not a number is equal to itself.
bool same(const HopperRuns::Key& a, const HopperRuns::Key& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

HopperRuns::Key HopperRuns::key(const Edits& edits, std::span<const double> plant_nuisances) {
  if (edits.laws_key == 0) return {};
  Key key{std::bit_cast<double>(edits.laws_key)};
  for (const auto& edit : edits.belief) {
    key.push_back(static_cast<double>(std::hash<std::string>{}(edit.key) >> 12));
    key.push_back(edit.factor);
    key.push_back(edit.addend);
  }
  for (const auto& edit : edits.sensors)
    if (acts_on_plant(edit.channel)) {
      if (edit.kind == SensorEdit::Kind::law && edit.law_key == 0) return {};
      key.push_back(static_cast<double>(edit.kind));
      key.push_back(edit.value);
      key.push_back(std::bit_cast<double>(edit.law_key));
    }
  key.insert(key.end(), plant_nuisances.begin(), plant_nuisances.end());
  return key;
}

const HopperTraces* HopperRuns::find(const Key& key, std::uint32_t block) {
  if (key.empty()) return nullptr;
  for (auto& run : runs_)
    if (run.block == block && same(run.key, key)) {
      run.used = ++clock_;
      return &run.traces;
    }
  return nullptr;
}

const HopperTraces& HopperRuns::keep(const Key& key, std::uint32_t block, HopperTraces traces) {
  auto& oldest = *std::ranges::min_element(runs_, {}, &Run::used);
  oldest = {key, block, ++clock_, std::move(traces)};
  return oldest.traces;
}

}  // namespace sandhopper::diagnose
